//! Equation of motion as the integrators see it, and tolerances of the second run of an error estimate.

use crate::engine::{Batch, Motion};
use crate::mechanism::{Equation, Instants, LoadValue};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Detail, MotionPiece};
use crate::scene::Variable;

pub(super) struct Forward<'a>(pub &'a Equation);

impl Motion for Forward<'_> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        self.0.acceleration(t, angle, speed)
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        self.0.acceleration_and_power(t, angle, speed)
    }

    fn depends_on_time(&self) -> bool {
        self.0.loads().reads().has(Variable::T)
    }

    fn has_power(&self) -> bool {
        !self.0.loads().have_potential()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.0.loads().next_corner(t)
    }

    fn has_detail(&self) -> bool {
        self.0.loads().have_detail()
    }

    fn detail(&self, reach: &MotionPiece, ellipse: f64) -> Detail {
        let loads = self.0.loads();
        let seen = self.0.linkage().enclosed_state(reach, loads.meet_slider());
        let force = loads.detail(&seen, seen.unit_load_effects(), ellipse);
        force.times(1.0 / self.0.terms(reach.angle.middle()).inertia.m)
    }

    fn corner_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.0.loads().row_on_way(from, to)
    }

    fn of_time(&self, t: f64) -> [f64; 2] {
        let LoadValue { torque, force } = self.0.loads().of_time(t);
        [torque, force]
    }

    fn fill(&self, batch: &mut Batch) {
        let of_time = batch
            .of_time
            .map(|[torque, force]| LoadValue { torque, force });
        let at = Instants {
            t: &batch.t,
            of_time: &of_time,
            turns: batch.turns,
            theta: &batch.theta,
            omega: &batch.omega,
        };
        self.0
            .accelerations(&at, &mut batch.alpha, &mut batch.power);
    }
}

/// Least tail of a series, as part of its largest coefficient: below it rounding hides the decay of the coefficients.
pub(super) const LEAST_TAIL: f64 = 4e-15;
/// Largest tolerance of a second run by collocation. Below it rounding inside the steps dominates: a tenth of it takes up
/// to four times as many evaluations for equal stated errors.
const TIGHT: f64 = 1e-14;
/// Ratio of the tolerances of both runs, for a loose joint and where collocation does not reach the end.
pub(super) const TIGHTER: f64 = 50.0;
/// Least ratio of the tolerances of both runs, near rounding.
const LEAST_RATIO: f64 = 5.0;
/// Least tolerance of a second run by the method of the first, unless [`LEAST_RATIO`] asks for less: below it rounding
/// inside the steps would make them collapse.
const TIGHT_AGAIN: f64 = 1e-13;
/// Factor from the distance of two runs to the stated error, for the error of the second run.
pub(super) const MARGIN: f64 = 1.5;

/// Returns the tolerance of a second run by collocation, with negligible error.
pub(super) fn much_tighter(tolerance: f64) -> f64 {
    TIGHT.min(tolerance / LEAST_RATIO)
}

/// Returns the tolerance of a second run by the method of the first.
pub(super) fn tighter(tolerance: f64) -> f64 {
    (tolerance / TIGHTER).max(TIGHT_AGAIN.min(tolerance / LEAST_RATIO))
}
