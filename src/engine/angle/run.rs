//! Run panel by panel, continued by the Poincaré map of a cycle where there are many turns.

use std::f64::consts::TAU;

use super::driving::{FEW_TURNS, work_until};
use super::poincare_map;
use super::progress::Done;
use super::stepper::PanelStepper;
use super::{Driven, Driving, Errors, Goal, Resolution, Short};
use crate::engine::energy::piece::SAME_ANGLE;
use crate::engine::energy::segment::{MOST_PANELS, Segment};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::run_in_time::{Ends, Start, UNLIMITED_TIME};
use crate::engine::work_forecast::WorkForecast;
use crate::numeric::angle::Angle;

/// Integrates from a start to the goal, or as far as the angle can be the independent variable.
///
/// # Errors
/// [`NotApplicable`] where the angle cannot be the independent variable at the start.
pub fn run<D: Driven>(
    driven: &D,
    from: Start,
    goal: Goal,
    resolution: Resolution<'_>,
) -> Result<Driving, NotApplicable> {
    let (start, speed) = (from.angle.reduced(), from.speed);
    let mut stepper = PanelStepper::new(driven, start, speed, resolution)?;
    stepper.begin = from.t;
    if from.t == 0.0 && start.turns == 0.0 {
        // An angle as given, not reduced, is not rounded.
        stepper.progress.errors = Errors::at(stepper.progress.kinetic, 0.0);
    }
    stepper.gives_up = true;
    let reads_time = driven.is_driven() && driven.reads_time();
    let repeats = !reads_time && stepper.panels[0].table.switch.is_none();
    let mut forecast = forecast(&stepper, goal, reads_time);
    let way = f64::from(driven.cycle()) * TAU;
    let mut segment = Segment::open();
    loop {
        let spent = stepper.spent();
        let done = stepper.at_cycle() && segment.len() > 0;
        if done
            && forecast
                .reason_to_stop(spent, stepper.progress.t.0, way)
                .is_some()
        {
            let why = NotApplicable::TooManyTurns;
            return Ok(ended(stepper, segment, (start, speed), why));
        }
        if repeats && stepper.at_cycle() && stepper.progress.turns.abs() >= FEW_TURNS {
            return poincare_map::run(stepper, segment, start, speed, goal, resolution);
        }
        let next = if segment.len() < MOST_PANELS {
            stepper.panel()
        } else {
            Err(NotApplicable::TooLong)
        };
        let Done { panel, spent, work } = match next {
            Ok(done) => done,
            Err(why) if segment.len() == 0 => return Err(why),
            Err(why) => return Ok(ended(stepper, segment, (start, speed), why)),
        };
        let turned = (panel.piece.to - start.rest).abs() + panel.turns.abs() * TAU;
        segment.push(panel);
        let passed = match goal {
            Goal::Time(until) => segment.duration.0 > until,
            Goal::Turned(way) => turned >= way - SAME_ANGLE,
        };
        if passed {
            let orbit = Orbit::one_way(start, speed, segment);
            let end = match goal {
                Goal::Time(until) => until,
                Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            };
            let work = stepper.progress.work - work + work_until(orbit.last_segment(), end, &spent);
            stepper.leave_panels();
            return Ok(Driving {
                orbit,
                end,
                work,
                errors: stepper.progress.errors,
                evaluations: stepper.evaluations,
                short: None,
            });
        }
    }
}

/// Starts the forecast for a run without a map: will it reach its goal within the limit?
fn forecast<'a, D: Driven>(
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
    WorkForecast::new(0.0, stepper.spent(), ends, reads_time)
}

/// Makes the result of a run that ended before its goal, from its initial angle and speed (rad/s).
fn ended<D: Driven>(
    mut stepper: PanelStepper<'_, D>,
    segment: Segment,
    (start, speed): (Angle, f64),
    why: NotApplicable,
) -> Driving {
    stepper.leave_panels();
    Driving {
        short: segment.last_angle(start.turns).map(|angle| Short {
            why,
            angle,
            kinetic: stepper.progress.kinetic,
        }),
        end: segment.duration.0,
        orbit: Orbit::one_way(start, speed, segment),
        work: stepper.progress.work,
        errors: stepper.progress.errors,
        evaluations: stepper.evaluations,
    }
}
