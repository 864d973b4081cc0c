//! Crank angles at which panels end so that their nodes show the loads that depend on the position alone.

use std::cell::RefCell;

use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Interval, Wanted, partition};

/// Panels of the crank angle begin with 25 nodes, and end where series have decayed to rounding.
const WANTED: Wanted = Wanted {
    nodes: 24,
    part: 1e-14,
};

/// Angles, rad, found where they were asked for.
pub(super) struct Marks<'a> {
    equation: &'a Equation,
    /// Angle and speed (rad/s) of the start.
    start: (Angle, f64),
    /// The last interval that was looked at, and what was found there.
    last: RefCell<(Interval, Vec<f64>)>,
}

impl<'a> Marks<'a> {
    /// None so far, of a motion from an angle and a speed (rad/s).
    pub fn new(equation: &'a Equation, start: Angle, speed: f64) -> Marks<'a> {
        let nowhere = Interval::new(f64::INFINITY, f64::NEG_INFINITY);
        Marks {
            equation,
            start: (start, speed),
            last: RefCell::new((nowhere, Vec::new())),
        }
    }

    /// Marks between two angles, in rising order.
    pub fn between(&self, low: f64, high: f64) -> Vec<f64> {
        let (loads, linkage) = (self.equation.loads(), self.equation.linkage());
        if !loads.have_detail_of_place() || low >= high {
            return Vec::new();
        }
        let detail = |angle, ellipse| loads.detail_of_place(linkage, angle, ellipse);
        let (start, speed) = self.start;
        // The energy of the start, and the work of its forces over a radian, J: what is little beside it is nothing.
        let unit = self.equation.kinetic_energy(start.rest, speed)
            + self.equation.size_of_terms(0.0, start, speed);
        partition(detail, Interval::new(low, high), WANTED, unit)
    }

    /// The first after `from` on the way to `to`, in either direction.
    pub fn next(&self, from: f64, to: f64) -> Option<f64> {
        if !self.equation.loads().have_detail_of_place() {
            return None;
        }
        let way = Interval::between(from, to);
        let (known, marks) = &mut *self.last.borrow_mut();
        if !(known.low <= way.low && way.high <= known.high) {
            *marks = self.between(way.low, way.high);
            *known = way;
        }
        let mut inside = marks
            .iter()
            .copied()
            .filter(|mark| way.low < *mark && *mark < way.high);
        if from < to {
            inside.next()
        } else {
            inside.next_back()
        }
    }
}

/// Angles in rising order; a corner that rounding has made two would make a panel without length.
pub(super) fn in_order(angles: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut angles: Vec<f64> = angles.collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    angles
}
