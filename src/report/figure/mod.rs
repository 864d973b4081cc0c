//! Figures as SVG: lines, points and bands over linear or logarithmic axes.

mod clip;
mod draw;
mod legend;
mod marks;
mod page;
mod scale;

use crate::error::Error;

/// How values are spread over an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleKind {
    /// Evenly.
    Linear,
    /// Evenly, read at parts of a turn.
    Degrees,
    /// By their logarithm; values that are not positive have no place.
    Log,
}

/// An axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    label: String,
    kind: ScaleKind,
    range: Option<(f64, f64)>,
}

impl Axis {
    /// A linear axis; the label names the quantity and its unit.
    pub fn linear(label: impl Into<String>) -> Axis {
        Axis {
            label: label.into(),
            kind: ScaleKind::Linear,
            range: None,
        }
    }

    /// A linear axis of angles in degrees, with ticks at parts of a turn; the label names the angle and its unit.
    pub fn degrees(label: impl Into<String>) -> Axis {
        Axis {
            kind: ScaleKind::Degrees,
            ..Axis::linear(label)
        }
    }

    /// A logarithmic axis; the label names the quantity and its unit.
    pub fn log(label: impl Into<String>) -> Axis {
        Axis {
            kind: ScaleKind::Log,
            ..Axis::linear(label)
        }
    }

    /// Shows exactly this range; what lies outside is cut off. Without it the axis fits the values.
    pub fn range(mut self, low: f64, high: f64) -> Axis {
        self.range = Some((low, high));
        self
    }

    /// Whether a value has a place on the axis.
    fn shows(&self, value: f64) -> bool {
        scale::coordinate(self.kind, value).is_finite()
    }
}

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
    series: Vec<Series>,
}

impl Figure {
    /// A figure without series.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Figure {
        Figure {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
        }
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

    /// The figure as SVG; the same figure gives the same text.
    pub fn to_svg(&self) -> Result<String, Error> {
        page::svg("", std::slice::from_ref(self), 1)
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

    /// The series with the numbers of their colours: one number for each label.
    fn numbered(&self) -> Vec<(usize, &Series)> {
        let mut labels: Vec<&str> = Vec::new();
        let mut numbered = Vec::new();
        for series in &self.series {
            let label = series.label.as_str();
            let known = labels.iter().position(|other| *other == label);
            let known = known.filter(|_| !label.is_empty());
            if known.is_none() && series.look != Look::VerticalMark {
                labels.push(label);
            }
            numbered.push((known.unwrap_or(labels.len().saturating_sub(1)), series));
        }
        numbered
    }
}

/// Several figures side by side in `columns` columns, row by row, under a common title.
pub fn panels(title: &str, figures: &[Figure], columns: usize) -> Result<String, Error> {
    page::svg(title, figures, columns.max(1))
}
