//! Warnings of a run for the reader of a result: values and messages.

use serde::{Serialize, Serializer};

use crate::engine::time::MotionState;
use crate::scene::Load;

/// Warning of a run.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Warning {
    /// The second run of the error estimate did not reach the end within its share of work.
    #[error("the error could not be estimated: the second, tighter run did not finish")]
    NotEstimated,
    /// The error of the crank angle at the end exceeds half a turn.
    #[error(
        "the error is not stated: on the way it has grown to more than half a turn, and only the statistics of the motion mean something; a shorter run states its error"
    )]
    Undetermined,
    /// The lengths make a change point.
    #[error(
        "the lengths make a change point: it is passed so that all velocities stay continuous, and the branch changes there; a slightly longer or shorter rod moves differently"
    )]
    ChangePoint,
    /// The lengths are close to a change point, at this distance in crank lengths.
    #[error(
        "the lengths are {0:e} crank lengths from a change point: which way the mechanism goes there depends on their last digits"
    )]
    NearChangePoint(f64),
    /// The inertia vanishes at the dead centres, where the speed has no bound.
    #[error(
        "the effective inertia vanishes at the dead centres, where the crank speed has no bound"
    )]
    UnboundedSpeed,
    /// More events occurred than are listed.
    #[error("{total} events occurred; the first {kept} are listed")]
    EventsLeftOut {
        /// Number of events.
        total: u64,
        /// Number of listed events.
        kept: usize,
    },
    /// The largest joint forces are not known.
    #[error(
        "the largest joint forces are not given: the run is too long to be looked through as closely as it takes, or a force has no finite value"
    )]
    NoForceMaxima,
    /// The range of the driving torque is not known.
    #[error("the range of the driving torque is not given: {0}")]
    NoTorqueRange(NoRange),
    /// The second run of a loose joint did not reach the end.
    #[error("the reproducible horizon is not known: the second, tighter run did not finish")]
    NoHorizon,
    /// The motion of a loose joint is reproducible up to a time only.
    #[error(
        "the motion is reproducible up to t = {t:.6} s ({turns:.2} turns); beyond it only its statistics mean something"
    )]
    HorizonAt {
        /// Reproducible horizon, s.
        t: f64,
        /// Number of turns of the crank up to the horizon.
        turns: f64,
    },
    /// The end lies beyond the horizon: the error of the crank is not known.
    #[error("the crank at the end lies beyond the reproducible horizon: its error is not stated")]
    BeyondHorizon,
    /// The penetration, m, exceeds the clearance.
    #[error(
        "the penetration reaches {0:.1e} m, more than the clearance: Hertz's law for a small spot of contact does not describe it"
    )]
    DeepContact(f64),
    /// A massless link is in tension for this part of the time.
    #[error("the massless link is drawn for {:.1} % of the time: there a journal would leave the bearing's wall", 100.0 * .0)]
    DrawnLink(f64),
}

/// Reason that the range of a driving torque is not known.
#[derive(Clone, Debug, thiserror::Error)]
#[non_exhaustive]
pub enum NoRange {
    /// The loads do not repeat, and the run has more turns than this, the largest number that is searched.
    #[error("the loads depend on the time or the crank angle, and the run has more than {0} turns")]
    TooManyTurns(f64),
    /// The loads vary too quickly for a search.
    #[error("the loads vary too quickly to be looked through as closely as it takes")]
    TooQuick,
    /// The torque is not finite at a state.
    #[error("{} at t = {} s, theta = {} rad", not_finite(*at_limit, load.as_deref()), at.t, at.angle.radians())]
    NotFinite {
        /// Whether the crank is at a limit of its motion.
        at_limit: bool,
        /// Load without a value, if any.
        load: Option<Box<Load>>,
        /// Time, crank angle and speed.
        at: MotionState,
    },
    /// The mean over the angle is not finite.
    #[error("its mean is not finite: a load has no value at an angle on the way")]
    Mean,
}

/// Returns the cause of a torque that is not finite, as a clause of a message.
fn not_finite(at_limit: bool, load: Option<&Load>) -> String {
    match load {
        _ if at_limit => "the crank is at a limit".to_owned(),
        Some(load) => format!("a load has no finite value ({load})"),
        None => "the torque is too large for a number".to_owned(),
    }
}

impl Serialize for Warning {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}
