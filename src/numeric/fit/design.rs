//! The least-squares problem of a rotation with harmonics, linear about given parameters c, Ω, a_1, b_1, a_2, b_2, ...

use super::condensed::Rows;
use super::gram::gram;
use super::triangle::Triangle;
use super::turn::{Periodic, Waves, harmonics};

pub(super) const UNTOLD: &str = "the samples do not determine rotation and harmonics";

/// The periodic part of the curve and its derivative by the angle, as factors of cosines and sines.
pub(super) fn curve(parameters: &[f64]) -> Waves<2> {
    let mut waves = vec![[[0.0; 2]; 2]];
    for (pair, k) in parameters[2..].chunks_exact(2).zip(1..) {
        let k = f64::from(k);
        waves.push([[pair[0], k * pair[1]], [pair[1], -k * pair[0]]]);
    }
    waves
}

/// The curve, and the derivative of the curve by each parameter, which take the place of what the list holds.
fn columns(tau: f64, parameters: &[f64], columns: &mut Vec<f64>) -> f64 {
    let angle = parameters[1] * tau;
    let (mut value, mut slope) = (parameters[0] + angle, 1.0);
    columns.clear();
    columns.extend([1.0, 0.0]);
    let pairs = parameters[2..].chunks_exact(2).zip(harmonics(angle));
    for ((pair, (sin, cos)), k) in pairs.zip(1..) {
        value += pair[0] * cos + pair[1] * sin;
        slope += f64::from(k) * (pair[1] * cos - pair[0] * sin);
        columns.extend([cos, sin]);
    }
    columns[1] = tau * slope;
    value
}

/// The sum of squares that a curve leaves.
pub(super) fn squares(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> f64 {
    let waves = Periodic::new(curve(parameters), samples.number());
    let parts = samples.parts(|range| {
        let one = |(t, weight, target): (f64, f64, f64)| {
            let angle = parameters[1] * (t - middle);
            let value = parameters[0] + angle + waves.at(angle)[0];
            (target - weight * value).powi(2)
        };
        samples.some(range).map(one).sum::<f64>()
    });
    samples.left + parts.iter().sum::<f64>()
}

/// The triangle of the design matrix at these parameters, extended by zeros to `count` harmonics, and the correction
/// of the parameters.
pub(super) fn solve(
    samples: &Rows<'_>,
    middle: f64,
    parameters: &[f64],
    count: usize,
) -> Result<(Triangle, Vec<f64>), String> {
    let extended = extended(parameters, count);
    let quick = samples.is_very_many();
    let quick = quick.then(|| Triangle::of_gram(&gram(samples, middle, &extended)));
    let quick = quick.filter(|triangle| triangle.size() == extended.len());
    let mut triangle = quick.unwrap_or_else(|| by_rows(samples, middle, &extended));
    let step = triangle.solve();
    match step {
        Some(step) if step.iter().all(|s| s.is_finite()) => Ok((triangle, step)),
        _ => Err(UNTOLD.to_owned()),
    }
}

/// The triangle of the design matrix at these parameters, extended by zeros to as many columns of `count` harmonics as the
/// samples tell apart: at the same angles in each turn they tell few.
pub(super) fn told(samples: &Rows<'_>, middle: f64, parameters: &[f64], count: usize) -> Triangle {
    let extended = extended(parameters, count);
    match samples.is_very_many() {
        true => Triangle::of_gram(&gram(samples, middle, &extended)),
        false => by_rows(samples, middle, &extended).told(),
    }
}

fn extended(parameters: &[f64], count: usize) -> Vec<f64> {
    let mut extended = parameters.to_vec();
    extended.resize(2 + 2 * count, 0.0);
    extended
}

/// The triangle of all columns, from the rows one after the other.
fn by_rows(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> Triangle {
    let mut triangle = Triangle::new(parameters.len());
    let mut list = Vec::new();
    for (t, weight, target) in samples.iter() {
        let value = columns(t - middle, parameters, &mut list);
        let residual = target - weight * value;
        triangle.add(list.iter().map(|column| weight * column), residual);
    }
    triangle
}

/// What rounding may add to the sum of squares.
pub(super) fn rounding(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> f64 {
    let one = |(t, weight, _): (f64, f64, f64)| {
        let size = (parameters[1] * (t - middle)).abs() + parameters[0].abs() + 1.0;
        let error = 8.0 * f64::EPSILON * size * weight;
        error * error
    };
    samples.iter().map(one).sum()
}
