//! Plan: takes a scene, returns the engine and its successors in order, the terms, coordinate, state and events, by
//! decision rules with reasons. The only place that decides them; `explain` prints it.

mod choice;
mod cycle;
mod method;
mod refusal;
mod terms;

use std::borrow::Cow;

use serde::Serialize;

use choice::{choose, successors};
pub(crate) use cycle::cycle_over_angle;
pub use cycle::{Cycle, LoadPeriod};
pub use method::Method;
pub use refusal::refuse;
use refusal::{modelled, not_modelled};
pub use terms::Term;
use terms::{TermLists, terms};

use crate::error::Error;
use crate::mechanism::{Class, Curve, Linkage, Loads};
use crate::numeric::angle::Angle;
use crate::scene::{MotionKind, Scene, Variable};

named! {
    /// Engine that computes a motion.
    #[derive(Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Engine {
        /// Prescribed crank speed: the equation gives the driving torque, without integration.
        ClosedForm = "closed-form",
        /// Energy integral, for loads that depend on the position alone.
        Energy = "energy",
        /// Crank angle as the independent variable, for loads that may also depend on speed and time.
        Angle = "angle",
        /// Integration in time.
        Time = "time",
        /// Integration in time of flight and contact in a joint with clearance.
        Contact = "contact",
    }
}

named! {
    /// One-step method of the time engine, named in words.
    #[derive(Serialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Stepper {
        /// Gauss collocation with 12 nodes (order 24), solved by Picard iteration.
        Picard = "Gauss collocation of order 24, by Picard sweeps",
        /// Dormand and Prince, order 8(5,3), of ode_solvers.
        Dop853 = "Dop853 of ode_solvers",
        /// Dormand and Prince, order 5(4), of ode_solvers.
        Dopri5 = "Dopri5 of ode_solvers",
    }
}

/// Engine with the reason for it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Candidate {
    /// The engine.
    pub engine: Engine,
    /// Reason for the first engine, or condition under which another takes over.
    pub reason: Cow<'static, str>,
}

impl Candidate {
    fn new(engine: Engine, reason: impl Into<Cow<'static, str>>) -> Candidate {
        let reason = reason.into();
        Candidate { engine, reason }
    }
}

/// Engines, coordinate, state, load cycle, events and terms of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Plan {
    /// First engine.
    pub engine: Engine,
    /// Reason for the first engine.
    pub reason: Cow<'static, str>,
    /// Engines that may take over where another cannot go on, in this order; the pieces of a run tell which did.
    pub then: Vec<Candidate>,
    /// Stepper of the first engine, if it has one.
    pub stepper: Option<Stepper>,
    /// Coordinate of the motion, in words.
    pub coordinate: &'static str,
    /// Integrated quantities, in this order; empty: none.
    pub state: Vec<&'static str>,
    /// Cycle of the loads over the crank angle.
    pub cycle: Cycle,
    /// Kinds of events that are located during the run.
    pub events: Vec<&'static str>,
    /// Terms of the equation that are modelled.
    pub kept: Vec<Term>,
    /// Terms of the equation that are not modelled.
    pub left_out: Vec<Term>,
}

impl Plan {
    /// Plans a scene.
    ///
    /// # Errors
    /// [`Error::Scene`] for impossible values and what is not modelled, [`Error::Refused`] for a method that cannot
    /// serve.
    pub fn new(scene: &Scene, method: Method) -> Result<Plan, Error> {
        scene.check()?;
        let reduced = scene.reduced();
        scene
            .places
            .reject_any(not_modelled(&reduced, &Linkage::new(&scene.geometry)))?;
        Plan::of_modelled(scene, reduced, method)
    }

    /// Plans the run of a scene, after the checks of [`refuse`].
    ///
    /// # Errors
    /// Errors of [`refuse`] and of [`Plan::new`].
    pub(crate) fn of_run(scene: &Scene, method: Method) -> Result<Plan, Error> {
        Plan::of_modelled(scene, modelled(scene)?, method)
    }

    fn of_modelled(scene: &Scene, reduced: Scene, method: Method) -> Result<Plan, Error> {
        let linkage = Linkage::new(&scene.geometry);
        let loads = Loads::new(&reduced);
        let Candidate { engine, reason } = choose(method, &reduced, &loads)?;
        let TermLists { kept, left_out } = terms(scene, &reduced);
        Ok(Plan {
            engine,
            reason,
            then: successors(engine, method, &reduced, &loads),
            stepper: (engine == Engine::Time).then_some(match method {
                Method::Dop853 => Stepper::Dop853,
                Method::Dopri5 => Stepper::Dopri5,
                _ => Stepper::Picard,
            }),
            coordinate: coordinate(engine, &reduced, &linkage),
            state: state(engine, &reduced, &loads),
            cycle: Cycle::of(scene),
            events: events(engine, &reduced, &loads),
            kept,
            left_out,
        })
    }

    /// Whether an engine may compute a part of a run.
    pub(crate) fn has(&self, engine: Engine) -> bool {
        self.engine == engine || self.then.iter().any(|candidate| candidate.engine == engine)
    }
}

fn is_prescribed(scene: &Scene) -> bool {
    scene.motion.kind == MotionKind::ConstantSpeed
}

/// Whether the crank has limits or a change point.
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
            if loads.reads.has(Variable::T) {
                state.push("t");
            }
            state
        }
    }
}

fn events(engine: Engine, scene: &Scene, loads: &Loads) -> Vec<&'static str> {
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
    let may_stick = scene.friction.is_some() || loads.are_dry();
    if engine != Engine::ClosedForm && may_stick {
        events.extend(["stick", "slip"]);
        if engine != Engine::Contact {
            events.push("rest");
        }
    }
    events
}
