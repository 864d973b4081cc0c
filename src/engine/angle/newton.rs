//! Newton's method on a panel, for loads so steep in the speed that sweeps do not gain.

use crate::numeric::chebyshev::{MOST, Rule, Values};

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
    let mut matrix = [[0.0; MOST + 1]; MOST + 1];
    let integrals = rule.integration();
    for i in 0..count {
        for j in 0..count {
            matrix[i][j] = -half * integrals[i][j] * rates[j];
        }
        matrix[i][i] += 1.0;
    }
    solve(&mut matrix, change, count)
}

/// Gaussian elimination with row pivots.
fn solve(matrix: &mut [[f64; MOST + 1]; MOST + 1], right: &mut Values, count: usize) -> Option<()> {
    for k in 0..count {
        let size = |i: &usize| matrix[*i][k].abs();
        let pivot = (k..count).max_by(|a, b| size(a).total_cmp(&size(b)))?;
        if matrix[pivot][k] == 0.0 || !matrix[pivot][k].is_finite() {
            return None;
        }
        matrix.swap(k, pivot);
        right.swap(k, pivot);
        let (head, below) = matrix.split_at_mut(k + 1);
        let row = &head[k];
        let (done, open) = right.split_at_mut(k + 1);
        for (other, value) in below[..count - k - 1].iter_mut().zip(open) {
            let factor = other[k] / row[k];
            if factor != 0.0 {
                for j in k + 1..count {
                    other[j] -= factor * row[j];
                }
                *value -= factor * done[k];
            }
        }
    }
    for k in (0..count).rev() {
        let sum: f64 = (k + 1..count).map(|j| matrix[k][j] * right[j]).sum();
        right[k] = (right[k] - sum) / matrix[k][k];
    }
    Some(())
}
