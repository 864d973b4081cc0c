//! Terms of the equation that a scene keeps or leaves out, with the reasons, displayed in words.

use std::borrow::Cow;
use std::fmt;

use serde::Serialize;

use crate::scene::{Clearance, Friction, Load, LoadOf, RodModel, Scene, Variables};

/// Term of the equation, modelled or left out.
#[derive(Clone, Debug, Serialize)]
pub struct Term {
    /// Name of the term, like `gravity` or `torque[1]`.
    pub name: Cow<'static, str>,
    /// Why the term is kept or left out.
    #[serde(serialize_with = "shown")]
    pub reason: TermReason,
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
    /// Load in the model.
    Load {
        /// The load.
        load: Load,
        /// Variables it depends on.
        reads: Variables,
        /// Whether it opposes motion and may hold its body at rest.
        holds: bool,
    },
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
            TermReason::Load { load, reads, holds } => {
                let holds = if *holds { "; holds at rest" } else { "" };
                write!(f, "{load}; depends on {reads}{holds}")
            }
            TermReason::Friction(friction) => {
                let (kinetic, held) = (friction.coefficient, friction.static_coefficient);
                write!(f, "at the guide, coefficient {kinetic}, static {held}")
            }
            TermReason::Clearance(clearance) => {
                let joint = clearance.joint.name().replace('-', " ");
                let (radial, law) = (clearance.radial, clearance.law.name());
                write!(f, "{radial} m at the {joint}, contact law {law}")
            }
        }
    }
}

/// Returns the terms kept and the terms left out; `reduced` is `scene` without parts of zero strength.
pub(super) fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
    let crank = reduced.crank.map(|crank| TermReason::Crank(crank.inertia));
    let rod = reduced.rod.map(|rod| TermReason::Rod(rod.mass, rod.model));
    let slider = reduced.slider.map(|slider| TermReason::Slider(slider.mass));
    let gravity = reduced.gravity.map(|g| TermReason::Gravity(g.vector()));
    let friction = reduced.friction.map(TermReason::Friction);
    let clearance = reduced.clearance.map(TermReason::Clearance);
    let mut terms = vec![
        part("crank inertia", crank, scene.crank.is_some()),
        part("connecting rod inertia", rod, scene.rod.is_some()),
        part("slider inertia", slider, scene.slider.is_some()),
        part("gravity", gravity, scene.gravity.is_some()),
    ];
    let is_loose = reduced.clearance.is_some();
    let (forces, torques): (Vec<_>, Vec<_>) = scene.loads().partition(|of| of.key.on_slider);
    for (word, loads) in [("torque", torques), ("force", forces)] {
        terms.extend(loads.is_empty().then(|| part(word, None, false)));
        terms.extend(loads.iter().map(|of| load(of, is_loose)));
    }
    terms.extend([
        part("Coulomb friction", friction, scene.friction.is_some()),
        part("joint clearance", clearance, scene.clearance.is_some()),
    ]);
    let (mut kept, mut left_out) = (Vec::new(), Vec::new());
    for (name, reason) in terms {
        match reason {
            Ok(reason) => kept.push(Term { name, reason }),
            Err(reason) => left_out.push(Term { name, reason }),
        }
    }
    (kept, left_out)
}

/// Name of a term, with the reason to keep it, or with the reason, as the error, to leave it out.
type Reasoned = (Cow<'static, str>, Result<TermReason, TermReason>);

/// Returns a part as kept, with the reason; else as left out: of zero strength if `is_given`, otherwise absent.
fn part(name: &'static str, kept: Option<TermReason>, is_given: bool) -> Reasoned {
    let absent = match is_given {
        true => TermReason::Zero,
        false => TermReason::Absent,
    };
    (name.into(), kept.ok_or(absent))
}

/// Returns a load as kept or left out; with a loose joint nothing is held at rest.
fn load(of: &LoadOf<'_>, is_loose: bool) -> Reasoned {
    let load = of.load.clone();
    let is_dry = |part: &Load| matches!(part, Load::Dry(_));
    let reason = match load.is_zero() {
        true => Err(TermReason::NoLoad(load)),
        false => Ok(TermReason::Load {
            holds: !is_loose && load.parts(of.key.on_slider).iter().any(is_dry),
            load,
            reads: of.reads(),
        }),
    };
    (of.key.to_string().into(), reason)
}
