//! Motion between two changes of the friction: the signs of slider velocity and normal force stay.

use std::cell::Cell;

use crate::engine::Motion;
use crate::engine::guard::Watched;
use crate::mechanism::{Constrained, Touch};
use crate::numeric::angle::Angle;
use crate::scene::{Friction, Variable};

/// The watched quantities.
pub(super) const SPEED: usize = 0;
pub(super) const DEAD_CENTRE: usize = 1;
pub(super) const LIMIT: usize = 2;
pub(super) const TURNED: usize = 3;
pub(super) const NORMAL: usize = 4;
pub(super) const CLEAR: usize = 5;
/// How many they are.
pub(super) const QUANTITIES: usize = 6;

/// Signs of the watched quantities.
pub(super) type Signs = [f64; QUANTITIES];

/// How the slider touches its guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::study) enum Phase {
    /// It slides; c = −μ sgn(v) sgn(N), zero without friction.
    Sliding { c: f64 },
    /// It sticks.
    Sticking,
}

/// The equation in one phase.
pub(super) struct InPhase<'a> {
    pub equation: &'a Constrained,
    pub phase: Phase,
}

impl InPhase<'_> {
    /// Acceleration (rad/s² of the coordinate), forces of the guide, and power (W) of all that has no potential.
    pub fn state(&self, t: f64, angle: Angle, speed: f64) -> (f64, Touch, f64) {
        let free = self.equation.free(t, angle, speed);
        match self.phase {
            Phase::Sliding { c } => {
                let (acceleration, touch) = free.sliding(c);
                let power = free.power + touch.friction * free.velocity(speed);
                (acceleration, touch, power)
            }
            Phase::Sticking => (0.0, free.holding().unwrap_or_default(), 0.0),
        }
    }
}

impl Motion for InPhase<'_> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        self.state(t, angle, speed).0
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        let (acceleration, _, power) = self.state(t, angle, speed);
        (acceleration, power)
    }

    fn depends_on_time(&self) -> bool {
        self.equation.loads().reads().has(Variable::T)
    }

    fn has_power(&self) -> bool {
        self.equation.friction().is_some() || !self.equation.loads().have_potential()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.equation.loads().next_corner(t)
    }
}

/// What is looked at during a run.
pub(super) struct Quantities<'a> {
    pub equation: &'a Constrained,
    /// The crank angle of the start, and how far the crank may turn, rad.
    pub turning: Option<(Angle, f64)>,
    pub evaluations: Cell<u64>,
}

impl Watched<QUANTITIES> for Quantities<'_> {
    fn values(&self, t: f64, angle: Angle, speed: f64) -> Signs {
        let curve = self.equation.curve();
        let place = curve.place(angle.rest);
        let (normal, clear) = match self.equation.friction() {
            Some(friction) => {
                self.evaluations.set(self.evaluations.get() + 1);
                let free = self.equation.free(t, angle, speed);
                (free.normal, free.clear_of_jam(friction.coefficient))
            }
            None => (1.0, 1.0),
        };
        let turned = self.turning.map_or(1.0, |(start, limit)| {
            limit - curve.crank_angle(angle).minus(start).abs()
        });
        let mut values = [0.0; QUANTITIES];
        values[SPEED] = speed;
        values[DEAD_CENTRE] = place.dx;
        values[LIMIT] = place.rod_cos;
        values[TURNED] = turned;
        values[NORMAL] = normal;
        values[CLEAR] = clear;
        values
    }
}

/// The signs with which motion in `direction` (±1 of the coordinate) begins: where a quantity is zero, that of
/// `ahead`, its value a little further.
pub(super) fn signs(values: Signs, ahead: Signs, direction: f64) -> Signs {
    let mut signs: Signs = std::array::from_fn(|i| {
        let nothing = values[i].abs() <= 1e-9 * ahead[i].abs();
        let value = if nothing { ahead[i] } else { values[i] };
        if value < 0.0 { -1.0 } else { 1.0 }
    });
    signs[SPEED] = direction;
    (signs[TURNED], signs[CLEAR]) = (1.0, 1.0);
    signs
}

/// The phase that goes with signs.
pub(super) fn sliding(friction: Option<Friction>, signs: &Signs) -> Phase {
    let mu = friction.map_or(0.0, |friction| friction.coefficient);
    Phase::Sliding {
        c: -mu * signs[SPEED] * signs[DEAD_CENTRE] * signs[NORMAL],
    }
}
