//! Why a scene has no periodic steady state, or no flywheel for it, and the words for it.

use super::super::stop::not_applicable;
use crate::engine::angle::NoCycle;
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::mechanism::{Class, Limits, Linkage};
use crate::plan::{Cycle, Method, Plan};
use crate::scene::{MotionKind, Scene};

/// Why there is no steady state, or no flywheel for it.
#[derive(Clone, Debug, thiserror::Error)]
pub(super) enum Refusal {
    #[error("a steady state is sought, but the scene prescribes the crank's speed")]
    Prescribed,
    #[error("a steady state is sought, but no cycle is like the next: {0}")]
    NoCycle(String),
    #[error("a steady state cannot be found directly with clearance in a joint")]
    Clearance,
    #[error("a steady state needs a crank that turns fully; these lengths make a {0}")]
    NotTurning(Class),
    #[error(
        "the effective inertia vanishes at the dead centres, where the crank speed has no bound: there is no speed fluctuation"
    )]
    Unbounded,
    #[error("no steady state: at every speed a cycle gains energy")]
    Gains,
    #[error(
        "no steady state: at every speed a cycle loses energy or is not completed, the crank stops"
    )]
    Stops,
    #[error("the steady state cannot be computed: {}", not_applicable(*.0))]
    NotComputed(NotApplicable),
    #[error(
        "no steady state: from its start speed the crank does not complete a turn, and no load depends on the speed"
    )]
    NoTurn,
    /// J
    #[error("no steady state: no load depends on the speed, and every cycle gains {0:.6e} J")]
    AlwaysGains(f64),
    /// J
    #[error("no steady state: no load depends on the speed, and every cycle loses {0:.6e} J")]
    AlwaysLoses(f64),
    #[error("the start is at rest, and no load depends on the speed: every speed is periodic")]
    AnySpeed,
    #[error("the start is at rest, and the crank has a steady state in either sense of rotation")]
    EitherSense,
    #[error("a coefficient of fluctuation of {0} is asked for")]
    NoCoefficient(f64),
    #[error(
        "no flywheel gives a coefficient of fluctuation of {0}: the speed is constant without one"
    )]
    ConstantSpeed(f64),
    /// kg m²
    #[error("no flywheel up to {0:.1e} kg m2 makes the coefficient of fluctuation so small")]
    TooHeavy(f64),
    #[error(
        "a coefficient of fluctuation of {wanted} needs a crank of less inertia than its mass has, or less than none; the largest that was reached is {largest:.6}"
    )]
    TooLight { wanted: f64, largest: f64 },
    #[error("no flywheel was found for a coefficient of fluctuation of {0}")]
    NotFound(f64),
}

impl Refusal {
    /// What would be right.
    fn help(&self) -> &'static str {
        match self {
            Refusal::Prescribed => {
                "use motion kind = \"free\"; the prescribed motion is steady already"
            }
            Refusal::NoCycle(_) => "use loads of theta that repeat, and loads of omega, x and v",
            Refusal::Clearance => {
                "take [clearance] out of the scene, or simulate until the motion repeats"
            }
            Refusal::NotTurning(_) => {
                "the crank turns fully if the rod is longer than crank and offset together"
            }
            Refusal::Unbounded => "give the crank an inertia",
            Refusal::Gains => "add a load that brakes the more the faster the crank turns",
            Refusal::Stops => "add a load that drives the crank in the sense of motion.speed",
            Refusal::NotComputed(_) => "look at the loads; or simulate until the motion repeats",
            Refusal::NoTurn => {
                "give a greater start speed, or a load that drives the crank and depends on the speed"
            }
            Refusal::AlwaysGains(_) => "add a load that brakes and depends on the speed",
            Refusal::AlwaysLoses(_) => "add a load that drives the crank and depends on the speed",
            Refusal::AnySpeed => "give a start speed: motion.speed",
            Refusal::EitherSense => "give motion.speed the sign of the rotation that is meant",
            Refusal::NoCoefficient(_) => "give a number between 0 and 2, like 0.02",
            Refusal::ConstantSpeed(_) => "a flywheel is for a speed that varies",
            Refusal::TooHeavy(_) => "ask for a larger coefficient",
            Refusal::TooLight { .. } => "ask for a smaller coefficient",
            Refusal::NotFound(_) => "ask for another coefficient",
        }
    }
}

impl From<Refusal> for Error {
    fn from(refusal: Refusal) -> Error {
        Error::refused(refusal.to_string(), refusal.help())
    }
}

impl From<NoCycle> for Refusal {
    fn from(reason: NoCycle) -> Refusal {
        match reason {
            NoCycle::Gains => Refusal::Gains,
            NoCycle::Stops => Refusal::Stops,
            NoCycle::NotApplicable(why) => Refusal::NotComputed(why),
        }
    }
}

/// Why a turn of loads that do not depend on the speed cannot be computed.
pub(super) fn not_turned(reason: NotApplicable) -> Refusal {
    match reason {
        NotApplicable::TooSlow => Refusal::NoTurn,
        why => Refusal::NotComputed(why),
    }
}

/// Refuses what has no steady state.
pub(super) fn refuse_what_has_none(scene: &Scene) -> Result<(), Error> {
    scene.check()?;
    let class = Limits::new(&Linkage::new(&scene.geometry), 0.0).class;
    let refusal = if scene.motion.kind == MotionKind::ConstantSpeed {
        Refusal::Prescribed
    } else if let Some(why) = Cycle::of(scene).why_not {
        Refusal::NoCycle(why)
    } else if scene.reduced().clearance.is_some() {
        Refusal::Clearance
    } else if class != Class::RotatingCrank {
        Refusal::NotTurning(class)
    } else {
        return Ok(());
    };
    Err(refusal.into())
}

/// What the cycles are computed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Over {
    /// The crank angle.
    Angle,
    /// The time: a load may jump, has its corners elsewhere, or friction jams the guide somewhere.
    Time,
}

/// What serves the cycles of a scene.
pub(super) fn over(scene: &Scene) -> Over {
    let mut turning = scene.clone();
    if scene.motion.speed == 0.0 {
        turning.motion.speed = 1.0;
    }
    match Plan::new(&turning, Method::Angle) {
        Ok(_) => Over::Angle,
        Err(_) => Over::Time,
    }
}
