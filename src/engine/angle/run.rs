//! Run panel by panel, continued by the Poincaré map of a cycle where there are many turns.

use std::f64::consts::TAU;

use super::angle_run::work_until;
use super::poincare_map::{self, SINGLE_TURNS};
use super::progress::SolvedPanel;
use super::stepper::PanelStepper;
use super::{AngleRun, Dynamics, Goal, Resolution};
use crate::engine::energy::piece::SAME_ANGLE;
use crate::engine::energy::segment::{MOST_PANELS, Segment};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::run_in_time::{Ends, MotionState, UNLIMITED_TIME};
use crate::engine::work_forecast::WorkForecast;

/// Integrates from a start to the goal, or as far as the angle can be the independent variable.
///
/// # Errors
/// [`NotApplicable`] where the angle cannot be the independent variable at the start.
pub fn run<D: Dynamics>(
    dynamics: &D,
    from: MotionState,
    goal: Goal,
    resolution: Resolution<'_>,
) -> Result<AngleRun, NotApplicable> {
    let mut stepper = PanelStepper::new(dynamics, from, resolution)?;
    let MotionState { angle, speed, .. } = stepper.start;
    let reads_time = dynamics.reads_time();
    let repeats = !reads_time && stepper.panels.panels[0].table.switch.is_none();
    let mut forecast = forecast(&stepper, goal, reads_time);
    let way = f64::from(dynamics.cycle()) * TAU;
    let mut segment = Segment::open();
    loop {
        let cost = stepper.cost();
        let done = stepper.panels.at_cycle() && segment.len() > 0;
        if done
            && forecast
                .reason_to_stop(cost, stepper.progress.t.0, way)
                .is_some()
        {
            let why = NotApplicable::TooManyTurns;
            return Ok(ended(stepper, segment, why));
        }
        if repeats && stepper.panels.at_cycle() && stepper.progress.turns.abs() >= SINGLE_TURNS {
            return poincare_map::run(stepper, segment, goal);
        }
        let next = if segment.len() < MOST_PANELS {
            stepper.panel()
        } else {
            Err(NotApplicable::TooLong)
        };
        let SolvedPanel { panel, force, work } = match next {
            Ok(done) => done,
            Err(why) if segment.len() == 0 => return Err(why),
            Err(why) => return Ok(ended(stepper, segment, why)),
        };
        let turned = (panel.piece.to - angle.rest).abs() + panel.turns.abs() * TAU;
        segment.push(panel);
        let passed = match goal {
            Goal::Time(until) => segment.duration.0 > until,
            Goal::Turned(way) => turned >= way - SAME_ANGLE,
        };
        if passed {
            let orbit = Orbit::one_way(angle, speed, segment, None);
            let end = match goal {
                Goal::Time(until) => until,
                Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            };
            let work = stepper.progress.work - work + work_until(orbit.last_segment(), end, &force);
            return Ok(stepper.finished(orbit, end, work, None));
        }
    }
}

/// Starts the forecast for a run without a map: will it reach its goal within the limit?
fn forecast<'a, D: Dynamics>(
    stepper: &PanelStepper<'a, D>,
    goal: Goal,
    reads_time: bool,
) -> WorkForecast<'a> {
    let (t, way) = match goal {
        Goal::Time(until) => (until, f64::INFINITY),
        Goal::Turned(way) => (UNLIMITED_TIME, way),
    };
    let ends = Ends {
        t,
        way,
        limit: stepper.limit,
    };
    WorkForecast::new(0.0, stepper.cost(), ends, reads_time)
}

/// Makes the result of a run that ended before its goal.
fn ended<D: Dynamics>(
    stepper: PanelStepper<'_, D>,
    segment: Segment,
    why: NotApplicable,
) -> AngleRun {
    let MotionState { angle, speed, .. } = stepper.start;
    let early_end = stepper.early_end(&segment, angle.turns, why);
    let (end, work) = (segment.duration.0, stepper.progress.work);
    let orbit = Orbit::one_way(angle, speed, segment, None);
    stepper.finished(orbit, end, work, early_end)
}
