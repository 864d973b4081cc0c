//! The search for the largest forces of a finished run along its dense motion.

use super::super::simulation::Simulation;
use super::way::Way;
use super::{FORCES, Peak, Peaks};
use crate::numeric::maximum;
use crate::scene::Scene;

/// Most rows of a search, and most steps that are kept for it.
pub(in crate::simulate) const MOST_ROWS: usize = 400_000;
/// Rows are close enough where every second of them shows the largest values to this part.
const PART: f64 = 0.02;
/// Most tops of a force that are looked at closely.
const MOST_TOPS: usize = 8;
/// Part of the distance of two rows within which the place of a maximum is known.
const LEFT: f64 = 1e-9;

/// The largest forces of a finished run; none where it is too long to be looked through, or a force has no value.
pub(in crate::simulate) fn search(scene: &Scene, run: &Simulation) -> Option<Peaks> {
    let mut way = Way::of(scene, run, MOST_ROWS)?;
    loop {
        let sizes = way.places.iter().map(|at| (way.sizes)(*at));
        let sizes = sizes.collect::<Option<Vec<_>>>()?;
        if !sizes.as_flattened().iter().all(|size| size.is_finite()) {
            return None;
        }
        let is_resolved = |k: usize| {
            let [all, half] = [1, 2].map(|stride| largest(&sizes, k, stride));
            all - half <= PART * all
        };
        if (0..FORCES).all(is_resolved) {
            let peak = |k| peak(&way, run, k, &sizes);
            return Some(Peaks::new(std::array::from_fn(peak)));
        }
        if 2 * way.places.len() > MOST_ROWS {
            return None;
        }
        way.places = halved(&way.places);
    }
}

/// The largest size of a force on every `stride`-th row.
fn largest(sizes: &[[f64; FORCES]], force: usize, stride: usize) -> f64 {
    let rows = sizes.iter().step_by(stride);
    rows.fold(0.0, |largest, row| largest.max(row[force]))
}

/// Places with one more between each two.
fn halved(places: &[f64]) -> Vec<f64> {
    let between = places.windows(2);
    let between = between.flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    between.chain(places.last().copied()).collect()
}

/// A force where it is largest: beside the rows that are no smaller than their neighbours, nor than the largest by more than
/// rows may miss.
fn peak(way: &Way, run: &Simulation, k: usize, sizes: &[[f64; FORCES]]) -> Peak {
    let size = |at: f64| (way.sizes)(at).map_or(f64::NEG_INFINITY, |sizes| sizes[k]);
    let last = sizes.len() - 1;
    let beside = |row: usize| [row.saturating_sub(1), row, (row + 1).min(last)];
    let least = (1.0 - 2.0 * PART) * largest(sizes, k, 1);
    let is_top = |row: &usize| {
        let [before, here, after] = beside(*row).map(|row| sizes[row][k]);
        here >= least.max(before).max(after)
    };
    let mut tops: Vec<usize> = (0..=last).filter(is_top).collect();
    tops.sort_by(|a, b| sizes[*b][k].total_cmp(&sizes[*a][k]));
    tops.truncate(MOST_TOPS);
    let ((at, value), width) = tops
        .into_iter()
        .map(|row| {
            let known = beside(row).map(|row| (way.places[row], sizes[row][k]));
            (refined(size, known), known[2].0 - known[0].0)
        })
        .reduce(|best, found| if found.0.1 > best.0.1 { found } else { best })
        .unwrap_or_default();
    let (first, last) = (way.places[0], way.places[last]);
    let beside = [-LEFT, LEFT].map(|left| size((at + left * width).clamp(first, last)));
    let t = (way.time)(at).clamp(0.0, run.summary.last.t_s);
    Peak {
        value_n: value,
        t_s: t,
        theta_rad: run.at(t).map_or(0.0, |(theta, _)| theta),
        added_n: (beside[0].max(beside[1]) - value).max(0.0),
    }
}

/// Where a function is largest beside a place, and its value there: `known` at the place and its neighbours, of which the place
/// itself may be one.
pub(in crate::simulate) fn refined(
    f: impl FnMut(f64) -> f64,
    known: [(f64, f64); 3],
) -> (f64, f64) {
    let [(from, _), here, (to, _)] = known;
    let between = match from < here.0 && here.0 < to {
        true => maximum::between(f, known),
        false => maximum::largest(f, from, to),
    };
    if between.1 > here.1 { between } else { here }
}
