//! The motion that integrators see.

use std::cell::Cell;

use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{Detail, Reach};

/// An equation of motion θ̈ = f(t, θ, θ̇) and a power whose integral is wanted beside it.
pub trait Motion {
    /// θ̈, rad/s². Not finite means: not possible here.
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64;

    /// θ̈, and the power (W) to be integrated.
    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64);

    /// Whether time occurs in the acceleration or the power.
    fn depends_on_time(&self) -> bool;

    /// Whether there is a power to be integrated.
    fn has_power(&self) -> bool;

    /// The next time after `t` at which the acceleration is not smooth in time; steps end there.
    fn next_corner(&self, t: f64) -> f64;

    /// Whether the acceleration may do something between the nodes of a step that its decay does not tell.
    fn has_detail(&self) -> bool {
        false
    }

    /// What the acceleration, rad/s², does on a piece of the motion, and in a Bernstein ellipse of this size around it.
    fn detail(&self, _reach: &Reach, _ellipse: f64) -> Detail {
        Detail::NONE
    }

    /// The first coordinate, rad, after `from` on the way to `to` at which the acceleration is known not to be smooth.
    fn corner_on_way(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// What the motion takes from the time alone: computed once for each instant of a [`Batch`].
    fn of_time(&self, _t: f64) -> [f64; 2] {
        [0.0; 2]
    }

    /// Accelerations and powers of a batch.
    fn fill(&self, batch: &mut Batch) {
        for i in 0..NODES {
            let angle = Angle::new(batch.turns, batch.theta[i]);
            (batch.alpha[i], batch.power[i]) =
                self.acceleration_and_power(batch.t[i], angle, batch.omega[i]);
        }
    }
}

/// Pieces of a step in each of which a quantity changes its sign at most once, and the speed has one extreme at most.
pub const PIECES: usize = 8;

/// Instants in a batch.
pub const NODES: usize = 12;

/// Instants whose accelerations are asked for together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Batch {
    /// s
    pub t: [f64; NODES],
    /// [`Motion::of_time`] at these times.
    pub of_time: [[f64; 2]; NODES],
    /// Whole turns beside the angles.
    pub turns: f64,
    /// rad
    pub theta: [f64; NODES],
    /// rad/s
    pub omega: [f64; NODES],
    /// θ̈, rad/s²
    pub alpha: [f64; NODES],
    /// W
    pub power: [f64; NODES],
}

/// A motion that counts its evaluations and remembers where one was not possible.
pub struct Counted<'a> {
    motion: &'a dyn Motion,
    evaluations: Cell<u64>,
    impossible: Cell<Option<(f64, Angle, f64)>>,
}

impl<'a> Counted<'a> {
    /// Counts from zero.
    pub fn new(motion: &'a dyn Motion) -> Counted<'a> {
        Counted {
            motion,
            evaluations: Cell::new(0),
            impossible: Cell::new(None),
        }
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> u64 {
        self.evaluations.get()
    }

    /// Time, angle and speed of the last evaluation without a finite result.
    pub fn impossible(&self) -> Option<(f64, Angle, f64)> {
        self.impossible.get()
    }

    fn note(&self, acceleration: f64, t: f64, angle: Angle, speed: f64) {
        self.evaluations.set(self.evaluations.get() + 1);
        self.remember(acceleration, t, angle, speed);
    }

    fn remember(&self, acceleration: f64, t: f64, angle: Angle, speed: f64) {
        // A state that is not finite itself comes from an impossible evaluation before it.
        let asked = angle.rest.is_finite() && speed.is_finite();
        if asked && !acceleration.is_finite() {
            self.impossible.set(Some((t, angle, speed)));
        }
    }
}

impl Motion for Counted<'_> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        let acceleration = self.motion.acceleration(t, angle, speed);
        self.note(acceleration, t, angle, speed);
        acceleration
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        let (acceleration, power) = self.motion.acceleration_and_power(t, angle, speed);
        self.note(acceleration, t, angle, speed);
        (acceleration, power)
    }

    fn depends_on_time(&self) -> bool {
        self.motion.depends_on_time()
    }

    fn has_power(&self) -> bool {
        self.motion.has_power()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.motion.next_corner(t)
    }

    fn has_detail(&self) -> bool {
        self.motion.has_detail()
    }

    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail {
        self.motion.detail(reach, ellipse)
    }

    fn corner_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.motion.corner_on_way(from, to)
    }

    fn of_time(&self, t: f64) -> [f64; 2] {
        self.motion.of_time(t)
    }

    fn fill(&self, batch: &mut Batch) {
        self.motion.fill(batch);
        self.evaluations.set(self.evaluations.get() + NODES as u64);
        for i in 0..NODES {
            let angle = Angle::new(batch.turns, batch.theta[i]);
            self.remember(batch.alpha[i], batch.t[i], angle, batch.omega[i]);
        }
    }
}
