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
    pub x: &'static str,
    /// Name and unit of the vertical axis.
    pub y: &'static str,
    /// What is drawn.
    pub series: Vec<Series>,
}

/// One curve or set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend.
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
    pub(super) fn new(x: &'static str, y: &'static str) -> Plot {
        Plot {
            x,
            y,
            series: Vec::new(),
        }
    }

    fn with(mut self, label: &str, style: Style, points: Vec<(f64, f64)>) -> Plot {
        self.series.push(Series {
            label: label.to_owned(),
            style,
            points,
        });
        self
    }

    pub(super) fn line(self, label: &str, points: Vec<(f64, f64)>) -> Plot {
        self.with(label, Style::Line, points)
    }

    pub(super) fn dashed(self, label: &str, points: Vec<(f64, f64)>) -> Plot {
        self.with(label, Style::Dashed, points)
    }

    pub(super) fn points(self, label: &str, points: Vec<(f64, f64)>) -> Plot {
        self.with(label, Style::Points, points)
    }
}

/// f over a range in equal steps, ends included.
pub(super) fn sampled(from: f64, to: f64, steps: u32, f: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..=steps)
        .map(|i| from + (to - from) * f64::from(i) / f64::from(steps))
        .map(|x| (x, f(x)))
        .collect()
}
