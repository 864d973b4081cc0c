//! Reasons for the end of a run before its goal, with values and state, and the messages for them.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::engine::time::MotionState;
use crate::mechanism::Jam;
use crate::scene::{Load, unrounded};

/// End of a run before its goal.
#[derive(Clone, Debug)]
pub struct Stopped {
    /// Reason for the end.
    pub why: Why,
    /// Time (s), crank angle and speed (rad/s) at the end.
    pub at: MotionState,
}

/// Reason for an end before the goal.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Why {
    /// The run reached its limit of evaluations.
    #[error("the work limit of evaluations is reached")]
    WorkLimit,
    /// The steps are too short for the run to reach its end within the work limit.
    #[error(
        "the steps have become so short that the work limit of evaluations would be reached long before the end"
    )]
    WorkLimitAhead,
    /// The crank turns too often for the run to reach its end within the work limit.
    #[error(
        "the crank turns so often that the work limit of evaluations would be reached long before the end"
    )]
    TooManyTurns,
    /// The caller asked the run to stop.
    #[error("interrupted")]
    Interrupted,
    /// The crank does not complete this number of turns within 1e9 s.
    #[error("the crank does not complete {}", counted(*.0))]
    TurnsNeverComplete(f64),
    /// The crank swings periodically and does not complete its turns.
    #[error(
        "the crank swings to and fro and does not complete {}: shown is one period of {period} s",
        counted(*turns)
    )]
    Period {
        /// Number of turns asked for.
        turns: f64,
        /// Period of the swing, s.
        period: f64,
    },
    /// The last turning points led no further than between two angles: the crank does not complete its turns.
    #[error(
        "the crank swings to and fro and does not complete {}: in its last {since} turning points it came no further than between theta = {} rad and {} rad",
        counted(*turns), unrounded(reach[0]), unrounded(reach[1])
    )]
    Caught {
        /// Number of turns asked for.
        turns: f64,
        /// Number of turning points since the last one further out.
        since: u64,
        /// Outermost crank angles, rad.
        reach: [f64; 2],
    },
    /// The crank comes to rest for good before its turns are complete.
    #[error("the crank comes to rest{} and does not complete {}", held(held_by.as_ref()), counted(*turns))]
    AtRest {
        /// Number of turns asked for.
        turns: f64,
        /// Torques that friction holds; none if the crank cannot turn fully.
        held_by: Option<Torques>,
    },
    /// The crank stalled near a balance of its torques.
    #[error(
        "the crank stalled at theta = {} rad, {torques}{}",
        unrounded(*theta),
        turns.map_or_else(String::new, |turns| format!(" and does not complete {}", counted(turns)))
    )]
    Stalled {
        /// Crank angle of the balance, rad.
        theta: f64,
        /// Torques that balance there.
        torques: Torques,
        /// Number of turns asked for, if any.
        turns: Option<f64>,
    },
    /// The crank reaches a limit of its motion, where the rod is normal to the guide.
    #[error("the crank reaches the limit of its motion, where the rod stands normal to the guide")]
    AtLimit,
    /// A crank of prescribed speed reaches a limit of its motion.
    #[error(
        "the crank reaches the limit of its motion: the rod stands normal to the guide there and no constant speed passes it"
    )]
    DrivenToLimit,
    /// Friction locks the guide of a crank of prescribed speed.
    #[error(
        "the guide locks itself from here on, as the coefficient of friction times tan phi reaches 1: no crank torque keeps up the speed"
    )]
    Locked,
    /// A load has no finite value.
    #[error(
        "a load has no finite value at {}{}",
        state(asked), outside(load.as_ref())
    )]
    NoValue {
        /// State of the evaluation.
        asked: MotionState,
        /// Load without a value, if known.
        load: Option<Load>,
    },
    /// The effective inertia vanishes.
    #[error("the effective inertia vanishes")]
    NoInertia,
    /// The effective inertia nearly vanishes.
    #[error("the effective inertia nearly vanishes and the speed grows without bound")]
    NearlyNoInertia,
    /// The effective inertia vanishes at a limit or dead centre on the configuration curve.
    #[error(
        "the effective inertia vanishes at this limit of its motion or dead centre, where the speed has no bound"
    )]
    NoInertiaOnCurve,
    /// A load or the speed is too large for a floating-point number.
    #[error("a load or the crank speed is too large to be computed with")]
    TooLarge,
    /// The steps became too small: the equation is singular or too stiff.
    #[error("the equation is singular or too stiff for this method")]
    Singular,
    /// The slider jams in its guide.
    #[error(
        "the slider jams in its guide: {} acceleration satisfies the equations of rigid bodies, as the coefficient of friction {mu} times |dN/dF| = {kappa} is 1 or more",
        match solutions { Jam::NoSolution => "no", Jam::TwoSolutions => "more than one" }
    )]
    Jam {
        /// No acceleration, or more than one, satisfies the equations.
        solutions: Jam,
        /// Coefficient of friction.
        mu: f64,
        /// |dN/dF| of the guide, dimensionless.
        kappa: f64,
    },
    /// A slider with a loose joint jams.
    #[error(
        "the slider jams: rigid bodies with this coefficient of friction have no acceleration, or two"
    )]
    JamLoose,
    /// The contact is too stiff for steps in double precision.
    #[error("the contact is too stiff for steps in double precision")]
    ContactTooStiff,
    /// No engine gave a reason: a defect of the program.
    #[error("the run ended before its goal and no engine gave a reason, a defect of this program")]
    Untold,
}

impl Why {
    /// Whether the motion is as exact up to the end as any, and ends at a place that it reaches.
    pub(super) fn is_at_a_place(&self) -> bool {
        matches!(self, Why::NoValue { .. } | Why::Jam { .. })
    }

    /// Returns the advice for this reason, if there is any.
    fn cure(&self) -> Option<&'static str> {
        Some(match self {
            Why::WorkLimit => "raise --max-evaluations, shorten the run or loosen the tolerance",
            Why::WorkLimitAhead => {
                "the equation is too stiff for a method in time, or a load jumps back and forth with the speed: give dry friction as kind = \"dry\" or at the guide as [friction], and steep losses less steep, or raise --max-evaluations"
            }
            Why::TooManyTurns => "shorten the run or raise --max-evaluations",
            Why::TurnsNeverComplete(_)
            | Why::Period { .. }
            | Why::Caught { .. }
            | Why::AtRest { .. } => "give a duration instead",
            Why::Stalled { .. } => "give it more torque, or a duration instead",
            Why::AtLimit => "give the rod or the slider a mass, which carries it on",
            Why::NoInertia => "give the crank an inertia",
            Why::NearlyNoInertia => {
                "give the crank an inertia, or use method energy if the loads depend on the position alone"
            }
            Why::NoInertiaOnCurve => "give the rod or the slider a mass, or the crank an inertia",
            _ => return None,
        })
    }
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let why = &self.why;
        write!(f, "{why}: stopped at {}", state(&self.at))?;
        why.cure().map_or(Ok(()), |cure| write!(f, "; {cure}"))
    }
}

/// Ends are equal if their messages are.
impl PartialEq for Stopped {
    fn eq(&self, other: &Stopped) -> bool {
        self.to_string() == other.to_string()
    }
}

impl Serialize for Stopped {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Returns a number of turns in words.
fn counted(turns: f64) -> String {
    let unit = if turns == 1.0 { "turn" } else { "turns" };
    format!("{turns} {unit}")
}

fn state(at: &MotionState) -> String {
    let [t, theta, omega] = [at.t, at.angle.radians(), at.speed].map(unrounded);
    format!("t = {t} s, theta = {theta} rad, omega = {omega} rad/s")
}

fn held(by: Option<&Torques>) -> String {
    by.map_or_else(String::new, |torques| {
        format!(", where friction holds {torques},")
    })
}

fn outside(load: Option<&Load>) -> String {
    load.map_or_else(String::new, |load| {
        let of = match load.table().is_some() {
            true => "beyond its rows",
            false => "outside its domain",
        };
        format!(" ({load}, {of})")
    })
}

/// Driving torque and load that balance, N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torques {
    /// Whether a motor drives the crank.
    pub(super) by_motor: bool,
    pub(super) drive: f64,
    pub(super) load: f64,
}

impl fmt::Display for Torques {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = if self.by_motor { "motor" } else { "crank" };
        let [drive, load] = [self.drive, self.load].map(unrounded);
        write!(f, "{what} torque {drive} N m, load {load} N m")
    }
}
