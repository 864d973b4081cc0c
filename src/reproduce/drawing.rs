//! Data of the recomputed figures of the papers.

/// Recomputed figure of a paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Name of the paper.
    pub paper: &'static str,
    /// Name of the figure in file names.
    pub name: String,
    /// Title.
    pub title: String,
    /// Plots of the figure, in order.
    pub plots: Vec<Plot>,
}

/// Plot: one pair of axes with its series.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// Name and unit of the horizontal axis.
    pub x: String,
    /// Name and unit of the vertical axis.
    pub y: String,
    /// Curves and points.
    pub series: Vec<Series>,
}

/// Curve or set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name of the curve in the legend.
    pub label: String,
    /// Drawing style.
    pub style: Style,
    /// Points (x, y); y is NaN where undefined.
    pub points: Vec<(f64, f64)>,
}

named! {
    /// Drawing style of a series.
    pub enum Style {
        /// Solid line.
        Line = "line",
        /// Dashed line.
        Dashed = "dashed",
        /// Single points.
        Points = "points",
    }
}
