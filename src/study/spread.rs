//! The spread of angle and speed, carried along the motion: what rounding does to a run grows and turns with it.
//!
//! δθ̈ = a δθ + b δθ̇ with the slopes a, b of the acceleration. Where the motion moves a good deal in a step, slopes
//! from one place are not enough: errors of the transition would grow by themselves from turn to turn. But one
//! perturbation is known exactly, that of a motion a little later, δ = (θ̇, θ̈), and the determinant is
//! exp ∫ b dt (Liouville; Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., I.11):
//! only what a perturbation across the motion gains along it is left to the slopes.

use crate::engine::Motion;
use crate::engine::step::Step;

/// Changes from which slopes of the acceleration are taken: of the angle, rad, of the speed, in parts of itself,
/// and of the time, in parts of the step. The polynomial of a step is not quite its acceleration: of a smaller change
/// it would be no small part.
const CHANGE: f64 = 1e-4;
const LATER: f64 = 1e-2;
/// On a way this short, rad, the slopes are taken as constant if the motion is not onwards (half or twice as much changes the
/// stated errors of 200 random runs by 0.2 % at most)...
const SHORT: f64 = 1e-3;
/// ... and on one this short always: angle and speed are rounded.
const SHORTEST: f64 = 1e-11;

/// A motion is onwards where its least speed in a step is this part of the largest.
const EVEN: f64 = 0.5;

/// Where the time changes the motion by more than this part of it in a step, the one a little later is another one.
const PUSHED: f64 = 0.3;

/// A 2 by 2 matrix, row by row.
pub(super) type Transition = [[f64; 2]; 2];

/// Variances and covariance of angle (rad) and speed (rad/s), in units of the last place squared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spread {
    pub angle: f64,
    pub both: f64,
    pub speed: f64,
}

impl Spread {
    /// This one, or the one before where numbers have become too large.
    fn or(self, before: &Spread) -> Spread {
        let finite = self.angle.is_finite() && self.both.is_finite() && self.speed.is_finite();
        if finite { self } else { *before }
    }

    /// With errors of angle (rad) and speed (rad/s) that have nothing to do with it.
    pub fn plus(self, angle: f64, speed: f64) -> Spread {
        let sum = Spread {
            angle: self.angle + angle * angle,
            speed: self.speed + speed * speed,
            ..self
        };
        sum.or(&self)
    }

    /// With an error of the acceleration (rad/s²) that lasts over a step of length h (s), at the end of the step.
    pub fn pushed(self, acceleration: f64, transition: &Transition, h: f64) -> Spread {
        let speed = transition[0][1] * acceleration;
        self.along(0.5 * h * speed, speed)
    }

    /// With errors of angle (rad) and speed (rad/s) that are one.
    pub fn along(self, angle: f64, speed: f64) -> Spread {
        let sum = Spread {
            angle: self.angle + angle * angle,
            both: self.both + angle * speed,
            speed: self.speed + speed * speed,
        };
        sum.or(&self)
    }

    /// After a transition.
    pub fn carried(self, [[c11, c12], [c21, c22]]: &Transition) -> Spread {
        let Spread { angle, both, speed } = self;
        // Where terms cancel, rounding may leave a variance below zero.
        let next = Spread {
            angle: (c11 * c11 * angle + 2.0 * c11 * c12 * both + c12 * c12 * speed).abs(),
            both: c11 * c21 * angle + (c11 * c22 + c12 * c21) * both + c12 * c22 * speed,
            speed: (c21 * c21 * angle + 2.0 * c21 * c22 * both + c22 * c22 * speed).abs(),
        };
        next.or(&self)
    }
}

/// Slopes of the acceleration in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Slopes {
    /// 1/s²
    pub by_angle: f64,
    /// 1/s
    pub by_speed: f64,
    /// rad/s³
    by_time: f64,
}

impl Slopes {
    /// Of the motion in a step. How the acceleration changes over the step tells its mean slope by the angle, also where
    /// that is steep in a small part of the step; only next to a turning point it is taken from one place.
    pub fn of(motion: &dyn Motion, step: &Step) -> Slopes {
        let h = step.length();
        let t = step.start.t + 0.5 * h;
        let (theta, speed) = step.at(t);
        let at = |t: f64, theta: f64, speed: f64| motion.acceleration(t, step.angle(theta), speed);
        let here = if step.has_polynomial() {
            step.acceleration_at(t)
        } else {
            at(t, theta, speed)
        };
        let faster = CHANGE * speed.abs().max(step.start.omega.abs()).max(1.0);
        let by_time = if motion.depends_on_time() {
            let later = t + LATER * h;
            (at(later, theta, speed) - here) / (later - t)
        } else {
            0.0
        };
        let by_speed = (at(t, theta, speed + faster) - here) / faster;
        let (start, end) = (&step.start, &step.end);
        let mean_speed = (end.theta - start.theta) / h;
        let mean_acceleration = (end.omega - start.omega) / h;
        let change = (end.alpha - start.alpha) / h;
        let along = (change - by_speed * mean_acceleration - by_time) / mean_speed;
        let onwards = start.omega.min(end.omega) > 0.0 || start.omega.max(end.omega) < 0.0;
        let tells = onwards && (mean_speed * h).abs() >= SHORTEST && along.is_finite();
        let by_angle = if tells {
            along
        } else {
            (at(t, theta + CHANGE, speed) - here) / CHANGE
        };
        Slopes {
            by_angle,
            by_speed,
            by_time,
        }
    }

    /// What a perturbation at the start of the step has become at its end.
    pub fn transition(&self, step: &Step) -> Transition {
        let h = step.length();
        let frozen = exponential(self.by_angle, self.by_speed, h);
        let travel = (step.end.theta - step.start.theta).abs();
        let along = [step.start.omega, step.start.alpha];
        // What the time changes in the forces moves the motion a little later in another way.
        let pushed = [0.5 * h * h * self.by_time, h * self.by_time];
        let then = [step.end.omega - pushed[0], step.end.alpha - pushed[1]];
        let size = |[angle, speed]: [f64; 2]| angle.hypot(h * speed);
        if travel < SHORTEST || size(pushed) > PUSHED * size(along) {
            return frozen;
        }
        let found = match self.onwards(step, then) {
            Some(found) => found,
            None if travel < SHORT => frozen,
            None => self.with_motion(&frozen, along, then, h),
        };
        let finite = found.iter().flatten().all(|entry| entry.is_finite());
        if finite { found } else { frozen }
    }

    /// The transition of a motion onwards. A motion that is faster at the start by one comes to the same angle faster by
    /// θ̇₀ exp(∫ b dt)/θ̇, and so much earlier that the time gained is the integral of that over θ̇: no slope by the
    /// angle is in it, which next to a limit may be steep in a small part of the step. None where the speed changes a lot.
    fn onwards(&self, step: &Step, then: [f64; 2]) -> Option<Transition> {
        let (start, h) = (&step.start, step.length());
        let (_, middle) = step.at(step.start.t + 0.5 * h);
        let speeds =
            [start.omega, middle, step.end.omega].map(|omega| omega * start.omega.signum());
        let least = speeds.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        let most = speeds.iter().fold(0.0f64, |a, b| a.max(*b));
        if least < EVEN * most || then[0] == 0.0 {
            return None;
        }
        let left = |part: f64| (part * self.by_speed * h).exp();
        let [first, second, third] = speeds.map(|speed| speeds[0] / (speed * speed));
        let gained = h / 6.0 * (first + 4.0 * left(0.5) * second + left(1.0) * third);
        let gained = gained * start.omega.signum();
        let faster = [
            gained * then[0],
            gained * then[1] + left(1.0) * start.omega / then[0],
        ];
        Some(std::array::from_fn(|i| {
            [(then[i] - start.alpha * faster[i]) / start.omega, faster[i]]
        }))
    }

    /// The transition that takes `along` to `then`, with the right determinant; the rest as in another one. Speeds
    /// are measured by angles over h.
    fn with_motion(
        &self,
        other: &Transition,
        along: [f64; 2],
        then: [f64; 2],
        h: f64,
    ) -> Transition {
        let product = |x: [f64; 2], y: [f64; 2]| x[0] * y[0] + h * h * x[1] * y[1];
        // Across the motion, with along ∧ across = 1.
        let across = |[speed, acceleration]: [f64; 2]| {
            let squared = product([speed, acceleration], [speed, acceleration]);
            [-h * h * acceleration / squared, speed / squared]
        };
        let [before, after] = [along, then].map(across);
        let image = other.map(|row| row[0] * before[0] + row[1] * before[1]);
        let gained = product(image, then) / product(then, then);
        let left = (self.by_speed * h).exp();
        let square = product(along, along);
        std::array::from_fn(|i| {
            let of_across = gained * then[i] + left * after[i];
            [
                then[i] * along[0] / square - of_across * along[1],
                then[i] * h * h * along[1] / square + of_across * along[0],
            ]
        })
    }
}

/// exp of h times the matrix with the rows (0, 1) and (a, b).
fn exponential(a: f64, b: f64, h: f64) -> Transition {
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
    use super::exponential;

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
            let (half, whole) = (exponential(a, b, 0.35), exponential(a, b, 0.7));
            for i in 0..2 {
                for j in 0..2 {
                    let twice = half[i][0] * half[0][j] + half[i][1] * half[1][j];
                    let size = 1.0 + whole[i][j].abs();
                    assert!((twice - whole[i][j]).abs() < 1e-9 * size, "{a} {b}");
                    let small = exponential(a, b, 1e-7);
                    let one = if i == j { 1.0 } else { 0.0 };
                    let slope = (small[i][j] - one) / 1e-7;
                    let matrix = [[0.0, 1.0], [a, b]][i][j];
                    assert!((slope - matrix).abs() < 1e-3 * (1.0 + b * b), "{a} {b}");
                }
            }
        }
    }
}
