//! Spectrum of what repeats, and the search for the likeliest one.

use std::iter;

use super::super::maximum::ENOUGH_RISE;
use super::super::model::prior::Prior;
use super::regression::{Posterior, Regression, Rest};
use crate::numeric::maximum::largest_to;

/// Least and largest order of the periodic process: its torque is continuous, and as smooth as a prior's at most.
pub(in crate::inverse) const ORDERS: [f64; 2] = [1.0, 3.0];

/// Variances of the coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::inverse) struct Spectrum {
    /// ln of s, N m in units of σ
    pub log_size: f64,
    /// Order m of the periodic Wiener process; between whole numbers a fractional one.
    pub order: f64,
}

impl Spectrum {
    /// Standard deviation of the coefficients of a harmonic, by its number, in units of σ.
    pub fn deviation(self, number: usize) -> f64 {
        (self.log_size - self.order * log(number)).exp()
    }

    /// Standard deviation of each coefficient in units of σ.
    pub fn deviations(self, prior: Prior) -> Vec<f64> {
        let of = |number| iter::repeat_n(self.deviation(number), prior.of_harmonic());
        prior.numbers().flat_map(of).collect()
    }

    /// Returns the spectrum after a step along ln s and m, within the bounds of both.
    fn moved(self, [size, order]: [f64; 2], [low, high]: [f64; 2]) -> Spectrum {
        Spectrum {
            log_size: (self.log_size + size).clamp(low, high),
            order: (self.order + order).clamp(ORDERS[0], ORDERS[1]),
        }
    }
}

/// ln of the number of a harmonic.
pub(in crate::inverse) fn log(number: usize) -> f64 {
    (number as f64).ln()
}

impl Regression {
    /// Returns the likeliest spectrum with its coefficients, from one or from the likeliest of the middle order, by
    /// Fisher's scoring: the step is the score over its variance (Patterson and Thompson, Biometrika 58 (1971) 545), halved
    /// where the likelihood falls.
    pub fn likeliest(&self, near: Option<Spectrum>, rest: &Rest) -> Option<(Spectrum, Posterior)> {
        // From e⁻² to 1e13 times the least standard error of a coefficient.
        let least = self.least_error().ln();
        let sizes = [least - 2.0, least + 30.0];
        let mut now = near.unwrap_or_else(|| self.likeliest_of_middle(sizes, rest));
        let mut found = self.solved(now, rest)?;
        loop {
            let step = self.scoring(&found, rest.variance(found.fall), now);
            let mut part = 1.0;
            loop {
                if part * step.rise.max(0.0) < ENOUGH_RISE {
                    return Some((now, found));
                }
                let next = now.moved(step.change.map(|change| part * change), sizes);
                match self.solved(next, rest) {
                    Some(other) if rest.likelihood_of(&other) > rest.likelihood_of(&found) => {
                        (now, found) = (next, other);
                        break;
                    }
                    _ => part *= 0.5,
                }
            }
        }
    }

    /// Returns the likeliest spectrum of the middle order.
    fn likeliest_of_middle(&self, sizes: [f64; 2], rest: &Rest) -> Spectrum {
        let with = |log_size: f64| Spectrum {
            log_size,
            order: 0.5 * (ORDERS[0] + ORDERS[1]),
        };
        let value = |log: f64| {
            let found = self.solved_with(with(log).deviations(self.prior));
            found.map_or(f64::NEG_INFINITY, |found| rest.likelihood_of(&found))
        };
        with(largest_to(value, sizes, 1.0).0)
    }

    /// The scoring step of ln s and m: with the shares H = I − (I + D½ information D½)⁻¹ that the samples have in the
    /// coefficients β, the score of ln of each deviation is β²/(σ² D) − H, with the covariance 2 H² of each two.
    pub fn scoring(&self, found: &Posterior, variance: f64, at: Spectrum) -> Scoring {
        let (left, of) = (found.left(), self.prior.of_harmonic());
        let numbers = self.prior.numbers().enumerate();
        let smooth = numbers.filter(|(index, _)| !found.lines.contains(index));
        let columns =
            |(index, number)| (of * index..of * (index + 1)).map(move |j| (j, log(number)));
        let logs: Vec<(usize, f64)> = smooth.flat_map(columns).collect();
        let (mut slope, mut information) = ([0.0; 2], [0.0; 3]);
        for &(j, log) in &logs {
            let size = found.coefficients[j] / found.deviations[j];
            let score = size * size / variance - (1.0 - left[(j, j)]);
            slope = [slope[0] + score, slope[1] - log * score];
            for &(i, other) in &logs {
                let unit = if i == j { 1.0 } else { 0.0 };
                let square = 2.0 * (unit - left[(i, j)]).powi(2);
                let parts = [square, -square * log, square * log * other];
                (0..3).for_each(|k| information[k] += parts[k]);
            }
        }
        let [a, b, c] = information;
        let both =
            [c * slope[0] - b * slope[1], a * slope[1] - b * slope[0]].map(|d| d / (a * c - b * b));
        // At the least or largest order the size alone may change.
        let change = match (at.order + both[1]).clamp(ORDERS[0], ORDERS[1]) - at.order {
            0.0 => [slope[0] / a, 0.0],
            _ => both,
        };
        let rise = 0.5 * (slope[0] * change[0] + slope[1] * change[1]);
        Scoring {
            change,
            rise,
            information,
        }
    }
}

/// Change of ln s and m, and the rise of ln of the likelihood that it promises.
pub(in crate::inverse) struct Scoring {
    change: [f64; 2],
    rise: f64,
    /// Fisher's information of ln s, of both, and of m.
    pub information: [f64; 3],
}
