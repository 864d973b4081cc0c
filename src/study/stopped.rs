//! Why a run in time ends before its time, or cannot begin, in words.

use std::f64::consts::TAU;

use super::in_time::FAR;
use crate::engine::Motion;
use crate::engine::step::Step;
use crate::engine::time::{Finish, Start};
use crate::error::Error;
use crate::mechanism::{Equation, Limits, Obstacle};
use crate::numeric::angle::Angle;
use crate::scene::Extent;

pub(super) fn at_limit(last: &Step) -> String {
    format!(
        "the crank reaches the limit of its motion, where the rod stands normal to the guide: stopped at t = {} s, theta = {} rad; give the rod or the slider a mass, which carries it on",
        last.end.t,
        last.angle(last.end.theta).radians()
    )
}

/// Whether a crank angle in [0, 2π) lies in one of the intervals; no intervals: anywhere.
pub(super) fn inside(reach: &[[f64; 2]], theta: f64) -> bool {
    let within = |[from, to]: &[f64; 2]| (theta - from).rem_euclid(TAU) <= to - from;
    reach.is_empty() || reach.iter().any(within)
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
        "the steps have become so short that the work limit of evaluations would be reached long before the end: stopped {place}; the equation is too stiff for a method in time, or a load jumps back and forth with the speed: give dry friction at the guide as [friction] and steep losses less steep, or raise --max-evaluations"
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
        (Finish::AtEnd | Finish::Stopped | Finish::NoStart, _) => None,
        (Finish::WorkLimit, _) => Some(work_limit(&place)),
        (Finish::WorkLimitAhead, _) => Some(work_limit_ahead(&place)),
        (Finish::TooManyTurns, _) => Some(too_many_turns(&place)),
        (Finish::StepTooSmall, _) => {
            let (t, angle, speed) = impossible.unwrap_or((end.t, last.angle(end.theta), end.omega));
            Some(match equation.obstacle(t, angle, speed) {
                Some(Obstacle::Blocked) => at_limit(last),
                Some(Obstacle::Load) => format!(
                    "a load has no finite value at t = {t} s, theta = {} rad, omega = {speed} rad/s (outside its table, or outside the domain of its formula): stopped {place}",
                    angle.radians()
                ),
                Some(Obstacle::NoInertia) => {
                    format!(
                        "the effective inertia vanishes: stopped {place}; give the crank an inertia"
                    )
                }
                Some(Obstacle::TooLarge) => format!(
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

/// Whether the inertia is next to nothing here, compared with that a radian further.
fn nearly_vanishes(equation: &Equation, last: &Step) -> bool {
    let inertia = |theta: f64| equation.terms(theta).inertia.m;
    let theta = last.end.theta;
    inertia(theta) < 1e-9 * inertia(theta + 1.0)
}

/// Why there is no run of a crank that stays at rest.
pub(super) fn never_turns(turns: f64) -> Error {
    Error::refused(
        format!("a crank at rest never completes {turns} turns"),
        "give motion.speed, or run.duration",
    )
}

/// Refuses turns of a crank that starts at rest in a balance of forces that last.
pub(super) fn refuse_balance(
    extent: Extent,
    start: Start,
    motion: &dyn Motion,
) -> Result<(), Error> {
    let balanced = || {
        start.speed == 0.0
            && !motion.depends_on_time()
            && motion.acceleration(start.t, start.angle, start.speed) == 0.0
    };
    match extent {
        Extent::Revolutions(turns) if balanced() => Err(never_turns(turns)),
        _ => Ok(()),
    }
}

/// Refuses turns that a crank between limits, rad, can never make.
pub(super) fn refuse_turns(reach: &[[f64; 2]], extent: Extent) -> Result<(), Error> {
    let widest = reach
        .iter()
        .fold(0.0, |widest: f64, [from, to]| widest.max(to - from));
    match extent {
        Extent::Revolutions(turns) if widest > 0.0 && turns * TAU > widest => Err(Error::refused(
            format!(
                "run.revolutions: the crank cannot turn by more than {} deg between its limits and never completes {turns} turns",
                widest.to_degrees()
            ),
            "give run.duration instead",
        )),
        _ => Ok(()),
    }
}

/// Why a run cannot begin.
pub(super) fn no_start(equation: &Equation, start: Start, limits: &Limits) -> Error {
    let theta = start.angle.radians();
    match equation.obstacle(start.t, start.angle, start.speed) {
        Some(Obstacle::Blocked) | None => {
            let reach: Vec<String> = limits
                .reach
                .iter()
                .map(|[from, to]| format!("{:.6} to {:.6} deg", from.to_degrees(), to.to_degrees()))
                .collect();
            Error::refused(
                format!(
                    "motion.angle: the mechanism has no position at crank angle {theta} rad: the rod does not reach the guide or stands normal to it"
                ),
                format!("give an angle inside {}", reach.join(" or ")),
            )
        }
        Some(Obstacle::Load) => Error::refused(
            format!(
                "a load has no finite value at the start (t = 0, theta = {theta} rad, omega = {} rad/s)",
                start.speed
            ),
            "check the range of its table or the domain of its formula",
        ),
        Some(Obstacle::TooLarge) => Error::refused(
            format!("a load is too large to be computed with at the start, theta = {theta} rad"),
            "check the units of the loads, and what their formulas give",
        ),
        Some(Obstacle::NoInertia) => Error::refused(
            format!("the effective inertia vanishes at the start, theta = {theta} rad"),
            "give the crank an inertia, or start away from the dead centre",
        ),
    }
}
