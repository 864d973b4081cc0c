//! Checks of the model: combinations of parts that are not modelled, and mechanisms whose motion is undetermined.

use crate::mechanism::{Class, Curve, Equation, Linkage, LooseMechanism};
use crate::numeric::angle::Angle;
use crate::scene::{ContactLaw, Load, LoadOf, MotionKind, Problem, RodModel, Scene};

/// Returns the problems of a scene without parts of zero strength.
pub fn problems(scene: &Scene, linkage: &Linkage) -> Vec<Problem> {
    let mut list = Vec::new();
    friction(scene, &mut list);
    match (scene.clearance, scene.motion.kind) {
        (Some(clearance), _) => {
            if let Err(problems) = LooseMechanism::new(scene, clearance) {
                list.extend(problems.list().iter().cloned());
            }
            loose(scene, clearance.radial, linkage, &mut list);
            dry(scene, &mut list);
        }
        (None, MotionKind::Free) => free(scene, linkage, &mut list),
        (None, MotionKind::ConstantSpeed) => {}
    }
    list
}

fn friction(scene: &Scene, list: &mut Vec<Problem>) {
    if scene.friction.is_none() {
        return;
    }
    if scene.rod.is_some_and(|rod| rod.model == RodModel::SpinOnly) {
        list.push(Problem::new(
            "rod.model",
            "the rod model \"spin-only\" leaves out the rod's translation, so no normal force goes with it",
            "use model = \"rigid\" or \"two-mass\" with [friction]",
        ));
    }
    let law = scene.clearance.map(|clearance| clearance.law);
    if law == Some(ContactLaw::MasslessLink) {
        list.push(Problem::new(
            "clearance.contact_law",
            "Coulomb friction at the guide together with a massless link in a joint is not modelled",
            "use another contact_law, or take [friction] out of the scene",
        ));
    }
}

fn free(scene: &Scene, linkage: &Linkage, list: &mut Vec<Problem>) {
    if !Equation::new(scene).has_inertia() {
        list.push(Problem::new(
            "crank.inertia",
            "the mechanism has no inertia, so its loads decide no motion",
            "give the crank an inertia, or the rod or the slider a mass, or use motion kind = \"constant-speed\"",
        ));
    }
    let at_crossing = || {
        linkage.reaches(scene.motion.angle)
            && Curve::through(linkage, Angle::from(scene.motion.angle).reduced()).is_none()
    };
    if Class::of(linkage) == Class::ChangePoint && at_crossing() {
        list.push(Problem::new(
            "motion.angle",
            "motion.angle is the change point of these lengths, where the mechanism may go on in two ways, and the scene does not say which",
            "start away from it, or change a length a little to say which mechanism is meant",
        ));
    }
}

/// Rejects dry loads in a scene with clearance.
fn dry(scene: &Scene, list: &mut Vec<Problem>) {
    let dry = |of: &LoadOf<'_>| matches!(of.load, Load::Dry(_));
    list.extend(scene.loads().filter(dry).map(|of| {
        Problem::new(
            &format!("{}.kind", of.key),
            "a load of kind \"dry\" together with clearance in a joint is not modelled",
            "use kind = \"viscous\", or take [clearance] out of the scene",
        )
    }));
}

/// Rejects, with clearance, a change point, and constant speed if even `slack` (m) lets the crank not turn fully.
fn loose(scene: &Scene, slack: f64, linkage: &Linkage, list: &mut Vec<Problem>) {
    if Class::of(linkage) == Class::ChangePoint {
        list.push(Problem::new(
            "geometry.rod",
            "the lengths make a change point, where joints with clearance may go on in two ways",
            "change a length a little to say which mechanism is meant",
        ));
        return;
    }
    let prescribed = scene.motion.kind == MotionKind::ConstantSpeed;
    if prescribed && linkage.margin() + slack < 0.0 {
        list.push(Problem::new(
            "motion.kind",
            "the crank cannot turn fully, and at constant speed nothing gives way but the loose joint",
            "use motion kind = \"free\", or lengths whose crank turns fully",
        ));
    }
}
