//! Scenes that cannot be computed, with the reason.

use crate::error::Error;
use crate::mechanism::{Class, Limits, Linkage};
use crate::scene::{MotionKind, Scene};

pub(super) fn refuse_what_is_not_modelled(scene: &Scene) -> Result<(), Error> {
    if scene.friction.is_some() {
        return Err(Error::refused(
            "Coulomb friction in motion is not part of this version",
            "take [friction] out of the scene, or set its coefficient to 0",
        ));
    }
    Ok(())
}

pub(super) fn refuse_what_cannot_move(scene: &Scene, linkage: &Linkage) -> Result<(), Error> {
    let massless = scene.crank.is_none_or(|crank| crank.inertia == 0.0)
        && scene.rod.is_none()
        && scene.slider.is_none();
    if massless {
        return Err(Error::refused(
            "the mechanism has no inertia, so its loads decide no motion",
            "give the crank an inertia, or the rod or the slider a mass, or use motion kind = \"constant-speed\"",
        ));
    }
    if Limits::new(linkage, 0.0).class == Class::ChangePoint {
        return Err(Error::refused(
            "the lengths make a change point: where crank and rod lie in one line the mechanism may go on in two ways, and the equation does not say which",
            "change a length a little to say which mechanism is meant",
        ));
    }
    Ok(())
}

/// With clearance: a crank whose prescribed motion the rod cannot follow.
pub(super) fn refuse_what_jams(scene: &Scene, linkage: &Linkage) -> Result<(), Error> {
    let slack = scene.clearance.map_or(0.0, |clearance| clearance.radial);
    let prescribed = scene.motion.kind == MotionKind::ConstantSpeed;
    if prescribed && linkage.margin() + slack < 0.0 {
        return Err(Error::refused(
            "the crank cannot turn fully, and at constant speed nothing gives way but the loose joint",
            "use motion kind = \"free\", or lengths whose crank turns fully",
        ));
    }
    Ok(())
}
