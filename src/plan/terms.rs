//! Terms of the equation that a scene keeps or leaves out, with the reasons, displayed in words.

use std::fmt;

use serde::Serialize;

use crate::scene::{Clearance, Friction, Joint, Load, RodModel, Scene, Variables};

/// Term of the equation, modelled or left out.
#[derive(Clone, Debug, Serialize)]
pub struct Term {
    /// Name of the term.
    #[serde(serialize_with = "shown")]
    pub name: TermName,
    /// Why the term is kept or left out.
    #[serde(serialize_with = "shown")]
    pub reason: TermReason,
}

/// Name of a term, like `gravity` or `torque[1]`.
#[derive(Clone, Copy, Debug)]
pub struct TermName {
    word: &'static str,
    /// Number in a list of loads, from 1; none outside a list.
    number: Option<usize>,
}

/// Reason to keep or leave out a term: the part of the scene that makes it.
#[derive(Clone, Debug)]
pub enum TermReason {
    /// The part is not in the scene.
    Absent,
    /// The strength of the part is zero.
    Zero,
    /// Inertia of the crank about O, kg m².
    Crank(f64),
    /// Mass (kg) and model of the rod.
    Rod(f64, RodModel),
    /// Mass of the slider, kg.
    Slider(f64),
    /// Gravity along x and y, m/s².
    Gravity([f64; 2]),
    /// Load of zero strength.
    NoLoad(Load),
    /// Load and the variables it depends on.
    Load(Load, Variables),
    /// Friction of the guide.
    Friction(Friction),
    /// Clearance of a joint.
    Clearance(Clearance),
}

/// Serializes a value as its displayed text.
pub(super) fn shown<S: serde::Serializer>(
    what: &impl fmt::Display,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_str(what)
}

impl fmt::Display for TermName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.number {
            Some(number) => write!(f, "{}[{number}]", self.word),
            None => f.write_str(self.word),
        }
    }
}

impl fmt::Display for TermReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            TermReason::Absent => f.write_str("not in the scene"),
            TermReason::Zero => f.write_str("its strength is zero"),
            TermReason::Crank(inertia) => write!(f, "{inertia} kg m2 about O"),
            TermReason::Rod(mass, model) => {
                let what = match model {
                    RodModel::Rigid => "rigid body: translation and spin",
                    RodModel::TwoMass => "two masses at the pins",
                    RodModel::SpinOnly => "spin only, as printed by Duarte et al.",
                    RodModel::Massless => "massless",
                };
                write!(f, "{mass} kg, {what}")
            }
            TermReason::Slider(mass) => write!(f, "{mass} kg"),
            TermReason::Gravity([gx, gy]) => write!(f, "({gx}, {gy}) m/s2"),
            TermReason::NoLoad(load) => write!(f, "{load}: {}", TermReason::Zero),
            TermReason::Load(load, reads) => write!(f, "{load}; depends on {reads}"),
            TermReason::Friction(friction) => {
                let (kinetic, held) = (friction.coefficient, friction.static_coefficient);
                write!(f, "at the guide, coefficient {kinetic}, static {held}")
            }
            TermReason::Clearance(clearance) => {
                let joint = match clearance.joint {
                    Joint::CrankPin => "crank pin",
                    Joint::WristPin => "wrist pin",
                };
                let (radial, law) = (clearance.radial, clearance.law.name());
                write!(f, "{radial} m at the {joint}, contact law {law}")
            }
        }
    }
}

#[derive(Default)]
struct Terms {
    kept: Vec<Term>,
    left_out: Vec<Term>,
}

impl Terms {
    /// Lists a term under the reason to keep it, or under the reason, as the error, to leave it out.
    fn list(&mut self, name: TermName, reason: Result<TermReason, TermReason>) {
        let (list, reason) = match reason {
            Ok(reason) => (&mut self.kept, reason),
            Err(reason) => (&mut self.left_out, reason),
        };
        list.push(Term { name, reason });
    }

    /// Lists a part as kept, with the reason; else as left out: of zero strength if `is_given`, otherwise absent.
    fn part(&mut self, word: &'static str, kept: Option<TermReason>, is_given: bool) {
        let absent = match is_given {
            true => TermReason::Zero,
            false => TermReason::Absent,
        };
        self.list(TermName { word, number: None }, kept.ok_or(absent));
    }

    /// Lists torques or forces, each by its number.
    fn loads(&mut self, word: &'static str, loads: &[Load], on_slider: bool) {
        if loads.is_empty() {
            self.part(word, None, false);
        }
        for (number, load) in (1..).zip(loads) {
            let reason = match load.is_zero() {
                true => Err(TermReason::NoLoad(load.clone())),
                false => Ok(TermReason::Load(load.clone(), load.reads(on_slider))),
            };
            let number = Some(number);
            self.list(TermName { word, number }, reason);
        }
    }
}

/// Returns the terms kept and the terms left out; `reduced` is `scene` without parts of zero strength.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
    let mut terms = Terms::default();
    let kept = reduced.crank.map(|crank| TermReason::Crank(crank.inertia));
    terms.part("crank inertia", kept, scene.crank.is_some());
    let kept = reduced.rod.map(|rod| TermReason::Rod(rod.mass, rod.model));
    terms.part("connecting rod inertia", kept, scene.rod.is_some());
    let kept = reduced.slider.map(|slider| TermReason::Slider(slider.mass));
    terms.part("slider inertia", kept, scene.slider.is_some());
    let kept = reduced
        .gravity
        .map(|gravity| TermReason::Gravity(gravity.vector()));
    terms.part("gravity", kept, scene.gravity.is_some());
    terms.loads("torque", &scene.torques, false);
    terms.loads("force", &scene.forces, true);
    let kept = reduced.friction.map(TermReason::Friction);
    terms.part("Coulomb friction", kept, scene.friction.is_some());
    let kept = reduced.clearance.map(TermReason::Clearance);
    terms.part("joint clearance", kept, scene.clearance.is_some());
    (terms.kept, terms.left_out)
}
