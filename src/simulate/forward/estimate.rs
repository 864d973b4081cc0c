//! Global error of a free motion.

use std::f64::consts::TAU;
use std::time::Instant;

use super::super::angle_motion::{PLACE, late_by};
use super::super::by_angle::{ROUNDING, finer, most_evaluations};
use super::super::configuration_curve::{self, Follow, Noise};
use super::super::error_estimate::{self, Forward, MARGIN, Rounding, tighter};
use super::super::outcome::Estimate;
use super::super::record::Record;
use super::super::result::{Cost, ErrorEstimate};
use super::super::roundoff_propagation::Spread;
use super::super::state_transition::StateTransition;
use super::super::{by_angle, by_energy};
use super::arrived::{Arrived, Driven, End, Sink};
use super::engine_loop::Course;
use crate::engine::Counted;
use crate::engine::angle::Errors;
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::mechanism::{CurveEquation, Equation};
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::scene::Extent;

/// The second run is handed over at other places.
const OTHER_WAIT: f64 = 1.4 * TAU;
/// What is stated of rounding with friction, in standard deviations.
const RUBBING_DEVIATIONS: f64 = 2.0;

/// Less of an error of the energy than this is forgotten. Half or twice as much changes none of 200 random runs.
const FORGOTTEN: f64 = 0.1;

/// Carries what rounding does from piece to piece.
struct Shaken<'a> {
    equation: &'a Equation,
    motion: &'a Counted<'a>,
    /// Of pieces over the angle, and in time without friction.
    rounding: Rounding,
    /// Of all, if there is friction.
    rubbing: Option<Noise<'a>>,
}

impl Shaken<'_> {
    /// Angle error and speed error, in rad and rad/s.
    fn noise(&self) -> [f64; 2] {
        match &self.rubbing {
            Some(noise) => [noise.spread.angle(), noise.spread.speed()]
                .map(|deviation| RUBBING_DEVIATIONS * f64::EPSILON * deviation),
            None => self.rounding.stated(),
        }
    }

    /// What becomes of a perturbation over a piece over the angle: it is early by a time, which stays, and has another
    /// energy, which makes it early, too.
    fn transition(&self, [from, to]: [&Start; 2], errors: &Errors) -> StateTransition {
        let [inertia, then] = [from, to].map(|at| self.inertia(at));
        let [alpha, after] = [from, to].map(|at| self.acceleration(at));
        let energy = [-inertia * alpha, inertia * from.speed];
        // A piece that loses nearly all of its energy forgets what it had.
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

impl Sink for Shaken<'_> {
    fn over_angle(&mut self, driven: &Driven) -> Result<(), Error> {
        let Driven {
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
        // By its own rounding.
        let [late, off] = [errors.late, errors.off].map(|error| error / f64::EPSILON);
        let angle = speed * late;
        let faster = off / (self.inertia(&to) * speed);
        let along = [angle, self.acceleration(&to) * late];
        let carried = |spread: Spread| {
            spread
                .carried(&transition)
                .along(along[0], along[1])
                .plus(0.0, faster)
        };
        self.rounding.spread = carried(self.rounding.spread);
        if let Some(noise) = &mut self.rubbing {
            noise.spread = carried(noise.spread);
        }
        Ok(())
    }

    fn begin_in_time(&mut self, from: Start) {
        self.rounding.round(from.angle.rest, from.speed);
    }

    fn step(&mut self, step: &Step) -> bool {
        self.rounding.step(self.equation, self.motion, step);
        false
    }

    fn along_curve(
        &mut self,
        _: &CurveEquation,
        _: Angle,
        run: &mut dyn FnMut(&mut dyn configuration_curve::Observer),
    ) {
        if let Some(noise) = &mut self.rubbing {
            run(noise);
        }
    }

    fn end_in_time(&mut self, _: &Counted<'_>, _: &Step, _: &Settings) -> Option<Step> {
        None
    }
}

/// Global error of a run, by the second run that its engine asks for, or by none; none where that does not finish.
pub(super) fn estimate<'a>(
    course: &'a Course<'_>,
    arrived: &'a Arrived,
    record: &'a Record,
    wants_rows: bool,
) -> impl FnOnce() -> Option<Estimate> + 'a {
    move || match (&arrived.driven, &arrived.on_curve, &arrived.last) {
        (Some(driven), ..) if arrived.is_one_piece() => {
            over_angle(course, arrived, driven, wants_rows)
        }
        (_, Some(followed), _) if arrived.is_one_piece() => {
            let on = course.curve.get()?;
            let follow = Follow {
                equation: &on.equation,
                settings: course.settings,
                start: on.start,
                turn_limit: course.extent.angle(),
                turned_from: course.task.start(),
            };
            configuration_curve::estimate(&follow, followed, &record.checkpoints)
                .map(Estimate::from)
        }
        (_, None, Some(last)) if arrived.is_one_piece() => {
            let run = error_estimate::Ended {
                last,
                evaluations: arrived.evaluations,
                checkpoints: &record.checkpoints,
            };
            let task = course.task;
            error_estimate::estimate(task.equation(), task.first_state(), &course.settings, run)
                .map(Estimate::from)
        }
        _ => by_other_pieces(course, arrived),
    }
}

/// Of one piece over the angle.
fn over_angle(
    course: &Course<'_>,
    arrived: &Arrived,
    driven: &Driven,
    wants_rows: bool,
) -> Option<Estimate> {
    let task = course.task;
    match driven.engine {
        Engine::Energy => Some(by_energy::estimate(
            task,
            &driven.driving,
            arrived.work,
            wants_rows,
        )),
        _ => match by_angle::estimate(
            course.position,
            task,
            arrived.evaluations,
            &driven.driving,
            wants_rows,
        ) {
            Ok(estimate) => estimate,
            Err(_) => by_other_pieces(course, arrived),
        },
    }
}

/// Of pieces of several engines: the distance of the last state from that of a much finer run with other pieces, and what
/// rounding may have added to both.
fn by_other_pieces(course: &Course<'_>, arrived: &Arrived) -> Option<Estimate> {
    let task = course.task;
    let equation = task.equation();
    let begun = Instant::now();
    let end = arrived.now;
    let finer = Course {
        first: Engine::Angle,
        is_second: true,
        extent: Extent::Duration(end.t),
        resolution: finer(),
        settings: Settings {
            tolerance: tighter(course.settings.tolerance),
            t_end: end.t,
            ..course.settings
        },
        wait: OTHER_WAIT,
        max_evaluations: most_evaluations(arrived.evaluations, course.max_evaluations),
        ..course.clone()
    };
    let forward = Forward(equation);
    let motion = Counted::new(&forward);
    let sliding = task.maker.sliding;
    let mut shaken = Shaken {
        equation,
        motion: &motion,
        rounding: Rounding::new(finer.settings.method, true),
        rubbing: sliding.map(|sliding| Noise::new(sliding.equation())),
    };
    let best = finer.run(&mut shaken).ok()?;
    if !matches!(best.end, End::AtGoal) {
        return None;
    }
    let floor = late_by(task, (end.angle, end.speed), end.t, ROUNDING * end.t, PLACE);
    let [angle_noise, speed_noise] = shaken.noise();
    let error = ErrorEstimate {
        theta_rad: MARGIN * end.angle.minus(best.now.angle).abs() + floor.theta_rad + angle_noise,
        omega_rad_per_s: MARGIN * (end.speed - best.now.speed).abs()
            + floor.omega_rad_per_s
            + speed_noise,
    };
    let for_slopes = shaken.rubbing.map_or(0, |noise| noise.evaluations.get());
    let cost = Cost {
        evaluations: best.evaluations + motion.evaluations() + for_slopes,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some(Estimate::of_end(error, Some(cost)))
}
