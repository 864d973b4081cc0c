//! Figures as SVG: lines, points and bands over linear or logarithmic axes.

mod axis;
mod clip;
mod draw;
mod legend;
mod marks;
mod page;
mod scale;

use crate::error::Error;
pub use axis::{Axis, ScaleKind};
pub(super) use page::escaped;

/// What is drawn of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Look {
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
    look: Look,
    points: Vec<(f64, f64, f64)>,
}

/// A series with the numbers by which it is told apart.
#[derive(Clone, Copy, Debug)]
struct Numbered<'a> {
    /// Number of its colour and marker.
    colour: usize,
    /// Number of its stroke, among series of this look.
    line: usize,
    series: &'a Series,
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
    x: Axis,
    y: Axis,
    /// Whether both axes have one scale.
    is_equal: bool,
    series: Vec<Series>,
}

impl Figure {
    /// Horizontal axis of the figure.
    pub(super) fn x_axis(&mut self) -> &mut Axis {
        &mut self.x
    }

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
        self.with(label, Look::Line, points)
    }

    /// A dashed line through points (x, y), broken where y is not a number.
    pub fn dashed(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, Look::Dashed, points)
    }

    /// Points (x, y).
    pub fn points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, Look::Points, points)
    }

    /// Points (x, y) joined by a line, broken where y is not a number.
    pub fn line_with_points(self, label: impl Into<String>, points: Vec<(f64, f64)>) -> Figure {
        self.with(label, Look::LineWithPoints, points)
    }

    /// The area between `low` and `high` of points (x, low, high).
    pub fn band(mut self, label: impl Into<String>, points: Vec<(f64, f64, f64)>) -> Figure {
        self.series.push(Series {
            label: label.into(),
            look: Look::Band,
            points,
        });
        self
    }

    /// A vertical line at `x`. Its label stands in the legend, once for all marks with the same label.
    pub fn vertical_mark(self, x: f64, label: impl Into<String>) -> Figure {
        self.with(label, Look::VerticalMark, vec![(x, f64::NAN)])
    }

    /// The figure as SVG; equal figures give equal texts.
    ///
    /// # Errors
    /// [`Error::Write`], which would be a defect.
    pub fn to_svg(&self) -> Result<String, Error> {
        Sheet::default().svg(std::slice::from_ref(self))
    }

    fn with(mut self, label: impl Into<String>, look: Look, points: Vec<(f64, f64)>) -> Figure {
        self.series.push(Series {
            label: label.into(),
            look,
            points: points.into_iter().map(|(x, y)| (x, y, y)).collect(),
        });
        self
    }
}

impl Figure {
    /// Coordinates of all points that have a place on both axes.
    fn values(&self, of: impl Fn((f64, f64, f64)) -> [f64; 2]) -> impl Iterator<Item = f64> {
        let marks = |series: &Series| series.look == Look::VerticalMark;
        let (x, y) = (&self.x, &self.y);
        self.series
            .iter()
            .flat_map(move |series| {
                let seen = move |(a, low, high): &(f64, f64, f64)| {
                    x.shows(*a) && (marks(series) || y.shows(*low) || y.shows(*high))
                };
                series.points.iter().copied().filter(seen)
            })
            .flat_map(of)
    }

    fn is_empty(&self) -> bool {
        self.values(|(_, low, high)| [low, high])
            .all(|value| value.is_nan())
    }

    /// The series with the numbers of their looks: one number for each label.
    fn numbered(&self) -> Vec<Numbered<'_>> {
        let mut labels: Vec<&str> = Vec::new();
        let mut drawn: Vec<(Look, usize)> = Vec::new();
        let mut numbered = Vec::new();
        for series in &self.series {
            let label = series.label.as_str();
            let known = labels.iter().position(|other| *other == label);
            let known = known.filter(|_| !label.is_empty());
            if known.is_none() && series.look != Look::VerticalMark {
                labels.push(label);
            }
            let colour = known.unwrap_or(labels.len().saturating_sub(1));
            let line = (series.look, colour);
            if !drawn.contains(&line) {
                drawn.push(line);
            }
            let alike = drawn.iter().filter(|(look, _)| *look == series.look);
            let line = alike.take_while(|other| **other != line).count();
            numbered.push(Numbered {
                colour,
                line,
                series,
            });
        }
        numbered
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

impl Sheet<'_> {
    /// The figures as SVG; equal figures give equal texts.
    ///
    /// # Errors
    /// [`Error::Refused`] if the sheet is too small for them.
    pub fn svg(&self, figures: &[Figure]) -> Result<String, Error> {
        page::svg(self, figures)
    }
}
