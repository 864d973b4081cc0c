//! The equations of rotation with harmonics: their design matrix and Gauss and Newton's method.

use super::Samples;
use super::triangle::Triangle;

/// Corrections of the rotation after which a fit is given up.
const ROUNDS: usize = 40;

/// A step that gains less than this part of what noise gives a parameter settles a fit.
const SETTLED: f64 = 1e-8;

const UNSETTLED: &str = "the fit by rotation and harmonics does not settle";

/// Value and two derivatives in time.
pub(super) type Jet = [f64; 3];

/// The curve with three derivatives, and the derivative of the curve by each parameter, with two in time.
pub(super) fn columns(tau: f64, parameters: &[f64]) -> ([f64; 4], Vec<Jet>) {
    let omega = parameters[1];
    let mut value = [parameters[0] + omega * tau, omega, 0.0, 0.0];
    let mut columns = vec![[1.0, 0.0, 0.0], [0.0; 3]];
    let mut rate = 0.0;
    for pair in parameters[2..].chunks_exact(2) {
        rate += omega;
        let (sin, cos) = (rate * tau).sin_cos();
        let squared = rate * rate;
        let (even, odd) = (pair[0] * cos + pair[1] * sin, pair[1] * cos - pair[0] * sin);
        value[0] += even;
        value[1] += rate * odd;
        value[2] -= squared * even;
        value[3] -= squared * rate * odd;
        columns.push([cos, -rate * sin, -squared * cos]);
        columns.push([sin, rate * cos, -squared * sin]);
    }
    let per = if omega == 0.0 { 0.0 } else { 1.0 / omega };
    columns[1] = [
        if omega == 0.0 {
            tau
        } else {
            tau * value[1] * per
        },
        if omega == 0.0 {
            1.0
        } else {
            (value[1] + tau * value[2]) * per
        },
        (2.0 * value[2] + tau * value[3]) * per,
    ];
    (value, columns)
}

pub(super) fn squares(samples: &Samples<'_>, middle: f64, parameters: &[f64]) -> f64 {
    residuals(samples, middle, parameters)
        .map(|(_, _, r)| r * r)
        .sum()
}

/// Weight, columns and residual of each sample.
fn residuals<'a>(
    samples: &'a Samples<'a>,
    middle: f64,
    parameters: &'a [f64],
) -> impl Iterator<Item = (f64, Vec<Jet>, f64)> + 'a {
    samples.t.iter().enumerate().map(move |(i, t)| {
        let weight = samples.weight.map_or(1.0, |w| w[i]);
        let (value, columns) = columns(t - middle, parameters);
        (weight, columns, samples.target[i] - weight * value[0])
    })
}

/// The triangle of the design matrix at these parameters, extended by zeros to `count` harmonics, and the correction
/// of the parameters.
pub(super) fn solve(
    samples: &Samples<'_>,
    middle: f64,
    parameters: &[f64],
    count: usize,
) -> Result<(Triangle, Vec<f64>), String> {
    let mut extended = parameters.to_vec();
    extended.resize(2 + 2 * count, 0.0);
    let mut triangle = Triangle::new(extended.len());
    for (weight, columns, residual) in residuals(samples, middle, &extended) {
        triangle.add(columns.iter().map(|column| weight * column[0]), residual);
    }
    let step = triangle.solve();
    match step {
        Some(step) if step.iter().all(|s| s.is_finite()) => Ok((triangle, step)),
        _ => Err("the samples do not determine rotation and harmonics".to_owned()),
    }
}

/// Gauss and Newton's method for all parameters; a step that does not lessen the squares is halved.
pub(super) fn settle(
    samples: &Samples<'_>,
    middle: f64,
    parameters: &mut Vec<f64>,
) -> Result<(), String> {
    let count = parameters.len() / 2 - 1;
    let free = (samples.t.len() - parameters.len()).max(1) as f64;
    let mut before = squares(samples, middle, parameters);
    for _ in 0..ROUNDS {
        let (triangle, step) = solve(samples, middle, parameters, count)?;
        let sums = triangle.squares();
        let noise = (before / free).max(samples.floor * samples.floor);
        // What the step should gain, in units of what one parameter gains from noise.
        if sums[0] - sums[sums.len() - 1] <= SETTLED * noise {
            return Ok(());
        }
        let mut part = 1.0;
        let (next, after) = loop {
            let moved = parameters.iter().zip(&step).map(|(p, s)| p + part * s);
            let moved: Vec<f64> = moved.collect();
            let after = squares(samples, middle, &moved);
            if after < before || part < 1e-3 {
                break (moved, after);
            }
            part *= 0.5;
        };
        if after >= before {
            // At rounding there is nothing left to gain.
            let gain = sums[0] - sums[sums.len() - 1];
            let none = gain < 1e-6 * before || gain < rounding(samples, middle, parameters);
            return if none {
                Ok(())
            } else {
                Err(UNSETTLED.to_owned())
            };
        }
        *parameters = next;
        before = after;
    }
    Err(UNSETTLED.to_owned())
}

/// What rounding may add to the sum of squares.
fn rounding(samples: &Samples<'_>, middle: f64, parameters: &[f64]) -> f64 {
    let one = |(i, t): (usize, &f64)| {
        let size = (parameters[1] * (t - middle)).abs() + parameters[0].abs() + 1.0;
        let error = 8.0 * f64::EPSILON * size * samples.weight.map_or(1.0, |w| w[i]);
        error * error
    };
    samples.t.iter().enumerate().map(one).sum()
}
