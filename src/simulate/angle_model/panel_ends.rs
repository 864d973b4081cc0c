//! Crank angles at which panels must end to resolve the loads of the position alone, from enclosures of these loads.

use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;

use super::super::run_setup::RunSetup;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Interval, PanelResolution, has_pole, partition};

/// Panels begin with 25 nodes and end where the series have decayed to rounding.
const RESOLUTION: PanelResolution = PanelResolution {
    nodes: 24,
    part: 1e-14,
};

/// Panel ends for the loads of the position alone, rad, computed on demand.
pub(super) struct PanelEnds<'a> {
    equation: &'a Equation,
    /// Crank angle and speed (rad/s) at the start of the run.
    start: (Angle, f64),
    /// Crank angles in reach, rad, from and to; empty: all.
    reach: &'a [[f64; 2]],
    /// Interval of the last search, rad, and the panel ends found in it.
    last: RefCell<(Interval, Vec<f64>)>,
    /// True if a panel end of [`Self::in_cycle`] is a pole.
    pub has_pole_in_cycle: Cell<bool>,
}

impl<'a> PanelEnds<'a> {
    /// Makes an empty set for a run.
    pub fn new(task: &'a RunSetup<'_>) -> PanelEnds<'a> {
        let nowhere = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
        PanelEnds {
            equation: task.equation(),
            start: (task.start(), task.speed),
            reach: &task.limits.reach,
            last: RefCell::new((nowhere, Vec::new())),
            has_pole_in_cycle: Cell::new(false),
        }
    }

    /// Returns the panel ends between two angles, rad, in rising order.
    pub fn between(&self, low: f64, high: f64) -> Vec<f64> {
        let (loads, linkage) = (self.equation.loads(), self.equation.linkage());
        if !loads.vary_with_position_between_nodes() || low >= high {
            return Vec::new();
        }
        let variation = |angle, ellipse| loads.variation_with_position(linkage, angle, ellipse);
        let (start, speed) = self.start;
        // Energy of the start and work of its forces over a radian, J: unit beside which small details are negligible.
        let unit = self.equation.kinetic_energy(start.rest, speed)
            + self.equation.size_of_terms(0.0, start, speed);
        let parts = self.in_reach(low, high);
        let ends = |part| partition(variation, part, RESOLUTION, unit);
        parts.into_iter().flat_map(ends).collect()
    }

    /// Whether the loads of the position have a pole at a panel end, rad, that is known to some roundings.
    pub fn is_pole(&self, at: f64) -> bool {
        let width = 1e-13 * at.abs().max(1.0);
        let (loads, linkage) = (self.equation.loads(), self.equation.linkage());
        let near = Interval::new(at - width, at + width);
        let enclosed = loads.variation_with_position(linkage, near, 1.0);
        let force = |aside: f64| {
            let pose = linkage.pose(at + aside);
            loads.of_place(at + aside, pose.x).generalized(pose.dx)
        };
        enclosed.change.is_infinite() && has_pole(force, width)
    }

    /// Returns the parts of an interval, rad, that the crank reaches, in rising order.
    fn in_reach(&self, low: f64, high: f64) -> Vec<Interval> {
        if self.reach.is_empty() {
            return vec![Interval::new(low, high)];
        }
        let turns = (low / TAU).floor() as i64 - 1..=(high / TAU).ceil() as i64;
        let part = |[from, to]: [f64; 2], turn: i64| {
            let before = turn as f64 * TAU;
            let part = Interval::new(low.max(from + before), high.min(to + before));
            (part.low < part.high).then_some(part)
        };
        turns
            .flat_map(|turn| {
                self.reach
                    .iter()
                    .filter_map(move |reach| part(*reach, turn))
            })
            .collect()
    }

    /// Returns the panel ends in [0, length), rad, for loads that repeat after that length. A corner at the start, which
    /// no search within the length sees, lies between the last end of a cycle and the first of the next.
    pub fn in_cycle(&self, length: f64) -> Vec<f64> {
        let mut ends = self.between(0.0, length);
        let is_pole = |end: &f64| self.is_pole(*end);
        self.has_pole_in_cycle.set(ends.iter().any(is_pole));
        let last = ends.last().unwrap_or(&(0.5 * length)) - length;
        let first = *ends.first().unwrap_or(&(0.5 * length));
        if !self.between(last, first).is_empty() {
            ends.insert(0, 0.0);
        }
        ends
    }

    /// Returns the first panel end after `from` on the way to `to`, in either direction, rad.
    pub fn next(&self, from: f64, to: f64) -> Option<f64> {
        if !self.equation.loads().vary_with_position_between_nodes() {
            return None;
        }
        let way = Interval::between(from, to);
        let (known, ends) = &mut *self.last.borrow_mut();
        if !(known.low <= way.low && way.high <= known.high) {
            // Ways that follow each other overlap: a search as long again keeps the number of searches small.
            let ahead = if known.contains(from) { to - from } else { 0.0 };
            *known = Interval::between(from, to + ahead);
            *ends = self.between(known.low, known.high);
        }
        let mut inside = ends
            .iter()
            .copied()
            .filter(|panel_end| way.low < *panel_end && *panel_end < way.high);
        if from < to {
            inside.next()
        } else {
            inside.next_back()
        }
    }
}

/// Distance, rad, below which two corners are one: the rows of a table may be rounded to nine digits.
pub(in super::super) const SAME_CORNER: f64 = 1e-9;

/// Sorts angles, rad, and merges equal ones: a corner doubled by rounding makes an empty panel.
pub(super) fn sorted_corners(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut angles: Vec<f64> = angles.collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < SAME_CORNER);
    angles
}
