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
struct Notes {
    kept: Vec<Term>,
    left_out: Vec<Term>,
}

impl Notes {
    /// Lists a part as kept, with the reason; else as left out: of zero strength if `is_given`, otherwise absent.
    fn take(&mut self, word: &'static str, kept: Option<TermReason>, is_given: bool) {
        let absent = match is_given {
            true => TermReason::Zero,
            false => TermReason::Absent,
        };
        let (list, reason) = match kept {
            Some(reason) => (&mut self.kept, reason),
            None => (&mut self.left_out, absent),
        };
        let name = TermName { word, number: None };
        list.push(Term { name, reason });
    }
}

/// Returns the terms kept and the terms left out; `reduced` is `scene` without parts of zero strength.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
    let mut notes = Notes::default();
    let kept = reduced.crank.map(|crank| TermReason::Crank(crank.inertia));
    notes.take("crank inertia", kept, scene.crank.is_some());
    let kept = reduced.rod.map(|rod| TermReason::Rod(rod.mass, rod.model));
    notes.take("connecting rod inertia", kept, scene.rod.is_some());
    let kept = reduced.slider.map(|slider| TermReason::Slider(slider.mass));
    notes.take("slider inertia", kept, scene.slider.is_some());
    let kept = reduced
        .gravity
        .map(|gravity| TermReason::Gravity(gravity.vector()));
    notes.take("gravity", kept, scene.gravity.is_some());
    for (word, loads) in [("torque", &scene.torques), ("force", &scene.forces)] {
        if loads.is_empty() {
            notes.take(word, None, false);
        }
        for (i, load) in loads.iter().enumerate() {
            let (list, reason) = match load.is_zero() {
                true => (&mut notes.left_out, TermReason::NoLoad(load.clone())),
                false => {
                    let reads = load.reads(word == "force");
                    (&mut notes.kept, TermReason::Load(load.clone(), reads))
                }
            };
            let name = TermName {
                word,
                number: Some(i + 1),
            };
            list.push(Term { name, reason });
        }
    }
    let kept = reduced.friction.map(TermReason::Friction);
    notes.take("Coulomb friction", kept, scene.friction.is_some());
    let kept = reduced.clearance.map(TermReason::Clearance);
    notes.take("joint clearance", kept, scene.clearance.is_some());
    (notes.kept, notes.left_out)
}
