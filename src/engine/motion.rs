//! Equation of motion as the integrators see it.

use std::cell::Cell;
use std::ops::Deref;

use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{MotionPiece, Variation};

/// Equation of motion θ̈ = f(t, θ, θ̇) with a power to be integrated along the motion.
pub trait Motion {
    /// Returns θ̈, rad/s²; not finite where no motion is possible.
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64;

    /// Returns θ̈, rad/s², and the power to be integrated, W.
    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64);

    /// True if the acceleration or the power depends on time explicitly.
    fn depends_on_time(&self) -> bool;

    /// True if there is a power to be integrated.
    fn has_power(&self) -> bool;

    /// Returns the next time after `t`, s, at which the acceleration is not smooth in time; steps end there.
    fn next_corner(&self, t: f64) -> f64;

    /// True if the acceleration may vary between the nodes of a step without a trace in the decay of its series.
    fn varies_between_nodes(&self) -> bool {
        false
    }

    /// Returns the variation of the acceleration, rad/s², on a piece and in its Bernstein ellipse, ρ = `ellipse`.
    fn variation(&self, _reach: &MotionPiece, _ellipse: f64) -> Variation {
        Variation::NONE
    }

    /// Returns the first coordinate, rad, between `from` and `to` at which the acceleration is known not to be smooth.
    fn corner_on_way(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// Returns the quantities that depend on time (s) alone, computed once for the instants of a [`Batch`].
    fn of_times(&self, _t: &[f64; NODES]) -> [[f64; 2]; NODES] {
        [[0.0; 2]; NODES]
    }

    /// Computes accelerations and powers of a batch.
    fn fill(&self, batch: &mut Batch) {
        fill_one_by_one(self, batch);
    }
}

/// Computes accelerations and powers of a batch, each by itself.
pub fn fill_one_by_one(motion: &(impl Motion + ?Sized), batch: &mut Batch) {
    for i in 0..NODES {
        let angle = Angle::new(batch.turns, batch.theta[i]);
        (batch.alpha[i], batch.power[i]) =
            motion.acceleration_and_power(batch.t[i], angle, batch.omega[i]);
    }
}

/// Subintervals of a step; a quantity is taken to change sign, and the speed to have an extreme, at most once in each.
pub const PIECES: usize = 8;

/// Number of instants in a batch: the nodes of the collocation.
pub const NODES: usize = 12;

/// Instants evaluated together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Batch {
    /// Times, s.
    pub t: [f64; NODES],
    /// Values of [`Motion::of_times`] at these times.
    pub of_time: [[f64; 2]; NODES],
    /// Whole turns to be added to the angles.
    pub turns: f64,
    /// Angles without the whole turns, rad.
    pub theta: [f64; NODES],
    /// Speeds, rad/s.
    pub omega: [f64; NODES],
    /// Accelerations θ̈, rad/s².
    pub alpha: [f64; NODES],
    /// Powers, W.
    pub power: [f64; NODES],
}

/// Wrapper of a motion that counts evaluations and keeps the last state without a finite acceleration.
pub struct Counted<'a> {
    motion: &'a dyn Motion,
    evaluations: Cell<u64>,
    singular_state: Cell<Option<(f64, Angle, f64)>>,
}

impl<'a> Counted<'a> {
    /// Wraps a motion, with the count at zero.
    pub fn new(motion: &'a dyn Motion) -> Counted<'a> {
        Counted {
            motion,
            evaluations: Cell::new(0),
            singular_state: Cell::new(None),
        }
    }

    /// Number of evaluations.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Time (s), angle and speed (rad/s) of the last evaluation without a finite acceleration.
    pub fn singular_state(&self) -> Option<(f64, Angle, f64)> {
        self.singular_state.get()
    }

    /// True if rounding hides what is left, s, to a pole of a load from a time (s), angle and speed (rad/s). The pole
    /// becomes the last state without a finite acceleration.
    pub fn reaches_pole(&self, left: f64, t: f64, angle: Angle, speed: f64) -> bool {
        let pole = angle.plus(speed * left);
        self.singular_state.set(Some((t + left, pole, speed)));
        // Nearer, the roundings of time and angle leave too few places to find the pole again.
        let least_roundings = 1e6;
        let rounding = f64::EPSILON * t.abs().max((angle.radians() / speed).abs());
        left <= least_roundings * rounding
    }

    /// Returns [`Motion::acceleration`], counted.
    pub fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        let acceleration = self.motion.acceleration(t, angle, speed);
        self.note(acceleration, t, angle, speed);
        acceleration
    }

    /// Returns [`Motion::acceleration_and_power`], counted.
    pub fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        let (acceleration, power) = self.motion.acceleration_and_power(t, angle, speed);
        self.note(acceleration, t, angle, speed);
        (acceleration, power)
    }

    /// Computes a batch as [`Motion::fill`], counted.
    pub fn fill(&self, batch: &mut Batch) {
        self.motion.fill(batch);
        for i in 0..NODES {
            let angle = Angle::new(batch.turns, batch.theta[i]);
            self.note(batch.alpha[i], batch.t[i], angle, batch.omega[i]);
        }
    }

    fn note(&self, acceleration: f64, t: f64, angle: Angle, speed: f64) {
        self.evaluations.set(self.evaluations.get() + 1);
        // A non-finite state results from an earlier non-finite evaluation.
        let asked = angle.rest.is_finite() && speed.is_finite();
        if asked && !acceleration.is_finite() {
            self.singular_state.set(Some((t, angle, speed)));
        }
    }
}

/// What is no evaluation is not counted.
impl<'a> Deref for Counted<'a> {
    type Target = dyn Motion + 'a;

    fn deref(&self) -> &(dyn Motion + 'a) {
        self.motion
    }
}
