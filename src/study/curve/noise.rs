//! What rounding does to a run on the curve: the spread of angle and speed, carried along with the motion.

use std::cell::Cell;

use super::arrived::Observer;
use super::phase::{InPhase, Phase};
use crate::engine::Motion;
use crate::engine::step::Step;
use crate::mechanism::Constrained;
use crate::numeric::angle::Angle;

/// Rounding of one evaluation of the acceleration, in units of the last place.
const EVALUATION: f64 = 8.0;
/// Relative change from which slopes of the acceleration are taken.
const CHANGE: f64 = 1e-6;

/// Variances and covariance of angle (rad) and speed (rad/s) of the coordinate, in units of the last place squared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread {
    pub angle: f64,
    pub both: f64,
    pub speed: f64,
}

/// Follows a run.
pub(super) struct Noise<'a> {
    pub equation: &'a Constrained,
    pub spread: Spread,
    /// Evaluations for the slopes.
    pub evaluations: Cell<u64>,
    /// Acceleration at the end of the last step.
    before: Option<f64>,
}

impl<'a> Noise<'a> {
    /// Nothing yet.
    pub fn new(equation: &'a Constrained) -> Noise<'a> {
        Noise {
            equation,
            spread: Spread::default(),
            evaluations: Cell::new(0),
            before: None,
        }
    }

    /// ∂q̈/∂q and ∂q̈/∂q̇ in the middle of a step.
    fn slopes(&self, step: &Step, motion: &InPhase<'_>) -> [f64; 2] {
        let t = step.start.t + 0.5 * step.length();
        let (theta, speed) = step.at(t);
        let faster = CHANGE * speed.abs().max(step.start.omega.abs()).max(1.0);
        let at = |theta: f64, speed: f64| motion.acceleration(t, step.angle(theta), speed);
        self.evaluations.set(self.evaluations.get() + 4);
        [
            (at(theta + CHANGE, speed) - at(theta - CHANGE, speed)) / (2.0 * CHANGE),
            (at(theta, speed + faster) - at(theta, speed - faster)) / (2.0 * faster),
        ]
    }
}

impl Observer for Noise<'_> {
    fn step(&mut self, step: &Step, phase: Phase) -> bool {
        if phase == Phase::Sticking {
            // What it is off in speed is lost at rest.
            self.spread.speed = 0.0;
            self.spread.both = 0.0;
            self.before = None;
            return false;
        }
        let (start, end, h) = (&step.start, &step.end, step.length());
        if start.omega == 0.0
            && let Some(before) = self.before.filter(|before| *before != 0.0)
        {
            // Turned back later or sooner, under another friction than before.
            let change = start.alpha / before;
            self.spread.both *= change;
            self.spread.speed *= change * change;
        }
        self.before = Some(end.alpha);
        let motion = InPhase {
            equation: self.equation,
            phase,
        };
        let [by_angle, by_speed] = self.slopes(step, &motion);
        self.spread = self.spread.carried(by_angle, by_speed, h);
        // Rounded states at the ends of the steps, at rounded times.
        let late = 0.5 * end.t.abs();
        let angle = 0.5 * (1.0 + end.theta.abs()) + late * end.omega.abs();
        let speed = 0.5 * end.omega.abs() + late * end.alpha.abs();
        // Accelerations from rounded angles.
        let place = 4.0 * end.theta.abs() * by_angle;
        let within = h * (place.abs() + EVALUATION * start.alpha.abs().max(end.alpha.abs()));
        let added = Spread {
            angle: angle * angle,
            both: 0.0,
            speed: speed * speed + within * within,
        };
        self.spread = self.spread.plus(&added);
        false
    }

    fn event(&mut self, _: &'static str, _: f64, _: Angle, _: f64) {}
}

impl Spread {
    /// This one, or the one before where numbers have become too large.
    fn or(self, before: &Spread) -> Spread {
        let finite = self.angle.is_finite() && self.both.is_finite() && self.speed.is_finite();
        if finite { self } else { *before }
    }

    fn plus(&self, other: &Spread) -> Spread {
        let sum = Spread {
            angle: self.angle + other.angle,
            both: self.both + other.both,
            speed: self.speed + other.speed,
        };
        sum.or(self)
    }

    /// After a time h (s) of δq̈ = a δq + b δq̇.
    fn carried(&self, a: f64, b: f64, h: f64) -> Spread {
        let [[c11, c12], [c21, c22]] = transition(a, b, h);
        let Spread { angle, both, speed } = *self;
        let next = Spread {
            angle: c11 * c11 * angle + 2.0 * c11 * c12 * both + c12 * c12 * speed,
            both: c11 * c21 * angle + (c11 * c22 + c12 * c21) * both + c12 * c22 * speed,
            speed: c21 * c21 * angle + 2.0 * c21 * c22 * both + c22 * c22 * speed,
        };
        next.or(self)
    }
}

/// exp of h times the matrix with the rows (0, 1) and (a, b).
fn transition(a: f64, b: f64, h: f64) -> [[f64; 2]; 2] {
    let (mean, squared) = (0.5 * b, 0.25 * b * b + a);
    let root = squared.abs().sqrt();
    // Mean of the two modes, and their difference over twice the root.
    let (even, odd) = if root * h < 1e-6 {
        let decay = (mean * h).exp();
        (decay, decay * h)
    } else if squared < 0.0 {
        let decay = (mean * h).exp();
        let (sin, cos) = (root * h).sin_cos();
        (decay * cos, decay * sin / root)
    } else {
        let [fast, slow] = [mean + root, mean - root].map(|rate| (rate * h).exp());
        (0.5 * (fast + slow), 0.5 * (fast - slow) / root)
    };
    [[even - mean * odd, odd], [a * odd, even + mean * odd]]
}

#[cfg(test)]
mod tests {
    use super::transition;

    /// Two halves make a whole, and the slope at zero is the matrix.
    #[test]
    fn transitions_are_exponentials() {
        for (a, b) in [
            (-4.0, -0.3),
            (3.0, 0.5),
            (0.0, 0.0),
            (-1.0, -2.0),
            (2.0, -1e3),
        ] {
            let (half, whole) = (transition(a, b, 0.35), transition(a, b, 0.7));
            for i in 0..2 {
                for j in 0..2 {
                    let twice = half[i][0] * half[0][j] + half[i][1] * half[1][j];
                    let size = 1.0 + whole[i][j].abs();
                    assert!((twice - whole[i][j]).abs() < 1e-9 * size, "{a} {b}");
                    let small = transition(a, b, 1e-7);
                    let one = if i == j { 1.0 } else { 0.0 };
                    let slope = (small[i][j] - one) / 1e-7;
                    let matrix = [[0.0, 1.0], [a, b]][i][j];
                    assert!((slope - matrix).abs() < 1e-3 * (1.0 + b * b), "{a} {b}");
                }
            }
        }
    }
}
