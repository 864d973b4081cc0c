//! Scenes that cannot be computed, with the reason.

use crate::error::Error;
use crate::mechanism::{Class, Curve, Linkage};
use crate::numeric::angle::Angle;
use crate::scene::{ContactLaw, MotionKind, RodModel, Scene};

pub(super) fn refuse_what_is_not_modelled(scene: &Scene) -> Result<(), Error> {
    let spin_only = scene.rod.is_some_and(|rod| rod.model == RodModel::SpinOnly);
    if scene.friction.is_some() && spin_only {
        return Err(Error::refused(
            "the rod model \"spin-only\" leaves out the rod's translation, so no normal force goes with it",
            "use model = \"rigid\" or \"two-mass\" with [friction]",
        ));
    }
    let linked = scene
        .clearance
        .is_some_and(|clearance| clearance.law == ContactLaw::MasslessLink);
    if scene.friction.is_some() && linked {
        return Err(Error::refused(
            "Coulomb friction at the guide together with a massless link in a joint is not modelled",
            "use another contact_law, or take [friction] out of the scene",
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
    let at_crossing = || {
        linkage.reaches(scene.motion.angle)
            && Curve::through(linkage, Angle::from(scene.motion.angle).reduced()).is_none()
    };
    if Class::of(linkage) == Class::ChangePoint && at_crossing() {
        return Err(Error::refused(
            "motion.angle is the change point of these lengths, where the mechanism may go on in two ways, and the scene does not say which",
            "start away from it, or change a length a little to say which mechanism is meant",
        ));
    }
    Ok(())
}

/// With clearance: a crank whose prescribed motion the rod cannot follow.
pub(super) fn refuse_what_jams(scene: &Scene, linkage: &Linkage) -> Result<(), Error> {
    let slack = scene.clearance.map_or(0.0, |clearance| clearance.radial);
    if Class::of(linkage) == Class::ChangePoint {
        return Err(Error::refused(
            "the lengths make a change point, where joints with clearance may go on in two ways",
            "change a length a little to say which mechanism is meant",
        ));
    }
    let prescribed = scene.motion.kind == MotionKind::ConstantSpeed;
    if prescribed && linkage.margin() + slack < 0.0 {
        return Err(Error::refused(
            "the crank cannot turn fully, and at constant speed nothing gives way but the loose joint",
            "use motion kind = \"free\", or lengths whose crank turns fully",
        ));
    }
    Ok(())
}
