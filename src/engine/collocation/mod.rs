//! Integration in time by Gauss collocation, solved by Picard iteration.
//!
//! A step is the polynomial whose second derivative equals the acceleration at the nodes of the Gauss rule. Each sweep
//! evaluates the accelerations at all nodes of a guess together and integrates them twice for a better one (Picard,
//! Lindelöf). Where sweeps converge too slowly because the acceleration is steep in the speed, Newton's method solves
//! the same equations. The polynomial is the motion inside the step, too.

mod attempt;
mod guide;
mod newton;
mod state;
mod step;
mod tableau;

use std::f64::consts::TAU;

use super::Counted;
use super::resolution::Feature;
use super::step::{Node, Step};
use super::time::{Finish, MotionState, Settings};
use attempt::{Accepted, Rejection};
pub use guide::tolerance_beside;
use state::State;
use step::Collocation;
pub use tableau::Tableau;

/// Integrates and hands every accepted step to `sink`, which ends the run by returning true. Returns the reason for the
/// end, the last step and the number of steps.
pub fn run(
    motion: &Counted<'_>,
    start: MotionState,
    settings: &Settings<'_>,
    sink: &mut dyn FnMut(&Step) -> bool,
) -> (Finish, Step, u64) {
    let mut state = State::new(start);
    let alpha = motion.acceleration(state.t, state.angle(), state.omega);
    let node = state.node(alpha);
    let mut last = Step::new(state.turns, node, node);
    if !alpha.is_finite() {
        return (Finish::NoStart, last, 0);
    }
    let mut collocation = Collocation::new(motion, settings, alpha);
    let mut wanted = first_length(&node, settings.way);
    let (mut steps, mut at_corner) = (0, false);
    let mut hidden = f64::INFINITY;
    // Bounds of the ratio of a step to the one before, and of its ratio to one that was too long.
    let (least_factor, greatest_factor, greatest_retry) = (0.1, 4.0, 0.9);
    while state.t < settings.t_end {
        if hidden <= state.t {
            hidden = f64::INFINITY;
        }
        let corner = motion.next_corner(state.t).min(hidden);
        let until = corner.min(settings.t_end);
        let left = until - state.t;
        let beside_guide = guide::length_beside(settings.guide, state.t);
        let way = wanted.min(TAU / state.omega.abs()).min(beside_guide);
        let length = fitted(way, left);
        // Length that results from the rounded times.
        let h = (state.t + length) - state.t;
        if h <= 0.0 {
            return (Finish::StepTooSmall, last, steps);
        }
        if settings.limit.is_reached(motion.evaluations()) {
            return (Finish::WorkLimit, last, steps);
        }
        let is_last = state.t + h >= until;
        // The end of the run is no corner: the acceleration there must be that of the step.
        let ends_at_corner = is_last && corner <= settings.t_end;
        match collocation.attempt(&state, h, [at_corner, ends_at_corner]) {
            // A step of one rounding of the time cannot become shorter.
            Err(_) if h <= 2.0 * f64::EPSILON * state.t.abs() => {
                return (Finish::StepTooSmall, last, steps);
            }
            Err(Rejection::TooLong(factor)) => {
                wanted = h * factor.clamp(least_factor, greatest_retry);
            }
            Err(Rejection::Unresolved(found)) if found.feature != Feature::Pole => {
                hidden = state.t + found.at * h;
            }
            Err(Rejection::Unresolved(pole)) => {
                let left = pole.at * h;
                if motion.reaches_pole(left, state.t, state.angle(), state.omega) {
                    return (Finish::NoValue, last, steps);
                }
                wanted = 0.5 * left;
            }
            Err(Rejection::Corner { at, factor }) => {
                hidden = state.t + at * h;
                wanted = h * factor.clamp(least_factor, greatest_retry);
            }
            Ok(Accepted { step, next, factor }) => {
                // A step cut short by a corner says little about the length of the next.
                if length >= way || factor < 1.0 {
                    wanted = length * factor.clamp(least_factor, greatest_factor);
                }
                state = next;
                last = step;
                if is_last {
                    state.t = until;
                    last.end.t = until;
                }
                if ends_at_corner {
                    collocation.begin_anew(last.end.alpha);
                }
                at_corner = ends_at_corner;
                steps += 1;
                if sink(&last) && state.t < settings.t_end {
                    return (Finish::Stopped, last, steps);
                }
            }
        }
    }
    (Finish::AtEnd, last, steps)
}

/// Returns a first length, s: a travel of 0.1 rad, or of `way` (rad) if less, by the initial state; at most 0.1 s.
fn first_length(start: &Node, way: f64) -> f64 {
    let travel = way.min(0.1);
    let by_speed = travel / start.omega.abs();
    let by_acceleration = (2.0 * travel / start.alpha.abs()).sqrt();
    by_speed.min(by_acceleration).min(0.1)
}

/// Returns the step, or all that is left, or half of what is left to avoid a tiny last step.
fn fitted(wanted: f64, left: f64) -> f64 {
    if left <= wanted * 1.01 {
        left
    } else if left < 2.0 * wanted {
        0.5 * left
    } else {
        wanted
    }
}
