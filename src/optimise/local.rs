//! A local search.

use std::cell::RefCell;

use cobyla::{RhoBeg, StopTols, minimize};

use super::judge::{Judge, Judged};

/// Searches end where steps are this small a part of the ranges.
const LAST_STEP: f64 = 1e-10;

/// Limits are kept by this part of their spread, so that ends of a search meet them despite its last step.
const KEPT_FROM_LIMITS: f64 = 1e-9;

/// Most designs of a search for each key, which COBYLA without a curved valley needs a few dozen of.
const DESIGNS: usize = 300;

/// A search that is over.
#[derive(Clone, Debug)]
pub(super) struct Searched {
    /// Where it began.
    pub from: Vec<f64>,
    /// The best of its designs.
    pub end: Judged,
    /// Number of designs computed.
    pub designs: u64,
}

/// The designs of a search: the last one, of which goal and limits are asked one after the other, and the best.
struct Incumbent {
    last: Judged,
    best: Judged,
    designs: u64,
}

/// COBYLA from a design, with first steps of this part of the ranges; `worst` is the scaled goal of designs without one.
pub(super) fn search(judge: &Judge, from: Judged, step: f64, worst: f64) -> Searched {
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
            seen.last = judge.judge(at.to_vec());
            seen.designs += 1;
            if seen.last.order(&seen.best).is_lt() {
                seen.best = seen.last.clone();
            }
        }
        seen.last.clone()
    };
    let goal = |at: &[f64], _: &mut ()| judge.aim(&look(at), worst);
    let limit = |subject| {
        let look = &look;
        move |at: &[f64], _: &mut ()| judge.margin(&look(at), subject) - KEPT_FROM_LIMITS
    };
    let limits: Vec<_> = (0..judge.asked.subjects.len()).map(limit).collect();
    let tolerances = StopTols {
        xtol_abs: vec![LAST_STEP; keys],
        ..StopTols::default()
    };
    // What it returns is among what it looked at.
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
