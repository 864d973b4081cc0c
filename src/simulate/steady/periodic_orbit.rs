//! One computation of the periodic motion, by a fixed-point search, and the extremes of its speed.

use std::f64::consts::TAU;

use super::super::angle_model::AngleModel;
use super::super::options::Options;
use super::super::run_setup::RunSetup;
use super::super::stop::Stopped;
use super::cycles::{CycleMap, CycleRun};
use super::fixed_point::{FixedPoint, NoCycle, fixed_point};
use crate::engine::energy::NotApplicable;
use crate::error::Error;
use crate::numeric::angle::{self, Angle};
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
    pub start: Angle,
    pub cycle: CycleRun,
    /// Number of turns in a period.
    pub turns: u32,
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
        (fast.omega - slow.omega).abs() * self.cycle.period / self.rotation()
    }

    /// Returns the Floquet multiplier: factor on a small energy deviation over one period.
    pub fn multiplier(&self) -> f64 {
        // Motions do not cross: a negative multiplier is rounding.
        (1.0 + self.fixed.slope).max(0.0)
    }

    /// Returns the rotation of the crank in a period, rad.
    pub fn rotation(&self) -> f64 {
        f64::from(self.turns) * TAU
    }

    /// Returns the speed, rad/s, where the crank has turned by `turned` (rad) since the start.
    pub fn omega(&self, turned: f64) -> f64 {
        self.cycle.omega(self.start, turned)
    }

    /// Returns the crank angle where the crank has turned by `turned` (rad) since the start.
    pub fn angle(&self, turned: f64) -> Angle {
        self.start.plus(self.cycle.speed.signum() * turned)
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
    let mut cycles = CycleMap::new(&task, &model);
    match (solve(&mut cycles, turns, step), cycles.refused) {
        (Err(_), Some(why)) => Err(why),
        (found, _) => found,
    }
}

/// Solves for the periodic motion over a number of turns, after which the loads repeat.
fn solve(cycles: &mut CycleMap<'_>, turns: u32, step: f64) -> Result<PeriodicOrbit, Error> {
    let task = cycles.task;
    let reads = task.equation().loads().reads;
    let by_speed = reads.has(Variable::Omega) || reads.has(Variable::V);
    if !by_speed && task.maker.guide.is_none() {
        let cycle = cycles.cycle(cycles.first()).map_err(not_turned)?;
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
            kinetic: cycles.first(),
            slope: 0.0,
            slope_error: 0.0,
            approached: true,
        };
        return found(task, turns, cycle, fixed, true);
    }
    let fixed = fixed_point(cycles, step);
    let fixed = fixed.map_err(|why| no_cycle(why, cycles.stopped.take()))?;
    let mut cycle = cycles.cycle(fixed.kinetic).map_err(not_computed)?;
    cycle.relative_error /= fixed.slope.abs().max(cycles.noise);
    found(task, turns, cycle, fixed, false)
}

/// Makes the result from a cycle that begins at a fixed point.
fn found(
    task: &RunSetup<'_>,
    turns: u32,
    cycle: CycleRun,
    fixed: FixedPoint,
    any_speed: bool,
) -> Result<PeriodicOrbit, Error> {
    let mut found = PeriodicOrbit {
        start: task.start(),
        turns,
        extremes: [Extreme {
            turned: 0.0,
            omega: cycle.speed,
        }; 2],
        fixed,
        any_speed,
        cycle,
    };
    found.extremes = [-1.0, 1.0].map(|sign| extreme(task, &found, sign));
    let known = found
        .extremes
        .iter()
        .all(|extreme| extreme.omega.is_finite());
    if known { Ok(found) } else { Err(unbounded()) }
}

/// Finds the largest sign·|speed|: zeros of the acceleration beside the best angles of a fine grid.
fn extreme(task: &RunSetup<'_>, found: &PeriodicOrbit, sign: f64) -> Extreme {
    let (sense, whole) = (found.cycle.speed.signum(), found.rotation());
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

fn not_computed(why: NotApplicable) -> Error {
    Error::refused(
        format!("the steady state cannot be computed: {why}"),
        "look at the loads; or simulate until the motion repeats",
    )
}

/// Returns the error of a search without a result; `stopped`: end of the first run that did not complete its cycle.
fn no_cycle(why: NoCycle, stopped: Option<Stopped>) -> Error {
    match why {
        NoCycle::Gains => Error::refused(
            "no steady state: at every speed a cycle gains energy",
            "add a load that brakes the more the faster the crank turns",
        ),
        NoCycle::Stops => Error::refused(
            "no steady state: at every speed a cycle loses energy or is not completed, the crank stops",
            "add a load that drives the crank in the sense of motion.speed",
        ),
        NoCycle::Incomplete => match stopped {
            Some(stopped) => Error::refused(
                format!("no steady state: at no speed the crank completes a cycle: {stopped}"),
                "change what ends the cycle there",
            ),
            // The reason is not a lack of energy.
            None => not_computed(NotApplicable::NotSmooth),
        },
        NoCycle::NotApplicable(why) => not_computed(why),
    }
}

/// Returns the error of loads independent of the speed whose cycle cannot be computed.
fn not_turned(why: NotApplicable) -> Error {
    match why {
        NotApplicable::TooSlow => Error::refused(
            "no steady state: from its start speed the crank does not complete a turn, and no load depends on the speed",
            "give a greater start speed, or a load that drives the crank and depends on the speed",
        ),
        why => not_computed(why),
    }
}
