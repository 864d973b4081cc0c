//! Global error of a run that was handed over.

use std::f64::consts::TAU;
use std::time::Instant;

use super::super::angle_motion::{PLACE, late_by};
use super::super::by_angle::{MARGIN, ROUNDING, finer, most_evaluations};
use super::super::configuration_curve;
use super::super::configuration_curve::Noise;
use super::super::error_estimate::{Forward, Rounding, tighter};
use super::super::result::{Cost, ErrorEstimate};
use super::super::roundoff_propagation::Spread;
use super::super::run_setup::RunSetup;
use super::super::state_transition::StateTransition;
use super::arrived::{Arrived, End, Observer};
use super::course::Course;
use crate::engine::Counted;
use crate::engine::angle::{Driving, Errors};
use crate::engine::step::Step;
use crate::engine::time::{Settings, Start};
use crate::error::Error;
use crate::mechanism::Equation;
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

impl Observer for Shaken<'_> {
    fn over_angle(&mut self, from: Start, until: f64, driving: Driving) -> Result<(), Error> {
        let (angle, speed) = driving.orbit.state(driving.end);
        let to = Start {
            t: until,
            angle,
            speed,
        };
        let errors = &driving.errors;
        let transition = self.transition([&from, &to], errors);
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

    fn with_friction(&mut self, run: &mut dyn FnMut(&mut dyn configuration_curve::Observer)) {
        if let Some(noise) = &mut self.rubbing {
            run(noise);
        }
    }

    fn end_in_time(&mut self, _: &Counted<'_>, _: &Step, _: &Settings) -> Option<Step> {
        None
    }
}

/// Global error of the last state: its distance from that of a much finer run with other pieces, and what rounding
/// may have added to both.
pub(super) fn estimate(
    task: &RunSetup<'_>,
    course: &Course<'_>,
    arrived: &Arrived,
) -> Option<(ErrorEstimate, Cost)> {
    let begun = Instant::now();
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
        max_evaluations: most_evaluations(arrived.evaluations, course.max_evaluations),
        ..*course
    };
    let forward = Forward(course.equation);
    let motion = Counted::new(&forward);
    let sliding = course.sliding;
    let mut shaken = Shaken {
        equation: course.equation,
        motion: &motion,
        rounding: Rounding::new(finer.settings.method, true),
        rubbing: sliding.map(|sliding| Noise::new(sliding.equation())),
    };
    let best = finer.run(None, &mut shaken).ok()?;
    if best.end != End::AtGoal {
        return None;
    }
    let floor = late_by(task, (end.angle, end.speed), end.t, ROUNDING * end.t, PLACE);
    let [angle_noise, speed_noise] = shaken.noise();
    let estimate = ErrorEstimate {
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
    Some((estimate, cost))
}
