//! Variables on which loads can depend.

use std::fmt;

use super::unit::Quantity;

named! {
    /// Variable on which a load can depend, in the order of [`Instant`].
    pub enum Variable {
        /// Time, s
        T = "t",
        /// Crank angle, rad, unwrapped
        Theta = "theta",
        /// Crank speed, rad/s
        Omega = "omega",
        /// Slider position, m
        X = "x",
        /// Slider velocity, m/s
        V = "v",
    }
}

impl Variable {
    pub(super) fn quantity(self) -> Quantity {
        use Quantity::{Angle, AngularSpeed, Length, Time, Velocity};
        [Time, Angle, AngularSpeed, Length, Velocity][self as usize]
    }
}

/// Set of the [`Variable`]s that a load reads, from which the plan knows the engines that can serve it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Variables(u8);

impl Variables {
    /// No variable: a constant.
    pub const NONE: Variables = Variables(0);
    /// Time.
    pub const T: Variables = Variables(1);
    /// Crank angle.
    pub const THETA: Variables = Variables(2);
    /// Crank speed.
    pub const OMEGA: Variables = Variables(4);
    /// Slider position.
    pub const X: Variables = Variables(8);
    /// Slider velocity.
    pub const V: Variables = Variables(16);
    /// All variables.
    pub const ALL: Variables = Variables(31);

    /// Returns the set with one more variable.
    pub fn with(self, variable: Variable) -> Variables {
        Variables(self.0 | 1 << variable as u8)
    }

    /// Returns the union.
    pub const fn or(self, other: Variables) -> Variables {
        Variables(self.0 | other.0)
    }

    /// Whether `variable` is in the set.
    pub fn has(self, variable: Variable) -> bool {
        self.0 & (1 << variable as u8) != 0
    }

    /// Whether the two sets have no variable in common.
    pub const fn disjoint(self, other: Variables) -> bool {
        self.0 & other.0 == 0
    }
}

impl fmt::Display for Variables {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let read = Variable::ALL.into_iter().filter(|v| self.has(*v));
        let names: Vec<_> = read.map(Variable::name).collect();
        match names.is_empty() {
            true => f.write_str("nothing"),
            false => f.write_str(&names.join(", ")),
        }
    }
}

/// Arguments of a load: time and state of the mechanism, SI and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant {
    /// Time, s
    pub t: f64,
    /// Crank angle, rad, unwrapped
    pub theta: f64,
    /// Crank speed, rad/s
    pub omega: f64,
    /// Slider position, m
    pub x: f64,
    /// Slider velocity, m/s
    pub v: f64,
}

impl Instant {
    /// Returns the value of one variable.
    pub fn get(&self, variable: Variable) -> f64 {
        match variable {
            Variable::T => self.t,
            Variable::Theta => self.theta,
            Variable::Omega => self.omega,
            Variable::X => self.x,
            Variable::V => self.v,
        }
    }
}
