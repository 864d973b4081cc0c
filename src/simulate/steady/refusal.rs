//! Scenes without a periodic steady state over the crank angle, with the reason.

use super::super::stop::not_applicable;
use crate::engine::angle::NoCycle;
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::mechanism::{Class, Limits, Linkage};
use crate::plan::{Cycle, Method, Plan};
use crate::scene::{MotionKind, Scene};

/// Refuses what has no steady state.
pub(super) fn refuse_what_has_none(scene: &Scene) -> Result<(), Error> {
    scene.check()?;
    let refuse = |what: &str, help: &str| Err(Error::refused(what, help));
    if scene.motion.kind == MotionKind::ConstantSpeed {
        return refuse(
            "a steady state is sought, but the scene prescribes the crank's speed",
            "use motion kind = \"free\"; the prescribed motion is steady already",
        );
    }
    let reduced = scene.reduced();
    if let Some(why) = Cycle::of(scene).why_not {
        return refuse(
            &format!("a steady state is sought, but no cycle is like the next: {why}"),
            "use loads of theta that repeat, and loads of omega, x and v",
        );
    }
    if reduced.clearance.is_some() {
        return refuse(
            "a steady state cannot be found directly with clearance in a joint",
            "take [clearance] out of the scene, or simulate until the motion repeats",
        );
    }
    let linkage = Linkage::new(&scene.geometry);
    let limits = Limits::new(&linkage, 0.0);
    if limits.class != Class::RotatingCrank {
        return refuse(
            &format!(
                "a steady state needs a crank that turns fully; these lengths make a {}",
                limits.class
            ),
            "the crank turns fully if the rod is longer than crank and offset together",
        );
    }
    Ok(())
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

/// Where the inertia vanishes the speed has no bound.
pub(super) fn unbounded() -> Error {
    Error::refused(
        "the effective inertia vanishes at the dead centres, where the crank speed has no bound: there is no speed fluctuation",
        "give the crank an inertia",
    )
}

/// Why there is no periodic motion.
pub(super) fn no_cycle(reason: NoCycle) -> Error {
    let (what, help) = match reason {
        NoCycle::Gains => (
            "no steady state: at every speed a cycle gains energy".to_owned(),
            "add a load that brakes the more the faster the crank turns",
        ),
        NoCycle::Stops => (
            "no steady state: at every speed a cycle loses energy or is not completed, the crank stops"
                .to_owned(),
            "add a load that drives the crank in the sense of motion.speed",
        ),
        NoCycle::NotApplicable(reason) => (
            format!(
                "the steady state cannot be computed: {}",
                not_applicable(reason)
            ),
            "look at the loads; or simulate until the motion repeats",
        ),
    };
    Error::refused(what, help)
}

/// A turn of loads that do not depend on the speed cannot be computed.
pub(super) fn not_turned(reason: NotApplicable) -> Error {
    if reason != NotApplicable::TooSlow {
        return no_cycle(reason.into());
    }
    Error::refused(
        "no steady state: from its start speed the crank does not complete a turn, and no load depends on the speed",
        "give a greater start speed, or a load that drives the crank and depends on the speed",
    )
}

/// A turn of loads that do not depend on the speed gains energy, J, at every speed.
pub(super) fn always_gains(gain: f64) -> Error {
    let (verb, what) = if gain > 0.0 {
        ("gains", "brakes")
    } else {
        ("loses", "drives the crank")
    };
    Error::refused(
        format!(
            "no steady state: no load depends on the speed, and every cycle {verb} {:.6e} J",
            gain.abs()
        ),
        format!("add a load that {what} and depends on the speed"),
    )
}
