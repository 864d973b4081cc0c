//! How the terms of a series fall off, and what those that are left out may amount to.
//!
//! Coefficients over orthonormal terms of an analytic function fall about geometrically. As measured, each is a normal
//! number of variance τ² + noise, with ln τ² = level − fall·k for term k; level and fall are those of the largest
//! likelihood. They tell how many terms leave out little, and how much.

/// Variance of the terms of a series, with the variance of the noise in each as unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Decay {
    noise: f64,
    level: f64,
    fall: f64,
}

/// Terms left out may add this part to the variance of the second derivative.
const SLIGHT: f64 = 0.1;

/// Terms after which a tail is not followed.
const FAR: usize = 60;

impl Decay {
    /// The decay of terms from their squares: those of term k are the sum of `each` squared coefficients. Terms far before
    /// the last that the samples support (`supported`) say little about those that come after it.
    pub fn of(squares: &[f64], each: f64, noise: f64, supported: usize) -> Decay {
        let noise = noise.max(f64::MIN_POSITIVE);
        let from = (supported / 2).min(squares.len().saturating_sub(1));
        let window: Vec<(f64, f64)> = (from..squares.len())
            .map(|k| (k as f64, squares[k] / noise))
            .collect();
        let largest = window.iter().fold(1.0f64, |m, (_, s)| m.max(s / each));
        let cost = |level: f64, fall: f64| -> f64 {
            let one = |(k, square): &(f64, f64)| {
                let variance = 1.0 + (level - fall * (k - from as f64)).exp();
                each * variance.ln() + square / variance
            };
            window.iter().map(one).sum()
        };
        let mut best = (f64::INFINITY, 0.0, 1.0);
        let mut seek = |[from, to, step]: [f64; 3], [slowest, fastest, factor]: [f64; 3]| {
            let levels = (0..).map(|i| from + step * f64::from(i));
            for level in levels.take_while(|level| *level <= to) {
                let falls = (0..).map(|i| slowest * factor.powi(i));
                for fall in falls.take_while(|fall| *fall <= fastest) {
                    let cost = cost(level, fall);
                    if cost < best.0 {
                        best = (cost, level, fall);
                    }
                }
            }
            best
        };
        let (_, level, fall) = seek([-2.0, largest.ln() + 6.0, 2.0], [0.1, 10.0, 1.3]);
        let best = seek(
            [level - 1.5, level + 1.5, 0.5],
            [fall / 1.3, fall * 1.3, 1.06],
        );
        Decay {
            noise,
            level: best.1 + best.2 * from as f64,
            fall: best.2,
        }
    }

    /// Variance of a coefficient of term k.
    pub fn variance(&self, k: usize) -> f64 {
        self.noise * (self.level - self.fall * k as f64).min(600.0).exp()
    }

    /// The first number of terms, from `supported` to `most`, that leaves out little of the second derivative, to which
    /// term k adds in proportion to k^`power`.
    pub fn enough(&self, supported: usize, most: usize, power: i32) -> usize {
        let size = |k: usize| (k as f64).powi(power);
        let mut known: f64 = (1..=supported).map(|k| self.noise * size(k)).sum();
        for last in supported..most {
            let left: f64 = (last + 1..last + FAR)
                .map(|k| self.variance(k) * size(k))
                .sum();
            if left <= SLIGHT * known {
                return last;
            }
            known += self.noise * size(last + 1);
        }
        most
    }
}
