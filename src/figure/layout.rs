//! Measures of figures.

/// Measures of a figure, pixels.
pub(super) struct Layout {
    /// Width and height of the default panel, without title and legend.
    pub panel: (f64, f64),
    /// Width and height of the smallest panel, without title and legend.
    pub least_panel: (f64, f64),
    /// Free space at the edges of a panel.
    pub edge_space: f64,
    /// Free space on the right of the axes; it holds half a tick label.
    pub right_space: f64,
    /// Font size of titles.
    pub title: f64,
    /// Font size of all other texts.
    pub text: f64,
    /// Length of tick marks.
    pub tick: f64,
    /// Least distance between ticks of the y axis.
    pub tick_distance: f64,
    /// Least gap between tick labels of the x axis.
    pub tick_label_gap: f64,
    /// Width of the sample of a series in the legend.
    pub sample: f64,
    /// Gap between a sample and its label.
    pub sample_gap: f64,
    /// Gap after an entry of the legend.
    pub entry_gap: f64,
    /// Radius of a marker.
    pub marker_radius: f64,
}

/// Measures chosen by eye for the default panel.
pub(super) const LAYOUT: Layout = Layout {
    panel: (680.0, 420.0),
    least_panel: (150.0, 100.0),
    edge_space: 10.0,
    right_space: 34.0,
    title: 17.0,
    text: 13.0,
    tick: 5.0,
    tick_distance: 34.0,
    tick_label_gap: 16.0,
    sample: 30.0,
    sample_gap: 6.0,
    entry_gap: 24.0,
    marker_radius: 3.2,
};
