//! The least-squares problem of a rotation with harmonics, linear about given parameters c, Ω, a_1, b_1, a_2, b_2, ...

use std::array;
use std::ops::Range;

use nalgebra::DMatrix;

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

/// Arguments that are taken side by side.
const LANES: usize = 4;

/// A number for each of them.
type Lanes = [f64; LANES];

/// The curve alone at several arguments side by side.
pub(super) fn values(tau: &Lanes, parameters: &[f64]) -> Lanes {
    let angle = tau.map(|tau| parameters[1] * tau);
    let mut sum = angle.map(|angle| parameters[0] + angle);
    let first = angle.map(f64::sin_cos);
    let first = [first.map(|(sin, _)| sin), first.map(|(_, cos)| cos)];
    let mut wave = first;
    for pair in parameters[2..].chunks_exact(2) {
        let [sin, cos] = &wave;
        for lane in 0..LANES {
            sum[lane] += pair[0] * cos[lane] + pair[1] * sin[lane];
        }
        wave = turned(&wave, &first);
    }
    sum
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
    let parts = samples.parts(|range| {
        let mut sum = 0.0;
        for from in range.clone().step_by(LANES) {
            let some = || samples.some(from..(from + LANES).min(range.end));
            let mut taus = some().map(|(t, _, _)| t - middle);
            let found = values(&array::from_fn(|_| taus.next().unwrap_or(0.0)), parameters);
            for ((_, weight, target), value) in some().zip(found) {
                sum += (target - weight * value).powi(2);
            }
        }
        sum
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
    let mut extended = parameters.to_vec();
    extended.resize(2 + 2 * count, 0.0);
    let quick = samples.is_very_many().then(|| {
        let gram = gram(samples, middle, &extended);
        Triangle::of_gram(&gram)
    });
    let mut triangle = quick.flatten().unwrap_or_else(|| {
        let mut triangle = Triangle::new(extended.len());
        let mut list = Vec::new();
        for (t, weight, target) in samples.iter() {
            let value = columns(t - middle, &extended, &mut list);
            let residual = target - weight * value[0];
            triangle.add(list.iter().map(|column| weight * column[0]), residual);
        }
        triangle
    });
    let step = triangle.solve();
    match step {
        Some(step) if step.iter().all(|s| s.is_finite()) => Ok((triangle, step)),
        _ => Err("the samples do not determine rotation and harmonics".to_owned()),
    }
}

/// Sums of cos kφ, sin kφ, of those with the column of the rotation and with the residuals, and of these two with each other.
#[derive(Debug, Default)]
struct Sums {
    waves: Vec<[Lanes; 2]>,
    beside: Vec<[[Lanes; 2]; 2]>,
    own: [Lanes; 3],
}

impl Sums {
    fn of(samples: &Rows<'_>, range: Range<usize>, middle: f64, parameters: &[f64]) -> Sums {
        let count = parameters.len() / 2 - 1;
        let (omega, length) = (parameters[1], 2 * count + 1);
        let mut sums = Sums {
            waves: vec![[[0.0; LANES]; 2]; length],
            beside: vec![[[[0.0; LANES]; 2]; 2]; count + 1],
            own: [[0.0; LANES]; 3],
        };
        let mut list = vec![[[0.0; LANES], [1.0; LANES]]; length.max(2)];
        for from in range.clone().step_by(LANES) {
            let mut rows = samples.some(from..(from + LANES).min(range.end));
            // What is not there has no weight.
            let rows: [_; LANES] = array::from_fn(|_| rows.next().unwrap_or((middle, 0.0, 0.0)));
            let tau = rows.map(|(t, _, _)| t - middle);
            let angle = tau.map(|tau| omega * tau);
            let first = angle.map(f64::sin_cos);
            list[1] = [first.map(|(sin, _)| sin), first.map(|(_, cos)| cos)];
            for k in 2..length {
                list[k] = turned(&list[k - 1], &list[1]);
            }
            let mut value = angle.map(|angle| parameters[0] + angle);
            let mut slope = [1.0; LANES];
            let pairs = parameters[2..].chunks_exact(2).zip(&list[1..]);
            for ((pair, [sin, cos]), k) in pairs.zip(1..) {
                for lane in 0..LANES {
                    value[lane] += pair[0] * cos[lane] + pair[1] * sin[lane];
                    slope[lane] += f64::from(k) * (pair[1] * cos[lane] - pair[0] * sin[lane]);
                }
            }
            let weight = rows.map(|(_, weight, _)| weight);
            let square = weight.map(|weight| weight * weight);
            for (sum, [sin, cos]) in sums.waves.iter_mut().zip(&list) {
                add(&mut sum[0], &square, cos);
                add(&mut sum[1], &square, sin);
            }
            let rotation = array::from_fn(|i| tau[i] * slope[i]);
            let residual: Lanes = array::from_fn(|i| rows[i].2 - weight[i] * value[i]);
            let two: [Lanes; 2] = [
                array::from_fn(|i| square[i] * rotation[i]),
                array::from_fn(|i| weight[i] * residual[i]),
            ];
            for (sum, [sin, cos]) in sums.beside.iter_mut().zip(&list) {
                for (sum, value) in sum.iter_mut().zip(&two) {
                    add(&mut sum[0], value, cos);
                    add(&mut sum[1], value, sin);
                }
            }
            add(&mut sums.own[0], &two[0], &rotation);
            add(&mut sums.own[1], &two[1], &rotation);
            add(&mut sums.own[2], &residual, &residual);
        }
        sums
    }
}

/// Adds products lane by lane.
#[inline(always)]
fn add(sum: &mut Lanes, a: &Lanes, b: &Lanes) {
    for lane in 0..LANES {
        sum[lane] += a[lane] * b[lane];
    }
}

/// Sines and cosines of the sums of angles.
#[inline(always)]
fn turned([sin, cos]: &[Lanes; 2], [by_sin, by_cos]: &[Lanes; 2]) -> [Lanes; 2] {
    [
        array::from_fn(|i| sin[i] * by_cos[i] + cos[i] * by_sin[i]),
        array::from_fn(|i| cos[i] * by_cos[i] - sin[i] * by_sin[i]),
    ]
}

/// Products of the columns of the design matrix and the residuals with each other. Those of two harmonics follow from sums
/// over one: 2 cos kφ cos lφ = cos (k − l)φ + cos (k + l)φ.
fn gram(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> DMatrix<f64> {
    let count = parameters.len() / 2 - 1;
    let (size, length) = (parameters.len(), 2 * count + 1);
    let parts = samples.parts(|range| Sums::of(samples, range, middle, parameters));
    let mut waves = vec![[0.0; 2]; length];
    let mut beside = vec![[[0.0; 2]; 2]; count + 1];
    let mut own = [0.0; 3];
    for part in parts {
        let add = |(sum, lanes): (&mut f64, &Lanes)| *sum += lanes.iter().sum::<f64>();
        let pairs = waves.as_flattened_mut().iter_mut();
        pairs.zip(part.waves.as_flattened()).for_each(add);
        let pairs = beside.as_flattened_mut().as_flattened_mut().iter_mut();
        pairs
            .zip(part.beside.as_flattened().as_flattened())
            .for_each(add);
        own.iter_mut().zip(&part.own).for_each(add);
    }
    // Harmonic of a column, and whether it is a sine.
    let harmonic = |column: usize| match column {
        0 => (0, 0),
        _ => (column / 2, column % 2),
    };
    let product = |(k, a): (usize, usize), (l, b): (usize, usize)| {
        let [together, apart] = [waves[k + l], waves[k.abs_diff(l)]];
        match (a, b) {
            (0, 0) => 0.5 * (apart[0] + together[0]),
            (1, 1) => 0.5 * (apart[0] - together[0]),
            // The sine's harmonic less the other.
            _ => {
                let positive = (a == 1) == (k >= l);
                0.5 * (together[1] + if positive { apart[1] } else { -apart[1] })
            }
        }
    };
    DMatrix::from_fn(size + 1, size + 1, |i, j| {
        let (i, j) = (i.min(j), i.max(j));
        match (i, j) {
            (1, 1) => own[0],
            _ if (i, j) == (1, size) => own[1],
            _ if i == size => own[2],
            _ if j == size || i == 1 || j == 1 => {
                let (k, sine) = harmonic(if i == 1 { j } else { i });
                beside[k][usize::from(j == size)][sine]
            }
            _ => product(harmonic(i), harmonic(j)),
        }
    })
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
