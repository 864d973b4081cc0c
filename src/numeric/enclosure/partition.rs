//! Partition of an interval into panels whose nodes resolve a function, by bisection.

use super::{Interval, Variation, ellipses, resolved};

/// Required resolution of the panels.
#[derive(Clone, Copy, Debug)]
pub struct PanelResolution {
    /// Nodes of a panel.
    pub nodes: usize,
    /// Allowed error, as a part of the change of the function over the whole, or of a unit.
    pub part: f64,
}

/// Halvings of the whole that locate a corner or a jump, to some units of its last place.
const HALVINGS: usize = 50;

/// Locates the ends between panels inside an interval, in rising order, for a function whose `variation` on an interval
/// and in an ellipse of some size is given: the nodes of each panel resolve it. A corner or a jump is an end; beside a
/// narrow pulse panels become shorter towards it.
pub fn partition(
    variation: impl Fn(Interval, f64) -> Variation,
    over: Interval,
    wanted: PanelResolution,
    unit: f64,
) -> Vec<f64> {
    let ellipses = ellipses(wanted.nodes, wanted.part);
    let real = |part: Interval| variation(part, ellipses[0]);
    let allowed = wanted.part * scale(&real, over, unit);
    let is_resolved = |part: Interval| {
        let variation = |size| variation(part, size);
        resolved(variation, ellipses, allowed, wanted.nodes)
            .1
            .is_some()
    };
    if is_resolved(over) {
        return Vec::new();
    }
    let width = over.high - over.low;
    let is_corner = |part: Interval| {
        let share = (part.high - part.low) / width;
        let middle = part.middle();
        let is_point = middle <= part.low || middle >= part.high;
        // The node at an end of a panel may lie behind a corner by as much as the piece is long.
        is_point || share < 0.5f64.powi(HALVINGS as i32) || real(part).change <= allowed
    };
    let mut left = vec![over];
    let mut pieces: Vec<(Interval, bool)> = Vec::new();
    let most_pieces = 100_000;
    while let Some(part) = left.pop() {
        let is_resolved = is_resolved(part);
        if is_resolved || is_corner(part) || pieces.len() + left.len() >= most_pieces {
            pieces.push((part, is_resolved));
        } else {
            let middle = part.middle();
            left.push(Interval::new(middle, part.high));
            left.push(Interval::new(part.low, middle));
        }
    }
    merged(&pieces, is_resolved)
}

/// Returns the change over the whole, or over the first part of it on which it is finite; not less than a unit.
fn scale(variation: &impl Fn(Interval) -> Variation, over: Interval, unit: f64) -> f64 {
    let mut part = over;
    for _ in 0..HALVINGS {
        let change = variation(part).change;
        if change.is_finite() {
            return change.max(unit).max(f64::MIN_POSITIVE);
        }
        part = Interval::new(part.low, part.middle());
    }
    unit.max(f64::MIN_POSITIVE)
}

/// Returns the ends between pieces, each with whether it is resolved; neighbours resolved together are one, a corner
/// lies in the middle of its piece.
fn merged(pieces: &[(Interval, bool)], are_resolved: impl Fn(Interval) -> bool) -> Vec<f64> {
    let mut ends = Vec::new();
    let mut begin = None;
    for (part, is_resolved) in pieces {
        match begin {
            _ if !is_resolved => {
                ends.push(part.middle());
                begin = None;
            }
            Some(from) if !are_resolved(Interval::new(from, part.high)) => {
                ends.push(part.low);
                begin = Some(part.low);
            }
            None => begin = Some(part.low),
            Some(_) => {}
        }
    }
    ends
}
