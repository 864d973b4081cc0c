//! Which terms of the equation are modelled, which are not, and why.

use super::Term;
use crate::scene::{Joint, RodModel, Scene};

/// Terms kept, terms left out.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    let mut note = |name: &str, is_kept: bool, reason: String| {
        let term = Term {
            name: name.to_owned(),
            reason,
        };
        if is_kept { &mut kept } else { &mut left_out }.push(term);
    };
    let absent = |given: bool| {
        if given {
            "its strength is zero"
        } else {
            "not in the scene"
        }
        .to_owned()
    };
    match &reduced.crank {
        Some(crank) => note(
            "crank inertia",
            true,
            format!("{} kg m2 about O", crank.inertia),
        ),
        None => note("crank inertia", false, absent(scene.crank.is_some())),
    }
    match &reduced.rod {
        Some(rod) => {
            let what = match rod.model {
                RodModel::Rigid => "rigid body: translation and spin",
                RodModel::TwoMass => "two masses at the pins",
                RodModel::SpinOnly => "spin only, as printed by Duarte et al.",
                RodModel::Massless => "massless",
            };
            note(
                "connecting rod inertia",
                true,
                format!("{} kg, {what}", rod.mass),
            );
        }
        None => note("connecting rod inertia", false, absent(scene.rod.is_some())),
    }
    match &reduced.slider {
        Some(slider) => note("slider inertia", true, format!("{} kg", slider.mass)),
        None => note("slider inertia", false, absent(scene.slider.is_some())),
    }
    match &reduced.gravity {
        Some(gravity) => {
            let [gx, gy] = gravity.vector();
            note("gravity", true, format!("({gx}, {gy}) m/s2"));
        }
        None => note("gravity", false, absent(scene.gravity.is_some())),
    }
    for (name, loads) in [("torque", &scene.torques), ("force", &scene.forces)] {
        if loads.is_empty() {
            note(name, false, absent(false));
        }
        for (i, load) in loads.iter().enumerate() {
            let label = format!("{name}[{}]", i + 1);
            if load.is_zero() {
                note(&label, false, format!("{load}: {}", absent(true)));
            } else {
                let reads = load.reads(name == "force");
                note(&label, true, format!("{load}; depends on {reads}"));
            }
        }
    }
    match &reduced.friction {
        Some(friction) => note(
            "Coulomb friction",
            true,
            format!(
                "at the guide, coefficient {}, static {}",
                friction.coefficient, friction.static_coefficient
            ),
        ),
        None => note("Coulomb friction", false, absent(scene.friction.is_some())),
    }
    match &reduced.clearance {
        Some(clearance) => {
            let joint = match clearance.joint {
                Joint::CrankPin => "crank pin",
                Joint::WristPin => "wrist pin",
            };
            let (radial, law) = (clearance.radial, clearance.law.name());
            note(
                "joint clearance",
                true,
                format!("{radial} m at the {joint}, contact law {law}"),
            );
        }
        None => note("joint clearance", false, absent(scene.clearance.is_some())),
    }
    (kept, left_out)
}
