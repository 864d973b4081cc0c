//! Key figures of a design: reads a named scalar or word from its results.

use std::fmt;
use std::str::FromStr;

use super::Design;
use crate::kinematics::{Diagrams, Kinematics, Located};
use crate::scene::nearest;
use crate::scene::unit::Quantity;
use crate::simulate::{Peaks, SteadyState, Summary};

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
    quantity: Quantity,
    of: Of,
}

/// Function that reads a figure, by the result it needs.
#[derive(Clone, Copy)]
enum Of {
    Turn(fn(&Kinematics) -> FigureValue<'_>),
    Diagrams(fn(&Diagrams) -> FigureValue<'_>),
    Motion(fn(&Summary) -> FigureValue<'_>),
    Peaks(fn(&Peaks) -> FigureValue<'_>),
    Steady(fn(&SteadyState) -> FigureValue<'_>),
    Flywheel(fn(&SteadyState) -> FigureValue<'_>),
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

const fn turn(
    name: &'static str,
    quantity: Quantity,
    of: fn(&Kinematics) -> FigureValue<'_>,
) -> Figure {
    let of = Of::Turn(of);
    Figure { name, quantity, of }
}

const fn diagram(
    name: &'static str,
    quantity: Quantity,
    of: fn(&Diagrams) -> FigureValue<'_>,
) -> Figure {
    let of = Of::Diagrams(of);
    Figure { name, quantity, of }
}

const fn motion(
    name: &'static str,
    quantity: Quantity,
    of: fn(&Summary) -> FigureValue<'_>,
) -> Figure {
    let of = Of::Motion(of);
    Figure { name, quantity, of }
}

const fn peak(name: &'static str, of: fn(&Peaks) -> FigureValue<'_>) -> Figure {
    Figure {
        name,
        quantity: Quantity::Force,
        of: Of::Peaks(of),
    }
}

const fn steady(
    name: &'static str,
    quantity: Quantity,
    of: fn(&SteadyState) -> FigureValue<'_>,
) -> Figure {
    let of = Of::Steady(of);
    Figure { name, quantity, of }
}

fn some(value: Option<f64>) -> FigureValue<'static> {
    value.map_or(FigureValue::Empty, FigureValue::Number)
}

/// Velocity or acceleration of the slider; empty if the scene has no speed to scale it.
fn at_speed(turn: &Kinematics, located: Option<Located>) -> FigureValue<'static> {
    let moves = turn.speed_rad_per_s.is_some();
    some(located.filter(|_| moves).map(|located| located.value))
}

impl Figure {
    /// All figures, in the order of the columns.
    pub const ALL: &[Figure] = {
        use FigureValue::{Number, Word};
        use Quantity::{
            Acceleration, Angle, AngularSpeed, Energy, Inertia, Length, Power, Pressure, Time,
            Torque, Velocity,
        };
        const NONE: Quantity = Quantity::Number;
        &[
            turn("class", NONE, |turn| Word(turn.class)),
            turn("stroke", Length, |turn| Number(turn.stroke_m)),
            turn("advance", Angle, |turn| some(turn.advance_rad)),
            turn("return", Angle, |turn| some(turn.return_rad)),
            turn("time_ratio", NONE, |turn| some(turn.time_ratio)),
            turn("transmission_min", Angle, |turn| {
                Number(turn.transmission_min_rad)
            }),
            turn("velocity_max", Velocity, |turn| {
                at_speed(turn, turn.velocity_max)
            }),
            turn("velocity_min", Velocity, |turn| {
                at_speed(turn, turn.velocity_min)
            }),
            turn("acceleration_max", Acceleration, |turn| {
                at_speed(turn, turn.acceleration_max)
            }),
            turn("acceleration_min", Acceleration, |turn| {
                at_speed(turn, turn.acceleration_min)
            }),
            diagram("indicated_work", Energy, |cycle| {
                some(cycle.indicated.as_ref().map(|gas| gas.work_j))
            }),
            diagram("mean_effective_pressure", Pressure, |cycle| {
                let gas = cycle.indicated.as_ref();
                some(gas.map(|gas| gas.mean_effective_pressure_pa))
            }),
            diagram("turning_moment_mean", Torque, |cycle| {
                Number(cycle.turning_moment.mean_nm)
            }),
            diagram("turning_moment_fluctuation", Energy, |cycle| {
                Number(cycle.turning_moment.fluctuation_j)
            }),
            motion("engine", NONE, |run| Word(&run.engine)),
            motion("t", Time, |run| Number(run.last.t_s)),
            motion("theta", Angle, |run| Number(run.last.theta_rad)),
            motion("omega", AngularSpeed, |run| {
                Number(run.last.omega_rad_per_s)
            }),
            motion("error_theta", Angle, |run| {
                some(run.error_estimate.map(|error| error.theta_rad))
            }),
            motion("error_omega", AngularSpeed, |run| {
                some(run.error_estimate.map(|error| error.omega_rad_per_s))
            }),
            motion("revolutions", NONE, |run| Number(run.revolutions)),
            motion("omega_min", AngularSpeed, |run| Number(run.omega_min)),
            motion("omega_max", AngularSpeed, |run| Number(run.omega_max)),
            motion("driving_torque_min", Torque, |run| {
                some(run.driving_torque.map(|torque| torque.min_nm))
            }),
            motion("driving_torque_max", Torque, |run| {
                some(run.driving_torque.map(|torque| torque.max_nm))
            }),
            motion("driving_torque_mean", Torque, |run| {
                some(run.driving_torque.map(|torque| torque.mean_nm))
            }),
            motion("energy_residual", NONE, |run| Number(run.energy_residual)),
            motion("evaluations", NONE, |run| Number(run.evaluations as f64)),
            motion("events", NONE, |run| Number(run.events_total as f64)),
            peak("crank_bearing_peak", |peaks| {
                Number(peaks.crank_bearing.value_n)
            }),
            peak("crank_pin_peak", |peaks| Number(peaks.crank_pin.value_n)),
            peak("wrist_pin_peak", |peaks| Number(peaks.wrist_pin.value_n)),
            peak("guide_peak", |peaks| Number(peaks.guide.value_n)),
            peak("shaking_peak", |peaks| Number(peaks.shaking.value_n)),
            steady("cycle_turns", NONE, |steady| {
                Number(f64::from(steady.cycle_turns))
            }),
            steady("steady_omega_mean", AngularSpeed, |steady| {
                Number(steady.omega_mean_rad_per_s.value)
            }),
            steady("steady_omega_min", AngularSpeed, |steady| {
                Number(steady.slowest.omega_rad_per_s.value)
            }),
            steady("steady_omega_max", AngularSpeed, |steady| {
                Number(steady.fastest.omega_rad_per_s.value)
            }),
            steady("fluctuation", NONE, |steady| {
                Number(steady.fluctuation.value)
            }),
            steady("error_fluctuation", NONE, |steady| {
                Number(steady.fluctuation.error)
            }),
            steady("steady_power_in", Power, |steady| {
                Number(steady.power_in_w.value)
            }),
            Figure {
                name: "flywheel_added_inertia",
                quantity: Inertia,
                of: Of::Flywheel(|steady| {
                    let wheel = steady.flywheel.as_ref();
                    some(wheel.map(|wheel| wheel.added_inertia_kg_m2.value))
                }),
            },
        ]
    };

    /// Returns the physical quantity.
    pub fn quantity(&self) -> Quantity {
        self.quantity
    }

    /// Returns the computation that the figure needs.
    pub fn source(&self) -> Source {
        match self.of {
            Of::Turn(_) => Source::Turn,
            Of::Diagrams(_) => Source::Diagrams,
            Of::Motion(_) => Source::Motion,
            Of::Peaks(_) => Source::Peaks,
            Of::Steady(_) => Source::Steady,
            Of::Flywheel(_) => Source::Flywheel,
        }
    }

    /// Returns the value for a design.
    pub fn cell<'a>(&self, design: &'a Design) -> FigureValue<'a> {
        let motion = design.motion.as_ref();
        let cell = match self.of {
            Of::Turn(cell) => design.kinematics.as_ref().map(cell),
            Of::Diagrams(cell) => design.diagrams.as_ref().map(cell),
            Of::Motion(cell) => motion.map(cell),
            Of::Peaks(cell) => motion.and_then(|run| run.peaks.as_ref()).map(cell),
            Of::Steady(cell) | Of::Flywheel(cell) => design.steady.as_ref().map(cell),
        };
        cell.unwrap_or(FigureValue::Empty)
    }

    /// Returns the number for a design, in SI units and radians; none for a word or an absent value.
    pub fn number(&self, design: &Design) -> Option<f64> {
        match self.cell(design) {
            FigureValue::Number(number) => Some(number),
            FigureValue::Word(_) | FigureValue::Empty => None,
        }
    }
}

/// Writes the name of the column, with the SI unit.
impl fmt::Display for Figure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)?;
        match self.quantity.column() {
            unit if unit.is_empty() => Ok(()),
            unit => write!(f, "_{unit}"),
        }
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
            let names = || Figure::ALL.iter().map(|figure| figure.name);
            match nearest(text, names()) {
                Some(near) => format!("`{text}` is no key figure; did you mean `{near}`?"),
                None => {
                    let known: Vec<&str> = names().collect();
                    format!("`{text}` is no key figure; there are {}", known.join(", "))
                }
            }
        })
    }
}
