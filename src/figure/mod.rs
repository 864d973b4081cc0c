//! Plots as SVG: lines, points, bands and vertical marks over linear or logarithmic axes.

mod axis;
mod clip;
mod layout;
mod panel;
mod sheet;
mod svg;
mod words;

use crate::error::Error;
pub use axis::Axis;
pub use sheet::sheet;
pub(crate) use words::escaped;

/// Resolution of a figure, pixels per inch: that of CSS.
pub(crate) const PIXELS_PER_INCH: f64 = 96.0;

/// Style of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SeriesStyle {
    Line,
    Dashed,
    Points,
    LineWithPoints,
    Band,
    VerticalMark,
}

/// Labelled points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in the legend; empty for no entry.
    pub label: String,
    style: SeriesStyle,
    /// Points (x, low, high); low equals high except for bands. What cannot be drawn is NaN.
    pub points: Vec<(f64, f64, f64)>,
    /// Index of colour and marker, one per label.
    colour: usize,
    /// Index of the stroke, among series of this style.
    stroke: usize,
}

/// Figure: title, two axes and series of points.
///
/// Series with one label share colour and entry in the legend; an empty label has no entry. A point that cannot be
/// drawn (NaN, infinite, not positive on a logarithmic axis) is left out, and breaks a line.
///
/// ```
/// use slider_crank::figure::{Axis, Figure};
///
/// let figure = Figure::new(
///     "Error of a run",
///     Axis::log("tolerance"),
///     Axis::log("error [rad]"),
/// )
/// .line_with_points("dop853", vec![(1e-6, 1e-5), (1e-9, 2e-8), (1e-12, 1e-11)])
/// .dashed("as asked for", vec![(1e-12, 1e-12), (1e-6, 1e-6)]);
/// let svg = figure.to_svg()?;
/// assert!(svg.starts_with("<svg") && svg.contains("error [rad]"));
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    pub(crate) title: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// Whether both axes have equal pixels per unit.
    is_equal: bool,
    /// Series, in the order of the legend.
    pub series: Vec<Series>,
}

impl Figure {
    /// Returns a figure without series.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Figure {
        Figure {
            title: title.into(),
            x,
            y,
            is_equal: false,
            series: Vec::new(),
        }
    }

    /// Sets equal pixels per unit on both linear axes, which keeps circles round.
    pub fn equal(mut self) -> Figure {
        self.is_equal = true;
        self
    }

    /// Adds a line through points (x, y), broken where y is NaN.
    pub fn line(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Line, points)
    }

    /// Adds a dashed line through points (x, y), broken where y is NaN.
    pub fn dashed(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Dashed, points)
    }

    /// Adds points (x, y).
    pub fn points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Points, points)
    }

    /// Adds points (x, y) joined by a line, broken where y is NaN.
    pub fn line_with_points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::LineWithPoints, points)
    }

    /// Adds a vertical line at `x`; the legend shows each label once.
    pub fn vertical_mark(self, x: f64, label: impl Into<String>) -> Figure {
        self.with(label, SeriesStyle::VerticalMark, vec![(x, f64::NAN)])
    }

    fn with(self, label: impl Into<String>, style: SeriesStyle, points: Vec<(f64, f64)>) -> Figure {
        let points = points.into_iter().map(|(x, y)| (x, y, y));
        self.push(label.into(), style, points.collect())
    }

    /// Adds the area between `low` and `high` of points (x, low, high).
    pub fn band(self, label: impl Into<String>, points: Vec<(f64, f64, f64)>) -> Figure {
        self.push(label.into(), SeriesStyle::Band, points)
    }

    fn push(mut self, label: String, style: SeriesStyle, points: Vec<(f64, f64, f64)>) -> Figure {
        let next = |numbers: &mut dyn Iterator<Item = usize>| numbers.max().map_or(0, |n| n + 1);
        let is_coloured = |s: &&Series| s.style != SeriesStyle::VerticalMark;
        let coloured = || self.series.iter().filter(is_coloured);
        let known = coloured().find(|s| !label.is_empty() && s.label == label);
        let colour = known.map_or_else(|| next(&mut coloured().map(|s| s.colour)), |s| s.colour);
        let alike = || self.series.iter().filter(|s| s.style == style);
        let known = alike().find(|s| s.colour == colour);
        let stroke = known.map_or_else(|| next(&mut alike().map(|s| s.stroke)), |s| s.stroke);
        self.series.push(Series {
            label,
            style,
            points,
            colour,
            stroke,
        });
        self
    }

    /// Returns the figure as SVG; equal figures give equal texts.
    pub fn to_svg(&self) -> Result<String, Error> {
        sheet("", 1, None, std::slice::from_ref(self))
    }

    /// Returns coordinates of all points that can be drawn on both axes.
    fn values(&self, of: impl Fn((f64, f64, f64)) -> [f64; 2]) -> impl Iterator<Item = f64> {
        let seen = |series: &Series, (x, low, high): (f64, f64, f64)| {
            let shown = self.y.shows(low) || self.y.shows(high);
            self.x.shows(x) && (shown || series.style == SeriesStyle::VerticalMark)
        };
        let all = self.series.iter();
        let points = all.flat_map(move |series| {
            let points = series.points.iter().copied();
            points.filter(move |point| seen(series, *point))
        });
        points.flat_map(of)
    }
}

/// Size of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Width, mm.
    pub width: f64,
    /// Height, mm.
    pub height: f64,
}
