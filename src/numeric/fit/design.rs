//! The least-squares problem of a rotation with harmonics, linear about given parameters c, Ω, a_1, b_1, a_2, b_2, ...

use super::Samples;
use super::condensed::Rows;
use super::triangle::Triangle;

/// Value and two derivatives in time.
pub(super) type Jet = [f64; 3];

/// Sine and cosine of an angle, of twice the angle and so on, by the theorem of addition: each is as exact as the rounded angle lets
/// it be.
pub(super) fn harmonics(angle: f64) -> impl Iterator<Item = (f64, f64)> {
    let (sin, cos) = angle.sin_cos();
    let turned = move |(s, c): &(f64, f64)| Some((s * cos + c * sin, c * cos - s * sin));
    std::iter::successors(Some((sin, cos)), turned)
}

/// The curve alone.
pub(super) fn value(tau: f64, parameters: &[f64]) -> f64 {
    let angle = parameters[1] * tau;
    let pairs = parameters[2..].chunks_exact(2).zip(harmonics(angle));
    let terms = pairs.map(|(pair, (sin, cos))| pair[0] * cos + pair[1] * sin);
    terms.fold(parameters[0] + angle, |sum, term| sum + term)
}

/// The curve with three derivatives, and the derivative of the curve by each parameter, with two in time, which take the
/// place of what the list holds.
pub(super) fn columns(tau: f64, parameters: &[f64], columns: &mut Vec<Jet>) -> [f64; 4] {
    let omega = parameters[1];
    let mut value = [parameters[0] + omega * tau, omega, 0.0, 0.0];
    columns.clear();
    columns.extend([[1.0, 0.0, 0.0], [0.0; 3]]);
    let mut rate = 0.0;
    for (pair, (sin, cos)) in parameters[2..].chunks_exact(2).zip(harmonics(omega * tau)) {
        rate += omega;
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
    value
}

pub(super) fn squares(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> f64 {
    let rest = samples.iter().map(|(t, weight, target)| {
        let residual = target - weight * value(t - middle, parameters);
        residual * residual
    });
    samples.left + rest.sum::<f64>()
}

/// The triangle of the design matrix at these parameters, extended by zeros to `count` harmonics, and the correction
/// of the parameters.
pub(super) fn solve(
    samples: &Rows<'_>,
    middle: f64,
    parameters: &[f64],
    count: usize,
) -> Result<(Triangle, Vec<f64>), String> {
    let mut extended = parameters.to_vec();
    extended.resize(2 + 2 * count, 0.0);
    let mut triangle = Triangle::new(extended.len());
    let mut list = Vec::new();
    for (t, weight, target) in samples.iter() {
        let value = columns(t - middle, &extended, &mut list);
        let residual = target - weight * value[0];
        triangle.add(list.iter().map(|column| weight * column[0]), residual);
    }
    let step = triangle.solve();
    match step {
        Some(step) if step.iter().all(|s| s.is_finite()) => Ok((triangle, step)),
        _ => Err("the samples do not determine rotation and harmonics".to_owned()),
    }
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

/// Products of the columns of the design matrix with lists of errors, one for each sample.
pub(super) fn products(
    samples: &Samples<'_>,
    middle: f64,
    parameters: &[f64],
    errors: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut products = vec![vec![0.0; parameters.len()]; errors.len()];
    let mut list = Vec::with_capacity(parameters.len());
    for (i, t) in samples.t.iter().enumerate() {
        let weight = samples.weight.map_or(1.0, |weight| weight[i]);
        columns(t - middle, parameters, &mut list);
        for (products, error) in products.iter_mut().zip(errors) {
            let error = weight * error[i];
            let rows = products.iter_mut().zip(&list);
            rows.for_each(|(p, column)| *p += column[0] * error);
        }
    }
    products
}

/// The columns, each times its weight, together.
pub(super) fn combined(weights: &[f64], columns: &[Jet]) -> Jet {
    let mut sum = [0.0; 3];
    for (weight, column) in weights.iter().zip(columns) {
        for (sum, value) in sum.iter_mut().zip(column) {
            *sum += weight * value;
        }
    }
    sum
}
