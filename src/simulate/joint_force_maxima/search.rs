//! The search for the largest forces of a finished run along its dense motion.

use super::super::simulation::Simulation;
use super::rows::{Rows, Top};
use super::way::Way;
use super::{FORCES, Peak, Peaks};
use crate::numeric::maximum;
use crate::scene::Scene;

/// Most rows of a search, and most steps that are kept for it.
pub(in crate::simulate) const MOST_ROWS: usize = 400_000;
/// Rows are close enough where half of them differ by this part in the largest values.
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
        let rows = Rows {
            places: &way.places,
            sizes: &sizes,
        };
        let is_resolved = |k| {
            let [all, half] = [1, 2].map(|stride| rows.highest(k, stride));
            (all - half).abs() <= PART * all
        };
        if (0..FORCES).all(is_resolved) {
            return Some(Peaks::new(std::array::from_fn(|k| {
                // A force is no larger than the parabola's top by more than that is above its row.
                let surely = rows.tops(k, 1).map(|top| top.row()).fold(0.0, f64::max);
                let may = |top: &Top| 2.0 * top.value - top.row() >= surely;
                let mut tops: Vec<_> = rows.tops(k, 1).filter(may).collect();
                tops.sort_by(|a, b| b.value.total_cmp(&a.value));
                tops.truncate(MOST_TOPS);
                peak(&way, run, k, &tops)
            })));
        }
        if 2 * way.places.len() > MOST_ROWS {
            return None;
        }
        way.places = halved(&way.places);
    }
}

/// Places with one more between each two.
fn halved(places: &[f64]) -> Vec<f64> {
    let between = places.windows(2);
    let between = between.flat_map(|pair| [pair[0], 0.5 * (pair[0] + pair[1])]);
    between.chain(places.last().copied()).collect()
}

/// A force where it is largest beside some tops.
fn peak(way: &Way, run: &Simulation, k: usize, tops: &[Top]) -> Peak {
    let size = |at: f64| (way.sizes)(at).map_or(f64::NEG_INFINITY, |sizes| sizes[k]);
    let mut best = ((0.0, f64::NEG_INFINITY), 0.0);
    for top in tops {
        let [(from, _), here, (to, _)] = top.beside;
        let between = match from < here.0 && here.0 < to {
            true => maximum::between(size, top.beside),
            false => maximum::largest(size, from, to),
        };
        for found in [here, between] {
            if found.1 > best.0.1 {
                best = (found, to - from);
            }
        }
    }
    let ((at, value), width) = best;
    let (first, last) = (way.places[0], way.places[way.places.len() - 1]);
    let beside = [-LEFT, LEFT].map(|left| size((at + left * width).clamp(first, last)));
    let t = (way.time)(at).clamp(0.0, run.summary.last.t_s);
    Peak {
        value_n: value,
        t_s: t,
        theta_rad: run.at(t).map_or(0.0, |(theta, _)| theta),
        added_n: (beside[0].max(beside[1]) - value).max(0.0),
    }
}
