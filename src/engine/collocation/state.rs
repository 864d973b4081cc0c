//! The state between steps, with what rounding would lose.

use std::f64::consts::TAU;

use super::super::step::Node;
use super::super::time::Start;
use crate::numeric::angle::{Angle, TAU_REST};
use crate::numeric::exact::two_sum;

/// Angle, speed and work as a number and the digits below its last place (compensated summation, Kahan).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// s
    pub t: f64,
    /// Whole turns.
    pub turns: f64,
    /// rad, beside the turns
    pub theta: f64,
    /// Below `theta`.
    pub theta_low: f64,
    /// rad/s
    pub omega: f64,
    /// Below `omega`.
    pub omega_low: f64,
    /// J
    pub work: f64,
    /// Below `work`.
    pub work_low: f64,
}

impl State {
    /// The state of a start.
    pub fn new(start: Start) -> State {
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

    /// The whole angle.
    pub fn angle(&self) -> Angle {
        Angle::new(self.turns, self.theta)
    }

    /// The state as the end of a step.
    pub fn node(&self, alpha: f64) -> Node {
        Node {
            t: self.t,
            theta: self.theta,
            omega: self.omega,
            alpha,
            work: self.work,
        }
    }

    /// The state a step of length h later, whose accelerations bring this much more angle than the speed
    /// alone, and this much speed and work.
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

    /// The state with so much more speed, rad/s.
    pub fn faster(mut self, by: f64) -> State {
        (self.omega, self.omega_low) = two_sum(self.omega, self.omega_low + by);
        self
    }

    /// The state with less than a turn of angle.
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
