//! The search for the largest forces of a run that can be made again.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::result::Summary;
use super::super::row::RowSink;
use super::super::schedule::{Schedule, WINDOWS};
use super::scan::{Scan, Track};
use super::{FORCES, Peak, Peaks};
use crate::error::Error;
use crate::mechanism::Linkage;
use crate::scene::Scene;

/// Most rows of a search.
const MOST_ROWS: f64 = 4e5;
/// Least rows of a search.
const LEAST_ROWS: f64 = 720.0;
/// Most refinements.
const MOST_PASSES: u32 = 6;
/// The forces are found where a refinement adds less than this part of them; the next would add a thousandth of it.
const SETTLED: f64 = 1e-8;

/// The largest forces of a finished run; none where it is too long to be looked through, or a force has no value.
/// `look` makes the run again with these rows.
pub(in crate::simulate) fn search(
    scene: &Scene,
    summary: &Summary,
    look: &mut dyn FnMut(Schedule, &mut dyn RowSink) -> Result<(), Error>,
) -> Result<Option<Peaks>, Error> {
    let end = summary.last.t_s;
    let mut step = first_step(scene, summary);
    let coarse = loop {
        if end > MOST_ROWS * step {
            return Ok(None);
        }
        let mut scan = Scan::new(step);
        look(Schedule::Times { step, end }, &mut scan)?;
        if !scan.all.finite {
            return Ok(None);
        }
        if scan.is_resolved() {
            break scan.all;
        }
        step *= 0.5;
    };
    refined(coarse, step, end, look)
}

/// Time between the rows at first, s: the crank turns by a degree at most, and by less where the run has narrow peaks.
fn first_step(scene: &Scene, summary: &Summary) -> f64 {
    let fastest = summary.omega_min.abs().max(summary.omega_max.abs());
    let way = fastest * summary.last.t_s;
    let narrow = narrowest(&Linkage::new(&scene.geometry), scene.motion.angle, way);
    let angle = (PI / 180.0).min(0.1 * narrow);
    summary.last.t_s / (way / angle).max(LEAST_ROWS)
}

/// Least width in the crank angle, rad, of the peaks on a way (rad) from an angle. Rods that are hardly long enough make
/// some of the width sqrt((l − |e ± r|)/r) where the crank stands normal to the guide; away from there nothing is narrower
/// than the distance from it.
fn narrowest(linkage: &Linkage, angle: f64, way: f64) -> f64 {
    let Linkage { r, l, e, .. } = *linkage;
    let width = |side: f64| {
        let apart = (angle - side * FRAC_PI_2).rem_euclid(TAU);
        let distance = apart.min(TAU - apart) - way;
        ((l - (e + side * r).abs()) / r).abs().sqrt().max(distance)
    };
    width(1.0).min(width(-1.0))
}

fn refined(
    mut found: Track,
    mut step: f64,
    end: f64,
    look: &mut dyn FnMut(Schedule, &mut dyn RowSink) -> Result<(), Error>,
) -> Result<Option<Peaks>, Error> {
    let mut added = [f64::INFINITY; FORCES];
    for _ in 0..MOST_PASSES {
        let mut times: [f64; WINDOWS] = std::array::from_fn(|i| match i < FORCES {
            true => found.largest[i].t,
            false => found.highest[i - FORCES].t,
        });
        times.sort_by(f64::total_cmp);
        let (schedule, finer) = Schedule::about(times, step, end);
        let mut scan = Scan::new(finer);
        look(schedule, &mut scan)?;
        if !scan.all.finite {
            return Ok(None);
        }
        step = finer;
        let both = found.largest.iter_mut().zip(scan.all.largest);
        for ((best, now), added) in both.zip(&mut added) {
            *added = (now.value - best.value).max(0.0);
            if now.value > best.value {
                *best = now;
            }
        }
        found.highest = scan.all.highest;
        let settled = |k: usize| added[k] <= SETTLED * found.largest[k].value;
        if (0..FORCES).all(settled) {
            break;
        }
    }
    Ok(Some(Peaks::new(std::array::from_fn(|k| Peak {
        value_n: found.largest[k].value,
        t_s: found.largest[k].t,
        theta_rad: found.largest[k].theta,
        added_n: added[k],
    }))))
}
