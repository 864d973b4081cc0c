//! Second run of an error estimate: its tolerances, and its comparison with states of the first. Runs that return to
//! one course may agree only at the end.

use std::iter::Peekable;
use std::sync::LazyLock;

use super::result::ErrorEstimate;
use crate::engine::step::Step;
use crate::engine::{NODES, collocation};
use crate::numeric::gauss;
use crate::scene::LEAST_RUN_TOLERANCE;

/// Least tail of a series, as part of its largest coefficient: below it rounding hides the decay of the coefficients.
pub(super) const LEAST_TAIL: f64 = 4e-15;
/// Factor from the distance of two runs to the stated error, for the error of the second run.
pub(super) const MARGIN: f64 = 1.5;

/// Returns the tolerance of a second run by another method than collocation, whose error is then negligible.
pub(super) fn other_method_tolerance(tolerance: f64) -> f64 {
    let ratio = 1e3;
    above_rounding(tolerance / ratio, tolerance)
}

/// Returns the tolerance of a second run by collocation.
pub(super) fn collocation_tolerance(tolerance: f64) -> f64 {
    above_rounding(collocation::tolerance_beside(tolerance), tolerance)
}

/// Raises the tolerance of a second run to the least one, or to a tenth of the first if that is less.
fn above_rounding(second: f64, first: f64) -> f64 {
    let least_ratio = 10.0;
    second.max(LEAST_RUN_TOLERANCE.min(first / least_ratio))
}

/// Returns the tolerance of a second run by the method of the first.
pub(super) fn same_method_tolerance(tolerance: f64) -> f64 {
    let ratio = 50.0;
    // Least ratio of the tolerances near rounding, which below this tolerance would make the steps collapse.
    let (least_ratio, least) = (5.0, 1e-13_f64);
    (tolerance / ratio).max(least.min(tolerance / least_ratio))
}

/// Steps of a run, kept for comparison with a second run and as a predictor for it.
#[derive(Clone, Debug, Default)]
pub(super) struct Checkpoints {
    pub first: Vec<Step>,
    /// Every 2^thinned-th of the later steps.
    later: Vec<Step>,
    thinned: u32,
    passed: u64,
}

impl Checkpoints {
    /// Takes a step of the first run.
    pub fn add(&mut self, step: &Step) {
        // A megabyte of steps.
        let most_first = 4096;
        // When so many are kept, every other one is dropped.
        let most_later = 128;
        if self.first.len() < most_first {
            self.first.push(*step);
            return;
        }
        self.passed += 1;
        if self.later.len() == most_later {
            let mut odd = false;
            self.later.retain(|_| {
                odd = !odd;
                !odd
            });
            self.thinned += 1;
        }
        if self.passed.is_multiple_of(1 << self.thinned) {
            self.later.push(*step);
        }
    }
}

/// Comparison of a second run with checkpoints of the first, at the ends of steps and where a polynomial errs most.
pub(super) struct Comparison<'a> {
    remaining: Peekable<Box<dyn Iterator<Item = Probe<'a>> + 'a>>,
    /// Largest differences up to now: crank angle, rad, and crank speed, rad/s.
    largest_difference: [f64; 2],
}

/// Place in a step of the first run.
struct Probe<'a> {
    step: &'a Step,
    t: f64,
}

/// Node of a collocation step beside its middle, as a part of its length.
static NODE: LazyLock<f64> = LazyLock::new(|| gauss::legendre(NODES as u32, NODES / 2).0);

/// Returns where a collocation step errs most: at a node the speed, in the middle the angle; and its end.
fn probes(step: &Step) -> [Probe<'_>; 3] {
    let inside = match step.has_polynomial() {
        true => [*NODE, 0.5].map(|part| step.start.t + part * step.length()),
        false => [step.end.t; 2],
    };
    [inside[0], inside[1], step.end.t].map(|t| Probe { step, t })
}

impl<'a> Comparison<'a> {
    pub fn with(checkpoints: &'a Checkpoints) -> Comparison<'a> {
        let Checkpoints { first, later, .. } = checkpoints;
        let all: Box<dyn Iterator<Item = _>> = Box::new(first.iter().chain(later).flat_map(probes));
        Comparison {
            remaining: all.peekable(),
            largest_difference: [0.0; 2],
        }
    }

    /// Compares states inside a step of the second run. `rate`: derivative of the crank angle at a coordinate.
    pub fn compare(&mut self, step: &Step, rate: impl Fn(f64) -> f64) {
        while let Some(probe) = self.remaining.next_if(|probe| probe.t <= step.end.t) {
            if probe.t >= step.start.t {
                let (theta, omega) = step.at(probe.t);
                let (theta_first, omega_first) = probe.step.at(probe.t);
                let way = step.angle(theta).minus(probe.step.angle(theta_first));
                let apart = [way, omega - omega_first];
                let rate = rate(theta_first);
                for (largest, apart) in self.largest_difference.iter_mut().zip(apart) {
                    *largest = largest.max((rate * apart).abs());
                }
            }
        }
    }

    /// Returns the larger of the known error at the end and the errors at the checkpoints.
    pub fn worst(&self, end: ErrorEstimate) -> ErrorEstimate {
        let [angle, speed] = self.largest_difference.map(|largest| MARGIN * largest);
        end.max(ErrorEstimate {
            theta_rad: angle,
            omega_rad_per_s: speed,
        })
    }
}
