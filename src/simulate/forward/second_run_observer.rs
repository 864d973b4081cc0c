//! Observer of the second run of an error estimate: the roundoff on the way, and the distance from the first run.

use super::super::configuration_curve::{CurveProblem, StepObserver};
use super::super::coordinate::Coordinate;
use super::super::roundoff_propagation::RoundoffPropagation;
use super::super::second_run::Comparison;
use super::super::state_transition::StateTransition;
use super::engine_loop::{AnglePiece, PassObserver, Reason};
use super::estimate::STATED_DEVIATIONS;
use crate::engine::Counted;
use crate::engine::angle::Errors;
use crate::engine::step::Step;
use crate::engine::time::MotionState;
use crate::error::Error;
use crate::mechanism::Equation;

/// Observer of the second run: propagates roundoff and compares with the states of the first.
pub(super) struct SecondRunObserver<'m, 'a> {
    pub equation: &'m Equation,
    pub motion: &'m Counted<'m>,
    /// Whether the motion does not begin in a balance.
    pub moves: bool,
    pub rounding: RoundoffPropagation,
    pub comparison: Comparison<'a>,
}

impl SecondRunObserver<'_, '_> {
    /// Computes the transition over a piece over the angle: a lead in time stays, and an energy error adds to it.
    fn transition(&self, [from, to]: [&MotionState; 2], errors: &Errors) -> StateTransition {
        let [inertia, then] = [from, to].map(|at| self.inertia(at));
        let [alpha, after] = [from, to].map(|at| self.acceleration(at));
        let energy = [-inertia * alpha, inertia * from.speed];
        // A piece that loses nearly all of its energy forgets an energy error. Half or twice this fraction changes none
        // of 200 random runs.
        let forgotten = 0.1;
        let by_energy = if errors.retained < forgotten {
            0.0
        } else {
            errors.advance
        };
        let early = [
            1.0 / from.speed + by_energy * energy[0],
            by_energy * energy[1],
        ];
        let angle = early.map(|early| to.speed * early);
        let speed =
            [0, 1].map(|k| (errors.retained * energy[k] / then + after * angle[k]) / to.speed);
        [angle, speed]
    }

    fn inertia(&self, at: &MotionState) -> f64 {
        self.equation.terms(at.angle.rest).m
    }

    fn acceleration(&self, at: &MotionState) -> f64 {
        self.equation.acceleration(at.t, at.angle, at.speed)
    }
}

impl PassObserver for SecondRunObserver<'_, '_> {
    fn over_angle(&mut self, piece: &AnglePiece, _: Reason) -> Result<(), Error> {
        let AnglePiece { run, from, to, .. } = piece;
        let (angle, speed) = run.orbit.state(run.end);
        let t = to.t;
        let to = MotionState { t, angle, speed };
        let errors = &run.errors;
        let transition = self.transition([from, &to], errors);
        // The roundoff of the piece is a stated error, no standard deviation.
        let unit = STATED_DEVIATIONS * f64::EPSILON;
        let [late, off] = [errors.time, errors.energy].map(|error| error / unit);
        let carried = self.rounding.covariance.propagated(&transition);
        self.rounding.covariance = carried
            .plus_error(speed * late, self.acceleration(&to) * late)
            .plus_independent(0.0, off / (self.inertia(&to) * speed));
        Ok(())
    }

    fn begin_in_time(&mut self, from: MotionState, curve: Option<&CurveProblem>, _: Reason) {
        // Panels over the angle state their roundoff themselves.
        if from.t == 0.0 && self.moves {
            // Tolerances are absolute below one radian: a start in motion is rounded as an angle of one.
            self.rounding.round(1.0, 0.0);
        } else if from.t > 0.0 && curve.is_none() {
            self.rounding.round(from.angle.rest, from.speed);
        }
    }
}

impl StepObserver for SecondRunObserver<'_, '_> {
    fn step(&mut self, step: &Step, along: &Coordinate<'_>) -> bool {
        match *along {
            Coordinate::Curve(along) => {
                let rate = |q: f64| along.equation.curve().pose(q).dtheta;
                self.comparison.compare(step, rate);
                self.rounding.step_on_curve(along, step);
            }
            Coordinate::Crank(equation) => {
                self.comparison.compare(step, |_| 1.0);
                self.rounding.step(equation, self.motion, step);
            }
        }
        false
    }
}
