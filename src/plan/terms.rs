//! Which terms of the equation are modelled, which are not, and why.

use std::borrow::Cow;

use super::Term;
use crate::scene::{Joint, RodModel, Scene};

type Text = Cow<'static, str>;

#[derive(Default)]
struct Notes {
    kept: Vec<Term>,
    left_out: Vec<Term>,
}

impl Notes {
    fn keep(&mut self, name: impl Into<Text>, reason: impl Into<Text>) {
        let (name, reason) = (name.into(), reason.into());
        self.kept.push(Term { name, reason });
    }

    fn leave_out(&mut self, name: impl Into<Text>, reason: impl Into<Text>) {
        let (name, reason) = (name.into(), reason.into());
        self.left_out.push(Term { name, reason });
    }
}

fn absent(given: bool) -> &'static str {
    if given {
        "its strength is zero"
    } else {
        "not in the scene"
    }
}

/// Terms kept, terms left out.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
    let mut notes = Notes::default();
    match &reduced.crank {
        Some(crank) => notes.keep("crank inertia", format!("{} kg m2 about O", crank.inertia)),
        None => notes.leave_out("crank inertia", absent(scene.crank.is_some())),
    }
    match &reduced.rod {
        Some(rod) => {
            let what = match rod.model {
                RodModel::Rigid => "rigid body: translation and spin",
                RodModel::TwoMass => "two masses at the pins",
                RodModel::SpinOnly => "spin only, as printed by Duarte et al.",
                RodModel::Massless => "massless",
            };
            notes.keep("connecting rod inertia", format!("{} kg, {what}", rod.mass));
        }
        None => notes.leave_out("connecting rod inertia", absent(scene.rod.is_some())),
    }
    match &reduced.slider {
        Some(slider) => notes.keep("slider inertia", format!("{} kg", slider.mass)),
        None => notes.leave_out("slider inertia", absent(scene.slider.is_some())),
    }
    match &reduced.gravity {
        Some(gravity) => {
            let [gx, gy] = gravity.vector();
            notes.keep("gravity", format!("({gx}, {gy}) m/s2"));
        }
        None => notes.leave_out("gravity", absent(scene.gravity.is_some())),
    }
    for (name, loads) in [("torque", &scene.torques), ("force", &scene.forces)] {
        if loads.is_empty() {
            notes.leave_out(name, absent(false));
        }
        for (i, load) in loads.iter().enumerate() {
            let label = format!("{name}[{}]", i + 1);
            if load.is_zero() {
                notes.leave_out(label, format!("{load}: {}", absent(true)));
            } else {
                let reads = load.reads(name == "force");
                notes.keep(label, format!("{load}; depends on {reads}"));
            }
        }
    }
    match &reduced.friction {
        Some(friction) => notes.keep(
            "Coulomb friction",
            format!(
                "at the guide, coefficient {}, static {}",
                friction.coefficient, friction.static_coefficient
            ),
        ),
        None => notes.leave_out("Coulomb friction", absent(scene.friction.is_some())),
    }
    match &reduced.clearance {
        Some(clearance) => {
            let joint = match clearance.joint {
                Joint::CrankPin => "crank pin",
                Joint::WristPin => "wrist pin",
            };
            let (radial, law) = (clearance.radial, clearance.law.name());
            notes.keep(
                "joint clearance",
                format!("{radial} m at the {joint}, contact law {law}"),
            );
        }
        None => notes.leave_out("joint clearance", absent(scene.clearance.is_some())),
    }
    (notes.kept, notes.left_out)
}
