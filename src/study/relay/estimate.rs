//! Global error of a run that was handed over.

use std::f64::consts::TAU;
use std::time::Instant;

use super::arrived::{Arrived, End, Observer};
use super::course::Course;
use crate::engine::Counted;
use crate::engine::angle::Driving;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::scene::Extent;
use crate::study::by_angle::{MARGIN, ROUNDING, finer};
use crate::study::curve;
use crate::study::forward::{tighter, unevenness};
use crate::study::over_angle::late_by;
use crate::study::summary::{Cost, ErrorEstimate};
use crate::study::task::Task;

/// The second run is handed over at other places.
const OTHER_WAIT: f64 = 1.4 * TAU;
/// Evaluations of the second run for one of the first, and beside them.
const MOST_EVALUATIONS: (u64, u64) = (20, 200_000);

/// Adds up what rounding does in the pieces in time.
#[derive(Default)]
struct Shaken {
    unevenness: f64,
    largest_speed: f64,
    steps: u64,
    /// When the first piece in time begins, s.
    since: Option<f64>,
    /// The way since then, rad, and the largest speed on it, rad/s.
    way: f64,
    fastest: f64,
}

impl Shaken {
    fn pass(&mut self, way: f64, speed: f64) {
        if self.since.is_some() {
            self.way += way.abs();
            self.fastest = self.fastest.max(speed.abs());
        }
    }

    /// How long an error of the speed goes on to move the angle, s: a loss that brings the crank to rest ends it.
    fn lasting(&self, end: f64) -> f64 {
        let remaining = end - self.since.unwrap_or(end);
        remaining.min(2.0 * self.way / self.fastest.max(f64::MIN_POSITIVE))
    }
}

impl Observer for Shaken {
    fn over_angle(&mut self, from: Start, _: f64, driving: Driving) -> Result<(), Error> {
        let (angle, speed) = driving.orbit.state(driving.end);
        self.pass(angle.minus(from.angle), speed.abs().max(from.speed.abs()));
        Ok(())
    }

    fn begin_in_time(&mut self, from: Start) {
        self.since.get_or_insert(from.t);
    }

    fn step(&mut self, step: &Step) -> bool {
        self.steps += 1;
        self.unevenness += unevenness(step);
        let speed = step.start.omega.abs().max(step.end.omega.abs());
        self.pass(step.end.theta - step.start.theta, speed);
        self.largest_speed = self.largest_speed.max(speed);
        false
    }

    fn with_friction(&mut self, run: &mut dyn FnMut(&mut dyn curve::Observer)) {
        run(self);
    }

    fn end_in_time(&mut self, _: &Counted<'_>, _: &Step, _: &Settings) -> Option<Step> {
        None
    }
}

impl curve::Observer for Shaken {
    fn step(&mut self, step: &Step, _: curve::Phase) -> bool {
        self.since.get_or_insert(step.start.t);
        Observer::step(self, step)
    }

    fn event(&mut self, _: &'static str, _: f64, _: Angle, _: f64) {}
}

/// Global error of the last state: its distance from that of a much finer run with other pieces, and what rounding
/// may have added to both.
pub(super) fn estimate(
    task: &Task<'_>,
    course: &Course<'_>,
    arrived: &Arrived,
) -> Option<(ErrorEstimate, Cost)> {
    let begun = Instant::now();
    let (factor, beside) = MOST_EVALUATIONS;
    let end = arrived.now;
    let finer = Course {
        extent: Extent::Duration(end.t),
        resolution: finer(),
        settings: Settings {
            tolerance: tighter(course.settings.tolerance),
            t_end: end.t,
            ..course.settings
        },
        wait: OTHER_WAIT,
        max_evaluations: arrived
            .evaluations
            .saturating_mul(factor)
            .saturating_add(beside),
        ..*course
    };
    let mut shaken = Shaken::default();
    let best = finer.run(None, &mut shaken).ok()?;
    if best.end != End::AtGoal {
        return None;
    }
    let floor = late_by(task, (end.angle, end.speed), end.t, ROUNDING * end.t);
    let noise = f64::EPSILON
        * (0.5 * shaken.largest_speed * (2.0 * shaken.steps as f64).sqrt()
            + shaken.unevenness.sqrt())
        + best.speed_noise;
    let estimate = ErrorEstimate {
        theta_rad: MARGIN * end.angle.minus(best.now.angle).abs()
            + floor.theta_rad
            + noise * shaken.lasting(end.t),
        omega_rad_per_s: MARGIN * (end.speed - best.now.speed).abs()
            + floor.omega_rad_per_s
            + noise,
    };
    let cost = Cost {
        evaluations: best.evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some((estimate, cost))
}
