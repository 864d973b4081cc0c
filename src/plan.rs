//! The plan: what a scene needs and which engine computes it. The one place where a scene becomes terms,
//! coordinate, events and engine; `explain` prints it.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use crate::error::Error;
use crate::mechanism::{Class, Limits, Linkage, Loads};
use crate::scene::{Load, MotionKind, RodModel, Scene, Variable, Variables};

/// What the user asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Whatever the plan finds best.
    #[default]
    Auto,
    /// Prescribed motion, no integration.
    ClosedForm,
    /// Energy integral.
    Energy,
    /// Crank angle as the independent variable.
    Angle,
    /// Integration in time with the default method.
    Time,
    /// Integration in time with Dop853 of ode_solvers.
    Dop853,
    /// Integration in time with Dopri5 of ode_solvers.
    Dopri5,
}

impl Method {
    const ALL: [(&'static str, Method); 7] = [
        ("auto", Method::Auto),
        ("closed-form", Method::ClosedForm),
        ("energy", Method::Energy),
        ("angle", Method::Angle),
        ("time", Method::Time),
        ("dop853", Method::Dop853),
        ("dopri5", Method::Dopri5),
    ];
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        Method::ALL
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, method)| *method)
            .ok_or_else(|| {
                let names: Vec<_> = Method::ALL.iter().map(|(name, _)| *name).collect();
                format!("use one of {}", names.join(", "))
            })
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Method::ALL.iter().find(|(_, method)| method == self);
        f.write_str(name.map_or("", |(name, _)| name))
    }
}

/// What computes the motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Engine {
    /// Prescribed motion; the equation is read backwards.
    ClosedForm,
    /// The energy integral: loads that depend on the position alone.
    Energy,
    /// The crank angle as the independent variable: loads that depend on speed and time too.
    Angle,
    /// Integration in time.
    Time,
}

impl Engine {
    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Engine::ClosedForm => "closed-form",
            Engine::Energy => "energy",
            Engine::Angle => "angle",
            Engine::Time => "time",
        }
    }
}

/// The stepper of the time engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stepper {
    /// Dormand and Prince, order 8(5,3), of ode_solvers.
    Dop853,
    /// Dormand and Prince, order 5(4), of ode_solvers.
    Dopri5,
}

/// One term that is modelled or left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Term {
    /// What it is.
    pub name: String,
    /// Why it is kept or left out.
    pub reason: String,
}

/// What will be computed, and how.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The engine.
    pub engine: Engine,
    /// Why this engine.
    pub reason: String,
    /// The stepper, if the engine has one.
    pub stepper: Option<Stepper>,
    /// The coordinate of the motion.
    pub coordinate: String,
    /// What is integrated, in this order; empty: nothing.
    pub state: Vec<String>,
    /// What is looked for during the run.
    pub events: Vec<String>,
    /// Terms of the equation.
    pub kept: Vec<Term>,
    /// Terms that are not modelled.
    pub left_out: Vec<Term>,
}

impl Plan {
    /// Plans a scene.
    ///
    /// # Errors
    /// [`Error::Scene`] for impossible values, [`Error::Refused`] for a scene that cannot be computed or a
    /// method that cannot serve it, with the reason.
    pub fn new(scene: &Scene, method: Method) -> Result<Plan, Error> {
        scene.check()?;
        let reduced = scene.reduced();
        let linkage = Linkage::new(&scene.geometry);
        refuse_what_is_not_modelled(&reduced)?;
        let (kept, left_out) = terms(scene, &reduced);
        let loads = Loads::new(&reduced);
        let prescribed = scene.motion.kind == MotionKind::ConstantSpeed;
        let (engine, stepper, reason) = engine(prescribed, method, &loads, &reduced)?;
        if engine != Engine::ClosedForm {
            refuse_what_cannot_move(&reduced, &linkage)?;
        }
        let mut state = Vec::new();
        if engine == Engine::Angle {
            state.extend(["kinetic energy", "t"]);
        }
        if engine == Engine::Time {
            state.extend(["theta", "omega"]);
            if !loads.have_potential() {
                state.push("work of the loads");
            }
            if loads.reads().has(Variable::T) {
                state.push("t");
            }
        }
        let mut events = vec!["dead-centre"];
        if engine != Engine::ClosedForm {
            events.push("turning-point");
        }
        if engine == Engine::Time && linkage.margin() < 0.0 {
            events.push("limit");
        }
        Ok(Plan {
            engine,
            reason,
            stepper,
            coordinate: "crank angle theta".to_owned(),
            state: state.into_iter().map(str::to_owned).collect(),
            events: events.into_iter().map(str::to_owned).collect(),
            kept,
            left_out,
        })
    }
}

/// Whether every load depends on the position alone, and its corners are known.
fn energy_serves(loads: &Loads, scene: &Scene) -> bool {
    let position = Variables::THETA.or(Variables::X);
    loads.reads().or(position) == position
        && scene.torques.iter().chain(&scene.forces).all(is_smooth)
}

/// Whether the crank turns and the corners of the loads are known.
fn angle_serves(scene: &Scene) -> bool {
    scene.motion.speed != 0.0 && scene.torques.iter().chain(&scene.forces).all(is_smooth)
}

/// Whether the corners of a load are known as crank angles, if it has any.
fn is_smooth(load: &Load) -> bool {
    match load {
        Load::Table(table) => table.of() == Variable::Theta,
        _ => true,
    }
}

fn engine(
    prescribed: bool,
    method: Method,
    loads: &Loads,
    scene: &Scene,
) -> Result<(Engine, Option<Stepper>, String), Error> {
    let reason = |text: &str| text.to_owned();
    match (method, prescribed) {
        (Method::Auto | Method::ClosedForm, true) => Ok((
            Engine::ClosedForm,
            None,
            reason(
                "the crank speed is prescribed: nothing to integrate, the equation is read backwards",
            ),
        )),
        (_, true) => Err(Error::refused(
            format!("method {method} cannot serve a scene whose crank speed is prescribed"),
            "use --method auto, or motion kind = \"free\"",
        )),
        (Method::ClosedForm, false) => Err(Error::refused(
            "method closed-form cannot serve a free motion",
            "use --method auto, or motion kind = \"constant-speed\"",
        )),
        (Method::Auto | Method::Energy, false) if energy_serves(loads, scene) => Ok((
            Engine::Energy,
            None,
            reason(
                "every load depends on the position alone: omega from the energy, time from one quadrature",
            ),
        )),
        (Method::Energy, false) => Err(Error::refused(
            format!(
                "method energy cannot serve loads that depend on {}",
                loads.reads()
            ),
            "use --method auto; energy needs loads of theta and x alone, and tables over theta only",
        )),
        (Method::Auto | Method::Angle, false) if angle_serves(scene) => Ok((
            Engine::Angle,
            None,
            reason("the crank turns: its energy and the time over the crank angle"),
        )),
        (Method::Angle, false) => Err(Error::refused(
            "method angle needs a crank that turns from the start, and tables over theta only",
            "use --method auto, time, dop853 or dopri5",
        )),
        (Method::Dopri5, false) => Ok((
            Engine::Time,
            Some(Stepper::Dopri5),
            reason("asked for; the loads and the start decide the motion"),
        )),
        (Method::Dop853, false) => Ok((
            Engine::Time,
            Some(Stepper::Dop853),
            reason("asked for; the loads and the start decide the motion"),
        )),
        (Method::Auto | Method::Time, false) => Ok((
            Engine::Time,
            Some(Stepper::Dop853),
            reason("the loads and the start decide the motion: integration in time, order 8"),
        )),
    }
}

fn refuse_what_is_not_modelled(scene: &Scene) -> Result<(), Error> {
    if scene.friction.is_some() {
        return Err(Error::refused(
            "Coulomb friction in motion is not part of this version",
            "take [friction] out of the scene, or set its coefficient to 0",
        ));
    }
    if scene.clearance.is_some() {
        return Err(Error::refused(
            "clearance is not part of this version",
            "take [clearance] out of the scene, or set radial to 0",
        ));
    }
    Ok(())
}

fn refuse_what_cannot_move(scene: &Scene, linkage: &Linkage) -> Result<(), Error> {
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

/// Terms kept, terms left out.
fn terms(scene: &Scene, reduced: &Scene) -> (Vec<Term>, Vec<Term>) {
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
    note("Coulomb friction", false, absent(scene.friction.is_some()));
    note("joint clearance", false, absent(scene.clearance.is_some()));
    (kept, left_out)
}
