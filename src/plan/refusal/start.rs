//! Checks of the start: reachable position, possible speed, finite loads, non-zero inertia.

use crate::mechanism::{Class, Curve, CurveEquation, Limits, Linkage, LooseMechanism, single};
use crate::numeric::angle::Angle;
use crate::scene::{Clearance, Instant, Load, MotionKind, Problem, Scene};

/// Adds problems of the start of a modelled scene; `reduced` has no parts of zero strength.
pub(super) fn problems(scene: &Scene, reduced: &Scene, list: &mut Vec<Problem>) {
    let linkage = Linkage::new(&scene.geometry);
    match (reduced.clearance, scene.motion.kind) {
        (Some(clearance), _) => loose(scene, reduced, clearance, list),
        (None, MotionKind::Free) => free(reduced, &linkage, list),
        (None, MotionKind::ConstantSpeed) => driven(reduced, &linkage, list),
    }
}

fn free(scene: &Scene, linkage: &Linkage, list: &mut Vec<Problem>) {
    let (theta, speed) = (
        Angle::from(scene.motion.angle).reduced(),
        scene.motion.speed,
    );
    let Some((curve, q)) = Curve::through(linkage, theta) else {
        list.push(out_of_reach(theta, &Limits::new(linkage, speed).reach));
        return;
    };
    let place = curve.pose(q.rest);
    // Largest |dθ/dq| that rounding alone makes differ from zero.
    let rounding = 1e-12;
    if place.dtheta.abs() < rounding && speed != 0.0 {
        list.push(Problem::new(
            "motion.speed",
            "motion.speed: at motion.angle the rod stands normal to the guide, and the crank has no speed there",
            "start at rest, or away from the limit",
        ));
        return;
    }
    let pace = match speed {
        0.0 => 0.0,
        speed => speed / place.dtheta,
    };
    let equation = CurveEquation::new(scene, curve);
    let before = list.len();
    let now = Instant {
        theta: theta.radians(),
        ..equation.instant(&place, 0.0, q, pace)
    };
    loads(scene, &now, list);
    if vanishes(&equation, q.rest) {
        list.push(Problem::new(
            "motion.angle",
            format!(
                "the effective inertia vanishes at the start, theta = {} rad",
                theta.radians()
            ),
            "give the crank an inertia, or start away from the dead centre",
        ));
    } else if list.len() == before && !equation.free(0.0, q, pace).acceleration.is_finite() {
        list.push(Problem::new(
            "motion",
            format!(
                "the loads or the speed are too large to be computed with at the start, theta = {} rad: the acceleration has no value in double precision",
                theta.radians()
            ),
            "check the units of loads, speed and inertia",
        ));
    }
}

/// Whether M vanishes at coordinate `q` (rad): not a normal number, or below half its mean at `q` ± rounding.
fn vanishes(equation: &CurveEquation, q: f64) -> bool {
    let m = |q: f64| equation.terms(q).m;
    let rounding = 4.0 * f64::EPSILON * q.abs().max(1.0);
    !m(q).is_normal() || m(q) < 0.25 * (m(q - rounding) + m(q + rounding))
}

/// Adds a problem for each load without a finite value at the start.
fn loads(scene: &Scene, now: &Instant, list: &mut Vec<Problem>) {
    for of in scene.loads() {
        let value = single(of.load, of.key.on_slider, now);
        if !value.is_finite() {
            list.push(no_value(&of.key.to_string(), of.load, value, now));
        }
    }
}

fn no_value(field: &str, load: &Load, value: f64, now: &Instant) -> Problem {
    let Instant { theta, omega, .. } = *now;
    let (key, help) = match load {
        Load::Table(_) | Load::Gas { .. } => {
            ("file", "give the table rows there, or start inside them")
        }
        _ => (
            "value",
            "check the domain of its formula, and what it divides by",
        ),
    };
    Problem::new(
        &format!("{field}.{key}"),
        format!(
            "a load has no finite value at the start: {field} is {value} at t = 0, theta = {theta} rad, omega = {omega} rad/s"
        ),
        help,
    )
}

fn out_of_reach(theta: Angle, reach: &[[f64; 2]]) -> Problem {
    let range =
        |[from, to]: &[f64; 2]| format!("{:.6} to {:.6} deg", from.to_degrees(), to.to_degrees());
    let ranges: Vec<String> = reach.iter().map(range).collect();
    Problem::new(
        "motion.angle",
        format!(
            "motion.angle: the mechanism has no position at crank angle {} rad: the rod does not reach the guide or stands normal to it",
            theta.radians()
        ),
        format!("give an angle inside {}", ranges.join(" or ")),
    )
}

fn loose(scene: &Scene, reduced: &Scene, clearance: Clearance, list: &mut Vec<Problem>) {
    let mechanism = LooseMechanism::new(reduced, clearance);
    let start = mechanism.and_then(|loose| Ok(loose.instant(&loose.start(scene)?)));
    match start {
        Ok(now) => loads(reduced, &now, list),
        Err(problems) => list.extend(problems.list().iter().cloned()),
    }
}

/// Rejects a start at constant speed at a limit, at a change point or where the guide locks itself.
fn driven(scene: &Scene, linkage: &Linkage, list: &mut Vec<Problem>) {
    let mu = scene.friction.map_or(0.0, |friction| friction.coefficient);
    let theta = Angle::from(scene.motion.angle).reduced();
    if Limits::inside(&Limits::driven_reach(linkage, mu), theta.rest) {
        return;
    }
    if linkage.unlocked(mu).is_some() {
        list.push(Problem::new(
            "motion.angle",
            format!(
                "motion.angle: at crank angle {} rad the guide locks itself, as the coefficient of friction times tan phi is 1 or more: no crank torque moves it at constant speed",
                theta.radians()
            ),
            "start where |e + r sin(theta)| is less than l/sqrt(1 + coefficient^2), or reduce the friction",
        ));
    } else if Class::of(linkage) == Class::ChangePoint {
        list.push(Problem::new(
            "motion.angle",
            format!("at crank angle {} rad the mechanism is at its change point, which no constant speed passes", theta.radians()),
            "start away from it",
        ));
    } else {
        let reach = Limits::new(linkage, scene.motion.speed).reach;
        list.push(out_of_reach(theta, &reach));
    }
}
