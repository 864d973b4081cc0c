//! The search for the largest forces of a finished run along its dense motion.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::result::Summary;
use super::super::row::Row;
use super::scan::{Place, Scan, Track};
use super::{Peak, Peaks, of_row};
use crate::mechanism::Linkage;
use crate::numeric::maximum;
use crate::scene::Scene;

/// Most rows of a search, and most steps that are kept for it.
pub(in crate::simulate) const MOST_ROWS: usize = 400_000;
/// Least rows of a search.
const LEAST_ROWS: f64 = 720.0;
/// Part of the distance of two rows within which golden section leaves the place of a maximum.
const LEFT: f64 = 1e-9;

/// The largest forces of a finished run, whose rows are known at any time (s) and repeat after a `period` (s), if they do;
/// none where the run is too long to be looked through, or a force has no value.
pub(in crate::simulate) fn search(
    scene: &Scene,
    summary: &Summary,
    period: Option<f64>,
    row: &dyn Fn(f64) -> Option<Row>,
) -> Option<Peaks> {
    let end = period.map_or(summary.last.t_s, |period| period.min(summary.last.t_s));
    let mut step = first_step(scene, summary);
    let coarse = loop {
        let rows = (end / step).ceil();
        if rows > MOST_ROWS as f64 {
            return None;
        }
        let mut scan = Scan::default();
        for index in 0..=rows as u64 {
            scan.take(&row((index as f64 * step).min(end))?);
        }
        if !scan.all.finite {
            return None;
        }
        if scan.is_resolved() {
            break scan.all;
        }
        step *= 0.5;
    };
    Some(refined(&coarse, step, end, row))
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

/// Each force at its top between the rows beside its largest row, and beside the row whose parabola is highest.
fn refined(coarse: &Track, step: f64, end: f64, row: &dyn Fn(f64) -> Option<Row>) -> Peaks {
    let size = |k: usize, t: f64| row(t).map_or(f64::NEG_INFINITY, |row| of_row(&row)[k]);
    Peaks::new(std::array::from_fn(|k| {
        let largest = coarse.largest[k];
        let highest = coarse.highest[k];
        let top = |place: &Place| {
            let (from, to) = ((place.t - step).max(0.0), (place.t + step).min(end));
            maximum::largest(|t| size(k, t), from, to)
        };
        let mut best = (largest.t, largest.value);
        for place in [Some(largest), (highest.t != largest.t).then_some(highest)] {
            let found = place.as_ref().map_or(best, top);
            if found.1 > best.1 {
                best = found;
            }
        }
        let (t, value) = best;
        let beside = [-LEFT, LEFT].map(|left| size(k, (t + left * step).clamp(0.0, end)));
        Peak {
            value_n: value,
            t_s: t,
            theta_rad: row(t).map_or(largest.theta, |row| row.theta),
            added_n: (beside[0].max(beside[1]) - value).max(0.0),
        }
    }))
}
