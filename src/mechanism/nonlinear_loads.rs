//! Values of nonlinear loads at an instant, one by one and summed as crank torque and slider force.

use crate::scene::{Instant, Load, Variable};

/// Torque on the crank and force on the slider at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadValue {
    /// Torque, N m, counter-clockwise
    pub torque: f64,
    /// Force, N, along +x
    pub force: f64,
}

impl LoadValue {
    pub(super) fn on(&mut self, slider: bool) -> &mut f64 {
        if slider {
            &mut self.force
        } else {
            &mut self.torque
        }
    }

    /// Whether both are finite.
    pub fn is_finite(&self) -> bool {
        self.torque.is_finite() && self.force.is_finite()
    }

    /// Returns the generalized force Q = τ + F x', N m, where x' is `dx`, m/rad.
    pub fn generalized(&self, dx: f64) -> f64 {
        self.torque + self.force * dx
    }

    /// Returns the sum of both values.
    pub fn plus(self, other: LoadValue) -> LoadValue {
        LoadValue {
            torque: self.torque + other.torque,
            force: self.force + other.force,
        }
    }
}

/// Loads that are evaluated when asked for, each on the crank or on the slider.
#[derive(Clone, Debug, Default)]
pub(super) struct NonlinearLoads(pub(super) Vec<(Load, bool)>);

impl NonlinearLoads {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether a load acts on the slider (`slider` true) or on the crank (false).
    pub fn are_on(&self, slider: bool) -> bool {
        self.0.iter().any(|(_, on_slider)| *on_slider == slider)
    }

    /// Returns the sums at some instants: each formula is interpreted once for all of them.
    fn values<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        let mut sums = [LoadValue::default(); N];
        for (load, on_slider) in &self.0 {
            let values = match load {
                Load::Expression(expression) => expression.values(now),
                _ => std::array::from_fn(|i| single(load, *on_slider, &now[i])),
            };
            for (sum, value) in sums.iter_mut().zip(&values) {
                *sum.on(*on_slider) += value;
            }
        }
        sums
    }

    /// Returns the sums of several lists at some instants.
    #[inline]
    pub fn sums<const N: usize, const M: usize>(
        lists: [&NonlinearLoads; M],
        now: &[Instant; N],
    ) -> [LoadValue; N] {
        let mut sums = [LoadValue::default(); N];
        for loads in lists.into_iter().filter(|loads| !loads.is_empty()) {
            for (sum, value) in sums.iter_mut().zip(&loads.values(now)) {
                *sum = sum.plus(*value);
            }
        }
        sums
    }

    /// Returns the first load without a finite value.
    pub fn without_value(&self, now: &Instant) -> Option<&Load> {
        let mut loads = self.0.iter();
        let (load, _) =
            loads.find(|(load, on_slider)| !single(load, *on_slider, now).is_finite())?;
        Some(load)
    }

    /// Returns the sums of the magnitudes of loads that oppose motion, N m and N.
    pub fn magnitude(&self, now: &Instant) -> LoadValue {
        let mut sums = LoadValue::default();
        for (load, on_slider) in &self.0 {
            *sums.on(*on_slider) += single_magnitude(load, *on_slider, now);
        }
        sums
    }

    pub fn loads(&self) -> impl Iterator<Item = &Load> {
        self.0.iter().map(|(load, _)| load)
    }
}

/// Returns the magnitude of a load that opposes motion, N m or N; a table is read at the size of the speed.
pub(super) fn single_magnitude(load: &Load, on_slider: bool, now: &Instant) -> f64 {
    let now = match load.magnitude() {
        Load::Table(_) => Instant {
            omega: now.omega.abs(),
            v: now.v.abs(),
            ..*now
        },
        _ => *now,
    };
    single(load.magnitude(), on_slider, &now)
}

/// Returns the value of one load, as a torque (N m) or as a force on the slider (N).
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

/// Signs of the speeds of crank and slider that dry loads oppose; zero at rest.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sense {
    /// sgn(ω)
    pub crank: f64,
    /// sgn(v)
    pub slider: f64,
}

impl Sense {
    /// Returns the senses of a crank speed (rad/s) and a slider velocity (m/s).
    pub fn of(omega: f64, v: f64) -> Sense {
        Sense {
            crank: sign(omega),
            slider: sign(v),
        }
    }
}

/// Returns the sign of a value, zero at zero.
pub(super) fn sign(value: f64) -> f64 {
    if value == 0.0 { 0.0 } else { value.signum() }
}
