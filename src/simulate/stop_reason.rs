//! Why a run in time ends before its time, or cannot begin, in words.

use crate::engine::step::Step;
use crate::engine::time::{FAR, Finish};
use crate::error::Error;
use crate::mechanism::{Equation, Singularity};
use crate::numeric::angle::Angle;
use crate::scene::{Extent, Instant};

pub(super) fn at_limit(last: &Step) -> String {
    format!(
        "the crank reaches the limit of its motion, where the rod stands normal to the guide: stopped at t = {} s, theta = {} rad; give the rod or the slider a mass, which carries it on",
        last.end.t,
        last.angle(last.end.theta).radians()
    )
}

/// A time (s) and its state (speed in rad/s) in words.
pub(super) fn place(t: f64, angle: Angle, speed: f64) -> String {
    let theta = angle.radians();
    format!("at t = {t} s, theta = {theta} rad, omega = {speed} rad/s")
}

pub(super) fn work_limit(place: &str) -> String {
    format!(
        "the work limit of evaluations is reached: stopped {place}; raise --max-evaluations, shorten the run or loosen the tolerance"
    )
}

pub(super) fn work_limit_ahead(place: &str) -> String {
    format!(
        "the steps have become so short that the work limit of evaluations would be reached long before the end: stopped {place}; the equation is too stiff for a method in time, or a load jumps back and forth with the speed: give dry friction as kind = \"dry\" or at the guide as [friction], and steep losses less steep, or raise --max-evaluations"
    )
}

pub(super) fn too_many_turns(place: &str) -> String {
    format!(
        "the crank turns so often that the work limit of evaluations would be reached long before the end: stopped {place}; shorten the run or raise --max-evaluations"
    )
}

/// Why a run ended before its time.
pub(super) fn reason(
    finish: Finish,
    equation: &Equation,
    impossible: Option<(f64, Angle, f64)>,
    last: &Step,
    extent: &Extent,
) -> Option<String> {
    let end = &last.end;
    let place = place(end.t, last.angle(end.theta), end.omega);
    match (finish, extent) {
        (Finish::AtEnd, Extent::Revolutions(turns)) if end.t >= FAR => Some(format!(
            "the crank does not complete {turns} turns: stopped {place}; give a duration instead"
        )),
        (Finish::AtEnd | Finish::Stopped, _) => None,
        (Finish::WorkLimit, _) => Some(work_limit(&place)),
        (Finish::WorkLimitAhead, _) => Some(work_limit_ahead(&place)),
        (Finish::TooManyTurns, _) => Some(too_many_turns(&place)),
        (Finish::StepTooSmall | Finish::NoStart, _) => {
            let (t, angle, speed) = impossible.unwrap_or((end.t, last.angle(end.theta), end.omega));
            Some(match equation.obstacle(t, angle, speed) {
                Some(Singularity::Blocked) => at_limit(last),
                Some(Singularity::Load) => no_value(equation, t, angle.radians(), speed, &place),
                Some(Singularity::NoInertia) => {
                    format!(
                        "the effective inertia vanishes: stopped {place}; give the crank an inertia"
                    )
                }
                Some(Singularity::TooLarge) => format!(
                    "a load or the crank speed is too large to be computed with: stopped {place}"
                ),
                None if nearly_vanishes(equation, last) => format!(
                    "the effective inertia nearly vanishes and the speed grows without bound: stopped {place}; give the crank an inertia, or use method energy if the loads depend on the position alone"
                ),
                None => format!(
                    "the equation is singular or too stiff for this method: stopped {place}"
                ),
            })
        }
    }
}

/// Says that a load has no finite value at a time (s), crank angle (rad) and speed (rad/s), and which.
pub(super) fn no_value(equation: &Equation, t: f64, theta: f64, omega: f64, place: &str) -> String {
    let pose = equation.linkage().pose(theta);
    let now = Instant {
        t,
        theta,
        omega,
        x: pose.x,
        v: pose.dx * omega,
    };
    let load = equation.loads().without_value(&now);
    let why = match load {
        Some(load) if load.is_tabulated() => format!(" ({load}, beyond its rows)"),
        Some(load) => format!(" ({load}, outside its domain)"),
        None => String::new(),
    };
    format!(
        "a load has no finite value at t = {t} s, theta = {theta} rad, omega = {omega} rad/s{why}: stopped {place}"
    )
}

/// Whether the inertia is next to nothing here, compared with that a radian further.
fn nearly_vanishes(equation: &Equation, last: &Step) -> bool {
    let inertia = |theta: f64| equation.terms(theta).inertia.m;
    let theta = last.end.theta;
    inertia(theta) < 1e-9 * inertia(theta + 1.0)
}

/// Why a run cannot begin from a crank angle and speed (rad/s) that nothing else is wrong with.
pub(super) fn no_start(angle: Angle, speed: f64) -> Error {
    Error::refused(
        format!(
            "no motion begins at the start, theta = {} rad, omega = {speed} rad/s: the equation has no finite acceleration next to it",
            angle.radians()
        ),
        "start at another angle, or check the loads there",
    )
}
