//! Selects the engine of a motion from clearance, prescribed speed, class, loads and start, with the reason.

use super::cycle::{cycle_over_angle, non_zero};
use super::{Candidate, Engine, Method};
use crate::error::Error;
use crate::mechanism::{Class, Curve, CurveEquation, Linkage, Loads};
use crate::numeric::{dip, maximum};
use crate::scene::{Load, MotionKind, Scene, Variable, Variables};

/// Returns the engines that take over where the chosen engine cannot start or continue, in this order.
pub(super) fn successors(
    first: Engine,
    method: Method,
    scene: &Scene,
    loads: &Loads,
) -> Vec<Candidate> {
    match (first, method) {
        (Engine::Energy, Method::Auto) => {
            let angle = choose(Method::Angle, scene, loads).ok().map(|_| {
                Candidate::new(
                    Engine::Angle,
                    "if the crank comes too near to rest for the energy alone, or its turns differ and are too many to be kept",
                )
            });
            let time = Candidate::new(
                Engine::Time,
                "if neither serves, and where the crank comes near to rest",
            );
            angle.into_iter().chain([time]).collect()
        }
        (Engine::Angle, _) => vec![Candidate::new(
            Engine::Time,
            "while the crank is near to rest, and if the angle does not serve",
        )],
        _ => Vec::new(),
    }
}

const METHODS_IN_TIME: &str = "use --method auto, time, dop853 or dopri5";
const METHODS_WITHOUT_ENERGY: &str = "use --method auto, angle, time, dop853 or dopri5";

/// Selects the first engine that serves a scene without parts of zero strength, or the engine that `method` asks for.
pub(super) fn choose(method: Method, scene: &Scene, loads: &Loads) -> Result<Candidate, Error> {
    if scene.clearance.is_some() {
        return only_if(
            method,
            &[Method::Auto],
            Candidate::new(
                Engine::Contact,
                "a joint has clearance: rod and slider move freely of it but for the contact force; flight and contact are integrated apart",
            ),
            "a scene with clearance in a joint",
            "use --method auto, or take [clearance] out of the scene",
        );
    }
    if scene.motion.kind == MotionKind::ConstantSpeed {
        return only_if(
            method,
            &[Method::Auto, Method::ClosedForm],
            Candidate::new(
                Engine::ClosedForm,
                "the crank speed is prescribed: nothing to integrate, the equation is read backwards",
            ),
            "a scene whose crank speed is prescribed",
            "use --method auto, or motion kind = \"free\"",
        );
    }
    let class = Class::of(&Linkage::new(&scene.geometry));
    match method {
        Method::ClosedForm => Err(cannot_serve(
            method,
            "a free motion",
            "use --method auto, or motion kind = \"constant-speed\"",
        )),
        Method::Dop853 | Method::Dopri5 => Ok(Candidate::new(
            Engine::Time,
            "asked for; the loads and the start decide the motion",
        )),
        Method::Time => Ok(Candidate::new(
            Engine::Time,
            "the loads and the start decide the motion: integration in time, by sweeps over Gauss nodes",
        )),
        _ if class == Class::ChangePoint => only_if(
            method,
            &[Method::Auto],
            Candidate::new(
                Engine::Time,
                "a change point: integration in time along the configuration curve",
            ),
            "the lengths of a change point, which it passes onto the other branch",
            METHODS_IN_TIME,
        ),
        _ => energy_angle_or_time(method, scene, loads, class),
    }
}

/// Returns `choice`, the only engine that serves the scene, if `method` is one of `methods`; otherwise refuses.
fn only_if(
    method: Method,
    methods: &[Method],
    choice: Candidate,
    what: &str,
    help: &str,
) -> Result<Candidate, Error> {
    match methods.contains(&method) {
        true => Ok(choice),
        false => Err(cannot_serve(method, what, help)),
    }
}

fn cannot_serve(method: Method, what: &str, help: &str) -> Error {
    Error::refused(format!("method {method} cannot serve {what}"), help)
}

/// Selects the energy integral, else the crank angle, else the time as the independent variable.
fn energy_angle_or_time(
    method: Method,
    scene: &Scene,
    loads: &Loads,
    class: Class,
) -> Result<Candidate, Error> {
    let has_friction = scene.friction.is_some();
    let without_energy = match has_friction {
        true => Some("Coulomb friction, whose work depends on the speed".to_owned()),
        false => why_not_energy(scene).map(|why| format!("this scene: {why}")),
    };
    match (method, without_energy) {
        (Method::Auto | Method::Energy, None) => {
            return Ok(Candidate::new(
                Engine::Energy,
                "every load depends on the position alone: omega from the energy, time from one quadrature",
            ));
        }
        (Method::Energy, Some(what)) => {
            return Err(cannot_serve(method, &what, METHODS_WITHOUT_ENERGY));
        }
        _ => {}
    }
    match why_not_angle(scene, loads, class) {
        None => Ok(Candidate::new(
            Engine::Angle,
            match has_friction {
                true => {
                    "the crank turns: its energy and the time over the crank angle, with Coulomb friction piece by piece between its changes; where it comes near to rest, integration in time takes over"
                }
                false => {
                    "the crank turns: its energy and the time over the crank angle; where it comes near to rest, integration in time takes over"
                }
            },
        )),
        Some(why) if method == Method::Angle => {
            let what = match has_friction {
                true => format!("this motion with Coulomb friction: {why}"),
                false => format!("this scene: {why}"),
            };
            Err(cannot_serve(method, &what, METHODS_IN_TIME))
        }
        Some(why) => Ok(Candidate::new(
            Engine::Time,
            match has_friction {
                true => format!(
                    "Coulomb friction, and {why}: integration in time, piece by piece between its changes"
                ),
                false => format!("{why}: integration in time, by sweeps over Gauss nodes"),
            },
        )),
    }
}

/// Returns why omega does not follow from the position: a load depends on more, or its corners are not known.
fn why_not_energy(scene: &Scene) -> Option<String> {
    let position = Variables::THETA.or(Variables::X);
    let more = non_zero(scene).find_map(|of| {
        let reads = of.reads();
        let depends = reads.or(position) != position;
        depends.then(|| format!("{of} depends on {reads}, and its work on more than the position"))
    });
    more.or_else(|| why_corners_are_unknown(scene))
}

/// Returns why the crank angle cannot be the independent variable from the start: the crank is at rest, a load has
/// unknown corners or no cycle to tabulate; where it may stick also: the crank cannot turn fully, or the guide jams.
fn why_not_angle(scene: &Scene, loads: &Loads, class: Class) -> Option<String> {
    let has_friction = scene.friction.is_some();
    if (has_friction || loads.are_dry()) && class != Class::RotatingCrank {
        return Some("the crank cannot turn fully".to_owned());
    }
    if scene.motion.speed == 0.0 {
        return Some("the crank starts at rest".to_owned());
    }
    let why = why_corners_are_unknown(scene).or_else(|| cycle_over_angle(scene).err());
    if why.is_none() && has_friction && jams(scene) {
        return Some("the slider jams in its guide at an angle of the turn".to_owned());
    }
    why
}

/// Whether rigid bodies jam (μ |κ| ≥ 1) at a crank angle of a turn.
fn jams(scene: &Scene) -> bool {
    let linkage = Linkage::new(&scene.geometry);
    let guide = CurveEquation::new(scene, Curve::on_crank(&linkage));
    let mu = guide.friction.map_or(0.0, |friction| friction.coefficient);
    let clear = |theta: f64| 1.0 - mu * guide.terms(theta).normal().force.abs();
    let grid = linkage.turn_grid(true).into_iter();
    let known: Vec<(f64, f64)> = grid.map(|theta| (theta, clear(theta))).collect();
    let dips = |three: &[(f64, f64)]| {
        let [a, b, c] = [three[0], three[1], three[2]];
        dip::may_dip([a.0, b.0, c.0], [a.1, b.1, c.1])
            && maximum::largest(|theta| -clear(theta), a.0, c.0).1 >= 0.0
    };
    known.iter().any(|(_, clear)| *clear <= 0.0) || known.windows(3).any(dips)
}

/// Returns the first load whose corners are not known as crank angles, and why.
fn why_corners_are_unknown(scene: &Scene) -> Option<String> {
    non_zero(scene).find_map(|of| match of.load.magnitude() {
        Load::Table(table) if !matches!(table.of(), Variable::Theta | Variable::X) => {
            let rows_over = table.of().name();
            Some(format!(
                "{of} has its rows over {rows_over}, not over theta or x"
            ))
        }
        Load::Expression(expression) if expression.jumps() => Some(format!(
            "{of} may jump: step, sign, floor or mod stands in it"
        )),
        _ => None,
    })
}
