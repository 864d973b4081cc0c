//! Loads: what a torque on the crank or a force on the slider depends on, and its value.

use std::fmt;
use std::sync::Arc;

use super::{Expression, Table};

/// The quantities a load can depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// time, s
    T,
    /// crank angle, rad, unwrapped
    Theta,
    /// crank speed, rad/s
    Omega,
    /// slider position, m
    X,
    /// slider velocity, m/s
    V,
}

impl Variable {
    /// All of them, in the order of [`Instant`].
    pub const ALL: [Variable; 5] = [Self::T, Self::Theta, Self::Omega, Self::X, Self::V];

    /// Its name in expressions and scene files.
    pub fn name(self) -> &'static str {
        match self {
            Self::T => "t",
            Self::Theta => "theta",
            Self::Omega => "omega",
            Self::X => "x",
            Self::V => "v",
        }
    }

    /// The variable with this name.
    pub fn named(name: &str) -> Option<Variable> {
        Self::ALL.into_iter().find(|v| v.name() == name)
    }
}

/// A set of [`Variable`]s: what a load reads, which is how the plan knows which engine can serve it.
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
    /// Everything.
    pub const ALL: Variables = Variables(31);

    /// The set with one more variable.
    pub fn with(self, variable: Variable) -> Variables {
        Variables(self.0 | 1 << variable as u8)
    }

    /// Union.
    pub const fn or(self, other: Variables) -> Variables {
        Variables(self.0 | other.0)
    }

    /// Whether `variable` is in the set.
    pub fn has(self, variable: Variable) -> bool {
        self.0 & (1 << variable as u8) != 0
    }

    /// Whether nothing of the two sets is common.
    pub const fn disjoint(self, other: Variables) -> bool {
        self.0 & other.0 == 0
    }
}

impl fmt::Display for Variables {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<_> = Variable::ALL
            .into_iter()
            .filter(|v| self.has(*v))
            .map(Variable::name)
            .collect();
        f.write_str(&if names.is_empty() {
            "nothing".to_owned()
        } else {
            names.join(", ")
        })
    }
}

/// The arguments of a load: time and state of the mechanism, SI and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Instant {
    /// time, s
    pub t: f64,
    /// crank angle, rad, unwrapped
    pub theta: f64,
    /// crank speed, rad/s
    pub omega: f64,
    /// slider position, m
    pub x: f64,
    /// slider velocity, m/s
    pub v: f64,
}

impl Instant {
    /// The value of one variable.
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

type LoadFunction = Arc<dyn Fn(&Instant) -> f64 + Send + Sync>;

/// A torque on the crank (N m, counter-clockwise) or a force on the slider (N, along +x).
#[derive(Clone)]
pub enum Load {
    /// Always the same.
    Constant(f64),
    /// −coefficient·omega (N m s/rad) on the crank, −coefficient·v (N s/m) on the slider.
    Viscous(f64),
    /// Torque that falls linearly from `stall` at rest to zero at `no_load_speed`, and on below zero.
    Motor {
        /// N m
        stall: f64,
        /// rad/s, of the sign of `stall`
        no_load_speed: f64,
    },
    /// Force −stiffness·(x − rest).
    Spring {
        /// N/m
        stiffness: f64,
        /// slider position of zero force, m
        rest: f64,
    },
    /// Interpolated values.
    Table(Table),
    /// Gas force (p − ambient)·area towards the crank, pressure from a table.
    Gas {
        /// pressure in Pa over the crank angle
        pressure: Table,
        /// Pa
        ambient: f64,
        /// m²
        area: f64,
        /// −1 on the right branch, +1 on the left: the sign of a force towards the crank.
        towards_crank: f64,
    },
    /// A formula.
    Expression(Expression),
    /// A function of code; what it reads must be said.
    Function {
        /// The variables the function depends on.
        reads: Variables,
        /// The function.
        function: LoadFunction,
    },
}

impl Load {
    /// A load from a closure.
    ///
    /// ```
    /// use slider_crank::scene::{Load, Variables};
    /// let drag = Load::function(Variables::OMEGA, |now| -1e-4 * now.omega * now.omega.abs());
    /// ```
    pub fn function(
        reads: Variables,
        function: impl Fn(&Instant) -> f64 + Send + Sync + 'static,
    ) -> Load {
        Load::Function {
            reads,
            function: Arc::new(function),
        }
    }

    /// The word for it in scene files.
    pub fn kind(&self) -> &'static str {
        match self {
            Load::Constant(_) => "constant",
            Load::Viscous(_) => "viscous",
            Load::Motor { .. } => "motor",
            Load::Spring { .. } => "spring",
            Load::Table(_) => "table",
            Load::Gas { .. } => "gas",
            Load::Expression(_) => "expression",
            Load::Function { .. } => "function",
        }
    }

    /// The variables it depends on, as a torque (`on_slider` false) or as a force.
    pub fn reads(&self, on_slider: bool) -> Variables {
        match self {
            Load::Constant(_) => Variables::NONE,
            Load::Viscous(_) if on_slider => Variables::V,
            Load::Viscous(_) | Load::Motor { .. } => Variables::OMEGA,
            Load::Spring { .. } => Variables::X,
            Load::Table(table) => Variables::NONE.with(table.of()),
            Load::Gas { .. } => Variables::THETA,
            Load::Expression(expression) => expression.reads(),
            Load::Function { reads, .. } => *reads,
        }
    }

    /// The next time after `t` (s) at which the load is not smooth in time; infinite if it is not known.
    pub fn next_corner(&self, t: f64) -> f64 {
        match self {
            Load::Table(table) if table.of() == Variable::T => table.next_row(t),
            _ => f64::INFINITY,
        }
    }

    /// Whether it is zero always; such a load is not modelled at all.
    pub fn is_zero(&self) -> bool {
        match self {
            Load::Constant(value) => *value == 0.0,
            Load::Viscous(coefficient) => *coefficient == 0.0,
            Load::Motor { stall, .. } => *stall == 0.0,
            Load::Spring { stiffness, .. } => *stiffness == 0.0,
            Load::Table(table) => table.is_zero(),
            Load::Gas { area, .. } => *area == 0.0,
            Load::Expression(_) | Load::Function { .. } => false,
        }
    }
}

impl fmt::Debug for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self}")
    }
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Load::Constant(value) => write!(f, "constant {value}"),
            Load::Viscous(c) => write!(f, "viscous, coefficient {c}"),
            Load::Motor {
                stall,
                no_load_speed,
            } => write!(
                f,
                "motor line, stall {stall} N m, no-load speed {no_load_speed} rad/s"
            ),
            Load::Spring { stiffness, rest } => {
                write!(f, "spring, {stiffness} N/m, rest at x = {rest} m")
            }
            Load::Table(table) => write!(f, "{table}"),
            Load::Gas { ambient, area, .. } => {
                write!(
                    f,
                    "gas pressure over theta, area {area} m2, ambient {ambient} Pa"
                )
            }
            Load::Expression(expression) => write!(f, "expression `{expression}`"),
            Load::Function { reads, .. } => write!(f, "function of {reads}"),
        }
    }
}
