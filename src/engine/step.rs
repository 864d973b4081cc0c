//! Accepted step with a polynomial for the motion between its ends.

use std::f64::consts::TAU;

use super::{Motion, NODES};
use crate::numeric::angle::Angle;
use crate::numeric::exact::SUM_ROUNDING;
use crate::numeric::hermite::Quintic;
use crate::numeric::root;

/// State at one end of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Node {
    /// Time, s.
    pub t: f64,
    /// Angle without the whole turns of the step, rad.
    pub theta: f64,
    /// Speed, rad/s.
    pub omega: f64,
    /// Acceleration, rad/s².
    pub alpha: f64,
    /// Integral of the power from the start of the run, J.
    pub work: f64,
}

/// Step from `start` to `end`. Between them θ is the quintic Hermite interpolant of angle, speed and acceleration at
/// both ends; [`Step::refine`] adds three terms that satisfy the equation of motion inside (Hermite-Birkhoff
/// interpolation of degree eight). A collocation step has its own polynomial instead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Whole turns to be added to every angle of the step.
    pub turns: f64,
    /// Earlier end.
    pub start: Node,
    /// Later end.
    pub end: Node,
    inside: Inside,
}

/// Number of terms of a collocation polynomial.
pub const TERMS: usize = NODES + 2;

/// Representation of the motion between the ends.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Inside {
    /// Quintic through the ends alone.
    Ends,
    /// Coefficients of the three added terms.
    Refined([f64; 3]),
    /// Coefficients of θ minus θ at the start, in powers of x = 2s − 1.
    Powers([f64; TERMS]),
}

/// Positions s of the conditions on θ̈ inside the step. The inner nodes of the five-point Lobatto rule would not do:
/// the second derivative of the odd term vanishes there.
const INNER: [f64; 3] = [0.25, 0.5, 0.75];

impl Step {
    /// Moves a time (s) inside the step by Newton's method, at most `most` times, until nothing is missing. `missing`: what is
    /// missing at a time, and the rate at which it falls.
    pub fn newton_time(
        &self,
        mut t: f64,
        most: usize,
        mut missing: impl FnMut(f64) -> [f64; 2],
    ) -> f64 {
        for _ in 0..most {
            let [missing, rate] = missing(t);
            if missing == 0.0 || rate == 0.0 {
                break;
            }
            t = (t + missing / rate).clamp(self.start.t, self.end.t);
        }
        t
    }

    /// Makes the step between two states, with the quintic.
    pub fn new(turns: f64, start: Node, end: Node) -> Step {
        Step {
            turns,
            start,
            end,
            inside: Inside::Ends,
        }
    }

    /// Makes the step between two states from a polynomial: θ minus θ at the start, in powers of x in [−1, 1].
    pub fn with_powers(turns: f64, start: Node, end: Node, powers: [f64; TERMS]) -> Step {
        Step {
            turns,
            start,
            end,
            inside: Inside::Powers(powers),
        }
    }

    /// True if the step has its own polynomial or has been refined.
    pub fn is_refined(&self) -> bool {
        self.inside != Inside::Ends
    }

    /// True if the step has its own polynomial.
    pub fn has_polynomial(&self) -> bool {
        matches!(self.inside, Inside::Powers(_))
    }

    /// Length, s.
    pub fn length(&self) -> f64 {
        self.end.t - self.start.t
    }

    /// Travel, rad.
    pub fn travel(&self) -> f64 {
        (self.end.theta - self.start.theta).abs()
    }

    /// Returns the part of the step in which it makes about one turn, if it makes more than two: there the polynomial
    /// does not follow the motion, and events cannot be listed.
    pub fn part_of_one_turn(&self) -> Option<f64> {
        let travel = self.travel();
        (travel > 2.0 * TAU).then_some(TAU / travel)
    }

    /// Returns the whole angle of a `theta` (rad) of this step.
    pub fn angle(&self, theta: f64) -> Angle {
        Angle::new(self.turns, theta)
    }

    /// Returns angle (without the turns, rad) and speed (rad/s) at time t (s) inside the step.
    pub fn at(&self, t: f64) -> (f64, f64) {
        if t == self.start.t {
            return (self.start.theta, self.start.omega);
        }
        if t == self.end.t {
            return (self.end.theta, self.end.omega);
        }
        let h = self.length();
        let s = (t - self.start.t) / h;
        if let Inside::Powers(powers) = &self.inside {
            let (mut value, mut slope, x) = (0.0, 0.0, 2.0 * s - 1.0);
            for power in powers.iter().rev() {
                slope = slope * x + value;
                value = value * x + power;
            }
            return (self.start.theta + value, 2.0 / h * slope);
        }
        let ([theta, dtheta, _], [bump, dbump, _]) = (self.quintic(s), self.bump(s));
        (theta + bump, (dtheta + dbump) / h)
    }

    /// Returns the second derivative of the angle of [`Self::at`], rad/s².
    pub fn acceleration_at(&self, t: f64) -> f64 {
        let h = self.length();
        let s = (t - self.start.t) / h;
        if let Inside::Powers(powers) = &self.inside {
            let [bend] = second_derivatives(powers, [2.0 * s - 1.0]);
            return 4.0 / (h * h) * bend;
        }
        (self.quintic(s)[2] + self.bump(s)[2]) / (h * h)
    }

    /// Returns the accelerations, rad/s², at N equally spaced times from start to end.
    pub fn accelerations<const N: usize>(&self) -> [f64; N] {
        let h = self.length();
        let part = |i: usize| i as f64 / (N - 1) as f64;
        let Inside::Powers(powers) = &self.inside else {
            return std::array::from_fn(|i| self.acceleration_at(self.start.t + part(i) * h));
        };
        let x = std::array::from_fn(|i| 2.0 * part(i) - 1.0);
        second_derivatives(powers, x).map(|bend| 4.0 / (h * h) * bend)
    }

    /// Adds the three terms, which make the motion inside the step accurate to order eight; six evaluations, once.
    pub fn refine(&mut self, motion: &dyn Motion) {
        if self.is_refined() {
            return;
        }
        let h = self.length();
        self.inside = Inside::Refined([0.0; 3]);
        for _ in 0..2 {
            let rest = INNER.map(|s| {
                let t = self.start.t + s * h;
                let ([theta, dtheta, d2theta], [bump, dbump, _]) = (self.quintic(s), self.bump(s));
                let angle = self.angle(theta + bump);
                h * h * motion.acceleration(t, angle, (dtheta + dbump) / h) - d2theta
            });
            // Second derivatives of the terms at the nodes: even ones -3/8, 9/128 and 1/8, -9/64; odd one -45/256.
            let even = 0.5 * (rest[0] + rest[2]);
            let odd = 0.5 * (rest[2] - rest[0]);
            let determinant = 0.375 * 0.140625 - 0.125 * 0.0703125;
            let found = [
                (-0.140625 * rest[1] - 0.125 * even) / determinant,
                odd / -0.17578125,
                (-0.375 * even - 0.0703125 * rest[1]) / determinant,
            ];
            if !found.iter().all(|term| term.is_finite()) {
                self.inside = Inside::Refined([0.0; 3]);
                return;
            }
            self.inside = Inside::Refined(found);
        }
    }

    /// Evaluates the quintic at s in [0, 1]: value, and derivatives with respect to s.
    fn quintic(&self, s: f64) -> [f64; 3] {
        let h = self.length();
        let (a, b) = (&self.start, &self.end);
        let (v0, v1) = (h * a.omega, h * b.omega);
        let (c0, c1) = (0.5 * h * h * a.alpha, 0.5 * h * h * b.alpha);
        let travel = if v0.abs().max(v1.abs()) > SUM_ROUNDING * a.theta.abs() {
            b.theta - a.theta
        } else {
            // The difference of the angles is mere rounding.
            0.5 * (v0 + v1) + (c0 - c1) / 6.0
        };
        let [way, rate, bend] = Quintic::new([v0, c0], [v1, c1], travel).at(s);
        [a.theta + way, rate, bend]
    }

    /// Evaluates the added terms s³(1−s)³(b0 + b1 σ + b2 σ²), σ = 2s − 1: value and derivatives.
    fn bump(&self, s: f64) -> [f64; 3] {
        let Inside::Refined([b0, b1, b2]) = self.inside else {
            return [0.0; 3];
        };
        let sigma = 2.0 * s - 1.0;
        let p = s * (1.0 - s);
        let (p3, dp3) = (p * p * p, -3.0 * p * p * sigma);
        let d2p3 = 6.0 * p * (sigma * sigma - p);
        let q = b0 + sigma * (b1 + sigma * b2);
        let dq = 2.0 * (b1 + 2.0 * sigma * b2);
        let d2q = 8.0 * b2;
        [
            p3 * q,
            dp3 * q + p3 * dq,
            d2p3 * q + 2.0 * dp3 * dq + p3 * d2q,
        ]
    }

    /// Returns the time, s, at which the angle passes `theta`; at `from` and `to` it must lie on opposite sides.
    pub fn time_of_angle(&self, theta: f64, from: f64, to: f64) -> Option<f64> {
        root::bracketed(|t| self.at(t).0 - theta, from, to)
    }
}

/// Returns the second derivatives of a polynomial in powers of x.
#[inline]
fn second_derivatives<const N: usize>(powers: &[f64; TERMS], x: [f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for k in (2..TERMS).rev() {
        let term = (k * (k - 1)) as f64 * powers[k];
        for i in 0..N {
            sums[i] = sums[i] * x[i] + term;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_many_turns_is_to_end_after_one() {
        let node = |t: f64, turns: f64| Node {
            t,
            theta: turns * TAU,
            omega: TAU,
            alpha: 0.0,
            work: 0.0,
        };
        let part = |turns: f64| Step::new(0.0, node(0.0, 0.0), node(1.0, turns)).part_of_one_turn();
        assert_eq!(part(1.9), None);
        assert_eq!(part(-10.0), Some(0.1));
    }
}
