//! Local search from a start design by COBYLA: linear approximations in a trust region, without derivatives.

use std::cell::RefCell;

use cobyla::{RhoBeg, StopTols, minimize};

use super::evaluator::{Candidate, Evaluator};

/// Final trust-region radius of a search, in parts of the ranges between the bounds.
const LAST_STEP: f64 = 1e-10;

/// Safety margin to each limit, in scales of the figure, for ends of searches to meet limits.
const KEPT_FROM_LIMITS: f64 = 10.0 * LAST_STEP;

/// Maximum number of designs of a search per key; COBYLA needs a few dozen where no valley is curved.
const DESIGNS: usize = 300;

/// Result of one local search.
#[derive(Clone, Debug)]
pub(super) struct Searched {
    /// Start, in the unit box.
    pub from: Vec<f64>,
    /// Best design of the search.
    pub end: Candidate,
    /// Number of designs computed.
    pub designs: u64,
}

/// Last design of a search, cached because COBYLA asks for goal and limits one by one, and the best design.
struct Incumbent {
    last: Candidate,
    best: Candidate,
    designs: u64,
}

/// Runs COBYLA from a design, initial trust radius `step` in parts of the ranges; `worst` replaces a missing goal.
pub(super) fn search(evaluator: &Evaluator, from: Candidate, step: f64, worst: f64) -> Searched {
    let start = from.at.clone();
    let keys = start.len();
    let seen = RefCell::new(Incumbent {
        last: from.clone(),
        best: from,
        designs: 0,
    });
    let look = |at: &[f64]| {
        let mut seen = seen.borrow_mut();
        if seen.last.at != at {
            seen.last = evaluator.evaluate(at.to_vec());
            seen.designs += 1;
            if seen.last.order(&seen.best).is_lt() {
                seen.best = seen.last.clone();
            }
        }
        seen.last.clone()
    };
    let goal = |at: &[f64], _: &mut ()| evaluator.scaled_objective(&look(at), worst);
    let limit = |constraint| {
        let look = &look;
        move |at: &[f64], _: &mut ()| {
            evaluator.scaled_margin(&look(at), constraint) - KEPT_FROM_LIMITS
        }
    };
    let limits: Vec<_> = (0..evaluator.problem.constraints.len())
        .map(limit)
        .collect();
    let tolerances = StopTols {
        xtol_abs: vec![LAST_STEP; keys],
        ..StopTols::default()
    };
    // The result is unused: `look` has recorded every evaluated design.
    let _ = minimize(
        goal,
        &start,
        &vec![(0.0, 1.0); keys],
        &limits,
        (),
        DESIGNS * keys,
        RhoBeg::All(step),
        Some(tolerances),
    );
    let Incumbent { best, designs, .. } = seen.into_inner();
    Searched {
        from: start,
        end: best,
        designs,
    }
}
