//! Global search in the unit box: Latin hypercube, multi-start local searches, sweeps of nested boxes round the best.

use std::f64::consts::PI;

use statrs::function::gamma::gamma;

use super::FinalSweeps;
use super::evaluator::{Evaluation, Evaluator};
use super::local::{LocalOptimum, search};
use crate::error::Error;
use crate::numeric::parallel;
use crate::sweep::{LatinHypercube, Outcome};

/// Number of designs per key, in the exploration and in each sweep round the best design.
pub(super) const DESIGNS_PER_KEY: u64 = 64;

/// Half-widths of the boxes round the best design, in parts of the ranges.
const HALF_WIDTHS: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6];

/// Result of the global search, in the unit box.
pub(super) struct SearchResult {
    pub best: Evaluation,
    pub starts: Vec<LocalOptimum>,
    pub proof: FinalSweeps,
    /// Least significant difference of the goal.
    pub resolution: f64,
}

/// Explores the box, searches from its best designs, and sweeps boxes round the optimum.
///
/// # Errors
/// [`Error::Refused`] if no design has the figures, [`Error::Incomplete`] if their motions end early;
/// [`Error::Interrupted`] before there is any.
pub(super) fn run(
    evaluator: &mut Evaluator,
    sample: LatinHypercube,
) -> Result<SearchResult, Error> {
    let explored = explore(evaluator, sample)?;
    evaluator.stop.reach(0.2);
    let mut sorted = evaluator.calibrate(explored);
    sorted.sort_by(Evaluation::order);
    let evaluator = &*evaluator;
    // Trust radius in parts of the ranges.
    let first_step = 0.1;
    let starts = parallel::map(starts(&sorted).into_iter(), |from| {
        search(evaluator, from, first_step)
    });
    evaluator.stop.reach(0.7);
    // Of equal designs the end of the first search.
    let ends = starts.iter().rev().map(|start| start.end.clone());
    let mut best = ends.fold(sorted.swap_remove(0), |best, end| {
        if end.order(&best).is_le() { end } else { best }
    });
    let proof = final_sweeps(evaluator, sample.seed, &mut best);
    let resolution = evaluator.resolution(&best);
    Ok(SearchResult {
        best,
        starts,
        proof,
        resolution,
    })
}

/// Computes the designs of a sample, at least one of them with all figures.
fn explore(evaluator: &Evaluator, sample: LatinHypercube) -> Result<Vec<Evaluation>, Error> {
    let keys = evaluator.sweep.varied.len() as u64;
    let at = |index| (0..keys).map(|key| sample.at(key, index)).collect();
    let found = parallel::map(0..sample.count, |index| evaluator.evaluate(at(index)));
    if found.iter().any(|one| one.objective.is_some()) {
        return Ok(found);
    }
    if evaluator.stop.is_requested() {
        return Err(Error::Interrupted);
    }
    let first = evaluator.design(&found[0].at);
    let note = first.notes.into_iter().next();
    let why = note.unwrap_or_else(|| "it has no such figure".to_owned());
    let what = format!(
        "none of {} designs between the bounds has all the figures; of the first one: {why}",
        found.len()
    );
    Err(match first.outcome {
        Outcome::Stopped => Error::Incomplete(what),
        _ => Error::refused(what, "let the bounds hold mechanisms that can be computed"),
    })
}

/// Returns the designs of a sorted sample with no better one in the critical distance of multi-level single linkage.
fn starts(sorted: &[Evaluation]) -> Vec<Evaluation> {
    let keys = sorted[0].at.len() as f64;
    // sigma = 4 keeps the number of searches finite for any sample size (Rinnooy Kan and Timmer, theorem 8).
    let count = sorted.len() as f64;
    let volume = gamma(1.0 + 0.5 * keys) * 4.0 * count.ln() / count;
    let critical = volume.powf(1.0 / keys) / PI.sqrt();
    let near = |one: &Evaluation, other: &Evaluation| {
        let squares = one.at.iter().zip(&other.at).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f64>() < critical * critical
    };
    let is_start = |i: &usize| {
        let one = &sorted[*i];
        one.objective.is_some() && !sorted[..*i].iter().any(|better| near(one, better))
    };
    let most_starts = 16;
    let found = (0..sorted.len()).filter(is_start).take(most_starts);
    found.map(|i| sorted[i].clone()).collect()
}

/// Sweeps boxes round the best design, widest first; restarts the search from any better design.
fn final_sweeps(evaluator: &Evaluator, seed: u64, best: &mut Evaluation) -> FinalSweeps {
    let keys = best.at.len() as u64;
    let mut sweeps = FinalSweeps {
        half_widths: HALF_WIDTHS.to_vec(),
        designs_each: DESIGNS_PER_KEY * keys,
        ..FinalSweeps::default()
    };
    let most_improvements = 30;
    'rounds: while sweeps.improvements < most_improvements {
        let resolution = evaluator.resolution(best);
        for (round, width) in (1u64..).zip(HALF_WIDTHS) {
            let sample = LatinHypercube {
                count: sweeps.designs_each,
                // A new sample in every round.
                seed: seed ^ (u64::from(sweeps.improvements) << 32 | round << 16),
            };
            let at = |index| {
                let middles = (0..).zip(&best.at);
                let at = middles.map(|(key, middle): (u64, &f64)| {
                    let part = 2.0 * sample.at(key, index) - 1.0;
                    (middle + part * width).clamp(0.0, 1.0)
                });
                at.collect()
            };
            let found = parallel::map(0..sample.count, |index| evaluator.evaluate(at(index)));
            if evaluator.stop.is_requested() {
                return sweeps;
            }
            let better = found.into_iter().min_by(Evaluation::order);
            if let Some(better) = better.filter(|one| evaluator.improves(one, best, resolution)) {
                *best = search(evaluator, better, width).end;
                sweeps.improvements += 1;
                let done = f64::from(sweeps.improvements) / f64::from(most_improvements);
                evaluator.stop.reach(0.7 + 0.3 * done);
                continue 'rounds;
            }
        }
        sweeps.is_complete = true;
        break;
    }
    sweeps
}
