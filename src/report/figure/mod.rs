//! Figures as SVG: lines, points and bands over linear or logarithmic axes.

mod axis;
mod clip;
mod panel;
mod sheet;
mod svg;
mod words;

use crate::error::Error;
pub use axis::Axis;
pub(super) use words::escaped;

/// What is drawn of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SeriesStyle {
    Line,
    Dashed,
    Points,
    LineWithPoints,
    Band,
    VerticalMark,
}

/// Points (x, low, high); of all but bands low and high are the same.
#[derive(Clone, Debug, PartialEq)]
struct Series {
    label: String,
    look: SeriesStyle,
    points: Vec<(f64, f64, f64)>,
    /// Number of the colour and the marker: one for each label.
    colour: usize,
    /// Number of the stroke, among series of this look.
    stroke: usize,
}

/// A figure: a title, two axes and series of points.
///
/// Series with the same label share colour and entry in the legend; those with an empty label have no
/// entry. A point without a place on the axes (not a number, infinite, not positive on a logarithmic axis)
/// is left out, and a line is broken there.
///
/// ```
/// use slider_crank::report::{Axis, Figure};
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
    title: String,
    pub(super) x: Axis,
    y: Axis,
    /// Whether both axes have one scale.
    is_equal: bool,
    series: Vec<Series>,
}

impl Figure {
    /// A figure without series.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Figure {
        Figure {
            title: title.into(),
            x,
            y,
            is_equal: false,
            series: Vec::new(),
        }
    }

    /// With one scale for both linear axes, so that a circle looks like one.
    pub fn equal(mut self) -> Figure {
        self.is_equal = true;
        self
    }

    /// A line through points (x, y), broken where y is not a number.
    pub fn line(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Line, points)
    }

    /// A dashed line through points (x, y), broken where y is not a number.
    pub fn dashed(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Dashed, points)
    }

    /// Points (x, y).
    pub fn points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::Points, points)
    }

    /// Points (x, y) joined by a line, broken where y is not a number.
    pub fn line_with_points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, SeriesStyle::LineWithPoints, points)
    }

    /// A vertical line at `x`. Its label stands in the legend, once for all marks with the same label.
    pub fn vertical_mark(self, x: f64, label: impl Into<String>) -> Figure {
        self.with(label, SeriesStyle::VerticalMark, vec![(x, f64::NAN)])
    }

    fn with(self, label: impl Into<String>, look: SeriesStyle, points: Vec<(f64, f64)>) -> Figure {
        let points = points.into_iter().map(|(x, y)| (x, y, y));
        self.push(label.into(), look, points.collect())
    }

    /// The area between `low` and `high` of points (x, low, high).
    pub fn band(self, label: impl Into<String>, points: Vec<(f64, f64, f64)>) -> Figure {
        self.push(label.into(), SeriesStyle::Band, points)
    }

    fn push(mut self, label: String, look: SeriesStyle, points: Vec<(f64, f64, f64)>) -> Figure {
        let next = |numbers: &mut dyn Iterator<Item = usize>| numbers.max().map_or(0, |n| n + 1);
        let coloured = || {
            self.series
                .iter()
                .filter(|s| s.look != SeriesStyle::VerticalMark)
        };
        let known = coloured().find(|s| !label.is_empty() && s.label == label);
        let colour = known.map_or_else(|| next(&mut coloured().map(|s| s.colour)), |s| s.colour);
        let alike = || self.series.iter().filter(|s| s.look == look);
        let known = alike().find(|s| s.colour == colour);
        let stroke = known.map_or_else(|| next(&mut alike().map(|s| s.stroke)), |s| s.stroke);
        self.series.push(Series {
            label,
            look,
            points,
            colour,
            stroke,
        });
        self
    }

    /// The figure as SVG; equal figures give equal texts.
    ///
    /// # Errors
    /// [`Error::Refused`] if there is no room.
    pub fn to_svg(&self) -> Result<String, Error> {
        Sheet::default().svg(std::slice::from_ref(self))
    }

    /// Coordinates of all points that have a place on both axes.
    fn values(&self, of: impl Fn((f64, f64, f64)) -> [f64; 2]) -> impl Iterator<Item = f64> {
        let seen = |series: &Series, (x, low, high): (f64, f64, f64)| {
            let shown = self.y.shows(low) || self.y.shows(high);
            self.x.shows(x) && (shown || series.look == SeriesStyle::VerticalMark)
        };
        let all = self.series.iter();
        let points = all.flat_map(move |series| {
            let points = series.points.iter().copied();
            points.filter(move |point| seen(series, *point))
        });
        points.flat_map(of)
    }
}

/// Width and height of a picture, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// mm
    pub width: f64,
    /// mm
    pub height: f64,
}

/// Several figures on one sheet, side by side in `columns` columns, row by row, under a common title.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheet<'a> {
    /// Above all figures.
    pub title: &'a str,
    /// Figures beside each other; 0 is 1.
    pub columns: usize,
    /// Size of the sheet; without it each figure has its usual one.
    pub size: Option<Shape>,
}
