//! One computation of the periodic motion, by a fixed-point search, and the extremes of its speed.

use std::f64::consts::TAU;

use super::super::angle_model::AngleModel;
use super::super::options::Options;
use super::super::run_setup::RunSetup;
use super::cycles::{CycleMap, CycleRun, not_computed};
use super::fixed_point::{FixedPoint, fixed_point};
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::numeric::angle;
use crate::numeric::{maximum, root};
use crate::plan::cycle_over_angle;
use crate::scene::{Extent, LEAST_RUN_TOLERANCE, Scene, Variable};

/// Extreme of the speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extreme {
    /// Rotation since the start, rad, positive.
    pub turned: f64,
    /// Signed crank speed, rad/s.
    pub omega: f64,
}

pub(super) struct PeriodicOrbit {
    pub cycle: CycleRun,
    /// Least and largest speed, without regard to sign.
    pub extremes: [Extreme; 2],
    /// Fixed point of the cycle map.
    pub fixed: FixedPoint,
    /// Whether every speed is periodic.
    pub any_speed: bool,
}

impl PeriodicOrbit {
    /// Returns the coefficient of fluctuation: range of the speed over its mean.
    pub fn fluctuation(&self) -> f64 {
        let [slow, fast] = self.extremes;
        (fast.omega - slow.omega).abs() * self.cycle.period / self.cycle.rotation()
    }

    /// Returns the Floquet multiplier: factor on a small energy deviation over one period.
    pub fn multiplier(&self) -> f64 {
        // Motions do not cross: a negative multiplier is rounding.
        (1.0 + self.fixed.slope).max(0.0)
    }
}

/// Finds the periodic motion that a scene's start approaches from a speed, rad/s.
pub(super) fn find(scene: &Scene, speed: f64, options: &Options) -> Result<PeriodicOrbit, Error> {
    let first_log_step = 0.05;
    search(scene, speed, options, LEAST_RUN_TOLERANCE, first_log_step)
}

/// Computes a second time, for comparison, a periodic motion that begins at about this speed, rad/s.
pub(super) fn again(scene: &Scene, speed: f64, options: &Options) -> Result<PeriodicOrbit, Error> {
    // Far above the distance of both motions: one step brackets the second.
    let first_log_step = 1e-10;
    let tolerance = 10.0 * LEAST_RUN_TOLERANCE;
    search(scene, speed, options, tolerance, first_log_step)
}

/// Searches at a tolerance of the runs, from a first step in the logarithm of the energy.
fn search(
    scene: &Scene,
    speed: f64,
    options: &Options,
    tolerance: f64,
    step: f64,
) -> Result<PeriodicOrbit, Error> {
    // A scene without a cycle is already refused.
    let turns = cycle_over_angle(scene).unwrap_or(1);
    let mut scene = scene.clone();
    scene.motion.speed = speed;
    scene.run.extent = Some(Extent::Revolutions(turns.into()));
    scene.run.output_every = None;
    scene.run.tolerance = tolerance;
    let task = RunSetup::new(&scene, options, 0)?;
    if task.inertia_vanishes() {
        return Err(unbounded());
    }
    let model = AngleModel::of(&task).with_shared_panels();
    let mut cycles = CycleMap::new(&task, &model, turns);
    match solve(&mut cycles, step) {
        Err(_) if cycles.is_limited => Err(cycles.incomplete()),
        found => found,
    }
}

/// Solves for the periodic motion.
fn solve(cycles: &mut CycleMap<'_>, step: f64) -> Result<PeriodicOrbit, Error> {
    let task = cycles.task;
    let reads = task.equation().loads().reads;
    let by_speed = reads.has(Variable::Omega) || reads.has(Variable::V);
    let any_speed = !by_speed && task.maker.guide.is_none();
    let (cycle, fixed) = match any_speed {
        true => at_first_speed(cycles)?,
        false => {
            let fixed = fixed_point(cycles, step)?;
            let cycle = cycles.cycle(fixed.kinetic)?;
            let mut cycle = cycle.ok_or_else(|| not_computed(NotApplicable::TooSlow))?;
            cycle.relative_error /= fixed.slope.abs().max(cycles.noise);
            (cycle, fixed)
        }
    };
    let extremes = [-1.0, 1.0].map(|sign| extreme(task, &cycle, sign));
    if !extremes.iter().all(|extreme| extreme.omega.is_finite()) {
        return Err(unbounded());
    }
    Ok(PeriodicOrbit {
        cycle,
        extremes,
        fixed,
        any_speed,
    })
}

/// Returns the cycle from the first speed, if it gains no energy: any speed is then periodic.
fn at_first_speed(cycles: &mut CycleMap<'_>) -> Result<(CycleRun, FixedPoint), Error> {
    let kinetic = cycles.first();
    let Some(cycle) = cycles.cycle(kinetic)? else {
        return Err(Error::refused(
            "no steady state: from its start speed the crank does not complete a turn, and no load depends on the speed",
            "give a greater start speed, or a load that drives the crank and depends on the speed",
        ));
    };
    // Largest gain that counts as none, as part of the largest energy: far above the rounding of loads.
    let no_gain = 1e-12;
    if cycle.gain.abs() > cycles.noise.max(no_gain) * cycle.largest_kinetic {
        let (what, load) = match cycle.gain > 0.0 {
            true => ("gains", "brakes"),
            false => ("loses", "drives the crank"),
        };
        return Err(Error::refused(
            format!(
                "no steady state: no load depends on the speed, and every cycle {what} {:.6e} J",
                cycle.gain.abs()
            ),
            format!("add a load that {load} and depends on the speed"),
        ));
    }
    let fixed = FixedPoint {
        kinetic,
        slope: 0.0,
        slope_error: 0.0,
        approached: true,
    };
    Ok((cycle, fixed))
}

/// Finds the largest sign·|speed|: zeros of the acceleration beside the best angles of a fine grid.
fn extreme(task: &RunSetup<'_>, found: &CycleRun, sign: f64) -> Extreme {
    let (sense, whole) = (found.speed.signum(), found.rotation());
    let grid = task.equation().linkage().turn_grid(false).into_iter();
    let since = |theta: f64| (sense * (theta - found.start.rest)).rem_euclid(TAU);
    let grid: Vec<f64> = grid.map(since).collect();
    let mut ways: Vec<f64> = angle::in_turns(&grid, 0..found.turns.into()).collect();
    ways.push(0.0);
    ways.retain(|way| *way < (1.0 - 16.0 * f64::EPSILON) * whole);
    let ways = angle::distinct(ways);
    let value = |way: f64| sign * sense * found.omega(way.rem_euclid(whole));
    let mut rows: Vec<(f64, f64)> = ways.iter().map(|way| (*way, value(*way))).collect();
    // Each place of the cycle has two neighbours.
    let (first, last) = (rows[0], rows[rows.len() - 1]);
    rows.insert(0, (last.0 - whole, last.1));
    rows.push((first.0 + whole, first.1));
    let slope = |way: f64| {
        let way = way.rem_euclid(whole);
        // Any time but the start, at which the guide takes its sign from ahead.
        let t = f64::MIN_POSITIVE;
        let (alpha, _) = task.maker.forward(t, found.angle(way), found.omega(way));
        alpha
    };
    let refine = |[before, here, after]: [(f64, f64); 3]| {
        let top = root::bracketed(slope, before.0, after.0).map(|way| (way, value(way)));
        top.filter(|top| top.1 > here.1).unwrap_or(here)
    };
    let best = maximum::among_rows(&rows, refine);
    let turned = best.map_or(0.0, |(way, _)| way.rem_euclid(whole));
    Extreme {
        turned,
        omega: found.omega(turned),
    }
}

fn unbounded() -> Error {
    Error::refused(
        "the effective inertia vanishes at the dead centres, where the crank speed has no bound: there is no speed fluctuation",
        "give the crank an inertia",
    )
}
