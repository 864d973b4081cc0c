//! Local search from a start design by COBYLA: linear approximations in a trust region, without derivatives.

use std::cell::RefCell;

use cobyla::{RhoBeg, StopTols, minimize};

use super::evaluator::{Evaluation, Evaluator};

/// Result of one local search.
#[derive(Clone, Debug)]
pub(super) struct LocalOptimum {
    /// Start, in the unit box.
    pub from: Vec<f64>,
    /// Best design of the search.
    pub end: Evaluation,
    /// Number of designs computed.
    pub designs: u64,
}

/// Last design of a search, cached because COBYLA asks for goal and limits one by one, and what is found so far.
struct Incumbent {
    last: Evaluation,
    found: LocalOptimum,
}

/// Runs COBYLA from a design, initial trust radius `step` in parts of the ranges.
pub(super) fn search(evaluator: &Evaluator, from: Evaluation, step: f64) -> LocalOptimum {
    let start = from.at.clone();
    let keys = start.len();
    // COBYLA needs a few dozen designs per key where no valley is curved.
    let most_designs = 300 * keys;
    // Final trust radius, in parts of the ranges, and margin to each limit, in scales of the figure, for ends of searches
    // to meet limits.
    let last_step = 1e-10;
    let safety_margin = 10.0 * last_step;
    let seen = RefCell::new(Incumbent {
        last: from.clone(),
        found: LocalOptimum {
            from: start.clone(),
            end: from,
            designs: 0,
        },
    });
    let look = |at: &[f64]| {
        let Incumbent { last, found } = &mut *seen.borrow_mut();
        if last.at != at {
            *last = evaluator.evaluate(at.to_vec());
            found.designs += 1;
            if last.order(&found.end).is_lt() {
                found.end = last.clone();
            }
        }
        last.clone()
    };
    let goal = |at: &[f64], _: &mut ()| evaluator.scaled_objective(&look(at));
    let limit = |constraint| {
        let look = &look;
        move |at: &[f64], _: &mut ()| evaluator.scaled_margin(&look(at), constraint) - safety_margin
    };
    let limits: Vec<_> = (0..evaluator.problem.constraints.len())
        .map(limit)
        .collect();
    let tolerances = StopTols {
        xtol_abs: vec![last_step; keys],
        ..StopTols::default()
    };
    // The result is unused: `look` has recorded every evaluated design.
    let _ = minimize(
        goal,
        &start,
        &vec![(0.0, 1.0); keys],
        &limits,
        (),
        most_designs,
        RhoBeg::All(step),
        Some(tolerances),
    );
    seen.into_inner().found
}
