//! A cycle by integration in time: for loads that jump, and for those whose corners are not known as crank angles.

use super::super::{NoRows, Options, Simulation, simulate, simulate_rows};
use super::round::{Motion, Round, Rounds};
use crate::engine::WorkLimit;
use crate::engine::angle::CycleMap;
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::plan::Method;
use crate::scene::{Extent, Scene};

/// Local error target, and that of another computation to compare with.
const TOLERANCE: f64 = 1e-14;
const OTHER: f64 = 1e-13;

/// Cycles in time.
pub(super) struct Timed {
    scene: Scene,
    start: Angle,
    turns: f64,
    /// Inertia at the start, kg m².
    inertia: f64,
    options: Options,
    largest: f64,
    noise: f64,
    /// What a run was refused for, beside a crank that does not complete the cycle.
    pub refused: Option<Error>,
}

impl Timed {
    /// Cycles of so many turns, in the direction of `speed` (rad/s); `other`: for the computation to compare with.
    pub fn new(scene: &Scene, speed: f64, turns: u32, other: bool, limit: WorkLimit<'_>) -> Timed {
        let mut scene = scene.clone();
        scene.motion.speed = speed;
        scene.run.extent = Some(Extent::Revolutions(turns.into()));
        scene.run.output_every = None;
        scene.run.tolerance = if other { OTHER } else { TOLERANCE };
        let start = Angle::from(scene.motion.angle).reduced();
        Timed {
            inertia: Equation::new(&scene).terms(start.rest).inertia.m,
            start,
            turns: turns.into(),
            options: Options {
                method: Method::Time,
                estimate: false,
                max_evaluations: limit.evaluations,
                stop: limit.stop.cloned(),
                events_kept: 0,
                ..Options::default()
            },
            largest: 0.0,
            noise: scene.run.tolerance,
            scene,
            refused: None,
        }
    }

    fn energy(&self, speed: f64) -> f64 {
        0.5 * self.inertia * speed * speed
    }

    /// One cycle.
    fn run(&mut self, kinetic: f64, keep: bool) -> Result<Simulation, NotApplicable> {
        let speed = (2.0 * kinetic / self.inertia).sqrt();
        self.scene.motion.speed = speed.copysign(self.scene.motion.speed);
        let options = Options {
            estimate: keep,
            ..self.options.clone()
        };
        let run = match keep {
            true => simulate(&self.scene, &options),
            false => simulate_rows(&self.scene, &options, &mut NoRows),
        };
        let run = run.map_err(|error| {
            self.refused = Some(error);
            NotApplicable::NotFinite
        })?;
        let summary = &run.summary;
        let fastest = summary.omega_max.abs().max(summary.omega_min.abs());
        self.largest = self.energy(fastest);
        let turned = summary.revolutions * self.scene.motion.speed.signum();
        let complete = summary.stopped.is_none() && turned > self.turns - 0.5;
        complete.then_some(run).ok_or(NotApplicable::TooSlow)
    }
}

impl CycleMap for Timed {
    fn first(&self) -> f64 {
        self.energy(self.scene.motion.speed)
    }

    fn gain(&mut self, kinetic: f64) -> Result<f64, NotApplicable> {
        let run = self.run(kinetic, false)?;
        Ok(self.energy(run.summary.last.omega_rad_per_s) - kinetic)
    }

    fn largest(&self) -> f64 {
        self.largest
    }

    fn noise(&self) -> f64 {
        self.noise
    }
}

impl Rounds for Timed {
    fn round(&mut self, kinetic: f64) -> Result<Round, NotApplicable> {
        let run = self.run(kinetic, true)?;
        let summary = &run.summary;
        let last = summary.last.omega_rad_per_s;
        let error = summary.error_estimate.map(|error| error.omega_rad_per_s);
        // An energy is off by twice as much as its speed.
        self.noise = self
            .noise
            .max(2.0 * error.unwrap_or(f64::INFINITY) / last.abs());
        let slowest = summary.omega_max.abs().min(summary.omega_min.abs());
        let trajectory = run.trajectory.ok_or(NotApplicable::NotFinite)?;
        Ok(Round {
            motion: Motion::Timed {
                trajectory: Box::new(trajectory),
                start: self.start,
            },
            period: summary.last.t_s,
            speed: self.scene.motion.speed,
            gain: self.energy(last) - kinetic,
            largest: self.largest,
            uncertain: self.noise * self.largest / self.energy(slowest),
        })
    }
}
