//! The plan: what a scene needs and which engine computes it. The one place where a scene becomes terms,
//! coordinate, events and engine; `explain` prints it.

mod choice;
mod cycle;
mod method;
mod refusal;
mod terms;

use std::borrow::Cow;

use serde::Serialize;

use choice::{after, choose};
pub(crate) use cycle::over_angle as cycle_over_angle;
pub use cycle::{Cycle, LoadPeriod};
pub use method::Method;
pub use refusal::refuse;
use refusal::{modelled, not_modelled};
use terms::terms;
pub use terms::{Term, TermName, TermReason};

use crate::error::Error;
use crate::mechanism::{Class, Curve, Linkage, Loads};
use crate::numeric::angle::Angle;
use crate::scene::{MotionKind, Scene, Variable};

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
    /// Name in outputs.
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

impl Stepper {
    /// Name in words.
    pub fn name(self) -> &'static str {
        match self {
            Stepper::Picard => "Gauss collocation of order 24, by Picard sweeps",
            Stepper::Dop853 => "Dop853 of ode_solvers",
            Stepper::Dopri5 => "Dopri5 of ode_solvers",
        }
    }
}

/// An engine that may take over.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Candidate {
    /// The engine.
    pub engine: Engine,
    /// When it does.
    pub reason: &'static str,
}

/// What will be computed, and how.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// The engine.
    pub engine: Engine,
    /// Why this engine.
    pub reason: Cow<'static, str>,
    /// What takes over where that engine cannot go on, in this order; which engines computed a run is told by its pieces.
    pub then: Vec<Candidate>,
    /// The stepper, if the engine has one.
    pub stepper: Option<Stepper>,
    /// The coordinate of the motion.
    pub coordinate: &'static str,
    /// What is integrated, in this order; empty: nothing.
    pub state: Vec<&'static str>,
    /// After how many turns the loads are the same again.
    pub cycle: Cycle,
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
    /// [`Error::Scene`] for impossible values and for what is not modelled, [`Error::Refused`] for a method that cannot
    /// serve the scene, with the reason.
    pub fn new(scene: &Scene, method: Method) -> Result<Plan, Error> {
        scene.check()?;
        let reduced = scene.reduced();
        scene.refused(not_modelled(&reduced, &Linkage::new(&scene.geometry)))?;
        Plan::of_modelled(scene, reduced, method)
    }

    /// Plans a scene whose motion can be modelled, begun and ended.
    ///
    /// # Errors
    /// Those of [`refuse`] and of [`Plan::new`].
    pub(crate) fn of_run(scene: &Scene, method: Method) -> Result<Plan, Error> {
        Plan::of_modelled(scene, modelled(scene)?, method)
    }

    fn of_modelled(scene: &Scene, reduced: Scene, method: Method) -> Result<Plan, Error> {
        let linkage = Linkage::new(&scene.geometry);
        let loads = Loads::new(&reduced);
        let choice = choose(method, &loads, &reduced)?;
        let (kept, left_out) = terms(scene, &reduced);
        Ok(Plan {
            then: after(&choice, method, &loads, &reduced),
            engine: choice.engine,
            reason: choice.reason,
            stepper: choice.stepper,
            coordinate: coordinate(choice.engine, &reduced, &linkage),
            state: state(choice.engine, &reduced, &loads),
            cycle: Cycle::of(scene),
            events: events(choice.engine, &reduced),
            kept,
            left_out,
        })
    }

    /// Whether an engine may compute a part of a run.
    pub(crate) fn has(&self, engine: Engine) -> bool {
        let then = self.then.iter().map(|candidate| candidate.engine);
        self.engine == engine || then.into_iter().any(|then| then == engine)
    }
}

fn is_prescribed(scene: &Scene) -> bool {
    scene.motion.kind == MotionKind::ConstantSpeed
}

/// Whether the crank meets limits of its motion, or a change point.
fn is_limited(scene: &Scene) -> bool {
    Class::of(&Linkage::new(&scene.geometry)) != Class::RotatingCrank
}

fn coordinate(engine: Engine, scene: &Scene, linkage: &Linkage) -> &'static str {
    let crank = "crank angle theta";
    match engine {
        Engine::Contact => "crank angle theta, direction psi of the rod, slider position x",
        Engine::Time => Curve::through(linkage, Angle::from(scene.motion.angle).reduced())
            .map_or(crank, |(curve, _)| curve.coordinate()),
        _ => crank,
    }
}

fn state(engine: Engine, scene: &Scene, loads: &Loads) -> Vec<&'static str> {
    match engine {
        Engine::ClosedForm | Engine::Energy => Vec::new(),
        Engine::Angle => vec!["kinetic energy", "t"],
        Engine::Contact => {
            let crank: &[_] = match is_prescribed(scene) {
                true => &[],
                false => &["theta", "omega"],
            };
            let free: &[_] = &["psi", "x", "psi.", "v", "work", "energy lost"];
            [&["t"], crank, free].concat()
        }
        Engine::Time => {
            let mut state = match is_limited(scene) {
                true => vec!["coordinate q", "its speed"],
                false => vec!["theta", "omega"],
            };
            if !loads.have_potential() || scene.friction.is_some() {
                state.push("work of the loads");
            }
            if loads.reads().has(Variable::T) {
                state.push("t");
            }
            state
        }
    }
}

fn events(engine: Engine, scene: &Scene) -> Vec<&'static str> {
    let mut events = vec!["dead-centre"];
    if engine == Engine::Contact {
        events.extend(["impact", "separation"]);
    }
    if !is_prescribed(scene) {
        events.push("turning-point");
    }
    if engine == Engine::Time && is_limited(scene) {
        events.push("limit");
    }
    let dry = engine == Engine::Time && Loads::new(scene).are_dry();
    if engine != Engine::ClosedForm && scene.friction.is_some() || dry {
        events.extend(["stick", "slip"]);
        if engine != Engine::Contact {
            events.push("rest");
        }
    }
    events
}
