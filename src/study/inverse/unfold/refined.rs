//! Polynomials in terms of what was measured: near a fold a value tells the square of an angle, or its size.

use super::super::sensor::Sensor;
use super::evidence::{Misfit, fitted};
use super::window::Window;
use crate::numeric::orthogonal::Expansion;

/// Steps of Gauss and Newton.
const STEPS: usize = 5;

/// The angle off the fold, rad, of what a polynomial tells, and its derivative.
pub(super) trait Told: Fn(f64) -> (f64, f64) {}

impl<F: Fn(f64) -> (f64, f64)> Told for F {}

/// Of a polynomial that tells the angle itself.
pub(super) fn itself(angle: f64) -> (f64, f64) {
    (angle, 1.0)
}

/// What polynomials leave in terms of what was measured.
pub(super) fn refined(
    window: &Window,
    sensor: &Sensor<'_>,
    fit: &Expansion<f64>,
    angle: impl Told,
) -> Vec<Misfit> {
    let mut list = Vec::new();
    let mut best = f64::INFINITY;
    for degree in (1..fit.squares.len()).rev().step_by(2) {
        let squares = solved(window, sensor, fit, degree, &angle).squares;
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
    /// What it tells, such as angles in rad, and how fast what is measured changes with them, in standard errors.
    pub angles: Vec<f64>,
    pub slopes: Vec<f64>,
}

/// The polynomial of a degree that leaves least in terms of what was measured (Gauss and Newton, with halved steps).
pub(super) fn solved(
    window: &Window,
    sensor: &Sensor<'_>,
    fit: &Expansion<f64>,
    degree: usize,
    angle: impl Told,
) -> Solved {
    let rows = |told: &[f64]| -> (Vec<f64>, Vec<f64>) {
        let shown = told.iter().zip(&window.shown);
        let rows = shown.map(|(told, (value, noise))| {
            let (angle, change) = angle(*told);
            let (rest, slope) = sensor.residual(*value, window.at_fold + angle);
            (rest / noise, slope * change / noise)
        });
        rows.unzip()
    };
    let size = |rest: &[f64]| {
        let sum: f64 = rest.iter().map(|r| r * r).sum();
        if sum.is_nan() { f64::INFINITY } else { sum }
    };
    let mut angles = values(fit, degree, &window.t);
    let (mut rest, mut slopes) = rows(&angles);
    let mut least = size(&rest);
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
            let (next_rest, next_slopes) = rows(&next);
            let sum = size(&next_rest);
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

/// A fit up to a degree at the given times.
fn values(fit: &Expansion<f64>, degree: usize, t: &[f64]) -> Vec<f64> {
    t.iter().map(|t| fit.value(degree, *t)).collect()
}
