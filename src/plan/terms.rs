//! Terms of the equation that a scene keeps or leaves out, with the reasons.

use std::borrow::Cow;

use serde::Serialize;

use crate::scene::{Clearance, Load, LoadOf, Rod, RodModel, Scene};

/// Term of the equation, modelled or left out.
#[derive(Clone, Debug, Serialize)]
pub struct Term {
    /// Name of the term, like `gravity` or `torque[1]`.
    pub name: Cow<'static, str>,
    /// Strength of a term that is kept, or why the term is left out.
    pub reason: Cow<'static, str>,
}

/// Terms kept and terms left out.
#[derive(Default)]
pub(super) struct TermLists {
    pub kept: Vec<Term>,
    pub left_out: Vec<Term>,
}

const ZERO: &str = "its strength is zero";

/// Returns the terms of a scene; `reduced` is `scene` without parts of zero strength.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> TermLists {
    let mut terms = TermLists::default();
    terms.part("crank inertia", [scene.crank, reduced.crank], |crank| {
        format!("{} kg m2 about O", crank.inertia)
    });
    terms.part("connecting rod inertia", [scene.rod, reduced.rod], of_rod);
    terms.part("slider inertia", [scene.slider, reduced.slider], |slider| {
        format!("{} kg", slider.mass)
    });
    terms.part("gravity", [scene.gravity, reduced.gravity], |gravity| {
        let [gx, gy] = gravity.vector();
        format!("({gx}, {gy}) m/s2")
    });
    let is_loose = reduced.clearance.is_some();
    for (word, on_slider) in [("torque", false), ("force", true)] {
        let loads = scene.loads().filter(|of| of.key.on_slider == on_slider);
        let mut loads = loads.peekable();
        if loads.peek().is_none() {
            terms.part::<()>(word, [None; 2], |()| String::new());
        }
        loads.for_each(|of| terms.load(&of, is_loose));
    }
    let friction = [scene.friction, reduced.friction];
    terms.part("Coulomb friction", friction, |friction| {
        let (kinetic, held) = (friction.coefficient, friction.static_coefficient);
        format!("at the guide, coefficient {kinetic}, static {held}")
    });
    let clearance = [scene.clearance, reduced.clearance];
    terms.part("joint clearance", clearance, of_clearance);
    terms
}

fn of_rod(rod: Rod) -> String {
    let what = match rod.model {
        RodModel::Rigid => "rigid body: translation and spin",
        RodModel::TwoMass => "two masses at the pins",
        RodModel::SpinOnly => "spin only, as printed by Duarte et al.",
        RodModel::Massless => "massless",
    };
    format!("{} kg, {what}", rod.mass)
}

fn of_clearance(clearance: Clearance) -> String {
    let joint = clearance.joint.name().replace('-', " ");
    let (radial, law) = (clearance.radial, clearance.law.name());
    format!("{radial} m at the {joint}, contact law {law}")
}

impl TermLists {
    /// Adds a part as given in the scene and as kept, absent where its strength is zero.
    fn part<T>(&mut self, name: &'static str, of: [Option<T>; 2], shown: fn(T) -> String) {
        let [given, kept] = of;
        let (terms, reason) = match (kept, given) {
            (Some(part), _) => (&mut self.kept, shown(part).into()),
            (None, Some(_)) => (&mut self.left_out, ZERO.into()),
            (None, None) => (&mut self.left_out, "not in the scene".into()),
        };
        let name = name.into();
        terms.push(Term { name, reason });
    }

    /// Adds a load; with a loose joint nothing is held at rest.
    fn load(&mut self, of: &LoadOf<'_>, is_loose: bool) {
        let load = of.load;
        let is_dry = |part: &Load| matches!(part, Load::Dry(_));
        let (terms, reason) = if load.is_zero() {
            (&mut self.left_out, format!("{load}: {ZERO}"))
        } else {
            let holds = !is_loose && load.parts(of.key.on_slider).iter().any(is_dry);
            let holds = if holds { "; holds at rest" } else { "" };
            (
                &mut self.kept,
                format!("{load}; depends on {}{holds}", of.reads()),
            )
        };
        terms.push(Term {
            name: of.key.to_string().into(),
            reason: reason.into(),
        });
    }
}
