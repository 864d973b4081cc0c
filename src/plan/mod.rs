//! The plan: what a scene needs and which engine computes it. The one place where a scene becomes terms,
//! coordinate, events and engine; `explain` prints it.

mod contact;
mod method;
mod periodic;
mod refusal;
mod rubbing;
mod terms;

use std::borrow::Cow;

use serde::Serialize;

use contact::{contact, contact_state};
pub use method::Method;
pub(crate) use periodic::repeats_with_each_turn;
use refusal::{refuse_what_cannot_move, refuse_what_is_not_modelled, refuse_what_jams};
use terms::terms;

use crate::error::Error;
use crate::mechanism::{Class, Curve, Linkage, Loads};
use crate::numeric::angle::Angle;
use crate::scene::{Load, MotionKind, Scene, Variable, Variables};

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
    /// Flight and contact in a loose joint, in time.
    Contact,
}

impl Engine {
    /// Its name in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Engine::ClosedForm => "closed-form",
            Engine::Energy => "energy",
            Engine::Angle => "angle",
            Engine::Time => "time",
            Engine::Contact => "contact",
        }
    }
}

/// The stepper of the time engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stepper {
    /// Gauss collocation with 12 nodes (order 24), solved by Picard sweeps.
    Picard,
    /// Dormand and Prince, order 8(5,3), of ode_solvers.
    Dop853,
    /// Dormand and Prince, order 5(4), of ode_solvers.
    Dopri5,
}

/// One term that is modelled or left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Term {
    /// What it is.
    pub name: Cow<'static, str>,
    /// Why it is kept or left out.
    pub reason: Cow<'static, str>,
}

/// What will be computed, and how.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// The engine.
    pub engine: Engine,
    /// Why this engine.
    pub reason: Cow<'static, str>,
    /// The stepper, if the engine has one.
    pub stepper: Option<Stepper>,
    /// The coordinate of the motion.
    pub coordinate: &'static str,
    /// What is integrated, in this order; empty: nothing.
    pub state: Vec<&'static str>,
    /// What is looked for during the run.
    pub events: Vec<&'static str>,
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
        if engine == Engine::Contact {
            refuse_what_jams(&reduced, &linkage)?;
        } else if engine != Engine::ClosedForm {
            refuse_what_cannot_move(&reduced, &linkage)?;
        }
        let mut state = Vec::new();
        if engine == Engine::Angle {
            state.extend(["kinetic energy", "t"]);
        }
        if engine == Engine::Time {
            state.extend(["theta", "omega"]);
            if !loads.have_potential() || reduced.friction.is_some() {
                state.push("work of the loads");
            }
            if loads.reads().has(Variable::T) {
                state.push("t");
            }
        }
        if engine == Engine::Contact {
            state.extend(contact_state(prescribed));
        }
        let mut events = vec!["dead-centre"];
        if engine == Engine::Contact {
            events.extend(["impact", "separation"]);
        }
        if engine != Engine::ClosedForm && !(engine == Engine::Contact && prescribed) {
            events.push("turning-point");
        }
        let on_curve = (engine == Engine::Time)
            .then(|| Curve::through(&linkage, Angle::from(scene.motion.angle).reduced()))
            .flatten();
        let coordinate = on_curve.map_or("crank angle theta", |(curve, _)| curve.coordinate());
        if engine == Engine::Time && Class::of(&linkage) != Class::RotatingCrank {
            events.push("limit");
            state[0] = "coordinate q";
            state[1] = "its speed";
        }
        if engine != Engine::ClosedForm && reduced.friction.is_some() {
            events.extend(["stick", "slip", "rest"]);
        }
        Ok(Plan {
            engine,
            reason,
            stepper,
            coordinate: match engine {
                Engine::Contact => "crank angle theta, direction psi of the rod, slider position x",
                _ => coordinate,
            },
            state,
            events,
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

/// Whether the crank turns, the corners of the loads are known, and one table of a turn serves all turns.
fn angle_serves(scene: &Scene) -> bool {
    scene.motion.speed != 0.0
        && scene.torques.iter().chain(&scene.forces).all(is_smooth)
        && repeats_with_each_turn(scene)
}

/// Whether the corners of a load are known as crank angles, if it has any.
fn is_smooth(load: &Load) -> bool {
    match load {
        Load::Table(table) => table.of() == Variable::Theta,
        Load::Expression(expression) => !expression.jumps(),
        _ => true,
    }
}

fn engine(
    prescribed: bool,
    method: Method,
    loads: &Loads,
    scene: &Scene,
) -> Result<(Engine, Option<Stepper>, Cow<'static, str>), Error> {
    let reason = |text: &'static str| Cow::Borrowed(text);
    let class = Class::of(&Linkage::new(&scene.geometry));
    let crosses = class == Class::ChangePoint;
    if scene.clearance.is_some() {
        return contact(method);
    }
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
        (Method::Energy | Method::Angle, false) if crosses => Err(Error::refused(
            format!(
                "method {method} cannot serve the lengths of a change point, which it passes onto the other branch"
            ),
            "use --method auto, time, dop853 or dopri5",
        )),
        (Method::Auto, false) if crosses => Ok((
            Engine::Time,
            Some(Stepper::Picard),
            reason("a change point: integration in time along the configuration curve"),
        )),
        (Method::Auto | Method::Energy | Method::Angle, false) if scene.friction.is_some() => {
            rubbing::engine(method, scene, class)
        }
        (Method::Auto | Method::Energy, false) if energy_serves(loads, scene) => Ok((
            Engine::Energy,
            None,
            reason(
                "every load depends on the position alone: omega from the energy, time from one quadrature",
            ),
        )),
        (Method::Energy, false) => Err(Error::refused(
            format!(
                "method energy cannot serve these loads, which depend on {}",
                loads.reads()
            ),
            "use --method auto; energy needs loads of theta and x alone, tables over theta only, and formulas without step, sign, floor and mod",
        )),
        (Method::Auto | Method::Angle, false) if angle_serves(scene) => Ok((
            Engine::Angle,
            None,
            reason(
                "the crank turns: its energy and the time over the crank angle; where it comes near to rest, integration in time takes over",
            ),
        )),
        (Method::Angle, false) => Err(Error::refused(
            "method angle needs a crank that turns from the start, tables over theta only, formulas without step, sign, floor and mod, and loads over theta that repeat with each turn",
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
            Some(Stepper::Picard),
            reason(
                "the loads and the start decide the motion: integration in time, by sweeps over Gauss nodes",
            ),
        )),
    }
}
