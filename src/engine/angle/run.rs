//! Run panel by panel, continued by the Poincaré map of a cycle where there are many turns.

use std::f64::consts::TAU;

use super::driving::{FEW_TURNS, work_until};
use super::poincare_map;
use super::stepper::{Done, PanelStepper};
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
    let mut march = PanelStepper::new(driven, start, speed, resolution)?;
    march.begin = from.t;
    if from.t == 0.0 && start.turns == 0.0 {
        // An angle as given, not reduced, is not rounded.
        march.errors = Errors::at(march.kinetic, 0.0);
    }
    march.gives_up = true;
    let reads_time = driven.is_driven() && driven.reads_time();
    let repeats = !reads_time && march.panels[0].table.switch.is_none();
    let mut forecast = forecast(&march, goal, reads_time);
    let way = f64::from(driven.cycle()) * TAU;
    let mut leg = Segment::open();
    loop {
        let spent = march.spent();
        let done = march.at_cycle() && leg.len() > 0;
        if done && forecast.reason_to_stop(spent, march.t.0, way).is_some() {
            let why = NotApplicable::TooManyTurns;
            return Ok(ended(march, leg, (start, speed), why));
        }
        if repeats && march.at_cycle() && march.turns.abs() >= FEW_TURNS {
            return poincare_map::run(march, leg, start, speed, goal, resolution);
        }
        let next = if leg.len() < MOST_PANELS {
            march.panel()
        } else {
            Err(NotApplicable::TooLong)
        };
        let Done { panel, spent, work } = match next {
            Ok(done) => done,
            Err(why) if leg.len() == 0 => return Err(why),
            Err(why) => return Ok(ended(march, leg, (start, speed), why)),
        };
        let turned = (panel.piece.to - start.rest).abs() + panel.turns.abs() * TAU;
        leg.push(panel);
        let passed = match goal {
            Goal::Time(until) => leg.duration.0 > until,
            Goal::Turned(way) => turned >= way - SAME_ANGLE,
        };
        if passed {
            let orbit = Orbit::one_way(start, speed, leg);
            let end = match goal {
                Goal::Time(until) => until,
                Goal::Turned(way) => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            };
            let work = march.work - work + work_until(orbit.last_segment(), end, &spent);
            march.leave_panels();
            return Ok(Driving {
                orbit,
                end,
                work,
                errors: march.errors,
                evaluations: march.evaluations,
                short: None,
            });
        }
    }
}

/// Starts the forecast for a run without a map: will it reach its goal within the limit?
fn forecast<'a, D: Driven>(
    march: &PanelStepper<'a, D>,
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
        limit: march.limit,
    };
    WorkForecast::new(0.0, march.spent(), ends, reads_time)
}

/// Makes the result of a run that ended before its goal, from its initial angle and speed (rad/s).
fn ended<D: Driven>(
    mut march: PanelStepper<'_, D>,
    leg: Segment,
    (start, speed): (Angle, f64),
    why: NotApplicable,
) -> Driving {
    march.leave_panels();
    Driving {
        short: leg.last_angle(start.turns).map(|angle| Short {
            why,
            angle,
            kinetic: march.kinetic,
        }),
        end: leg.duration.0,
        orbit: Orbit::one_way(start, speed, leg),
        work: march.work,
        errors: march.errors,
        evaluations: march.evaluations,
    }
}
