//! Measures of figures, chosen by eye for the default panel, pixels.

/// Width and height of the default panel, without title and legend.
pub(super) const PANEL: (f64, f64) = (680.0, 420.0);
/// Width and height of the smallest panel, without title and legend.
pub(super) const LEAST_PANEL: (f64, f64) = (150.0, 100.0);
/// Free space at the edges of a panel.
pub(super) const EDGE_SPACE: f64 = 10.0;
/// Free space on the right of the axes; it holds half a tick label.
pub(super) const RIGHT_SPACE: f64 = 34.0;
/// Font size of titles.
pub(super) const TITLE: f64 = 17.0;
/// Font size of all other texts.
pub(super) const TEXT: f64 = 13.0;
/// Length of tick marks.
pub(super) const TICK: f64 = 5.0;
/// Least distance between ticks of the y axis.
pub(super) const TICK_DISTANCE: f64 = 34.0;
/// Least gap between tick labels of the x axis.
pub(super) const TICK_LABEL_GAP: f64 = 16.0;
/// Width of the sample of a series in the legend.
pub(super) const SAMPLE: f64 = 30.0;
/// Gap between a sample and its label.
pub(super) const SAMPLE_GAP: f64 = 6.0;
/// Gap after an entry of the legend.
pub(super) const ENTRY_GAP: f64 = 24.0;
/// Radius of a marker.
pub(super) const MARKER_RADIUS: f64 = 3.2;
