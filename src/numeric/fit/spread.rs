//! The covariance of a rotation with harmonics and its derivatives: that of the harmonics is a sum of harmonics up to twice
//! the last one itself, which takes as many operations as there are parameters, and not as many as there are pairs.

use nalgebra::DMatrix;

use super::turn::{Periodic, Waves};

/// Covariance of value and two derivatives, rows of the lower triangle.
type Covariance = [f64; 6];

/// The covariance of the parameters c, Ω, a_1, b_1, a_2, b_2, ... as the curve needs it.
#[derive(Clone, Debug)]
pub(super) struct Spread {
    /// What constant and harmonics give of the covariance, and covariances of Ω with what they give of value and derivatives.
    waves: Periodic<9>,
    /// Variance of Ω.
    own: f64,
}

impl Spread {
    /// From the covariance of the parameters at a speed Ω, for about so many arguments.
    pub fn new(covariance: &DMatrix<f64>, omega: f64, arguments: usize) -> Spread {
        let size = covariance.nrows();
        let mut waves: Waves<9> = vec![[[0.0; 9]; 2]; size - 1];
        let trigonometric = || (0..size).filter(|column| *column != 1);
        for i in trigonometric() {
            for derivative in 0..3 {
                let (k, sine, factor) = wave(i, derivative, omega);
                waves[k][usize::from(sine)][6 + derivative] += covariance[(i, 1)] * factor;
            }
            for j in trigonometric() {
                let mut entry = 0;
                for first in 0..3 {
                    for second in 0..=first {
                        let ((k, a, factor), (l, b, other)) =
                            (wave(i, first, omega), wave(j, second, omega));
                        let half = 0.5 * covariance[(i, j)] * factor * other;
                        let (together, apart) = (k + l, k.abs_diff(l));
                        let mut add = |m: usize, sine: bool, value: f64| {
                            waves[m][usize::from(sine)][entry] += value;
                        };
                        if a == b {
                            add(apart, false, half);
                            add(together, false, if a { -half } else { half });
                        } else {
                            // The sine's harmonic less the other's.
                            let positive = a == (k >= l);
                            add(together, true, half);
                            add(apart, true, if positive { half } else { -half });
                        }
                        entry += 1;
                    }
                }
            }
        }
        Spread {
            waves: Periodic::new(waves, arguments),
            own: covariance[(1, 1)],
        }
    }

    /// The covariance at an angle Ωτ, where the derivatives of value and derivatives by Ω are given.
    pub fn at(&self, angle: f64, rotation: &[f64; 3]) -> Covariance {
        let [sums @ .., a, b, c] = self.waves.at(angle);
        let (mut sum, others): (Covariance, _) = (sums, [a, b, c]);
        let mut entry = 0;
        for i in 0..3 {
            for j in 0..=i {
                sum[entry] += self.own * rotation[i] * rotation[j]
                    + rotation[i] * others[j]
                    + rotation[j] * others[i];
                entry += 1;
            }
        }
        // Rounding must not make a variance negative.
        for diagonal in [0, 2, 5] {
            sum[diagonal] = sum[diagonal].max(0.0);
        }
        sum
    }
}

/// Harmonic, whether it is a sine, and factor of a derivative of the column of a parameter other than Ω.
fn wave(column: usize, derivative: usize, omega: f64) -> (usize, bool, f64) {
    let (k, sine) = (column / 2, column % 2 == 1);
    let rate = k as f64 * omega;
    match (derivative, sine) {
        (0, _) => (k, sine, 1.0),
        (1, true) => (k, false, rate),
        (1, false) => (k, true, -rate),
        _ => (k, sine, -rate * rate),
    }
}
