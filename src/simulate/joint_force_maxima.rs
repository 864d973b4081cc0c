//! Largest joint forces of a finished run, from its dense motion, by a grid search and Brent's method.
//!
//! The grid of rows is close enough to resolve geometry, loads and motion; Brent's method refines beside the rows at
//! which a force may be largest.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::driving_torque::ConstantSpeedMotion;
use super::load_resolution;
use super::result::{FORCES, Peak, Peaks};
use super::simulation::Simulation;
use crate::mechanism::{Linkage, Reactions};
use crate::numeric::angle;
use crate::numeric::maximum;
use crate::scene::{Scene, Variable};

/// Largest number of rows of a search, and of steps that are kept for it: 16 MB of forces.
pub(super) const MOST_FORCE_ROWS: usize = 400_000;
/// Relative difference of the maxima over all rows and over every second row up to which the grid counts as resolved.
/// Errors fall fourfold as the distance of the rows halves: that of all rows is about a third of the difference.
const GRID_ERROR: f64 = 0.02;

/// Searches the largest forces of a finished run; none if the run is too long to search, or if a force has no value.
pub(super) fn search(scene: &Scene, run: &Simulation) -> Option<Peaks> {
    // A motion that is a function of the crank angle is parametrized by the angle, any other by time.
    let mut way = at_constant_speed(run)
        .or_else(|| over_orbit(run))
        .or_else(|| over_time(scene, run))?;
    loop {
        let sizes = way.parameters.iter().map(|at| (way.sizes)(*at));
        let sizes = sizes.collect::<Option<Vec<_>>>()?;
        if !sizes.as_flattened().iter().all(|size| size.is_finite()) {
            return None;
        }
        let is_resolved = |k: usize| {
            let [all, half] = [1, 2].map(|stride| largest(&sizes, k, stride));
            all - half <= GRID_ERROR * all
        };
        if (0..FORCES).all(is_resolved) {
            let peak = |k| peak(&way, run, k, &sizes);
            return Some(Peaks::new(std::array::from_fn(peak)));
        }
        if 2 * way.parameters.len() > MOST_FORCE_ROWS {
            return None;
        }
        way.parameters = with_midpoints(&way.parameters);
    }
}

/// Returns the largest size of a force over every `stride`-th row, N.
fn largest(sizes: &[[f64; FORCES]], force: usize, stride: usize) -> f64 {
    let rows = sizes.iter().step_by(stride);
    rows.fold(0.0, |largest, row| largest.max(row[force]))
}

/// Inserts the midpoint of each interval between parameters.
fn with_midpoints(parameters: &[f64]) -> Vec<f64> {
    let between = parameters.windows(2);
    let between = between.flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    let mut rows: Vec<f64> = between.chain(parameters.last().copied()).collect();
    rows.dedup();
    rows
}

/// Finds the maximum of a force.
fn peak(way: &Parametrization, run: &Simulation, k: usize, sizes: &[[f64; FORCES]]) -> Peak {
    let size = |at: f64| (way.sizes)(at).map_or(f64::NEG_INFINITY, |sizes| sizes[k]);
    let places = way.parameters.iter().copied();
    let rows: Vec<(f64, f64)> = places.zip(sizes.iter().map(|sizes| sizes[k])).collect();
    let found = maximum::among_rows(&rows, |known| maximum::beside(size, known));
    let (at, value) = found.unwrap_or_default();
    let last = rows.len() - 1;
    let after = way
        .parameters
        .partition_point(|place| *place <= at)
        .min(last);
    let width = rows[after].0 - rows[after.saturating_sub(2)].0;
    let (first, last) = (rows[0].0, rows[last].0);
    // Uncertainty of the place of a maximum, as part of the interval: the last width of Brent's iteration.
    let place_error = 1e-9;
    let beside = [-place_error, place_error].map(|off| (at + off * width).clamp(first, last));
    let excess = beside.map(size);
    let t = (way.time)(at).clamp(0.0, run.summary.last.t_s);
    Peak {
        value_n: value,
        t_s: t,
        theta_rad: run.at(t).map_or(0.0, |(theta, _)| theta),
        added_n: (excess[0].max(excess[1]) - value).max(0.0),
    }
}

/// Parametrization of a run, with the joint forces along it.
struct Parametrization<'a> {
    /// Values of the parameter, in rising order.
    parameters: Vec<f64>,
    /// Sizes of the joint forces at a value of the parameter, N.
    sizes: Box<dyn Fn(f64) -> Option<[f64; FORCES]> + 'a>,
    /// Time at a value of the parameter, s.
    time: Box<dyn Fn(f64) -> f64 + 'a>,
}

/// Parametrizes a run at constant speed by time: one turn if all are equal, otherwise all; resolves geometry and loads.
fn at_constant_speed(run: &Simulation) -> Option<Parametrization<'_>> {
    let (start, speed) = run.trajectory.as_ref()?.as_uniform()?;
    let maker = run.maker.as_ref()?;
    let drive = ConstantSpeedMotion {
        maker,
        start,
        speed,
        end: run.summary.last.t_s,
    };
    let samples = drive.samples().ok()?;
    let is_one_turn = samples.is_one_turn;
    let turn = TAU / speed.abs();
    Some(Parametrization {
        parameters: samples.times,
        sizes: Box::new(move |t| drive.row_at(t).reactions.as_ref().map(sizes)),
        time: Box::new(move |t| if is_one_turn { t.rem_euclid(turn) } else { t }),
    })
}

/// Parametrizes a motion over the crank angle by its places: the nodes of the series of the motion.
fn over_orbit(run: &Simulation) -> Option<Parametrization<'_>> {
    let orbit = run.trajectory.as_ref()?.as_orbit()?;
    let end = run.summary.last.t_s;
    let maker = run.maker.as_ref()?;
    // The time of a place costs more than all else: it is computed only where a load reads it.
    let timed = maker.equation.loads().reads.has(Variable::T);
    let reactions = move |at: f64| {
        let (angle, speed) = orbit.state_at_position(at)?;
        let t = if timed {
            orbit.time_of_position(at)?
        } else {
            0.0
        };
        maker.row(t, angle, speed, None).reactions
    };
    Some(Parametrization {
        parameters: orbit.positions(end)?,
        sizes: Box::new(move |at| reactions(at).as_ref().map(sizes)),
        time: Box::new(move |at| orbit.time_of_position(at).unwrap_or(end)),
    })
}

/// Parametrizes a run by time: the crank turns by a degree at most between rows, less where geometry or loads vary.
fn over_time<'a>(scene: &Scene, run: &'a Simulation) -> Option<Parametrization<'a>> {
    let end = run.summary.last.t_s;
    let period = run.trajectory.as_ref()?.period();
    let span = period.map_or(end, |period| period.min(end));
    let fastest = run.summary.omega_min.abs().max(run.summary.omega_max.abs());
    // As many as of two turns, for loads that change while the crank hardly turns.
    let least_rows = 720.0;
    let step = end / (fastest * end).to_degrees().max(least_rows);
    let rows = (span / step).ceil();
    if rows.is_nan() || rows > MOST_FORCE_ROWS as f64 {
        return None;
    }
    let times = (0..=rows as usize).map(|index| (index as f64 * step).min(span));
    let times = angle::distinct(times.collect());
    let times = with_narrow_peaks(&Linkage::new(&scene.geometry), run, times)?;
    let loads = run.maker.as_ref()?.equation.loads();
    let pieces = load_resolution::unresolved(loads, &times, &|t| run.row(t))?;
    Some(Parametrization {
        parameters: load_resolution::with_pieces(times, &pieces),
        sizes: Box::new(move |t| run.row(t)?.reactions.as_ref().map(sizes)),
        time: Box::new(|t| t),
    })
}

/// Divides the intervals between times, a degree apart at most, in which the crank turns further than shows all that
/// the geometry causes. None for too many times.
fn with_narrow_peaks(linkage: &Linkage, run: &Simulation, times: Vec<f64>) -> Option<Vec<f64>> {
    let mut normals = [-FRAC_PI_2, FRAC_PI_2].into_iter();
    if normals.all(|normal| linkage.shown_distance(normal) >= 1f64.to_radians()) {
        return Some(times);
    }
    let is_resolved = |from: f64, to: f64| {
        let middle = 0.5 * (from + to);
        (to - from).abs() <= linkage.shown_distance(middle)
    };
    let angle = |t: f64| Some((t, run.at(t)?.0));
    let ends = times.into_iter().map(angle).collect::<Option<Vec<_>>>()?;
    let mut left: Vec<_> = ends.into_iter().rev().collect();
    let mut divided = vec![left.pop()?];
    while let Some(next) = left.pop() {
        let last = divided[divided.len() - 1];
        let middle = 0.5 * (last.0 + next.0);
        if is_resolved(last.1, next.1) || middle <= last.0 || middle >= next.0 {
            divided.push(next);
        } else {
            left.extend([next, angle(middle)?]);
        }
        if divided.len() > MOST_FORCE_ROWS {
            return None;
        }
    }
    Some(divided.into_iter().map(|(t, _)| t).collect())
}

/// Returns the sizes of the joint forces, N, in the order of [`Peaks`].
pub(super) fn sizes(forces: &Reactions) -> [f64; FORCES] {
    let size = |[x, y]: [f64; 2]| (x * x + y * y).sqrt();
    [
        size(forces.crank_bearing),
        size(forces.crank_pin),
        size(forces.wrist_pin),
        forces.guide.abs(),
        size(forces.shaking),
    ]
}
