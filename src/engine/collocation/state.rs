//! State between steps in compensated (double-double) form.

use std::f64::consts::TAU;

use super::super::step::Node;
use super::super::time::MotionState;
use crate::numeric::angle::{Angle, TAU_REST};
use crate::numeric::exact::two_sum;

/// Angle, speed and work, each as a double and the digits below its last place (compensated summation, Kahan).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Time, s.
    pub t: f64,
    /// Whole turns.
    pub turns: f64,
    /// Angle without the whole turns, rad.
    pub theta: f64,
    /// Digits below `theta`, rad.
    pub theta_low: f64,
    /// Speed, rad/s.
    pub omega: f64,
    /// Digits below `omega`, rad/s.
    pub omega_low: f64,
    /// Work, J.
    pub work: f64,
    /// Digits below `work`, J.
    pub work_low: f64,
}

impl State {
    /// Converts the start of a run to a state with zero work.
    pub fn new(start: MotionState) -> State {
        let angle = start.angle.reduced();
        State {
            t: start.t,
            turns: angle.turns,
            theta: angle.rest,
            theta_low: 0.0,
            omega: start.speed,
            omega_low: 0.0,
            work: 0.0,
            work_low: 0.0,
        }
    }

    /// Returns the whole angle.
    pub fn angle(&self) -> Angle {
        Angle::new(self.turns, self.theta)
    }

    /// Converts the state to the end of a step.
    pub fn node(&self, alpha: f64) -> Node {
        Node {
            t: self.t,
            theta: self.theta,
            omega: self.omega,
            alpha,
            work: self.work,
        }
    }

    /// Returns the state a step of length h (s) later; the accelerations contribute `angle` (rad) beyond h·ω, `omega`
    /// (rad/s) and `work` (J).
    pub fn moved(&self, h: f64, [angle, omega, work]: [f64; 3]) -> State {
        let travel = h * self.omega;
        let lost = h.mul_add(self.omega, -travel) + h * self.omega_low;
        let (far, below) = two_sum(self.theta, travel);
        let (theta, theta_low) = two_sum(far, angle + (below + lost + self.theta_low));
        let (omega, omega_low) = two_sum(self.omega, omega + self.omega_low);
        let (work, work_low) = two_sum(self.work, work + self.work_low);
        State {
            t: self.t + h,
            theta,
            theta_low,
            omega,
            omega_low,
            work,
            work_low,
            ..*self
        }
    }

    /// Returns the state with the speed increased by `by`, rad/s.
    pub fn faster(mut self, by: f64) -> State {
        (self.omega, self.omega_low) = two_sum(self.omega, self.omega_low + by);
        self
    }

    /// Returns the state with the angle reduced to less than a turn.
    pub fn reduced(mut self) -> State {
        if self.theta.abs() < TAU {
            return self;
        }
        let turns = (self.theta / TAU).floor();
        self.turns += turns;
        let low = self.theta_low - turns * TAU_REST;
        (self.theta, self.theta_low) = two_sum(self.theta - turns * TAU, low);
        self
    }
}
