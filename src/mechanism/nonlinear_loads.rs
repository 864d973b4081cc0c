//! Values of loads, one by one and together.

use super::Pose;
use crate::scene::{Instant, Load, Variable};

/// Torque on the crank and force on the slider at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadValue {
    /// N m, counter-clockwise
    pub torque: f64,
    /// N, along +x
    pub force: f64,
}

impl LoadValue {
    /// Whether both are finite.
    pub fn is_finite(&self) -> bool {
        self.torque.is_finite() && self.force.is_finite()
    }

    /// The generalized force Q = τ + F x', N m.
    pub fn generalized(&self, pose: &Pose) -> f64 {
        self.over(pose.dx)
    }

    /// Generalized force where x' is `dx`, m/rad.
    pub fn over(&self, dx: f64) -> f64 {
        self.torque + self.force * dx
    }

    /// The sum of both.
    pub fn plus(self, other: LoadValue) -> LoadValue {
        LoadValue {
            torque: self.torque + other.torque,
            force: self.force + other.force,
        }
    }
}

/// Loads that are called.
#[derive(Clone, Debug, Default)]
pub(super) struct NonlinearLoads {
    pub torques: Vec<Load>,
    pub forces: Vec<Load>,
}

impl NonlinearLoads {
    pub fn is_empty(&self) -> bool {
        self.torques.is_empty() && self.forces.is_empty()
    }

    pub fn value(&self, now: &Instant) -> LoadValue {
        self.values(&[*now])[0]
    }

    /// Values at some instants: formulas are read once for all of them.
    pub fn values<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        let mut sums = [LoadValue::default(); N];
        let mut values = [0.0; N];
        for (loads, on_slider) in [(&self.torques, false), (&self.forces, true)] {
            for load in loads {
                if let Load::Expression(expression) = load {
                    values = expression.values(now);
                } else {
                    for (value, now) in values.iter_mut().zip(now) {
                        *value = single(load, on_slider, now);
                    }
                }
                for (sum, value) in sums.iter_mut().zip(&values) {
                    let sum = if on_slider {
                        &mut sum.force
                    } else {
                        &mut sum.torque
                    };
                    *sum += value;
                }
            }
        }
        sums
    }

    fn sum(&self, value: impl Fn(&Load, bool) -> f64) -> LoadValue {
        let sum = |loads: &[Load], on_slider| loads.iter().map(|load| value(load, on_slider)).sum();
        LoadValue {
            torque: sum(&self.torques, false),
            force: sum(&self.forces, true),
        }
    }

    /// The first without a finite value.
    pub fn without_value(&self, now: &Instant) -> Option<&Load> {
        let has_none = |load: &&Load, on_slider| !single(load, on_slider, now).is_finite();
        let mut torques = self.torques.iter();
        let torque = torques.find(|load| has_none(load, false));
        torque.or_else(|| self.forces.iter().find(|load| has_none(load, true)))
    }

    /// The sums of the magnitudes of loads that oppose motion, N m and N.
    pub fn magnitude(&self, now: &Instant) -> LoadValue {
        self.sum(|load, on_slider| single_magnitude(load, on_slider, now))
    }

    pub fn loads(&self) -> impl Iterator<Item = &Load> {
        self.torques.iter().chain(&self.forces)
    }
}

/// Magnitude of a load that opposes motion, N m or N, which depends on the size of the speed.
pub(super) fn single_magnitude(load: &Load, on_slider: bool, now: &Instant) -> f64 {
    let now = Instant {
        omega: now.omega.abs(),
        v: now.v.abs(),
        ..*now
    };
    let magnitude = if let Load::Dry(magnitude) = load {
        magnitude
    } else {
        load
    };
    single(magnitude, on_slider, &now)
}

/// Value of one load, as a torque (N m) or as a force on the slider (N).
pub fn single(load: &Load, on_slider: bool, now: &Instant) -> f64 {
    match load {
        Load::Constant(value) => *value,
        Load::Viscous(coefficient) if on_slider => -coefficient * now.v,
        Load::Viscous(coefficient) => -coefficient * now.omega,
        Load::Motor {
            stall,
            no_load_speed,
        } => stall * (1.0 - now.omega / no_load_speed),
        Load::Spring { stiffness, rest } => -stiffness * (now.x - rest),
        Load::Table(table) => table.value(now.get(table.of())),
        Load::Gas {
            pressure,
            ambient,
            area,
            towards_crank,
        } => towards_crank * (pressure.value(now.get(Variable::Theta)) - ambient) * area,
        Load::Dry(magnitude) => {
            let speed = if on_slider { now.v } else { now.omega };
            match speed {
                0.0 => 0.0,
                speed => -speed.signum() * single_magnitude(magnitude, on_slider, now),
            }
        }
        Load::Expression(expression) => expression.value(now),
        Load::Function { function, .. } => function(now),
    }
}
