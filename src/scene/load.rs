//! Loads: what a torque on the crank or a force on the slider depends on, and its value.

use std::fmt;
use std::sync::Arc;

use super::{Expression, Instant, Period, Repeats, Table, Variable, Variables, WhyNot};

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
    /// Dry friction: it opposes the motion of what it acts on with the magnitude that another load gives, N m or N. At rest
    /// it holds as long as all else stays below the magnitude. One over omega or v is over their size.
    Dry(Box<Load>),
    /// A formula.
    Expression(Expression),
    /// A function of code; what it reads must be said.
    Function {
        /// The variables the function depends on.
        reads: Variables,
        /// The function.
        function: LoadFunction,
        /// After how much of a turn it is the same again, as far as it depends on the crank angle; none: it does not
        /// repeat.
        period: Option<Period>,
        /// The finest scales that are stated, each a variable and a length in its SI unit or rad.
        scales: Vec<(Variable, f64)>,
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
            period: None,
            scales: Vec::new(),
        }
    }

    /// A load that opposes motion with a constant magnitude, N m or N.
    ///
    /// ```
    /// use slider_crank::scene::{Crank, Load, Scene};
    /// use slider_crank::simulate::{Options, simulate};
    ///
    /// // 0.5 N m bring 0.02 kg m^2 at 100 rad/s to rest after 4 s.
    /// let brake = Scene::new(0.05, 0.15)
    ///     .crank(Crank { inertia: 0.02, ..Crank::default() })
    ///     .torque(Load::dry(0.5))
    ///     .start(0.0, 100.0)
    ///     .duration(5.0);
    /// let run = simulate(&brake, &Options::default()).unwrap();
    /// let rest = run.summary.events.iter().find(|event| event.kind == "rest").unwrap();
    /// assert!((rest.t_s - 4.0).abs() < 1e-12);
    /// ```
    pub fn dry(magnitude: f64) -> Load {
        Load::Dry(Box::new(Load::Constant(magnitude)))
    }

    /// Says of a load from a closure after how much of a turn it is the same again; a closure that reads the crank angle
    /// and does not say it is not taken to repeat. Other loads know their period.
    ///
    /// ```
    /// use slider_crank::scene::{Load, Period, Variables};
    /// let cam = Load::function(Variables::THETA, |now| 3.0 * (0.5 * now.theta).sin()).with_period(Period::turns(2).unwrap());
    /// ```
    pub fn with_period(mut self, stated: Period) -> Load {
        if let Load::Function { period, .. } = &mut self {
            *period = Some(stated);
        }
        self
    }

    /// States of a load from a closure that nothing it does over a variable is narrower than `scale`, in SI units or rad:
    /// no panel and no step of an engine goes further. A closure that states nothing is known at the nodes of panels and
    /// steps alone, and a pulse between them is not seen. A scale that is not positive states nothing; other loads are
    /// enclosed and need none.
    ///
    /// ```
    /// use slider_crank::scene::{Load, Variable, Variables};
    /// let blow = |t: f64| if (0.5..0.5003).contains(&t) { 2000.0 } else { 0.0 };
    /// let load = Load::function(Variables::T, move |now| blow(now.t)).with_finest_scale(Variable::T, 1e-4);
    /// ```
    pub fn with_finest_scale(mut self, variable: Variable, scale: f64) -> Load {
        if let Load::Function { scales, .. } = &mut self
            && scale > 0.0
        {
            scales.push((variable, scale));
        }
        self
    }

    /// Whether it is a closure that states no finest scale over a variable that it reads.
    pub fn is_only_sampled(&self) -> bool {
        match self {
            Load::Function { reads, scales, .. } => {
                let stated = |variable| scales.iter().any(|(of, _)| *of == variable);
                Variable::ALL
                    .into_iter()
                    .any(|variable| reads.has(variable) && !stated(variable))
            }
            Load::Dry(magnitude) => magnitude.is_only_sampled(),
            _ => false,
        }
    }

    /// Whether it is the same again after some turns of the crank, time and crank speed being the same.
    pub fn repeats(&self, on_slider: bool) -> Repeats {
        let of_position = match self {
            Load::Table(table)
            | Load::Gas {
                pressure: table, ..
            } if table.of() == Variable::Theta => table.repeats(),
            Load::Dry(magnitude) => magnitude.repeats(on_slider),
            Load::Expression(expression) => return expression.repeats(),
            Load::Function {
                period: Some(period),
                ..
            } => Repeats::After(*period),
            Load::Function { reads, .. } if reads.has(Variable::Theta) => {
                Repeats::Never(WhyNot::Unstated)
            }
            _ => Repeats::Always,
        };
        let turns = !self
            .reads(on_slider)
            .disjoint(Variables::X.or(Variables::V));
        of_position.with(if turns {
            Repeats::After(Period::TURN)
        } else {
            Repeats::Always
        })
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
            Load::Dry(_) => "dry",
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
            Load::Dry(magnitude) if on_slider => magnitude.reads(true).or(Variables::V),
            Load::Dry(magnitude) => magnitude.reads(false).or(Variables::OMEGA),
            Load::Expression(expression) => expression.reads(),
            Load::Function { reads, .. } => *reads,
        }
    }

    /// The table it is made of, if it is.
    pub(super) fn table(&self) -> Option<&Table> {
        match self {
            Load::Table(table)
            | Load::Gas {
                pressure: table, ..
            } => Some(table),
            Load::Dry(magnitude) => magnitude.table(),
            _ => None,
        }
    }

    /// Whether its values are those of a table.
    pub fn is_tabulated(&self) -> bool {
        self.table().is_some()
    }

    /// Whether it is zero always; such a load is not modelled at all.
    pub fn is_zero(&self) -> bool {
        match self {
            Load::Constant(value) => *value == 0.0,
            Load::Viscous(coefficient) => *coefficient == 0.0,
            Load::Motor { stall, .. } => *stall == 0.0,
            Load::Spring { stiffness, .. } => *stiffness == 0.0,
            Load::Table(table) => table.largest() == 0.0,
            Load::Gas { area, .. } => *area == 0.0,
            Load::Dry(magnitude) => magnitude.is_zero(),
            Load::Expression(_) => self.fixed() == Some(0.0),
            Load::Function { .. } => false,
        }
    }

    /// The value, N m or N, of a load that depends on nothing.
    pub fn fixed(&self) -> Option<f64> {
        match self {
            Load::Constant(value) => Some(*value),
            Load::Expression(expression) if expression.reads() == Variables::NONE => {
                Some(expression.value(&Instant::default()))
            }
            _ => None,
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
            Load::Dry(magnitude) => write!(f, "opposes motion, magnitude {magnitude}"),
            Load::Expression(expression) => write!(f, "expression `{expression}`"),
            Load::Function { reads, .. } => write!(f, "function of {reads}"),
        }
    }
}
