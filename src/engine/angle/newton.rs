//! Newton's method on a panel, for loads so steep in the speed that sweeps do not gain.

use nalgebra::{DMatrix, DVectorViewMut};

use crate::numeric::chebyshev::{Rule, Values};

/// Turns what a sweep would change into what makes the panel right, to first order: solves
/// (1 − half·S·diag(rates)) δ = change, where S integrates from the start of the panel. None if there is no
/// solution.
pub(super) fn correction(
    rule: &Rule,
    half: f64,
    rates: &Values,
    change: &mut Values,
) -> Option<()> {
    let count = rule.degree() + 1;
    let integrals = rule.integration();
    let matrix = DMatrix::from_fn(count, count, |i, j| {
        f64::from(u8::from(i == j)) - half * integrals[i][j] * rates[j]
    });
    let mut change = DVectorViewMut::from_slice(change, count);
    matrix.lu().solve_mut(&mut change).then_some(())
}

/// Shortens a change that would leave less than a tenth of the kinetic energy somewhere.
pub(super) fn keep_positive(kinetic: &Values, change: &mut Values) {
    let share = |k: f64, c: f64| if c < -0.9 * k { -0.9 * k / c } else { 1.0 };
    let pairs = kinetic.iter().zip(change.iter());
    let least = pairs.fold(1.0f64, |least, (k, c)| least.min(share(*k, *c)));
    if least < 1.0 {
        for c in change {
            *c *= least;
        }
    }
}
