//! The crank angle on each stroke, and the folds where strokes meet.
//!
//! What is measured belongs to one crank angle on each stroke. The angle is continuous along a stroke, so a motion
//! changes strokes at a fold alone: where the measured value is at an end of its range, and two strokes have the
//! same angle.

use std::cmp::Ordering;
use std::f64::consts::PI;

use super::super::sensor::Sensor;
use crate::mechanism::Linkage;
use crate::scene::{Branch, Measured};

/// A stroke: [`LEAN`] for the lean of the crank against the way to the wrist pin, and [`SIDE`] for the side of the pivot
/// that the pin is on.
pub(super) type Stroke = usize;

const LEAN: Stroke = 1;
const SIDE: Stroke = 2;

/// A value at which two strokes meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fold {
    /// rad or m
    pub value: f64,
    /// Whether it is a largest value, or a smallest.
    pub above: bool,
    /// What changes from one stroke to the other.
    pub change: Stroke,
}

/// The strokes of a mechanism.
#[derive(Debug)]
pub(super) struct Strokes<'a> {
    pub sensor: &'a Sensor<'a>,
    folds: Vec<Fold>,
}

impl Strokes<'_> {
    pub fn new<'a>(sensor: &'a Sensor<'a>) -> Strokes<'a> {
        let folds = match sensor.measured {
            Measured::X => folds_of_x(sensor.linkage),
            _ => folds_of_gamma(sensor.linkage),
        };
        Strokes { sensor, folds }
    }

    /// The strokes that a motion can begin on.
    pub fn all(&self) -> Vec<Stroke> {
        let Sensor { linkage, measured } = self.sensor;
        match measured {
            Measured::X => vec![0, LEAN],
            _ if !linkage.limit_angles().is_empty() => vec![0, LEAN, SIDE, SIDE | LEAN],
            _ if linkage.s > 0.0 => vec![0, LEAN],
            _ => vec![SIDE, SIDE | LEAN],
        }
    }

    /// The crank angle on each stroke, rad; of a slider position the first two count.
    pub fn angles(&self, value: f64) -> [f64; 4] {
        let linkage = self.sensor.linkage;
        match self.sensor.measured {
            Measured::X => {
                let [less, plus] = linkage.strokes_of_x(value);
                [less, plus, less, plus]
            }
            _ => linkage.strokes_of_gamma(value),
        }
    }

    /// The fold nearest to a largest or smallest value.
    pub fn fold(&self, value: f64, above: bool) -> Option<Fold> {
        let alike = self.folds.iter().filter(|fold| fold.above == above);
        let off = |fold: &&Fold| (fold.value - value).abs();
        alike.min_by(|a, b| off(a).total_cmp(&off(b))).copied()
    }

    /// The linkage on the branch that a fold is on, at a crank angle in rad.
    pub fn linkage_at(&self, fold: Fold, theta: f64) -> Linkage {
        let Sensor { linkage, measured } = self.sensor;
        let [right, left] = [Branch::Right, Branch::Left].map(|branch| linkage.on_branch(branch));
        let off = |linkage: &Linkage| {
            let measured = *measured;
            let sensor = Sensor { linkage, measured };
            sensor.residual(fold.value, theta).0.abs()
        };
        match off(&right).total_cmp(&off(&left)) {
            Ordering::Greater => left,
            _ => right,
        }
    }
}

fn folds_of_x(linkage: &Linkage) -> Vec<Fold> {
    let Linkage { r, l, e, .. } = *linkage;
    let mut folds = Vec::new();
    for (reach, outer) in [(l + r, true), ((l - r).abs(), false)] {
        let squared = (reach - e) * (reach + e);
        if squared >= 0.0 {
            let x = squared.sqrt();
            let change = LEAN;
            folds.extend([(x, outer), (-x, !outer)].map(|(value, above)| Fold {
                value,
                above,
                change,
            }));
        }
    }
    folds
}

fn folds_of_gamma(linkage: &Linkage) -> Vec<Fold> {
    let fold = |value: f64, above: bool, change: Stroke| Fold {
        value,
        above,
        change,
    };
    let lower = match linkage.gamma_beside_pivot() {
        Some(gamma) if gamma > 0.0 => fold(gamma, false, SIDE),
        _ => fold(0.0, false, LEAN),
    };
    vec![fold(PI, true, LEAN), lower]
}
