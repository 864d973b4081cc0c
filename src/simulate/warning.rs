//! What the reader of a result should know: warnings with their values, and the words for them.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::engine::time::Start;
use crate::scene::Load;

/// A warning of a run.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Warning {
    /// The second run of the estimate did not get to the end within its share of work.
    NotEstimated,
    /// The lengths make a change point.
    ChangePoint,
    /// The lengths are so many crank lengths from a change point.
    NearChangePoint(f64),
    /// The inertia vanishes at the dead centres.
    UnboundedSpeed,
    /// Of so many events only the first are listed.
    EventsLeftOut {
        /// How many there were.
        total: u64,
        /// How many are listed.
        kept: usize,
    },
    /// The largest joint forces are not known.
    NoForceMaxima,
    /// The range of the driving torque is not known.
    NoTorqueRange(NoRange),
    /// The second run of a loose joint did not finish.
    NoHorizon,
    /// The motion of a loose joint is reproducible up to a time, s.
    HorizonAt {
        /// s
        t: f64,
        /// Turns of the crank until then.
        turns: f64,
    },
    /// The crank at the end lies beyond the horizon.
    BeyondHorizon,
    /// The penetration (m) is more than the clearance.
    DeepContact(f64),
    /// A massless link is drawn for this part of the time.
    DrawnLink(f64),
}

/// Why the range of a driving torque is not known.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum NoRange {
    /// Loads that do not repeat, over more turns than are looked at.
    TooManyTurns(f64),
    /// The torque is not finite at a state.
    NotFinite {
        /// The crank stands at a limit there.
        at_limit: bool,
        /// The load that has no value.
        load: Option<Box<Load>>,
        /// Time, angle and speed.
        at: Start,
    },
    /// The mean over the angle is not finite.
    Mean,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Warning::NotEstimated => f.write_str(
                "the error could not be estimated: the second, tighter run did not finish",
            ),
            Warning::ChangePoint => f.write_str(
                "the lengths make a change point: it is passed so that all velocities stay continuous, and the branch changes there; a slightly longer or shorter rod moves differently",
            ),
            Warning::NearChangePoint(near) => write!(
                f,
                "the lengths are {near:e} crank lengths from a change point: which way the mechanism goes there depends on their last digits"
            ),
            Warning::UnboundedSpeed => f.write_str(
                "the effective inertia vanishes at the dead centres, where the crank speed has no bound",
            ),
            Warning::EventsLeftOut { total, kept } => {
                write!(f, "{total} events occurred; the first {kept} are listed")
            }
            Warning::NoForceMaxima => f.write_str(
                "the largest joint forces are not given: the run is too long to be looked through as closely as it takes, or a force has no finite value",
            ),
            Warning::NoTorqueRange(why) => {
                write!(f, "the range of the driving torque is not given: {why}")
            }
            Warning::NoHorizon => f.write_str(
                "the reproducible horizon is not known: the second, tighter run did not finish",
            ),
            Warning::HorizonAt { t, turns } => write!(
                f,
                "the motion is reproducible up to t = {t:.6} s ({turns:.2} turns); beyond it only its statistics mean something"
            ),
            Warning::BeyondHorizon => f.write_str(
                "the crank at the end lies beyond the reproducible horizon: its error is not stated",
            ),
            Warning::DeepContact(depth) => write!(
                f,
                "the penetration reaches {depth:.1e} m, more than the clearance: Hertz's law for a small spot of contact does not describe it"
            ),
            Warning::DrawnLink(share) => write!(
                f,
                "the massless link is drawn for {:.1} % of the time: there a journal would leave the bearing's wall",
                100.0 * share
            ),
        }
    }
}

impl fmt::Display for NoRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            NoRange::TooManyTurns(most) => write!(
                f,
                "the loads depend on the time or the crank angle, and the run has more than {most} turns"
            ),
            NoRange::NotFinite { at_limit, load, at } => {
                match load {
                    _ if *at_limit => f.write_str("the crank is at a limit")?,
                    Some(load) => write!(f, "a load has no finite value ({load})")?,
                    None => f.write_str("the torque is too large for a number")?,
                }
                write!(f, " at t = {} s, theta = {} rad", at.t, at.angle.radians())
            }
            NoRange::Mean => {
                f.write_str("its mean is not finite: a load has no value at an angle on the way")
            }
        }
    }
}

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
