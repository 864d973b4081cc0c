//! Observer of the second run of an error estimate: the roundoff on the way, and the distance from the first run.

use super::super::configuration_curve::{CurveProblem, StepObserver};
use super::super::coordinate::Coordinate;
use super::super::roundoff_propagation::RoundoffPropagation;
use super::super::second_run::Comparison;
use super::engine_loop::{AnglePiece, PassObserver, Reason};
use super::estimate::STATED_DEVIATIONS;
use crate::engine::Counted;
use crate::engine::step::Step;
use crate::engine::time::MotionState;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::covariance_factor::Transition;

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
    /// Returns the map from errors of angle (rad) and speed (rad/s) at a time to those of time (s) and kinetic energy
    /// (J) at the angle.
    fn departure(&self, at: &MotionState) -> Transition {
        let inertia = self.inertia(at);
        let by_angle = -inertia * self.acceleration(at);
        Transition::new(-1.0 / at.speed, 0.0, by_angle, inertia * at.speed)
    }

    /// Returns the map from errors of time (s) and kinetic energy (J) at an angle to those of angle (rad) and speed
    /// (rad/s) at the time.
    fn arrival(&self, at: &MotionState) -> Transition {
        let of_energy = 1.0 / (self.inertia(at) * at.speed);
        Transition::new(-at.speed, 0.0, -self.acceleration(at), of_energy)
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
        // The roundoff of the piece is a stated error, no standard deviation.
        let unit = 1.0 / STATED_DEVIATIONS;
        let errors = &run.errors;
        let over_angle = self.rounding.covariance.propagated(&self.departure(from));
        let carried = over_angle.propagated(&errors.transition);
        let whole = carried.plus(errors.rounding.scaled([unit, unit]));
        self.rounding.covariance = whole.propagated(&self.arrival(&to));
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
