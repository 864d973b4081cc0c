//! Map of a cycle (Poincare): kinetic energy at the end of a cycle from that at its start, by a run of one cycle.

use std::f64::consts::{PI, TAU};

use super::super::angle_model::AngleModel;
use super::super::forward;
use super::super::options::Options;
use super::super::row::NoRows;
use super::super::run_setup::RunSetup;
use super::super::simulation::Simulation;
use super::super::stop::{Stopped, Why};
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::trajectory::Trajectory;

/// Run of one cycle of the loads.
pub(super) struct CycleRun {
    trajectory: Trajectory,
    /// Crank angle at the start.
    pub start: Angle,
    /// Number of turns after which the loads repeat.
    pub turns: u32,
    /// Duration, s.
    pub period: f64,
    /// Crank speed at the start, rad/s.
    pub speed: f64,
    /// Gain of kinetic energy over the cycle, J.
    pub gain: f64,
    /// Largest kinetic energy, J.
    pub largest_kinetic: f64,
    /// Uncertainty of the energies, relative to them.
    pub relative_error: f64,
}

impl CycleRun {
    /// Returns the rotation of the crank, rad.
    pub fn rotation(&self) -> f64 {
        f64::from(self.turns) * TAU
    }

    /// Returns the crank angle where the crank has turned by `turned` (rad) since the start.
    pub fn angle(&self, turned: f64) -> Angle {
        self.start.plus(self.speed.signum() * turned)
    }

    /// Returns the speed (rad/s) where the crank has turned by `turned` (rad) since the start.
    pub fn omega(&self, turned: f64) -> f64 {
        if let Some(orbit) = self.trajectory.as_orbit() {
            return orbit.passage(turned).map_or(f64::NAN, |(_, speed)| speed);
        }
        let state = |t: f64| self.trajectory.state(t);
        let ahead = |t: f64| {
            let way = |(angle, _): (Angle, f64)| angle.minus(self.start).abs();
            state(t).map_or(f64::NAN, way) - turned
        };
        let end = self.trajectory.end();
        // At the end the rotation is rounded.
        let t = root::bracketed(ahead, 0.0, end).unwrap_or(end);
        state(t).map_or(f64::NAN, |(_, speed)| speed)
    }
}

/// Poincaré map of a scene, the gain of kinetic energy over a cycle: runs from any energy with one set-up, which share their panels.
pub(super) struct CycleMap<'a> {
    pub task: &'a RunSetup<'a>,
    model: &'a AngleModel<'a>,
    /// Number of turns after which the loads repeat.
    turns: u32,
    /// Inertia at the start, kg m².
    inertia: f64,
    /// Largest kinetic energy in the last cycle, J.
    pub largest_kinetic: f64,
    /// Error of a gain, relative to the largest energy.
    pub noise: f64,
    /// Evaluations that are left to the search.
    left: u64,
    /// Whether a run ended as it would have reached the work limit; a cycle from another energy may take less.
    pub is_limited: bool,
    /// Reason for which the first of the runs that ended early did not complete its cycle.
    pub stopped: Option<Stopped>,
}

impl<'a> CycleMap<'a> {
    /// Makes the map for a set-up and the model of its mechanism over the angle.
    pub fn new(task: &'a RunSetup<'a>, model: &'a AngleModel<'a>, turns: u32) -> CycleMap<'a> {
        CycleMap {
            task,
            model,
            turns,
            inertia: task.equation().terms(task.start().rest).m,
            largest_kinetic: 0.0,
            noise: task.scene.run.tolerance,
            left: task.options.max_evaluations,
            is_limited: false,
            stopped: None,
        }
    }

    fn energy(&self, speed: f64) -> f64 {
        0.5 * self.inertia * speed * speed
    }

    /// Returns the speed at the start for a kinetic energy (J), rad/s.
    fn speed(&self, kinetic: f64) -> f64 {
        (2.0 * kinetic / self.inertia)
            .sqrt()
            .copysign(self.task.speed)
    }

    /// Runs the cycle that begins with a kinetic energy, J; none if the crank does not complete it.
    fn run(&mut self, kinetic: f64, keep: bool) -> Result<Option<Simulation>, Error> {
        let options = Options {
            estimate: keep,
            max_evaluations: self.left,
            ..self.task.options.clone()
        };
        let task = RunSetup {
            speed: self.speed(kinetic),
            stops_at_reversal: true,
            steps_kept: if keep { usize::MAX } else { 0 },
            options: &options,
            ..self.task.clone()
        };
        let run = forward::run(&task, self.model, &mut NoRows)?;
        let summary = &run.summary;
        let estimate = summary.estimate_cost.map_or(0, |cost| cost.evaluations);
        self.left = self.left.saturating_sub(summary.evaluations + estimate);
        match summary.stopped.as_ref().map(|stopped| &stopped.why) {
            Some(Why::WorkLimit) => return Err(self.incomplete()),
            Some(Why::WorkLimitAhead | Why::TooManyTurns) => self.is_limited = true,
            _ => {}
        }
        let fastest = summary.omega_max.abs().max(summary.omega_min.abs());
        self.largest_kinetic = self.energy(fastest);
        let turned = TAU * summary.revolutions * self.task.speed.signum();
        let whole = task.extent.angle().unwrap_or_default();
        let complete = summary.stopped.is_none() && turned > whole - PI;
        if !complete {
            self.stopped = self.stopped.take().or(run.summary.stopped);
            return Ok(None);
        }
        Ok(Some(run))
    }

    /// Returns the error of a search that ends at the work limit.
    pub fn incomplete(&self) -> Error {
        Error::Incomplete(format!(
            "no steady state was found within the work limit of {} evaluations: raise --max-evaluations, or give loads that are less steep",
            self.task.options.max_evaluations
        ))
    }

    /// Returns the energy gained by a cycle, J: the work of its loads, exact also where it is small beside the energy.
    fn gained(&self, run: &Simulation) -> f64 {
        let rotation = self.task.extent.angle().unwrap_or_default();
        let torque = self.task.equation().loads().constant.torque;
        let by_torque = torque * rotation.copysign(self.task.speed);
        run.work.unwrap_or(f64::NAN) + by_torque
    }

    /// Computes the cycle that begins with a kinetic energy, J; none if the crank does not complete it.
    pub fn cycle(&mut self, kinetic: f64) -> Result<Option<CycleRun>, Error> {
        let Some(run) = self.run(kinetic, true)? else {
            return Ok(None);
        };
        let summary = &run.summary;
        let last = summary.last.omega_rad_per_s;
        let error = summary.error_estimate.map(|error| error.omega_rad_per_s);
        // The relative error of an energy is twice that of its speed.
        self.noise = self
            .noise
            .max(2.0 * error.unwrap_or(f64::INFINITY) / last.abs());
        let slowest = summary.omega_max.abs().min(summary.omega_min.abs());
        let (period, gain) = (summary.last.t_s, self.gained(&run));
        Ok(run.trajectory.map(|trajectory| CycleRun {
            trajectory,
            start: self.task.start(),
            turns: self.turns,
            period,
            speed: self.speed(kinetic),
            gain,
            largest_kinetic: self.largest_kinetic,
            relative_error: self.noise * self.largest_kinetic / self.energy(slowest),
        }))
    }

    /// Returns the energy at the start of the scene, J.
    pub fn first(&self) -> f64 {
        self.energy(self.task.speed)
    }

    /// Returns the energy gained by the cycle that begins with a kinetic energy, J; none if it is not completed.
    pub fn gain(&mut self, kinetic: f64) -> Result<Option<f64>, Error> {
        let run = self.run(kinetic, false)?;
        Ok(run.map(|run| self.gained(&run)))
    }

    /// Returns the gain of a cycle that the crank has to complete, J.
    pub fn gain_of_complete(&mut self, kinetic: f64) -> Result<f64, Error> {
        let gain = self.gain(kinetic)?;
        gain.ok_or_else(|| not_computed(NotApplicable::TooSlow))
    }
}

/// Returns the error of a steady state that cannot be computed.
pub(super) fn not_computed(why: NotApplicable) -> Error {
    Error::refused(
        format!("the steady state cannot be computed: {why}"),
        "look at the loads; or simulate until the motion repeats",
    )
}
