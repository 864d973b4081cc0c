//! The figures of the papers as data.

/// A figure of a paper, drawn anew.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Name of the paper.
    pub paper: &'static str,
    /// Name of its file, without ending.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// One plot below or beside the other.
    pub plots: Vec<Plot>,
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Name and unit of the horizontal axis.
    pub x: String,
    /// Name and unit of the vertical axis.
    pub y: String,
    /// What is drawn.
    pub series: Vec<Series>,
}

/// One curve or set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name of the curve in the legend.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// x and y; y is not a number where there is no value.
    pub points: Vec<(f64, f64)>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line.
    Line,
    /// A dashed line.
    Dashed,
    /// Single points.
    Points,
}

impl Drawing {
    pub(super) fn new(name: &str, title: &str, plots: Vec<Plot>) -> Drawing {
        Drawing {
            paper: "",
            name: name.to_owned(),
            title: title.to_owned(),
            plots,
        }
    }
}

impl Plot {
    pub(super) fn new(x: &str, y: &str) -> Plot {
        Plot {
            x: x.to_owned(),
            y: y.to_owned(),
            series: Vec::new(),
        }
    }

    pub(super) fn add(&mut self, label: &str, style: Style, points: Vec<(f64, f64)>) {
        self.series.push(Series {
            label: label.to_owned(),
            style,
            points,
        });
    }
}
