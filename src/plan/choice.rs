//! Which engine computes a motion, and why.

use std::borrow::Cow;

use super::contact::contact;
use super::cycle::{self, named};
use super::{Candidate, Engine, Method, Stepper, rubbing};
use crate::error::Error;
use crate::mechanism::{Class, Linkage, Loads};
use crate::scene::{Load, MotionKind, Scene, Variable, Variables};

/// An engine with its reason.
pub(super) struct Choice {
    pub engine: Engine,
    pub stepper: Option<Stepper>,
    pub reason: Cow<'static, str>,
}

impl Choice {
    /// An engine that has no stepper.
    pub fn of(engine: Engine, reason: impl Into<Cow<'static, str>>) -> Choice {
        Choice {
            engine,
            stepper: None,
            reason: reason.into(),
        }
    }

    /// The time engine.
    pub fn in_time(stepper: Stepper, reason: impl Into<Cow<'static, str>>) -> Choice {
        Choice {
            engine: Engine::Time,
            stepper: Some(stepper),
            reason: reason.into(),
        }
    }
}

/// What takes over where an engine that is chosen cannot go on, or not begin, in this order.
pub(super) fn after(
    choice: &Choice,
    method: Method,
    loads: &Loads,
    scene: &Scene,
) -> Vec<Candidate> {
    let in_time = |reason| Candidate {
        engine: Engine::Time,
        reason,
    };
    match (choice.engine, method) {
        (Engine::Energy, Method::Auto) => {
            let angle = choose(Method::Angle, loads, scene).ok().map(|_| Candidate {
                engine: Engine::Angle,
                reason: "if the crank comes too near to rest for the energy alone, or its turns differ and are too many to be kept",
            });
            let time = in_time("if neither serves, and where the crank comes near to rest");
            angle.into_iter().chain([time]).collect()
        }
        (Engine::Angle, _) => vec![in_time(
            "while the crank is near to rest, and if the angle does not serve",
        )],
        _ => Vec::new(),
    }
}

/// The first engine that serves a scene without parts of zero strength, or the one that is asked for.
pub(super) fn choose(method: Method, loads: &Loads, scene: &Scene) -> Result<Choice, Error> {
    if scene.clearance.is_some() {
        return contact(method);
    }
    if scene.motion.kind == MotionKind::ConstantSpeed {
        return prescribed(method);
    }
    let asked = "asked for; the loads and the start decide the motion";
    let class = Class::of(&Linkage::new(&scene.geometry));
    match method {
        Method::ClosedForm => Err(Error::refused(
            "method closed-form cannot serve a free motion",
            "use --method auto, or motion kind = \"constant-speed\"",
        )),
        Method::Dop853 => Ok(Choice::in_time(Stepper::Dop853, asked)),
        Method::Dopri5 => Ok(Choice::in_time(Stepper::Dopri5, asked)),
        Method::Time => Ok(by_sweeps()),
        Method::Auto | Method::Energy | Method::Angle => {
            if class == Class::ChangePoint {
                change_point(method)
            } else if loads.are_dry() {
                dry(method)
            } else if scene.friction.is_some() {
                rubbing::engine(method, scene, class)
            } else {
                over_angle(method, scene)
            }
        }
    }
}

fn by_sweeps() -> Choice {
    Choice::in_time(
        Stepper::Picard,
        "the loads and the start decide the motion: integration in time, by sweeps over Gauss nodes",
    )
}

fn prescribed(method: Method) -> Result<Choice, Error> {
    if matches!(method, Method::Auto | Method::ClosedForm) {
        Ok(Choice::of(
            Engine::ClosedForm,
            "the crank speed is prescribed: nothing to integrate, the equation is read backwards",
        ))
    } else {
        Err(Error::refused(
            format!("method {method} cannot serve a scene whose crank speed is prescribed"),
            "use --method auto, or motion kind = \"free\"",
        ))
    }
}

fn change_point(method: Method) -> Result<Choice, Error> {
    if method == Method::Auto {
        Ok(Choice::in_time(
            Stepper::Picard,
            "a change point: integration in time along the configuration curve",
        ))
    } else {
        Err(Error::refused(
            format!(
                "method {method} cannot serve the lengths of a change point, which it passes onto the other branch"
            ),
            "use --method auto, time, dop853 or dopri5",
        ))
    }
}

/// Loads that oppose motion turn round with the crank and with the slider.
fn dry(method: Method) -> Result<Choice, Error> {
    match method {
        Method::Auto => Ok(Choice::in_time(
            Stepper::Picard,
            "a load opposes motion: integration in time, piece by piece between the places where crank or slider turn back or rest",
        )),
        _ => Err(Error::refused(
            format!(
                "method {method} cannot serve a load of kind \"dry\", which turns round with the motion"
            ),
            "use --method auto, time, dop853 or dopri5",
        )),
    }
}

/// Without friction: the energy, else the crank angle, else the time as the independent variable.
fn over_angle(method: Method, scene: &Scene) -> Result<Choice, Error> {
    match method {
        Method::Auto | Method::Energy if why_not_energy(scene).is_none() => Ok(Choice::of(
            Engine::Energy,
            "every load depends on the position alone: omega from the energy, time from one quadrature",
        )),
        Method::Energy => Err(Error::refused(
            format!(
                "method energy cannot serve this scene: {}",
                why_not_energy(scene).unwrap_or_default()
            ),
            "use --method auto, angle, time, dop853 or dopri5",
        )),
        _ => match why_not_angle(scene) {
            None => Ok(Choice::of(
                Engine::Angle,
                "the crank turns: its energy and the time over the crank angle; where it comes near to rest, integration in time takes over",
            )),
            Some(why) if method == Method::Angle => Err(Error::refused(
                format!("method angle cannot serve this scene: {why}"),
                "use --method auto, time, dop853 or dopri5",
            )),
            Some(why) => Ok(Choice::in_time(
                Stepper::Picard,
                format!("{why}: integration in time, by sweeps over Gauss nodes"),
            )),
        },
    }
}

/// What keeps omega from following from the position: a load that depends on more, or one whose corners are not known.
fn why_not_energy(scene: &Scene) -> Option<String> {
    let position = Variables::THETA.or(Variables::X);
    let more = named(scene).find_map(|load| {
        let reads = load.reads();
        let depends = reads.or(position) != position;
        depends.then(|| {
            format!(
                "{} depends on {reads}, and its work on more than the position",
                load.name
            )
        })
    });
    more.or_else(|| why_corners(scene))
}

/// What keeps the crank angle from being the independent variable from the start: a crank at rest, a load whose corners
/// are not known, or one without a cycle that could be tabulated.
pub(super) fn why_not_angle(scene: &Scene) -> Option<String> {
    if scene.motion.speed == 0.0 {
        return Some("the crank starts at rest".to_owned());
    }
    why_corners(scene).or_else(|| cycle::over_angle(scene).err())
}

/// The first load whose corners are not known as crank angles, and why.
fn why_corners(scene: &Scene) -> Option<String> {
    named(scene).find_map(|load| {
        let why = why_rough(load.load)?;
        Some(format!("{} {why}", load.name))
    })
}

/// Why the corners of a load are not known as crank angles.
fn why_rough(load: &Load) -> Option<String> {
    match load {
        Load::Table(table) if table.of() != Variable::Theta => Some(format!(
            "has its rows over {}, not over theta",
            table.of().name()
        )),
        Load::Expression(expression) if expression.jumps() => {
            Some("may jump: step, sign, floor or mod stands in it".to_owned())
        }
        _ => None,
    }
}
