//! Integration in time by collocation or library calls, joined to one run with the angle reduced to one turn.

use std::f64::consts::TAU;

use super::collocation;
use super::resolution::{Feature, unresolved_on};
use super::runge_kutta::{self, Call};
use super::step::{Node, Step};
use super::work_forecast::WorkForecast;
use super::{Counted, WorkLimit};

pub use super::run_in_time::{Ends, Finish, MotionState, Settings, UNLIMITED_TIME};

/// Integrates and hands every accepted step to `sink`, which ends the run by returning true. Returns the reason for the
/// end, the last step (angles without the turns) and the number of steps.
pub fn run(
    motion: &Counted<'_>,
    start: MotionState,
    settings: &Settings<'_>,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> (Finish, Step, u64) {
    let mut forecast = WorkForecast::new(
        start.t,
        motion.evaluations(),
        settings.ends(),
        motion.depends_on_time(),
    );
    let mut forecast_end = None;
    let watched = &mut |step: &Step| {
        if sink(step) {
            return true;
        }
        let travel = step.end.theta - step.start.theta;
        forecast_end = forecast.reason_to_stop(motion.evaluations(), step.end.t, travel);
        forecast_end.is_some()
    };
    let (finish, last, steps) = match settings.method {
        None => collocation::run(motion, start, settings, watched),
        Some(method) => in_calls(motion, start, settings, method, watched),
    };
    match (finish, forecast_end) {
        (Finish::Stopped, Some(why)) => (why, last, steps),
        _ => (finish, last, steps),
    }
}

fn in_calls(
    motion: &Counted<'_>,
    start: MotionState,
    settings: &Settings<'_>,
    method: runge_kutta::RungeKutta,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> (Finish, Step, u64) {
    let mut angle = start.angle.reduced();
    let mut node = Node {
        t: start.t,
        theta: angle.rest,
        omega: start.speed,
        alpha: motion.acceleration(start.t, angle, start.speed),
        work: 0.0,
    };
    let mut last = Step::new(angle.turns, node, node);
    let mut steps = 0;
    if !node.alpha.is_finite() {
        return (Finish::NoStart, last, steps);
    }
    // The result vectors of a library call grow with each step.
    let most_in_call = 256;
    let mut first_step = 0.0;
    let mut resolved_until = f64::INFINITY;
    loop {
        let spent = motion.evaluations();
        if settings.limit.is_reached(spent) {
            return (Finish::WorkLimit, last, steps);
        }
        if resolved_until <= node.t {
            resolved_until = f64::INFINITY;
        }
        let (mut in_call, mut ended_by_sink, mut rejected) = (0, false, None);
        let left = settings.limit.after(spent).evaluations / method.evaluations_in_a_step();
        let ended = runge_kutta::integrate(Call {
            motion,
            method,
            settings,
            turns: angle.turns,
            start: node,
            t_end: motion
                .next_corner(node.t)
                .min(settings.t_end)
                .min(resolved_until),
            first_step,
            max_steps: left.min(u64::from(u32::MAX)) as u32,
            observer: &mut |step| {
                rejected = match step.part_of_one_turn() {
                    Some(part) => Some(Rejected::TooLong(part * step.length())),
                    None => missed(motion, step, method.order(), settings.tolerance),
                };
                if rejected.is_some() {
                    return true;
                }
                last = *step;
                in_call += 1;
                ended_by_sink = sink(step);
                ended_by_sink || in_call >= most_in_call || step.end.theta.abs() >= TAU
            },
        });
        steps += in_call as u64;
        let finish = match ended {
            _ if rejected.is_some() => None,
            Finish::Stopped if ended_by_sink => Some(Finish::Stopped),
            Finish::AtEnd | Finish::Stopped => {
                (last.end.t >= settings.t_end).then_some(Finish::AtEnd)
            }
            ended => Some(ended),
        };
        if let Some(finish) = finish {
            return (finish, last, steps);
        }
        angle = last.angle(last.end.theta).reduced();
        node = Node {
            theta: angle.rest,
            ..last.end
        };
        first_step = last.length();
        match rejected {
            Some(Rejected::TooLong(shorter)) => first_step = shorter,
            Some(Rejected::Unresolved(Feature::Pole, t)) => {
                let left = t - node.t;
                if motion.reaches_pole(left, node.t, angle, node.omega) {
                    return (Finish::NoValue, last, steps);
                }
                resolved_until = node.t + 0.5 * left;
            }
            Some(Rejected::Unresolved(_, until)) => resolved_until = until,
            None => {}
        }
    }
}

/// Reason to repeat an accepted library step from its start.
enum Rejected {
    /// Too long a travel; the length to try, s.
    TooLong(f64),
    /// Load not resolved by the step, with the time at which the step has to end, s.
    Unresolved(Feature, f64),
}

/// Returns what a library step misses of the loads, with the time (s) at which it has to end to resolve them.
fn missed(motion: &Counted<'_>, step: &Step, order: usize, tolerance: f64) -> Option<Rejected> {
    if !motion.varies_between_nodes() {
        return None;
    }
    let h = step.length();
    let allowed = tolerance * (1.0 + step.start.omega.abs()) / h;
    let found = unresolved_on(motion, step, (order, None), tolerance, allowed)?;
    Some(Rejected::Unresolved(
        found.feature,
        step.start.t + found.at * h,
    ))
}

/// Integrates a step anew up to a time `t_end` (s) inside it; `sink` sees the new steps, the last is returned.
pub fn shortened(
    motion: &Counted<'_>,
    step: &Step,
    t_end: f64,
    settings: &Settings<'_>,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> Step {
    let start = MotionState {
        t: step.start.t,
        angle: step.angle(step.start.theta),
        speed: step.start.omega,
    };
    let settings = Settings {
        t_end,
        limit: WorkLimit::NONE,
        ..*settings
    };
    let mut last = run(motion, start, &settings, sink).1;
    last.end.work += step.start.work;
    last
}
