//! Why a run on the curve ends before its time, and what the reader should know, in words.

use super::super::run_setup::RunSetup;
use super::super::stalled;
use super::super::stop_reason;
use super::arrived::{Arrived, End, crank_state};
use crate::engine::time::{FAR, Finish};
use crate::mechanism::{Class, CurveEquation};
use crate::scene::Extent;

/// Why a run ended before its time.
pub(in crate::simulate) fn why(
    task: &RunSetup<'_>,
    arrived: &Arrived,
    equation: &CurveEquation,
) -> Option<String> {
    let (angle, speed) = crank_state(equation.curve(), &arrived.last);
    let t = arrived.last.end.t;
    let place = format!(
        "at t = {t} s, theta = {} rad, omega = {speed} rad/s",
        angle.radians()
    );
    match (&arrived.end, task.extent) {
        (End::Done, Extent::Revolutions(turns)) if t >= FAR => Some(format!(
            "the crank does not complete {turns} turns: stopped {place}; give a duration instead"
        )),
        (End::AtRest, Extent::Revolutions(turns)) => {
            let held = match task.limits.class {
                Class::RotatingCrank => {
                    let torques = stalled::torques(task, angle.radians());
                    format!(", where friction holds {torques},")
                }
                _ => String::new(),
            };
            Some(format!(
                "the crank comes to rest{held} and does not complete {turns} turns: stopped {place}; give a duration instead"
            ))
        }
        (End::Done | End::AtRest | End::Stopped, _) => None,
        (End::Jam(why), _) => Some(format!("{why}: stopped {place}")),
        (End::Integrator(Finish::WorkLimit), _) => Some(stop_reason::work_limit(&place)),
        (End::Integrator(Finish::WorkLimitAhead), _) => Some(stop_reason::work_limit_ahead(&place)),
        (End::Integrator(Finish::TooManyTurns), _) => Some(stop_reason::too_many_turns(&place)),
        (End::Integrator(_), _) => Some(singular(task, arrived, equation, &place)),
    }
}

/// Why the steps became too small.
fn singular(
    task: &RunSetup<'_>,
    arrived: &Arrived,
    equation: &CurveEquation,
    place: &str,
) -> String {
    if let Some((t, theta, omega)) = arrived.impossible
        && !task.equation().load(t, theta, omega).is_finite()
    {
        return stop_reason::no_value(task.equation(), t, theta, omega, place);
    }
    if arrived.vanished || equation.vanishes_at(arrived.last.end.theta) {
        return format!(
            "the effective inertia vanishes at this limit of its motion or dead centre, where the speed has no bound: stopped {place}; give the rod or the slider a mass, or the crank an inertia"
        );
    }
    format!("the equation is singular here or too stiff for this method: stopped {place}")
}

/// What the reader should know about the lengths.
pub(in crate::simulate) fn warnings(task: &RunSetup<'_>) -> Vec<String> {
    let linkage = task.equation().linkage();
    let near = linkage.nearness_to_change_point();
    match task.limits.class {
        Class::ChangePoint => vec![
            "the lengths make a change point: it is passed so that all velocities stay continuous, and the branch changes there; a slightly longer or shorter rod moves differently".to_owned(),
        ],
        _ if near < 1e-6 => vec![format!(
            "the lengths are {near:e} crank lengths from a change point: which way the mechanism goes there depends on their last digits"
        )],
        _ => Vec::new(),
    }
}
