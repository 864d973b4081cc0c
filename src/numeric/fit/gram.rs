//! Products of the columns of the design matrix of a rotation with harmonics, for very many rows.

use std::ops::Range;

use nalgebra::DMatrix;

use super::Samples;
use super::condensed::Rows;
use super::design::curve;
use super::turn::{Sectors, Turn};

/// Powers of the place in a sector that follow harmonics up to twice the last one, and up to the last one, to 1e-10.
const TWICE: usize = 10;
const ONCE: usize = 8;

/// Sums over the rows of a sector: of squared weights, and of the column of the rotation and the residuals, each with its
/// weight.
#[derive(Clone, Debug)]
struct Moments {
    squares: [f64; TWICE],
    rotation: [f64; ONCE],
    residual: [f64; ONCE],
}

/// Sums over rows.
#[derive(Debug, Default)]
struct Sums {
    sectors: Vec<Moments>,
    /// Products of rotation and residuals with themselves and each other.
    own: [f64; 3],
}

impl Sums {
    fn none(sectors: Sectors) -> Sums {
        let none = Moments {
            squares: [0.0; TWICE],
            rotation: [0.0; ONCE],
            residual: [0.0; ONCE],
        };
        Sums {
            sectors: vec![none; sectors.count()],
            own: [0.0; 3],
        }
    }

    fn of(
        samples: &Rows<'_>,
        range: Range<usize>,
        middle: f64,
        parameters: &[f64],
        turn: &Turn<2>,
    ) -> Sums {
        let mut sums = Sums::none(turn.sectors);
        for (t, weight, target) in samples.some(range) {
            let tau = t - middle;
            let angle = parameters[1] * tau;
            let place = turn.sectors.place(angle);
            let [wave, slope] = turn.at(place);
            let rotation = tau * (1.0 + slope);
            let residual = target - weight * (parameters[0] + angle + wave);
            let square = weight * weight;
            let moments = &mut sums.sectors[place.0];
            let powers: [f64; TWICE] = powers(place.1);
            add(&mut moments.squares, square, &powers);
            add(&mut moments.rotation, square * rotation, &powers);
            add(&mut moments.residual, weight * residual, &powers);
            sums.own[0] += square * rotation * rotation;
            sums.own[1] += weight * rotation * residual;
            sums.own[2] += residual * residual;
        }
        sums
    }

    fn add(&mut self, other: &Sums) {
        for (sum, part) in self.sectors.iter_mut().zip(&other.sectors) {
            add(&mut sum.squares, 1.0, &part.squares);
            add(&mut sum.rotation, 1.0, &part.rotation);
            add(&mut sum.residual, 1.0, &part.residual);
        }
        add(&mut self.own, 1.0, &other.own);
    }
}

/// 1, u, u², ...
#[inline(always)]
fn powers<const N: usize>(u: f64) -> [f64; N] {
    let mut powers = [1.0; N];
    for power in 1..N {
        powers[power] = match power {
            1 => u,
            _ => powers[power / 2] * powers[power.div_ceil(2)],
        };
    }
    powers
}

/// Adds as many entries of a list as there are sums, each times a factor.
#[inline(always)]
fn add(sums: &mut [f64], factor: f64, list: &[f64]) {
    for (sum, value) in sums.iter_mut().zip(list) {
        *sum += factor * value;
    }
}

/// Sectors narrow enough for products of the harmonics of a curve.
fn sectors(parameters: &[f64]) -> Sectors {
    Sectors::of(parameters.len() - 2)
}

/// Products of the columns of the design matrix and the residuals with each other. Those of two harmonics follow from sums
/// over one: 2 cos kφ cos lφ = cos (k − l)φ + cos (k + l)φ.
pub(super) fn gram(samples: &Rows<'_>, middle: f64, parameters: &[f64]) -> DMatrix<f64> {
    let (size, last) = (parameters.len(), parameters.len() / 2 - 1);
    let sectors = sectors(parameters);
    let turn = Turn::new(sectors, &curve(parameters));
    let parts = samples.parts(|range| Sums::of(samples, range, middle, parameters, &turn));
    let mut sums = Sums::none(sectors);
    parts.iter().for_each(|part| sums.add(part));
    let waves = sectors.waves(sums.sectors.iter().map(|m| &m.squares), 2 * last);
    let beside = [
        sectors.waves(sums.sectors.iter().map(|m| &m.rotation), last),
        sectors.waves(sums.sectors.iter().map(|m| &m.residual), last),
    ];
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
            (1, 1) => sums.own[0],
            _ if (i, j) == (1, size) => sums.own[1],
            _ if i == size => sums.own[2],
            _ if j == size || i == 1 || j == 1 => {
                let (k, sine) = harmonic(if i == 1 { j } else { i });
                beside[usize::from(j == size)][k][sine]
            }
            _ => product(harmonic(i), harmonic(j)),
        }
    })
}

/// Products of the columns of the design matrix with a list of errors of the targets.
pub(super) fn products(
    samples: &Samples<'_>,
    middle: f64,
    parameters: &[f64],
    errors: &[f64],
) -> Vec<f64> {
    let sectors = sectors(parameters);
    let turn = Turn::new(sectors, &curve(parameters));
    let rows = Rows::from(samples);
    let parts = rows.parts(|range| {
        let mut sums = vec![[0.0; ONCE]; sectors.count()];
        let mut beside = 0.0;
        for ((t, weight, _), error) in rows.some(range.clone()).zip(&errors[range]) {
            let tau = t - middle;
            let place = sectors.place(parameters[1] * tau);
            let [_, slope] = turn.at(place);
            let powers: [f64; ONCE] = powers(place.1);
            add(&mut sums[place.0], weight * error, &powers);
            beside += weight * error * tau * (1.0 + slope);
        }
        (sums, beside)
    });
    let mut sums = vec![[0.0; ONCE]; sectors.count()];
    for (part, _) in &parts {
        let pairs = sums.iter_mut().zip(part);
        pairs.for_each(|(sum, part)| add(sum, 1.0, part));
    }
    let waves = sectors.waves(sums.iter(), parameters.len() / 2 - 1);
    let mut products = waves.as_flattened().to_vec();
    products[1] = parts.iter().map(|(_, beside)| beside).sum();
    products
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of the design matrix, by their formulas.
    fn columns(tau: f64, parameters: &[f64]) -> Vec<f64> {
        let mut slope = 1.0;
        let mut list = vec![1.0, 0.0];
        for (pair, k) in parameters[2..].chunks(2).zip(1..) {
            let k = f64::from(k);
            let (sin, cos) = (k * parameters[1] * tau).sin_cos();
            slope += k * (pair[1] * cos - pair[0] * sin);
            list.extend([cos, sin]);
        }
        list[1] = tau * slope;
        list
    }

    #[test]
    fn products_of_columns_are_those_of_all_rows() {
        let t: Vec<f64> = (0..700)
            .map(|i| 0.01 * f64::from(i) + 0.003 * f64::from(i % 7))
            .collect();
        let weight: Vec<f64> = t.iter().map(|t| 1.0 + 0.5 * (5.0 * t).cos()).collect();
        let target: Vec<f64> = t.iter().map(|t| 2.0 + 9.0 * t + (11.0 * t).sin()).collect();
        let samples = Samples {
            t: &t,
            target: &target,
            weight: Some(&weight),
            floor: 0.0,
        };
        let middle = 3.4;
        for harmonics in [0, 1, 6, 33] {
            let mut parameters = vec![30.0, 8.7];
            let amplitude = |k: usize| 0.3 / (1.0 + k as f64) * (3.0 * k as f64).sin();
            parameters.extend((0..2 * harmonics).map(amplitude));
            let size = parameters.len();
            let mut wanted = DMatrix::<f64>::zeros(size + 1, size + 1);
            let mut right = vec![0.0; size];
            for i in 0..t.len() {
                let tau = t[i] - middle;
                let mut row = columns(tau, &parameters);
                let mut value = parameters[0] + parameters[1] * tau;
                for k in 1..=harmonics {
                    value +=
                        parameters[2 * k] * row[2 * k] + parameters[2 * k + 1] * row[2 * k + 1];
                }
                row.iter_mut().for_each(|column| *column *= weight[i]);
                for (sum, column) in right.iter_mut().zip(&row) {
                    *sum += column * target[i];
                }
                row.push(target[i] - weight[i] * value);
                for (i, a) in row.iter().enumerate() {
                    for (j, b) in row.iter().enumerate() {
                        wanted[(i, j)] += a * b;
                    }
                }
            }
            let found = gram(&Rows::from(&samples), middle, &parameters);
            let errors = products(&samples, middle, &parameters, &target);
            let scale = |i: usize| wanted[(i, i)].sqrt();
            for i in 0..=size {
                for j in 0..=size {
                    let off = (found[(i, j)] - wanted[(i, j)]).abs();
                    assert!(
                        off < 1e-9 * scale(i) * scale(j),
                        "{harmonics}: {i}, {j}: {off}"
                    );
                }
            }
            let norm: f64 = target.iter().map(|y| y * y).sum::<f64>().sqrt();
            for i in 0..size {
                assert!(
                    (errors[i] - right[i]).abs() < 1e-9 * scale(i) * norm,
                    "{harmonics}: {i}"
                );
            }
        }
    }
}
