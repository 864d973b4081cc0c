//! Loads: torques on the crank and forces on the slider, the variables they depend on and their periods.

use std::fmt;
use std::sync::Arc;

use super::{Expression, Instant, Period, Periodicity, Table, Variable, Variables, WhyNot};

type LoadFunction = Arc<dyn Fn(&Instant) -> f64 + Send + Sync>;

/// A torque on the crank (N m, counter-clockwise) or a force on the slider (N, along +x).
#[derive(Clone)]
pub enum Load {
    /// Constant torque, N m, or force, N.
    Constant(f64),
    /// Viscous load −coefficient·omega (coefficient in N m s/rad) on the crank, −coefficient·v (N s/m) on the slider.
    Viscous(f64),
    /// Motor line: torque that falls linearly from `stall` at rest to zero at `no_load_speed`, and on below zero.
    Motor {
        /// Torque at rest, N m
        stall: f64,
        /// Speed of zero torque, rad/s, of the sign of `stall`
        no_load_speed: f64,
    },
    /// Spring force −stiffness·(x − rest).
    Spring {
        /// Stiffness, N/m
        stiffness: f64,
        /// Slider position of zero force, m
        rest: f64,
    },
    /// Values interpolated over one variable.
    Table(Table),
    /// Gas force (p − ambient)·area towards the crank, with the pressure p from a table.
    Gas {
        /// Pressure, Pa, over the crank angle
        pressure: Table,
        /// Ambient pressure, Pa
        ambient: f64,
        /// Piston area, m²
        area: f64,
        /// Sign of a force towards the crank: −1 on the right branch, +1 on the left.
        towards_crank: f64,
    },
    /// Dry friction of a magnitude, N m or N, from another load: opposes the motion of the body it acts on; at rest it
    /// holds while all else stays below the magnitude. A magnitude over omega or v reads |omega| or |v|.
    Dry(Box<Load>),
    /// Formula of time and state. If it is linear in the sign of the speed of the body it acts on, it opposes motion and
    /// holds at rest as [`Load::Dry`] does.
    Expression(Expression),
    /// Closure, with a statement of what it reads.
    Function {
        /// The variables the function depends on.
        reads: Variables,
        /// The closure.
        function: LoadFunction,
        /// Stated period over the crank angle, all other variables being equal; none: a closure that reads the crank
        /// angle is taken not to repeat.
        period: Option<Period>,
        /// Stated finest scales, each a variable and a length in its SI unit or rad.
        scales: Vec<(Variable, f64)>,
    },
}

impl Load {
    /// Creates a load from a closure.
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

    /// Creates a dry load of constant magnitude, N m or N.
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

    /// States the period over the crank angle of a load from a closure. A closure that reads the crank angle and states
    /// no period is taken not to repeat. Other loads know their period and stay as they are.
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

    /// States the finest scale of a load from a closure over a variable, in SI units or rad: no feature of the load is
    /// narrower than `scale`, and no panel and no step of an engine is longer. A closure without a stated scale is
    /// known only at the nodes of panels and steps, which miss a pulse between them. A scale that is not positive
    /// states nothing; other loads are enclosed and need none.
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

    /// Whether the load is a closure that states no finest scale over a variable that it reads.
    pub fn is_only_sampled(&self) -> bool {
        match self {
            Load::Function { reads, scales, .. } => {
                let stated = scales.iter().map(|(of, _)| *of);
                let stated = stated.fold(Variables::NONE, Variables::with);
                stated.or(*reads) != stated
            }
            Load::Dry(magnitude) => magnitude.is_only_sampled(),
            _ => false,
        }
    }

    /// Returns the period of the load over the crank angle, at equal time and crank speed.
    pub fn repeats(&self, on_slider: bool) -> Periodicity {
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
            } => Periodicity::After(*period),
            Load::Function { reads, .. } if reads.has(Variable::Theta) => {
                Periodicity::Never(WhyNot::Unstated)
            }
            _ => Periodicity::Always,
        };
        let of_slider = Variables::X.or(Variables::V);
        of_position.common(match self.reads(on_slider).disjoint(of_slider) {
            true => Periodicity::Always,
            false => Periodicity::After(Period::TURN),
        })
    }

    /// Returns the name of the kind in scene files.
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

    /// Returns the variables the load depends on, as a torque (`on_slider` false) or as a force.
    pub fn reads(&self, on_slider: bool) -> Variables {
        let speed = if on_slider {
            Variables::V
        } else {
            Variables::OMEGA
        };
        match self {
            Load::Constant(_) => Variables::NONE,
            Load::Viscous(_) => speed,
            Load::Motor { .. } => Variables::OMEGA,
            Load::Spring { .. } => Variables::X,
            Load::Table(table) => Variables::NONE.with(table.of()),
            Load::Gas { .. } => Variables::THETA,
            Load::Dry(magnitude) => magnitude.reads(on_slider).or(speed),
            Load::Expression(expression) => expression.reads(),
            Load::Function { reads, .. } => *reads,
        }
    }

    /// Returns the magnitude of a dry load, or the load itself.
    pub(crate) fn magnitude(&self) -> &Load {
        match self {
            Load::Dry(magnitude) => magnitude,
            other => other,
        }
    }

    /// Returns the table of the load, if the load has one.
    pub(crate) fn table(&self) -> Option<&Table> {
        match self {
            Load::Table(table)
            | Load::Gas {
                pressure: table, ..
            } => Some(table),
            Load::Dry(magnitude) => magnitude.table(),
            _ => None,
        }
    }

    /// Whether the load is known to be always zero, which leaves it out of the model.
    pub fn is_zero(&self) -> bool {
        match self {
            Load::Viscous(coefficient) => *coefficient == 0.0,
            Load::Motor { stall, .. } => *stall == 0.0,
            Load::Spring { stiffness, .. } => *stiffness == 0.0,
            Load::Table(table) => table.farthest_from_zero() == 0.0,
            Load::Gas { area, .. } => *area == 0.0,
            Load::Dry(magnitude) => magnitude.is_zero(),
            Load::Constant(_) | Load::Expression(_) => self.fixed() == Some(0.0),
            Load::Function { .. } => false,
        }
    }

    /// Returns the value, N m or N, of a load that depends on no variable; none for other loads.
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
