//! The angle engine: crank angle as the independent variable, for loads that depend on speed and time too,
//! as long as the speed keeps its sign.
//!
//! On each panel of Chebyshev points the kinetic energy and the time are found together by collocation,
//! K' = F(θ) + L(θ, ω, t), t' = 1/ω, with sweeps that start from the profile of the turns before and with
//! Newton's method where the loads are steep in the speed. What depends on the position alone is tabulated
//! once for a cycle, the turns after which the loads are the same again, and used in every one. Where time does not
//! occur, a cycle maps the kinetic energy at its start to that at its end: long runs iterate an interpolant of this map.
//!
//! The forces may have two forms, one on each side of a zero of a function of the state, the switch. A panel ends
//! there, and what is left of it is solved with the other form.

mod errors;
mod fixed_point;
mod forces;
mod guide;
mod panel;
mod poincare_map;
mod predictor;
mod refine;
mod seen;
mod stepper;
mod sweep;
mod swept;
mod switch;
mod table;
mod turn;
mod undamped;

use std::cell::RefCell;
use std::f64::consts::TAU;

use super::WorkLimit;
use super::energy::piece::SAME_ANGLE;
use super::energy::segment::{MOST_PANELS, Segment};
use super::energy::{NotApplicable, Orbit};
use super::time::{FAR, Start};
use super::work_forecast::{Ends, WorkForecast};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;
use crate::numeric::enclosure::{Detail, Reach};
pub use errors::Errors;
pub use fixed_point::{CycleMap, FixedPoint, NoCycle, fixed_point};
pub use guide::Guide;
pub use panel::Panels;
use stepper::{Done, PanelStepper};
use swept::Spent;
pub use table::{Switch, Table};

/// A state of the crank at a position of a table.
#[derive(Clone, Copy)]
pub struct State<'a, P> {
    pub place: &'a P,
    /// s
    pub t: f64,
    pub angle: Angle,
    /// rad/s
    pub speed: f64,
}

/// What the engine needs of a mechanism.
pub trait Driven {
    /// What the loads need to know of a position.
    type Place: Copy;

    /// Fills a table at the first `count` of some angles, rad, beside these whole turns, where the switch has the sign
    /// `side`, ±1.
    fn tabulate(
        &self,
        turns: f64,
        angles: (&Values, usize),
        side: f64,
        table: &mut Table<Self::Place>,
    );

    /// Where the panels of a run are left for the next one from the same angle; none where each run stands alone.
    fn shared(&self) -> Option<&RefCell<Panels<Self::Place>>>;

    /// How many positions were tabulated so far.
    fn positions(&self) -> u64;

    /// Whole turns after which everything that depends on the angle is the same again.
    fn cycle(&self) -> u32;

    /// Whether there are loads beside those of the table.
    fn is_driven(&self) -> bool;

    /// Whether these depend on time.
    fn reads_time(&self) -> bool;

    /// Their generalized force, N m, in some states.
    fn drive<const N: usize>(&self, at: &[State<'_, Self::Place>; N]) -> [f64; N];

    /// Whether they may do something between the points of a panel that the decay of their series does not tell.
    fn has_detail(&self) -> bool;

    /// What their generalized force (N m) does on a piece of the motion, and in a Bernstein ellipse of this size around it.
    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail;

    /// Their part of the switch.
    fn drive_switch(&self, at: &State<'_, Self::Place>) -> f64;

    /// Angles of a cycle from zero on, in rising order, at which panels end.
    fn corners(&self) -> &[f64];

    /// Corners and other angles, at which panels end too where the inertia nearly vanishes there: longer ones would not be
    /// resolved.
    fn corners_if_light(&self) -> &[f64];
}

/// Where a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// This long after its start, s.
    Time(f64),
    /// When the crank has turned by this, rad, in its direction.
    Turned(f64),
}

/// A run, to its goal or to where the angle cannot be the independent variable any more.
pub struct Driving {
    /// Motion, whose own time begins at 0.
    pub orbit: Orbit,
    /// Last time, s.
    pub end: f64,
    /// Work of the loads without a potential until its end, J.
    pub work: f64,
    /// What rounding does to it.
    pub errors: Errors,
    /// How often the loads were evaluated.
    pub evaluations: u64,
    /// What kept it from its goal.
    pub short: Option<Short>,
}

impl Driving {
    /// A whole motion until a time (s), which needed no loads of state or time.
    pub fn whole(orbit: Orbit, end: f64, work: f64) -> Driving {
        Driving {
            orbit,
            end,
            work,
            errors: Errors::at(0.0, 0.0),
            evaluations: 0,
            short: None,
        }
    }
}

/// Where a run ended before its goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Short {
    /// Why it did.
    pub why: NotApplicable,
    /// The angle there.
    pub angle: Angle,
    /// Kinetic energy there, J.
    pub kinetic: f64,
}

/// How fine the panels are.
#[derive(Clone, Copy, Debug)]
pub struct Resolution<'a> {
    /// Series end where their coefficients have decayed to this.
    pub tail: f64,
    /// Panels are cut unevenly once more from the start, which makes another discretization to compare with.
    pub other: bool,
    /// The run that is compared, if it is known.
    pub guide: Option<Guide<'a>>,
    /// On evaluations of the loads and positions in tables.
    pub limit: WorkLimit<'a>,
}

/// Turns that are run through one by one before the map of a cycle takes over, and where it ends; turns between those whose
/// starts are kept.
const FEW_TURNS: f64 = 48.0;

/// Runs from a start until the goal is reached, or until the angle cannot be the independent variable any more.
///
/// # Errors
/// [`NotApplicable`] where it cannot be that from the start.
pub fn run<D: Driven>(
    driven: &D,
    from: Start,
    goal: Goal,
    resolution: Resolution<'_>,
) -> Result<Driving, NotApplicable> {
    let (start, speed) = (from.angle.reduced(), from.speed);
    let mut march = PanelStepper::new(driven, start, speed, resolution)?;
    march.begin = from.t;
    if from.t == 0.0 && start.turns == 0.0 {
        // An angle that is given, and not reduced, is not rounded.
        march.errors = Errors::at(march.kinetic, 0.0);
    }
    march.gives_up = true;
    let reads_time = driven.is_driven() && driven.reads_time();
    let repeats = !reads_time && march.stations[0].table.switch.is_none();
    let mut forecast = forecast(&march, goal, reads_time);
    let way = f64::from(driven.cycle()) * TAU;
    let mut leg = Segment::open();
    loop {
        let spent = march.spent();
        let done = march.at_cycle() && leg.len() > 0;
        if done && forecast.is_hopeless(spent, march.t.0, way).is_some() {
            let why = NotApplicable::TooManyTurns;
            return Ok(ended(march, leg, (start, speed), why));
        }
        if repeats && march.at_cycle() && march.turns.abs() >= FEW_TURNS {
            return poincare_map::run(march, leg, start, speed, goal, resolution);
        }
        let next = if leg.len() < MOST_PANELS {
            march.panel()
        } else {
            Err(NotApplicable::TooLong)
        };
        let Done { panel, spent, work } = match next {
            Ok(done) => done,
            Err(why) if leg.len() == 0 => return Err(why),
            Err(why) => return Ok(ended(march, leg, (start, speed), why)),
        };
        let turned = (panel.piece.to - start.rest).abs() + panel.turns.abs() * TAU;
        leg.push(panel);
        let passed = match goal {
            Goal::Time(until) => leg.duration.0 > until,
            Goal::Turned(way) => turned >= way - SAME_ANGLE,
        };
        if passed {
            let orbit = Orbit::one_way(start, speed, leg);
            let end = match goal {
                Goal::Time(until) => until,
                Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            };
            let work = march.work - work + work_until(orbit.last_leg(), end, &spent);
            march.leave_panels();
            return Ok(Driving {
                orbit,
                end,
                work,
                errors: march.errors,
                evaluations: march.evaluations,
                short: None,
            });
        }
    }
}

/// What tells whether a run whose turns are run through one by one will reach its goal.
fn forecast<'a, D: Driven>(
    march: &PanelStepper<'a, D>,
    goal: Goal,
    reads_time: bool,
) -> WorkForecast<'a> {
    let (t, way) = match goal {
        Goal::Time(until) => (until, f64::INFINITY),
        Goal::Turned(way) => (FAR, way),
    };
    let ends = Ends {
        t,
        way,
        limit: march.limit,
    };
    WorkForecast::new(0.0, march.spent(), ends, reads_time)
}

/// A run that ended before its goal, from an angle with a speed (rad/s).
fn ended<D: Driven>(
    mut march: PanelStepper<'_, D>,
    leg: Segment,
    (start, speed): (Angle, f64),
    why: NotApplicable,
) -> Driving {
    march.leave_panels();
    Driving {
        short: leg.last_angle(start.turns).map(|angle| Short {
            why,
            angle,
            kinetic: march.kinetic,
        }),
        end: leg.duration.0,
        orbit: Orbit::one_way(start, speed, leg),
        work: march.work,
        errors: march.errors,
        evaluations: march.evaluations,
    }
}

/// Work from the begin of the last panel until a time in it.
fn work_until(leg: &Segment, until: f64, spent: &Spent) -> f64 {
    let Some((panel, since)) = leg.panel_at(until) else {
        return 0.0;
    };
    spent.work(panel.rule, panel.piece.span(), panel.position(since))
}
