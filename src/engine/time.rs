//! Integration in time: calls of a method joined to one run, with the angle kept small.

use std::f64::consts::TAU;

use super::library::{self, Call, Ended};
use super::picard;
use super::step::{Node, Step};
use super::{Counted, Motion};
use crate::numeric::angle::Angle;

/// The methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Gauss collocation of order 24 by sweeps.
    Picard,
    /// One of ode_solvers.
    Library(library::Method),
}

/// How to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The method.
    pub method: Method,
    /// Local error target, relative and absolute.
    pub tolerance: f64,
    /// Last time, s.
    pub t_end: f64,
    /// Most evaluations; the run ends there with [`Finish::WorkLimit`].
    pub max_evaluations: u64,
    /// Unit of work, J, in which its error is measured.
    pub work_unit: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finish {
    /// At the last time.
    AtEnd,
    /// Where the sink wanted it to end.
    Stopped,
    /// The work limit is reached.
    WorkLimit,
    /// At the pace of the last steps it would be reached long before the end.
    WorkLimitAhead,
    /// The step size became too small for the time to move on: a singularity.
    StepTooSmall,
    /// There is no acceleration at the start.
    NoStart,
}

/// A run's start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// s
    pub t: f64,
    /// rad
    pub angle: Angle,
    /// rad/s
    pub speed: f64,
}

/// Result vectors of the library grow with each step of a call.
const STEPS_IN_A_CALL: usize = 256;

/// A last time (s) from which on a run has none of its own.
pub const FAR: f64 = 1e9;

/// Integrates and hands every accepted step to `sink`, which ends the run by returning true.
/// Returns how the run ended, the last state reached (its angle beside the turns) and the number of steps.
pub fn run(
    motion: &Counted<'_>,
    start: Start,
    settings: &Settings,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> (Finish, Step, u64) {
    let mut pace = Pace::new(start.t, motion.evaluations(), settings);
    let mut hopeless = false;
    let watched = &mut |step: &Step| {
        if sink(step) {
            return true;
        }
        let travel = step.end.theta - step.start.theta;
        hopeless = pace.is_hopeless(motion.evaluations(), step.end.t, travel);
        hopeless
    };
    let (finish, last, steps) = match settings.method {
        Method::Picard => picard::run(motion, start, settings, watched),
        Method::Library(method) => in_calls(motion, start, settings, method, watched),
    };
    let finish = match finish {
        Finish::Stopped if hopeless => Finish::WorkLimitAhead,
        other => other,
    };
    (finish, last, steps)
}

/// Evaluations over which a pace is taken.
const WINDOW: u64 = 1_000_000;
/// A run is given up if at its pace it needs more than the work limit by this factor, and moves by less than so much
/// (rad) with each evaluation, in two windows in a row. A crank that spins fast and slows down later moves by more.
const BEYOND: f64 = 5.0;
const CRAWL: f64 = 1e-5;

/// How fast a run proceeds.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    t: f64,
    evaluations: u64,
    travel: f64,
    settings: Settings,
    slow: bool,
}

impl Pace {
    /// Of a run that begins at this time (s), with so many evaluations before it.
    pub fn new(t: f64, evaluations: u64, settings: &Settings) -> Pace {
        Pace {
            t,
            evaluations,
            travel: 0.0,
            settings: *settings,
            slow: false,
        }
    }

    /// Whether the work limit will be reached long before the last time, as a run shows that has got to this time (s)
    /// with so many evaluations in all, and moved by `travel` (rad) since it was last asked.
    pub fn is_hopeless(&mut self, evaluations: u64, t: f64, travel: f64) -> bool {
        let Settings {
            t_end,
            max_evaluations,
            ..
        } = self.settings;
        self.travel += travel.abs();
        let spent = (evaluations - self.evaluations) as f64;
        if spent < WINDOW as f64 || t_end >= FAR {
            return false;
        }
        let needed = (t_end - t) / (t - self.t) * spent;
        let left = max_evaluations.saturating_sub(evaluations) as f64;
        let slow = needed > BEYOND * left && self.travel < CRAWL * spent;
        let was_slow = std::mem::replace(&mut self.slow, slow);
        (self.t, self.evaluations, self.travel) = (t, evaluations, 0.0);
        slow && was_slow
    }
}

fn in_calls(
    motion: &Counted<'_>,
    start: Start,
    settings: &Settings,
    method: library::Method,
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
    let mut first_step = 0.0;
    loop {
        let mut in_call = 0;
        let mut ended_by_sink = false;
        let left = settings
            .max_evaluations
            .saturating_sub(motion.evaluations())
            / 12;
        let ended = library::integrate(Call {
            motion,
            method,
            tolerance: settings.tolerance,
            turns: angle.turns,
            start: node,
            t_end: motion.next_corner(node.t).min(settings.t_end),
            first_step,
            max_steps: left.min(u64::from(u32::MAX)) as u32,
            work_unit: settings.work_unit,
            observer: &mut |step| {
                last = *step;
                in_call += 1;
                ended_by_sink = sink(step);
                ended_by_sink || in_call >= STEPS_IN_A_CALL || step.end.theta.abs() >= TAU
            },
        });
        steps += in_call as u64;
        let finish = match ended {
            Ended::WorkLimit => Finish::WorkLimit,
            Ended::StepTooSmall => Finish::StepTooSmall,
            Ended::Stopped if ended_by_sink => Finish::Stopped,
            Ended::AtEnd | Ended::Stopped if last.end.t >= settings.t_end => Finish::AtEnd,
            Ended::AtEnd | Ended::Stopped => {
                angle = last.angle(last.end.theta).reduced();
                node = Node {
                    theta: angle.rest,
                    ..last.end
                };
                first_step = last.length();
                continue;
            }
        };
        return (finish, last, steps);
    }
}

/// A step ended at the time `t_end` (s) inside it, integrated anew; `sink` sees what it consists of.
pub fn shortened(
    motion: &Counted<'_>,
    step: &Step,
    t_end: f64,
    settings: &Settings,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> Step {
    let start = Start {
        t: step.start.t,
        angle: step.angle(step.start.theta),
        speed: step.start.omega,
    };
    let settings = Settings {
        t_end,
        max_evaluations: u64::MAX,
        ..*settings
    };
    let mut last = run(motion, start, &settings, sink).1;
    last.end.work += step.start.work;
    last
}
