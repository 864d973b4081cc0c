//! What is seen of rows.

use serde::Serialize;

use super::figure::Figure;
use crate::scene::Scene;
use crate::simulate::Summary;

/// What a picture and a page show of rows by themselves.
#[derive(Default)]
pub struct Look<'a> {
    /// Above a picture.
    pub(super) title: &'a str,
    /// Columns of a picture.
    pub(super) show: &'a [&'a str],
    /// Column of the horizontal axis; the crank angle if empty.
    pub(super) over: &'a str,
    /// Panels of a picture beside each other.
    pub(super) columns: usize,
    /// Half the width of a band in standard errors.
    pub(super) band: f64,
    /// Whether curves grow without bound towards dead centres, so that their bulk is shown.
    pub(super) has_poles: bool,
    /// What a picture has beside the columns, unless columns are chosen.
    pub(super) beside: Vec<Figure>,
    /// The mechanism that a page shows.
    pub(super) scene: Option<&'a Scene>,
    /// The run whose terms and events a page lists.
    pub(super) run: Option<&'a Summary>,
    /// Rows of a page that are no motion: one column over another.
    pub(super) scatter: Option<Scatter>,
    /// Figures of a page, as SVG, that stand as they are.
    pub(super) figures: Vec<String>,
}

/// What is shown at first of rows that are no motion.
#[derive(Clone, Debug, Default, Serialize)]
pub(super) struct Scatter {
    pub x: String,
    pub y: String,
    /// Column of the colour, or empty.
    pub colour: String,
    /// Whether both axes are logarithmic.
    pub log: bool,
    /// Whether rows of a kind are joined.
    pub lines: bool,
    /// Column of the kinds that are told apart.
    pub kind: &'static str,
    /// Column of what is shown one at a time.
    pub within: &'static str,
}
