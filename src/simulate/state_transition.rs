//! State transition matrix of angle and speed over a step, by the variational equation along the motion.
//!
//! δθ̈ = a δθ + b δθ̇ with the slopes a, b of the acceleration along the motion, taken at the nodes of the step. Small
//! errors of the slopes would grow from turn to turn. But two facts are exact: the motion a little later is a
//! perturbation, δ = (θ̇, θ̈), and the determinant is exp ∫ b dt (Liouville; Hairer, Nørsett, Wanner, Solving Ordinary
//! Differential Equations I, 2nd ed., I.11). The slopes only determine the gain along the motion of a perturbation
//! across it.

use std::array::from_fn;
use std::f64::consts::PI;

use nalgebra::{Matrix3, Vector2};

use crate::engine::step::Step;
use crate::engine::{Batch, Counted};
use crate::numeric::covariance_factor::Transition;

/// Values at the nodes of the rule.
type AtNodes<T> = [T; 3];

/// Nodes and weights of Gauss's rule with three points on [0, 1] (Abramowitz and Stegun, 25.4.30).
const GAUSS_RULE: AtNodes<(f64, f64)> = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// Partial derivatives of the acceleration at the nodes of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AccelerationSlopes {
    /// By the angle, 1/s².
    by_angle: AtNodes<f64>,
    /// By the speed, 1/s.
    by_speed: AtNodes<f64>,
    /// By the time, rad/s³.
    by_time: AtNodes<f64>,
}

impl AccelerationSlopes {
    /// Computes the slopes at the nodes of a step, by forward differences.
    pub fn of(motion: &Counted<'_>, step: &Step) -> AccelerationSlopes {
        let (start, end, h) = (&step.start, &step.end, step.length());
        // Differences, about the square root of a rounding: of the angle, rad, no more than in the step, as slopes near
        // a limit are steep, but enough to exceed rounding; of the speed, relative to the speed or 1 rad/s; of the
        // time, relative to the step.
        let (least_angle, most_angle, speed_share) = (1e-9, 1e-7, 1e-7);
        let aside = (end.theta - start.theta)
            .abs()
            .clamp(least_angle, most_angle);
        let later = 1e-5 * h;
        let mut faster = AtNodes::default();
        // Four states at each node: on the motion, and with another angle, speed and time.
        let mut beside = Batch {
            turns: step.turns,
            ..Batch::default()
        };
        for (i, (part, _)) in GAUSS_RULE.into_iter().enumerate() {
            let t = start.t + part * h;
            let (theta, speed) = step.at(t);
            faster[i] = speed_share * speed.abs().max(start.omega.abs()).max(1.0);
            for j in 0..4 {
                let at = 4 * i + j;
                (beside.t[at], beside.theta[at], beside.omega[at]) = (t, theta, speed);
            }
            beside.theta[4 * i + 1] += aside;
            beside.omega[4 * i + 2] += faster[i];
            beside.t[4 * i + 3] += later;
        }
        if motion.depends_on_time() {
            beside.of_time = motion.of_times(&beside.t);
        }
        motion.fill(&mut beside);
        let gain = |i: usize, j: usize| beside.alpha[4 * i + j] - beside.alpha[4 * i];
        AccelerationSlopes {
            by_angle: from_fn(|i| gain(i, 1) / aside),
            by_speed: from_fn(|i| gain(i, 2) / faster[i]),
            by_time: from_fn(|i| gain(i, 3) / later),
        }
    }

    /// Returns the mean slope by the angle, 1/s².
    pub fn by_angle(&self) -> f64 {
        mean(&self.by_angle)
    }

    /// Returns the root mean square of the slope by the time, rad/s³.
    pub fn by_time(&self) -> f64 {
        mean(&self.by_time.map(|slope| slope.powi(2))).sqrt()
    }

    /// Computes the transition over the step, from the slopes and, where exact enough, the motion a little later.
    pub fn transition(&self, step: &Step) -> Transition {
        let h = step.length();
        let (magnus_transition, pushed) = self.magnus_transition(h);
        let travel = (step.end.theta - step.start.theta).abs();
        let along = [step.start.omega, step.start.alpha];
        // The time changes the forces: this part of the state is no perturbation of the motion a little later.
        let then = [step.end.omega - pushed[0], step.end.alpha - pushed[1]];
        // In this time an angle becomes a speed by the slope: in a much shorter step an angle does not tell a delay.
        let turns = (h * h * self.by_angle().abs()).clamp(f64::EPSILON, 1.0);
        let unit = h / turns.sqrt();
        let size = |[angle, speed]: [f64; 2]| angle.hypot(unit * speed);
        // Rotation, rad, of which rounding leaves too little, and largest effect of the time beside the motion.
        let (shortest_travel, most_pushed) = (1e-11, 0.3);
        if travel < shortest_travel || size(pushed) > most_pushed * size(along) {
            return magnus_transition;
        }
        let found = self.with_exact_motion(&magnus_transition, along, then, [h, unit]);
        let finite = found.iter().all(|entry| entry.is_finite());
        if finite { found } else { magnus_transition }
    }

    /// Computes the transition over a step of length h (s) and the push of the time; exact for constant slopes.
    fn magnus_transition(&self, h: f64) -> (Transition, [f64; 2]) {
        let largest = self.by_time.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        let unit = if largest > 0.0 { h * h * largest } else { 1.0 };
        // State of the linear system: angle, speed times h, and one.
        let [first, middle, last]: AtNodes<Matrix3<f64>> = from_fn(|i| {
            let (by_angle, by_speed) = (h * h * self.by_angle[i], h * self.by_speed[i]);
            let push = h * h * self.by_time[i] / unit;
            Matrix3::new(0.0, 1.0, 0.0, by_angle, by_speed, push, 0.0, 0.0, 0.0)
        });
        let end = exponential([first, middle, last]);
        let transition =
            Transition::new(end[(0, 0)], h * end[(0, 1)], end[(1, 0)] / h, end[(1, 1)]);
        let pushed = [unit * end[(0, 2)], unit * end[(1, 2)] / h];
        (transition, pushed)
    }

    /// Computes the transition that takes `along` to `then` and has the right determinant over a step of length h (s);
    /// the rest comes from `other`. The metric multiplies speeds by a unit of time, s.
    fn with_exact_motion(
        &self,
        other: &Transition,
        along: [f64; 2],
        then: [f64; 2],
        [h, unit]: [f64; 2],
    ) -> Transition {
        let product = |x: [f64; 2], y: [f64; 2]| x[0] * y[0] + unit * unit * x[1] * y[1];
        // Vector across the motion, with along ∧ across = 1.
        let across = |[speed, acceleration]: [f64; 2]| {
            let squared = product([speed, acceleration], [speed, acceleration]);
            [-unit * unit * acceleration / squared, speed / squared]
        };
        let [before, after] = [along, then].map(across);
        let [image] = (other * Vector2::from(before)).data.0;
        let gained = product(image, then) / product(then, then);
        let left = (mean(&self.by_speed) * h).exp();
        let square = product(along, along);
        let rows = [0, 1].map(|i| {
            let of_across = gained * then[i] + left * after[i];
            [
                then[i] * along[0] / square - of_across * along[1],
                then[i] * unit * unit * along[1] / square + of_across * along[0],
            ]
        });
        Transition::from(rows).transpose()
    }
}

/// Solves y' = A(s) y over 0 < s < 1, from A at the nodes. Magnus's series of order six (Blanes, Casas, Oteo, Ros,
/// Physics Reports 470, 2009, eq. 253) where it is known to converge, ∫ ‖A‖ < π (section 2.7 there); for steeper losses
/// a product of exponentials, one A for each part of the step, which decays where A does.
fn exponential([first, middle, last]: AtNodes<Matrix3<f64>>) -> Matrix3<f64> {
    let size = |a: &Matrix3<f64>| a.iter().fold(0.0f64, |most, entry| most.max(entry.abs()));
    let largest = [&first, &middle, &last].map(size);
    // Largest element for which a transition is computed: the exponential squares its matrix again and again.
    let steepest = 1e12;
    if !largest.iter().all(|size| *size < steepest) {
        return Matrix3::repeat(f64::NAN);
    }
    if mean(&[first.norm(), middle.norm(), last.norm()]) < PI {
        let even = (first - 2.0 * middle + last) * (10.0 / 3.0);
        let odd = (last - first) * (15f64.sqrt() / 3.0);
        let inner = commutator(&middle, &odd);
        let outer = commutator(&middle, &(2.0 * even + inner));
        let mixed = commutator(&(inner - 20.0 * middle - even), &(odd - outer / 60.0));
        (middle + even / 12.0 + mixed / 240.0).exp()
    } else {
        let part = |a: Matrix3<f64>, i: usize| (a * GAUSS_RULE[i].1).exp();
        part(last, 2) * part(middle, 1) * part(first, 0)
    }
}

fn mean(values: &AtNodes<f64>) -> f64 {
    let weighted = GAUSS_RULE.iter().zip(values);
    weighted.map(|((_, weight), value)| weight * value).sum()
}

fn commutator(x: &Matrix3<f64>, y: &Matrix3<f64>) -> Matrix3<f64> {
    x * y - y * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::WorkLimit;
    use crate::engine::time::{self, MotionState, Settings};
    use crate::mechanism::Equation;
    use crate::numeric::angle::Angle;
    use crate::scene::{Crank, Expression, Load, Scene};

    /// Damped pendulum with a periodic torque of amplitude `push`, N m.
    fn pendulum(push: f64) -> Equation {
        let torque = format!("{push}*cos(3*t) - 4*sin(theta) - 0.1*omega");
        let torque = Expression::parse(&torque).expect("a formula");
        let crank = Crank {
            inertia: 1.0,
            ..Crank::default()
        };
        Equation::new(
            &Scene::new(0.1, 0.3)
                .crank(crank)
                .torque(Load::Expression(torque)),
        )
    }

    /// Steps of a run from a start to a time.
    fn steps(motion: &Equation, start: MotionState, t_end: f64) -> Vec<Step> {
        let settings = Settings {
            method: None,
            tolerance: 1e-14,
            t_end,
            way: f64::INFINITY,
            limit: WorkLimit::NONE,
            work_unit: 1.0,
            guide: &[],
        };
        let mut steps = Vec::new();
        time::run(&Counted::new(motion), start, &settings, &mut |step| {
            steps.push(*step);
            false
        });
        steps
    }

    /// Compares with runs from starts on both sides of the step: swings with turning points in the steps, full turns,
    /// with and without a load in time.
    #[test]
    fn transitions_are_those_of_runs_from_starts_beside() {
        let aside = 1e-4;
        for (push, angle, speed) in [(0.0, 2.0, 0.0), (0.0, 0.3, 9.0), (1.5, 1.0, -0.5)] {
            let equation = pendulum(push);
            let start = |t: f64, angle: f64, speed: f64| MotionState {
                t,
                angle: Angle::from(angle),
                speed,
            };
            for step in steps(&equation, start(0.0, angle, speed), 3.0) {
                let found =
                    AccelerationSlopes::of(&Counted::new(&equation), &step).transition(&step);
                let from = step.start;
                let end = |part: [f64; 2]| {
                    let beside = start(from.t, from.theta + part[0], from.omega + part[1]);
                    let last = *steps(&equation, beside, step.end.t).last().expect("a step");
                    [
                        last.end.theta + std::f64::consts::TAU * last.turns,
                        last.end.omega,
                    ]
                };
                for (column, part) in [[aside, 0.0], [0.0, aside]].into_iter().enumerate() {
                    let (more, less) = (end(part), end(part.map(|part| -part)));
                    for row in 0..2 {
                        let exact = (more[row] - less[row]) / (2.0 * aside);
                        let off = (found[(row, column)] - exact).abs();
                        assert!(off < 1e-4, "{step:?}: {found:?}, not {exact}");
                    }
                }
            }
        }
    }
}
