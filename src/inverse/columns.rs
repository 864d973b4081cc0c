//! Derivatives of a state by many coefficients, in blocks of some coefficients that the compiler vectorises.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use multiversion::multiversion;

use super::harmonics::AtNodes;
use super::matrix::{Matrix, Vector};
use crate::numeric::LANES;

/// Values by some coefficients, side by side.
pub(super) type Lanes = [f64; LANES];

/// Returns a row in blocks; the number of coefficients is a multiple of that of the lanes.
pub(super) fn blocks(row: &[f64]) -> &[Lanes] {
    row.as_chunks().0
}

/// Returns the sum of some values, each times a factor.
#[inline(always)]
fn combined<const K: usize>(factors: &[f64; K], values: &[Lanes; K]) -> Lanes {
    let mut sum = [0.0; LANES];
    for k in 0..K {
        add(&mut sum, factors[k], &values[k]);
    }
    sum
}

/// Adds a multiple of some values.
#[inline(always)]
fn add(to: &mut Lanes, factor: f64, values: &Lanes) {
    for i in 0..LANES {
        to[i] += factor * values[i];
    }
}

/// Multiplies derivatives by a matrix.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn transform<const N: usize>(of: &mut [[Lanes; N]], matrix: &Matrix<N>) {
    for of in of {
        let before = *of;
        for k in 0..N {
            of[k] = combined(&matrix[k], &before);
        }
    }
}

/// Adds the responses to torques.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn respond<const N: usize>(
    of: &mut [[Lanes; N]],
    responses: &[AtNodes<f64>; 3],
    torques: AtNodes<&[Lanes]>,
) {
    for block in 0..of.len() {
        for (k, response) in responses.iter().enumerate() {
            for node in 0..3 {
                add(&mut of[block][k], response[node], &torques[node][block]);
            }
        }
    }
}

/// Takes a sample with the row H into derivatives, and leaves E = −H of the derivatives.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn update<const N: usize>(
    of: &mut [[Lanes; N]],
    errors: &mut [Lanes],
    row: &Vector<N>,
    gain: &Vector<N>,
) {
    for block in 0..of.len() {
        let mut error = [0.0; LANES];
        for k in 0..N {
            add(&mut error, -row[k], &of[block][k]);
        }
        for k in 0..N {
            add(&mut of[block][k], gain[k], &error);
        }
        errors[block] = error;
    }
}

/// Takes a sample with its E over the standard deviation S^½ into the derivatives of the smoother's correction.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn correct<const N: usize>(
    of: &mut [[Lanes; N]],
    errors: &[Lanes],
    per: f64,
    row: &Vector<N>,
    gain: &Vector<N>,
) {
    for block in 0..of.len() {
        let mut change = [0.0; LANES];
        for k in 0..N {
            add(&mut change, -gain[k], &of[block][k]);
        }
        add(&mut change, per, &errors[block]);
        for k in 0..N {
            add(&mut of[block][k], row[k], &change);
        }
    }
}

/// Adds the product of a covariance and the derivatives of the correction to those of the state.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn add_product<const N: usize>(
    to: &mut [[Lanes; N]],
    covariance: &Matrix<N>,
    of: &[[Lanes; N]],
) {
    for block in 0..to.len() {
        for k in 0..N {
            add(
                &mut to[block][k],
                1.0,
                &combined(&covariance[k], &of[block]),
            );
        }
    }
}
