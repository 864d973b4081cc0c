//! Polynomials in terms of what was measured: near a fold a value tells the square of an angle, or its size.

use super::super::sensor::Sensor;
use super::evidence::{Misfit, fitted};
use super::window::Window;
use crate::numeric::orthogonal::Expansion;

/// Steps of Gauss and Newton.
pub(super) const STEPS: usize = 5;

/// What polynomials leave in terms of what was measured.
pub(super) fn refined(window: &Window, sensor: &Sensor<'_>, fit: &Expansion<f64>) -> Vec<Misfit> {
    let mut list = Vec::new();
    let mut best = f64::INFINITY;
    for degree in (1..fit.squares.len()).rev().step_by(2) {
        let squares = solved(window, sensor, fit, degree).squares;
        let misfit = Misfit { degree, squares };
        list.push(misfit);
        // Lower degrees leave more.
        if squares > best {
            break;
        }
        best = best.min(misfit.cost());
    }
    list
}

/// A polynomial in terms of what was measured.
#[derive(Debug)]
pub(super) struct Solved {
    /// Sum of squares in squared standard errors.
    pub squares: f64,
    /// Angles off the fold, rad, and how fast what is measured changes with them, in standard errors.
    pub angles: Vec<f64>,
    pub slopes: Vec<f64>,
}

/// The polynomial of a degree that leaves least in terms of what was measured (Gauss and Newton, with halved steps).
pub(super) fn solved(
    window: &Window,
    sensor: &Sensor<'_>,
    fit: &Expansion<f64>,
    degree: usize,
) -> Solved {
    let mut angles = values(fit, degree, &window.t);
    let (mut rest, mut slopes) = rows(window, sensor, &angles);
    let mut least = sum(&rest);
    for _ in 0..STEPS {
        let change = fitted(&window.t, &rest, &slopes, degree);
        let change = values(&change, degree, &window.t);
        let before = least;
        for part in [1.0, 0.5, 0.25, 0.125] {
            let next: Vec<f64> = angles
                .iter()
                .zip(&change)
                .map(|(a, c)| a + part * c)
                .collect();
            let (next_rest, next_slopes) = rows(window, sensor, &next);
            let sum = sum(&next_rest);
            if sum < least {
                (angles, rest, slopes, least) = (next, next_rest, next_slopes, sum);
                break;
            }
        }
        if least > 0.99 * before {
            break;
        }
    }
    Solved {
        squares: least,
        angles,
        slopes,
    }
}

/// What angles off the fold, rad, leave, and how fast what is measured changes with them, in standard errors.
pub(super) fn rows(window: &Window, sensor: &Sensor<'_>, angles: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let shown = angles.iter().zip(&window.shown);
    let rows = shown.map(|(angle, (value, noise))| {
        let (rest, slope) = sensor.residual(*value, window.at_fold + angle);
        (rest / noise, slope / noise)
    });
    rows.unzip()
}

/// The sum of squares.
pub(super) fn sum(rest: &[f64]) -> f64 {
    let sum: f64 = rest.iter().map(|r| r * r).sum();
    if sum.is_nan() { f64::INFINITY } else { sum }
}

/// A fit up to a degree at the given times.
pub(super) fn values(fit: &Expansion<f64>, degree: usize, t: &[f64]) -> Vec<f64> {
    t.iter().map(|t| fit.value(degree, *t)).collect()
}
