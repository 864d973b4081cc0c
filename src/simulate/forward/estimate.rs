//! Global error of a free motion: distance from a second, much finer run, plus the propagated roundoff of both.
//!
//! Roundoff: each step rounds θ and θ̇ to half a unit in the last place, independently of the others, and a rounded
//! angle changes the acceleration. The linearised motion carries these errors to the end, as they grow with it near a
//! balance; independent errors add up by their squares.

use std::f64::consts::TAU;
use std::sync::Arc;
use std::time::Instant;

use super::super::configuration_curve::{End, Observer, OnCurve};
use super::super::crank_motion::CrankMotion;
use super::super::outcome::Estimate;
use super::super::recorder::Record;
use super::super::result::{Cost, ErrorEstimate};
use super::super::roundoff_propagation::{Rounding, Spread};
use super::super::second_run::{Compared, MARGIN, collocation_tolerance, same_method_tolerance};
use super::super::state_transition::StateTransition;
use super::super::stick_slip::Phase;
use super::arrived::{AnglePiece, Arrived, Sink};
use super::engine_loop::Course;
use super::errors_over_angle::{
    PLACE_ROUNDING, TIME_ROUNDING, by_energy, late_by, row_error, worst_row,
};
use super::over_angle::finer;
use crate::engine::angle::{Errors, Guide};
use crate::engine::step::Step;
use crate::engine::time::{Method, Settings, Start};
use crate::engine::{Counted, Motion, WorkLimit};
use crate::error::Error;
use crate::mechanism::{CurveEquation, Equation};
use crate::plan::Engine;
use crate::scene::Extent;

/// Rotation before the angle engine resumes in the second run, rad: different from that of the first.
const OTHER_WAIT: f64 = 1.4 * TAU;
/// Evaluations of the second run for one of the first, plus a constant, in time or over the angle, for tables.
const FOR_ONE: u64 = 20;
const BESIDE: [u64; 2] = [20_000, 200_000];
/// Stated roundoff, in standard deviations.
const DEVIATIONS: f64 = 2.0;
/// Remaining part of an energy error that is neglected. Half or twice as much changes none of 200 random runs.
const FORGOTTEN: f64 = 0.1;

/// Estimates the global error of a run; none where no second run reaches the end.
pub(super) fn estimate(
    course: &Course<'_>,
    arrived: &Arrived,
    record: &Record,
    wants_rows: bool,
) -> Option<Estimate> {
    match &arrived.driven {
        Some(piece) if piece.engine == Engine::Energy => {
            Some(by_energy(course.task, &piece.driving, arrived, wants_rows))
        }
        _ => by_second_run(course, arrived, record, wants_rows),
    }
}

/// Estimates the error by a second run, by collocation or, where that does not arrive, by the method of the run.
fn by_second_run(
    course: &Course<'_>,
    arrived: &Arrived,
    record: &Record,
    wants_rows: bool,
) -> Option<Estimate> {
    let begun = Instant::now();
    let guide = arrived.driven.as_ref().filter(|_| arrived.is_one_piece());
    let guide = guide.map(|driven| Guide::new(&driven.driving.orbit, course.resolution.tail));
    let t_end = arrived.now.t;
    let over_angle = arrived.over_angle > 0;
    let limit = course.settings.limit;
    let share = arrived
        .evaluations
        .saturating_mul(FOR_ONE)
        .saturating_add(BESIDE[usize::from(over_angle)]);
    let plain = Settings {
        t_end,
        limit: WorkLimit {
            evaluations: share.min(limit.evaluations),
            ..limit
        },
        ..course.settings
    };
    let tolerance = plain.tolerance;
    let collocation = Settings {
        method: Method::Picard,
        tolerance: collocation_tolerance(tolerance),
        guide: &record.checkpoints.first,
        ..plain
    };
    // Used where collocation does not reach the end.
    let again = Settings {
        tolerance: same_method_tolerance(tolerance),
        ..plain
    };
    let mut evaluations = 0;
    let second = |settings| {
        let finer = Course {
            first: match over_angle {
                true => Engine::Angle,
                false => Engine::Time,
            },
            is_second: true,
            extent: Extent::Duration(t_end),
            resolution: finer(guide),
            settings,
            wait: OTHER_WAIT,
            ..course.clone()
        };
        let forward = CrankMotion(course.task.equation());
        let motion = Counted::new(&forward);
        let mut seen = Second::new(&finer, &motion, record);
        let best = finer.run(&motion, &mut seen).ok()?;
        evaluations += best.evaluations + seen.rounding.evaluations;
        let arrives = matches!(best.end, End::Done);
        arrives.then_some((best, seen.rounding.spread, seen.compared))
    };
    let (best, spread, compared) = [collocation, again].into_iter().find_map(second)?;
    let cost = Cost {
        evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    let error = distance(course, arrived, &best, spread);
    let rows = match (&arrived.driven, &best.driven) {
        _ if !arrived.is_one_piece() => None,
        (Some(one), Some(other)) => wants_rows.then(|| {
            let orbits = [one, other].map(|driven| &driven.driving.orbit);
            worst_row(one.driving.end, error, |t| row_error(orbits, t, error))
        }),
        (Some(_), None) => None,
        (None, _) => Some(compared.worst(error)),
    };
    Some(Estimate {
        error,
        on_the_way: rows,
        cost: Some(cost),
    })
}

/// Returns the distance of two runs at the end, plus the roundoff.
fn distance(
    course: &Course<'_>,
    arrived: &Arrived,
    best: &Arrived,
    spread: Spread,
) -> ErrorEstimate {
    let Start { t, angle, speed } = arrived.now;
    let [angle_noise, speed_noise] =
        of_crank(course, arrived, spread).map(|noise| DEVIATIONS * f64::EPSILON * noise);
    let floor = match arrived.over_angle {
        0 => ErrorEstimate {
            theta_rad: f64::EPSILON * angle.radians().abs(),
            omega_rad_per_s: f64::EPSILON * speed.abs(),
        },
        _ => late_by(course.task, arrived.now, TIME_ROUNDING * t, PLACE_ROUNDING),
    };
    ErrorEstimate {
        theta_rad: MARGIN * angle.minus(best.now.angle).abs() + floor.theta_rad + angle_noise,
        omega_rad_per_s: MARGIN * (speed - best.now.speed).abs()
            + floor.omega_rad_per_s
            + speed_noise,
    }
}

/// Converts the spread of a coordinate at the end to that of crank angle and crank speed.
fn of_crank(course: &Course<'_>, arrived: &Arrived, spread: Spread) -> [f64; 2] {
    let (angle, speed) = (spread.angle(), spread.speed());
    let on = course.curve.get().filter(|_| arrived.on_curve);
    let (Some(Step { end, .. }), Some(on)) = (arrived.last, on) else {
        return [angle, speed];
    };
    let place = on.equation.curve().pose(end.theta);
    let bend = Some((place.d2theta * end.omega).abs()).filter(|bend| bend.is_finite());
    let dtheta = place.dtheta.abs();
    [dtheta * angle, dtheta * speed + bend.unwrap_or(0.0) * angle]
}

/// Observer of the second run: propagates roundoff and compares with the states of the first.
struct Second<'m, 'a> {
    equation: &'m Equation,
    motion: &'m Counted<'m>,
    rounding: Rounding,
    /// Configuration curve of the last piece in time, if it follows one.
    on: Option<Arc<CurveEquation>>,
    compared: Compared<'a>,
}

impl<'m, 'a> Second<'m, 'a> {
    fn new(course: &'m Course<'_>, motion: &'m Counted<'m>, record: &'a Record) -> Second<'m, 'a> {
        let Start { t, angle, speed } = course.task.first_state();
        let force = || motion.acceleration(t, angle, speed);
        let moves = speed != 0.0 || motion.depends_on_time() || force() != 0.0;
        // Panels over the angle state their roundoff themselves.
        let moves = moves && course.first == Engine::Time;
        Second {
            equation: course.task.equation(),
            motion,
            rounding: Rounding::new(course.settings.method, moves),
            on: None,
            compared: Compared::with(&record.checkpoints),
        }
    }

    /// Computes the transition over a piece over the angle: a lead in time stays, and an energy error adds to it.
    fn transition(&self, [from, to]: [&Start; 2], errors: &Errors) -> StateTransition {
        let [inertia, then] = [from, to].map(|at| self.inertia(at));
        let [alpha, after] = [from, to].map(|at| self.acceleration(at));
        let energy = [-inertia * alpha, inertia * from.speed];
        // A piece that loses nearly all of its energy forgets an energy error.
        let by_energy = if errors.kept < FORGOTTEN {
            0.0
        } else {
            errors.early
        };
        let early = [
            1.0 / from.speed + by_energy * energy[0],
            by_energy * energy[1],
        ];
        let angle = early.map(|early| to.speed * early);
        let speed = [0, 1].map(|k| (errors.kept * energy[k] / then + after * angle[k]) / to.speed);
        [angle, speed]
    }

    fn inertia(&self, at: &Start) -> f64 {
        self.equation.terms(at.angle.rest).inertia.m
    }

    fn acceleration(&self, at: &Start) -> f64 {
        self.equation.acceleration(at.t, at.angle, at.speed)
    }
}

impl Sink for Second<'_, '_> {
    fn over_angle(&mut self, driven: &AnglePiece) -> Result<(), Error> {
        let AnglePiece {
            driving, from, to, ..
        } = driven;
        let (angle, speed) = driving.orbit.state(driving.end);
        let to = Start {
            t: to.t,
            angle,
            speed,
        };
        let errors = &driving.errors;
        let transition = self.transition([from, &to], errors);
        // The roundoff of the piece is a stated error, no standard deviation.
        let unit = DEVIATIONS * f64::EPSILON;
        let [late, off] = [errors.late, errors.off].map(|error| error / unit);
        let carried = self.rounding.spread.carried(&transition);
        self.rounding.spread = carried
            .along(speed * late, self.acceleration(&to) * late)
            .plus(0.0, off / (self.inertia(&to) * speed));
        Ok(())
    }

    fn begin_in_time(&mut self, from: Start, on: Option<&OnCurve>) {
        self.on = on.map(|on| on.equation.clone());
        if on.is_none() && from.t > 0.0 {
            self.rounding.round(from.angle.rest, from.speed);
        }
    }
}

impl Observer for Second<'_, '_> {
    fn step(&mut self, step: &Step, phase: Option<Phase>) -> bool {
        let Second {
            rounding, compared, ..
        } = self;
        match self.on.as_deref().zip(phase) {
            Some((on, phase)) => {
                compared.pass(step, |q| on.curve().pose(q).dtheta);
                rounding.step_on_curve(on, step, phase);
            }
            None => {
                rounding.step(self.equation, self.motion, step);
                compared.pass(step, |_| 1.0);
            }
        }
        false
    }
}
