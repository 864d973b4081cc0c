//! Key figures of a design: reads a named scalar or word from its results.

use std::fmt;
use std::str::FromStr;

use super::Design;
use crate::kinematics::{Kinematics, Located};
use crate::scene::did_you_mean;
use crate::scene::unit::Quantity;
use FigureValue::{Empty, Number, Word};

/// Key figure of a design, parsed from its name with or without the unit.
///
/// ```
/// use slider_crank::sweep::Figure;
/// let figure: Figure = "transmission_min".parse().unwrap();
/// assert_eq!(figure.to_string(), "transmission_min_rad");
/// assert!("transmision_min".parse::<Figure>().is_err());
/// ```
#[derive(Clone, Copy)]
pub struct Figure {
    name: &'static str,
    /// Physical quantity.
    pub quantity: Quantity,
    /// Computation that the figure needs.
    pub source: Source,
    /// Reads the figure from its result; none for a design without that result.
    read: fn(&Design) -> Option<FigureValue<'_>>,
}

/// Value of a figure for one design.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FigureValue<'a> {
    /// Number in SI units and radians.
    Number(f64),
    /// Word, for a class or an engine.
    Word(&'a str),
    /// Absent from this design.
    Empty,
}

/// Computation from which a figure is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// One turn in closed form, at the start speed of the scene.
    Turn,
    /// Diagrams of a cycle, at the start speed of the scene.
    Diagrams,
    /// Forward motion.
    Motion,
    /// Largest joint forces of the motion.
    Peaks,
    /// Periodic steady state.
    Steady,
    /// Flywheel for a coefficient of fluctuation of the steady state.
    Flywheel,
}

/// Table of figures: name, quantity and value, grouped by the result of a design from which they are read.
macro_rules! figures {
    ($($source:ident: |$design:ident| $of:expr, |$result:ident| {
        $($name:literal: $quantity:ident = $value:expr;)*
    })*) => {
        &[$($(Figure {
            name: $name,
            quantity: Quantity::$quantity,
            source: Source::$source,
            read: |$design| $of.map(|$result| $value),
        },)*)*]
    };
}

fn some(value: Option<f64>) -> FigureValue<'static> {
    value.map_or(Empty, Number)
}

/// Velocity or acceleration of the slider; empty if the scene has no speed to scale it.
fn at_speed(turn: &Kinematics, located: Option<Located>) -> FigureValue<'static> {
    let moves = turn.speed_rad_per_s.is_some();
    some(located.filter(|_| moves).map(|located| located.value))
}

impl Figure {
    /// All figures, in the order of the columns.
    pub const ALL: &[Figure] = figures! {
        Turn: |design| design.kinematics.as_deref(), |turn| {
            "class": Number = Word(turn.class);
            "stroke": Length = Number(turn.stroke_m);
            "advance": Angle = some(turn.advance_rad);
            "return": Angle = some(turn.return_rad);
            "time_ratio": Number = some(turn.time_ratio);
            "transmission_min": Angle = Number(turn.transmission_min_rad);
            "velocity_max": Velocity = at_speed(turn, turn.velocity_max);
            "velocity_min": Velocity = at_speed(turn, turn.velocity_min);
            "acceleration_max": Acceleration = at_speed(turn, turn.acceleration_max);
            "acceleration_min": Acceleration = at_speed(turn, turn.acceleration_min);
        }
        Diagrams: |design| design.diagrams.as_ref(), |cycle| {
            "indicated_work": Energy = some(cycle.indicated.as_ref().map(|gas| gas.work_j));
            "mean_effective_pressure": Pressure = {
                let gas = cycle.indicated.as_ref();
                some(gas.map(|gas| gas.mean_effective_pressure_pa))
            };
            "turning_moment_mean": Torque = Number(cycle.turning_moment.mean_nm);
            "turning_moment_fluctuation": Energy = Number(cycle.turning_moment.fluctuation_j);
        }
        Motion: |design| design.motion.as_ref(), |run| {
            "engine": Number = Word(&run.engine);
            "t": Time = Number(run.last.t_s);
            "theta": Angle = Number(run.last.theta_rad);
            "omega": AngularSpeed = Number(run.last.omega_rad_per_s);
            "error_theta": Angle = some(run.error_estimate.map(|error| error.theta_rad));
            "error_omega": AngularSpeed = some(run.error_estimate.map(|error| error.omega_rad_per_s));
            "revolutions": Number = Number(run.revolutions);
            "omega_min": AngularSpeed = Number(run.omega_min);
            "omega_max": AngularSpeed = Number(run.omega_max);
            "driving_torque_min": Torque = some(run.driving_torque.map(|torque| torque.min_nm));
            "driving_torque_max": Torque = some(run.driving_torque.map(|torque| torque.max_nm));
            "driving_torque_mean": Torque = some(run.driving_torque.map(|torque| torque.mean_nm));
            "energy_residual": Number = Number(run.energy_residual);
            "evaluations": Number = Number(run.evaluations as f64);
            "events": Number = Number(run.events_total as f64);
        }
        Peaks: |design| design.motion.as_ref().and_then(|run| run.peaks.as_ref()), |peaks| {
            "crank_bearing_peak": Force = Number(peaks.crank_bearing.value_n);
            "crank_pin_peak": Force = Number(peaks.crank_pin.value_n);
            "wrist_pin_peak": Force = Number(peaks.wrist_pin.value_n);
            "guide_peak": Force = Number(peaks.guide.value_n);
            "shaking_peak": Force = Number(peaks.shaking.value_n);
        }
        Steady: |design| design.steady.as_ref(), |steady| {
            "cycle_turns": Number = Number(f64::from(steady.cycle_turns));
            "steady_omega_mean": AngularSpeed = Number(steady.omega_mean_rad_per_s.value);
            "steady_omega_min": AngularSpeed = Number(steady.omegas()[0]);
            "steady_omega_max": AngularSpeed = Number(steady.omegas()[1]);
            "fluctuation": Number = Number(steady.fluctuation.value);
            "error_fluctuation": Number = Number(steady.fluctuation.error);
            "steady_power_in": Power = Number(steady.power_in_w.value);
        }
        Flywheel: |design| design.steady.as_ref(), |steady| {
            "flywheel_added_inertia": Inertia = {
                let wheel = steady.flywheel.as_ref();
                some(wheel.map(|wheel| wheel.added_inertia_kg_m2.value))
            };
        }
    };

    /// Parses the name of a figure that is a number, as a goal and a limit take it.
    ///
    /// # Errors
    /// The message for a name that is no figure, or one of a word.
    pub fn of_number(text: &str) -> Result<Figure, String> {
        let figure: Figure = text.parse()?;
        match figure.name {
            name @ ("class" | "engine") => Err(format!(
                "`{name}` is a word: name a key figure that is a number, like `stroke`"
            )),
            _ => Ok(figure),
        }
    }

    /// Returns the value for a design.
    pub fn value<'a>(&self, design: &'a Design) -> FigureValue<'a> {
        (self.read)(design).unwrap_or(Empty)
    }

    /// Returns the number for a design, in SI units and radians; none for a word or an absent value.
    pub fn number(&self, design: &Design) -> Option<f64> {
        match self.value(design) {
            Number(number) => Some(number),
            Word(_) | Empty => None,
        }
    }
}

/// Writes the name of the column, with the SI unit.
impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.quantity.column(self.name))
    }
}

/// Compares figures by name.
impl PartialEq for Figure {
    fn eq(&self, other: &Figure) -> bool {
        self.name == other.name
    }
}

impl fmt::Debug for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Figure {
    type Err = String;

    fn from_str(text: &str) -> Result<Figure, String> {
        let text = text.trim();
        let named = |figure: &&Figure| figure.name == text || figure.to_string() == text;
        Figure::ALL.iter().find(named).copied().ok_or_else(|| {
            let known = Figure::ALL.iter().map(|figure| figure.name);
            let help = did_you_mean(text, "a design", known);
            format!("`{text}` is no key figure; {help}")
        })
    }
}
