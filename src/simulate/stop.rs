//! Why a run ends before its goal: a reason with its values and the state, and the words for it.

use std::fmt;

use serde::{Serialize, Serializer};

use super::stalled::Torques;
use crate::engine::energy::NotApplicable;
use crate::engine::time::Start;
use crate::mechanism::Jam;
use crate::scene::Load;

/// A run that ended before its goal.
#[derive(Clone, Debug)]
pub struct Stopped {
    /// Why.
    pub why: Why,
    /// Time (s), crank angle and speed (rad/s) there.
    pub at: Start,
}

/// The reason.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Why {
    /// The work limit of evaluations is reached.
    WorkLimit,
    /// The steps have become so short that it would be reached long before the end.
    WorkLimitAhead,
    /// The crank turns so often that it would be.
    TooManyTurns,
    /// Somebody asked to stop.
    Interrupted,
    /// The crank needs for ever for so many turns.
    Turns(f64),
    /// A periodic swing of this period, s.
    Period {
        /// Turns that were asked for.
        turns: f64,
        /// s
        period: f64,
    },
    /// So many turning points led no further than between two angles, rad.
    Caught {
        /// Turns that were asked for.
        turns: f64,
        /// Turning points since one led further.
        since: u64,
        /// rad
        reach: [f64; 2],
    },
    /// At rest for good.
    AtRest {
        /// Turns that were asked for.
        turns: f64,
        /// What friction holds.
        held_by: Option<Torques>,
    },
    /// Next to the balance of its torques, at a crank angle in rad.
    Stalled {
        /// rad
        theta: f64,
        /// What balances there.
        torques: Torques,
        /// Turns that were asked for, if they were.
        turns: Option<f64>,
    },
    /// At a limit of its motion, where the rod stands normal to the guide.
    AtLimit,
    /// A crank of prescribed speed at its limit.
    DrivenToLimit,
    /// Friction locks the guide of a crank of prescribed speed.
    Locked,
    /// A load has no finite value.
    NoValue {
        /// Where it was asked for.
        asked: Start,
        /// Which.
        load: Option<Load>,
    },
    /// A load of a mechanism with a loose joint.
    NoValueLoose(Load),
    /// The effective inertia vanishes.
    NoInertia,
    /// The effective inertia nearly vanishes.
    NearlyNoInertia,
    /// At a limit or dead centre on the configuration curve.
    NoInertiaOnCurve,
    /// A load or the speed is too large for a number.
    TooLarge,
    /// The steps have become too small.
    Singular,
    /// On the configuration curve the steps have become too small.
    SingularOnCurve,
    /// The slider jams in its guide.
    Jam {
        /// How many accelerations there are.
        solutions: Jam,
        /// Coefficient of friction.
        mu: f64,
        /// |dN/dF| of the guide.
        kappa: f64,
    },
    /// A slider with a loose joint jams.
    JamLoose,
    /// The contact is too stiff for steps in double precision.
    ContactTooStiff,
    /// No engine told why.
    Untold,
}

impl fmt::Display for Stopped {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Start { t, angle, speed } = self.at;
        let theta = angle.radians();
        let place = format!("stopped at t = {t} s, theta = {theta} rad, omega = {speed} rad/s");
        match &self.why {
            Why::WorkLimit => write!(
                f,
                "the work limit of evaluations is reached: {place}; raise --max-evaluations, shorten the run or loosen the tolerance"
            ),
            Why::WorkLimitAhead => write!(
                f,
                "the steps have become so short that the work limit of evaluations would be reached long before the end: {place}; the equation is too stiff for a method in time, or a load jumps back and forth with the speed: give dry friction as kind = \"dry\" or at the guide as [friction], and steep losses less steep, or raise --max-evaluations"
            ),
            Why::TooManyTurns => write!(
                f,
                "the crank turns so often that the work limit of evaluations would be reached long before the end: {place}; shorten the run or raise --max-evaluations"
            ),
            Why::Interrupted => write!(f, "interrupted: {place}"),
            Why::Turns(turns) => write!(
                f,
                "the crank does not complete {}: {place}; give a duration instead",
                Turns(*turns)
            ),
            Why::Period { turns, period } => write!(
                f,
                "the crank swings to and fro and does not complete {}: shown is one period of {period} s; give a duration instead",
                Turns(*turns)
            ),
            Why::Caught {
                turns,
                since,
                reach: [from, to],
            } => write!(
                f,
                "the crank swings to and fro and does not complete {}: in its last {since} turning points it came no further than between theta = {from} rad and {to} rad; stopped at t = {t} s; give a duration instead",
                Turns(*turns)
            ),
            Why::AtRest { turns, held_by } => {
                f.write_str("the crank comes to rest")?;
                if let Some(torques) = held_by {
                    write!(f, ", where friction holds {torques},")?;
                }
                write!(
                    f,
                    " and does not complete {}: {place}; give a duration instead",
                    Turns(*turns)
                )
            }
            Why::Stalled {
                theta,
                torques,
                turns,
            } => {
                write!(f, "the crank stalled at theta = {theta} rad, {torques}")?;
                if let Some(turns) = turns {
                    write!(f, " and does not complete {}", Turns(*turns))?;
                }
                write!(
                    f,
                    ": stopped at t = {t} s, omega = {speed} rad/s; give it more torque, or a duration instead"
                )
            }
            Why::AtLimit => write!(
                f,
                "the crank reaches the limit of its motion, where the rod stands normal to the guide: stopped at t = {t} s, theta = {theta} rad; give the rod or the slider a mass, which carries it on"
            ),
            Why::DrivenToLimit => write!(
                f,
                "the crank reaches the limit of its motion: the rod stands normal to the guide there and no constant speed passes it; stopped at t = {t} s, theta = {theta} rad"
            ),
            Why::Locked => write!(
                f,
                "the guide locks itself from here on, as the coefficient of friction times tan phi reaches 1: no crank torque keeps up the speed; stopped at t = {t} s, theta = {theta} rad"
            ),
            Why::NoValue { asked, load } => {
                write!(
                    f,
                    "a load has no finite value at t = {} s, theta = {} rad, omega = {} rad/s",
                    asked.t,
                    asked.angle.radians(),
                    asked.speed
                )?;
                match load {
                    Some(load) if load.is_tabulated() => write!(f, " ({load}, beyond its rows)")?,
                    Some(load) => write!(f, " ({load}, outside its domain)")?,
                    None => {}
                }
                write!(f, ": {place}")
            }
            Why::NoValueLoose(load) => write!(f, "a load has no finite value ({load}): {place}"),
            Why::NoInertia => write!(
                f,
                "the effective inertia vanishes: {place}; give the crank an inertia"
            ),
            Why::NearlyNoInertia => write!(
                f,
                "the effective inertia nearly vanishes and the speed grows without bound: {place}; give the crank an inertia, or use method energy if the loads depend on the position alone"
            ),
            Why::NoInertiaOnCurve => write!(
                f,
                "the effective inertia vanishes at this limit of its motion or dead centre, where the speed has no bound: {place}; give the rod or the slider a mass, or the crank an inertia"
            ),
            Why::TooLarge => write!(
                f,
                "a load or the crank speed is too large to be computed with: {place}"
            ),
            Why::Singular => write!(
                f,
                "the equation is singular or too stiff for this method: {place}"
            ),
            Why::SingularOnCurve => write!(
                f,
                "the equation is singular here or too stiff for this method: {place}"
            ),
            Why::Jam {
                solutions,
                mu,
                kappa,
            } => {
                let what = match solutions {
                    Jam::NoSolution => "no acceleration satisfies",
                    Jam::TwoSolutions => "more than one acceleration satisfies",
                };
                write!(
                    f,
                    "the slider jams in its guide: {what} the equations of rigid bodies, as the coefficient of friction {mu} times |dN/dF| = {kappa} is 1 or more: {place}"
                )
            }
            Why::JamLoose => write!(
                f,
                "the slider jams: rigid bodies with this coefficient of friction have no acceleration, or two; {place}"
            ),
            Why::ContactTooStiff => write!(
                f,
                "the contact is too stiff for steps in double precision: {place}"
            ),
            Why::Untold => write!(
                f,
                "the run ended before its goal: {place}; no engine gave a reason, which is a defect of this program"
            ),
        }
    }
}

/// Ends are the same if they say the same.
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

/// Why a motion over the crank angle does not go on.
pub(super) fn not_applicable(unserved: NotApplicable) -> &'static str {
    match unserved {
        NotApplicable::Equilibrium => "it starts at rest without a force",
        NotApplicable::NotFinite => "a load has no finite value on the way",
        NotApplicable::NotSmooth => "a load is not smooth",
        NotApplicable::TooSlow => "the crank comes too near to rest",
        NotApplicable::WorkLimit => "it takes more evaluations than the work limit allows",
        NotApplicable::TooManyTurns => "it takes more turns than the work limit allows",
        NotApplicable::TooLong => {
            "its turns differ from each other, and they are too many to be kept"
        }
    }
}

/// A number of turns in words.
struct Turns(f64);

impl fmt::Display for Turns {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = if self.0 == 1.0 { "turn" } else { "turns" };
        write!(f, "{} {unit}", self.0)
    }
}
