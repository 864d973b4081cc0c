//! The equation of motion as the integrators see it, and what rounding does to a run in time.

use super::roundoff_propagation::Spread;
use super::state_transition::Slopes;
use crate::engine::step::Step;
use crate::engine::time;
use crate::engine::{Batch, Motion};
use crate::mechanism::{Equation, Instants, LoadValue};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Detail, Reach};
use crate::scene::Variable;

/// The equation, integrated forward.
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

    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail {
        let loads = self.0.loads();
        let seen = self.0.linkage().seen(reach, loads.meet_slider());
        let force = loads.detail(&seen, seen.arms(), ellipse);
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

/// Where rounding takes over from the decay of the coefficients of a series, as part of the largest.
pub(super) const LEAST_TAIL: f64 = 4e-15;
/// The second run of the estimate is so much tighter that its own error does not count, whatever the first
/// one's happens to be: at the order of collocation two more digits take a fifth more evaluations.
pub(super) const MUCH_TIGHTER: f64 = 1e4;
/// A short run is far better than a loose tolerance: the second one is never looser than at the default tolerance.
const LOOSEST: f64 = 1e-10 / MUCH_TIGHTER;
/// Where collocation does not get to the end, the same method again, this much tighter.
pub(super) const TIGHTER: f64 = 50.0;
/// What is stated is larger than the distance of the two runs by this, for the error of the second.
pub(super) const MARGIN: f64 = 1.5;
/// Standard deviation of one rounding, in units of the last place.
pub(super) const ONE_ROUNDING: f64 = 0.3;
/// Next to a balance several steps round in the same way, which adds up to this many times as much.
const CORRELATED_ROUNDING: f64 = 2.0;
/// Rounding of a step's mean acceleration, in units: of a few in each evaluation, averaged over the step.
const EVALUATION: f64 = 1.0;
/// An acceleration that is smaller than what this angle (rad) changes in it may be a difference of larger ones. Half or twice
/// as much changes the stated errors of 200 random runs by 1 % at most.
const BALANCED: f64 = 0.1;
/// Where rounding inside a step takes over.
pub(super) const TIGHTEST: f64 = 1e-15;
/// The method of the run again is tighter than this only by so much, for rounding inside the steps takes over, and they would
/// collapse.
const TIGHTEST_AGAIN: f64 = 1e-13;
const A_LITTLE: f64 = 5.0;

/// Tolerance of a second run that is so much tighter that its own error does not count.
pub(super) fn much_tighter(tolerance: f64) -> f64 {
    (tolerance / MUCH_TIGHTER).clamp(TIGHTEST, LOOSEST)
}

/// Tolerance of the method of the run again, where that one does not get to the end.
pub(super) fn tighter(tolerance: f64) -> f64 {
    (tolerance / TIGHTER).max(TIGHTEST_AGAIN.min(tolerance / A_LITTLE))
}

/// What rounding does to a run in time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// In units of the last place.
    pub spread: Spread,
    /// Whether the states at the ends of steps are rounded: collocation carries the digits below the last place.
    rounds_states: bool,
}

impl Rounding {
    /// Of a run by a method, which moves or stays in a balance. Tolerances are absolute for angles below one radian: of a
    /// motion less than a unit in the last place of one is not resolved at the start, however small the angle.
    pub fn new(method: time::Method, moves: bool) -> Rounding {
        let angle = if moves { ONE_ROUNDING } else { 0.0 };
        Rounding {
            spread: Spread::default().plus(angle, 0.0),
            rounds_states: !matches!(method, time::Method::Picard),
        }
    }

    /// The state at the end of a step is rounded.
    pub fn round(&mut self, theta: f64, omega: f64) {
        let [angle, speed] = [theta, omega].map(|size| ONE_ROUNDING * size.abs());
        self.spread = self.spread.plus(angle, speed);
    }

    /// Carries it over a step, and adds what that rounds.
    pub fn step(&mut self, equation: &Equation, motion: &dyn Motion, step: &Step) {
        let slopes = Slopes::of(motion, step);
        let transition = slopes.transition(step);
        let (h, end) = (step.length(), &step.end);
        let place = ONE_ROUNDING * end.theta.abs() * slopes.by_angle();
        let mut size = end.alpha.abs();
        if size < BALANCED * slopes.by_angle().abs() {
            let angle = step.angle(end.theta);
            let inertia = equation.terms(end.theta).inertia.m;
            size = size.max(
                CORRELATED_ROUNDING * equation.size_of_terms(end.t, angle, end.omega) / inertia,
            );
        }
        let shaken = place.hypot(EVALUATION * size);
        let carried = self.spread.carried(&transition);
        self.spread = carried.pushed(shaken, &transition, h);
        if self.rounds_states {
            self.round(end.theta, end.omega);
        }
    }
}
