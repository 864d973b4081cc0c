//! Default content of the picture and page of a result.

use serde::Serialize;

use crate::figure::Figure;
use crate::scene::Scene;
use crate::simulate::Summary;

/// Default content of the picture and page of a result, where the user chooses none.
#[derive(Default)]
pub struct DefaultView<'a> {
    /// Title above a picture.
    pub(super) title: &'a str,
    /// Columns drawn in a picture, separated by commas.
    pub(super) show: &'a str,
    /// Column of the horizontal axis.
    pub(super) over: &'a str,
    /// Number of panels side by side in a picture.
    pub(super) columns: usize,
    /// Half-width of a band, in standard errors.
    pub(super) band: f64,
    /// Whether curves have poles at dead centres, which are cut off.
    pub(super) has_poles: bool,
    /// Figures of a picture after the columns, unless the user chooses columns.
    pub(super) extra_figures: Vec<Figure>,
    /// Scene of the mechanism that a page animates.
    pub(super) scene: Option<&'a Scene>,
    /// Run whose terms and events a page lists.
    pub(super) run: Option<&'a Summary>,
    /// Scatter plot of a page, for rows other than a motion.
    pub(super) scatter: Option<Scatter>,
    /// Static figures of a page, as SVG.
    pub(super) figures: Vec<String>,
}

/// Initial scatter plot of rows other than a motion.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Scatter {
    pub x: String,
    pub y: String,
    /// Column of the colour; empty for none.
    pub colour: String,
    /// Whether both axes are logarithmic.
    pub log: bool,
    /// Whether lines join rows of equal `kind`.
    pub lines: bool,
    /// Column that sorts rows into kinds.
    pub kind: &'static str,
    /// Column whose values are shown one at a time; empty for none.
    pub within: &'static str,
}
