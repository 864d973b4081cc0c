//! Run at prescribed constant speed: the motion in closed form, its driving torque by inverse dynamics.

use std::f64::consts::TAU;
use std::time::Instant;

use super::driving_torque::ConstantSpeedMotion;
use super::energy_balance::EnergyBalance;
use super::passages;
use super::recorder::Recorder;
use super::row::RowSink;
use super::run_end::{Estimate, RunEnd};
use super::run_setup::RunSetup;
use super::schedule::Schedule;
use super::simulation::Simulation;
use super::stop::Why;
use super::warning::Warning;
use crate::engine::time::MotionState;
use crate::error::Error;
use crate::mechanism::Limits;
use crate::numeric::angle::Angle;
use crate::plan::Engine;
use crate::scene::Extent;
use crate::trajectory::Trajectory;

pub(super) fn run<'a>(
    task: &'a RunSetup<'a>,
    rows: &'a mut dyn RowSink,
) -> Result<Simulation, Error> {
    let begun = Instant::now();
    let equation = task.equation();
    let start = task.start();
    let speed = task.speed;
    let asked = duration(task.extent, speed);
    let blocked = time_to_limit(task, start, speed).filter(|t| *t < asked);
    let end = blocked.unwrap_or(asked);
    let mut motion = ConstantSpeedMotion {
        maker: &task.maker,
        start,
        speed,
        end,
    };
    let last = motion.angle(end);
    let range = blocked.is_none().then(|| motion.torque_range());
    let (torque, warnings) = match range.transpose() {
        Ok(range) => (range, Vec::new()),
        Err(why) => (None, vec![Warning::NoTorqueRange(why)]),
    };
    let balance = match blocked {
        None => motion.energy_balance(),
        // Towards a limit, or where the guide locks, torque and energy grow without bound.
        Some(_) => EnergyBalance {
            residual: f64::NAN,
            largest: f64::NAN,
        },
    };
    let wall_s = begun.elapsed().as_secs_f64();
    let schedule = Schedule::at_speed(task.scene.run.output_every, speed, end);
    let mut recorder = Recorder::new(task, rows, schedule);
    recorder.rows(&mut motion);
    // The limit itself has no finite velocity.
    let mut record = recorder.finish(|| blocked.is_none().then(|| motion.row_at(end)))?;
    (record.events, record.events_total) = passages::at_constant_speed(task, end);
    record.trajectory = Some(Trajectory::uniform(start, speed, end));
    let stopped = blocked.map(|_| match equation.linkage().unlocked(friction(task)) {
        Some(_) => Why::Locked,
        None => Why::DrivenToLimit,
    });
    let end = RunEnd {
        at: MotionState {
            t: end,
            angle: last,
            speed,
        },
        engine: Engine::ClosedForm,
        turned: speed * end,
        estimate: Some(Estimate::of_end(
            2.0 * f64::EPSILON * last.radians().abs(),
            0.0,
        )),
        balance,
        evaluations: 0,
        steps: 0,
        wall_s,
        warnings,
        stopped,
        record,
    };
    let mut run = end.conclude(task);
    run.summary.driving_torque = torque;
    Ok(run)
}

/// Returns the coefficient of friction at the guide.
fn friction(task: &RunSetup<'_>) -> f64 {
    task.maker.guide.as_ref().map_or(0.0, |guide| guide.mu)
}

/// Returns the duration, s, of a run at constant speed, rad/s.
pub(super) fn duration(extent: Extent, speed: f64) -> f64 {
    match extent {
        Extent::Duration(duration) => duration,
        Extent::Revolutions(turns) => turns * TAU / speed.abs(),
    }
}

/// Computes the time, s, at which the crank reaches the end of its range of angles; none if it reaches none.
fn time_to_limit(task: &RunSetup<'_>, start: Angle, speed: f64) -> Option<f64> {
    let [from, to] = Limits::driven_reach(task.equation().linkage(), friction(task))
        .into_iter()
        .find(|[from, to]| (start.rest - from).rem_euclid(TAU) <= to - from)?;
    let done = (start.rest - from).rem_euclid(TAU);
    let left = if speed > 0.0 { to - from - done } else { done };
    (speed != 0.0).then(|| left / speed.abs())
}
