//! Linear regression on the harmonics of what repeats: normal equations, the likeliest spectrum, the coefficients.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Harmonics of a cycle: with 24 a pressure peak of 25° at half its height is met to 1e-4.
const HARMONICS: usize = 24;

/// Number of coefficients.
pub(super) const COUNT: usize = 2 * HARMONICS;

/// A number for each coefficient.
pub(super) type Each = [f64; COUNT];

/// Largest order of the periodic process.
const ORDERS: i32 = 3;

/// Variances of the coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spectrum {
    /// s, N m in units of σ
    size: f64,
    /// m
    order: i32,
}

impl Spectrum {
    /// Standard deviation of each coefficient in units of σ.
    fn deviations(self) -> Each {
        std::array::from_fn(|j| self.size / (1.0 + (j / 2) as f64).powi(self.order))
    }
}

/// Normal equations of the coefficients: Σ EᵀE/S, of which the lower triangle is kept, and −Σ Eᵀe/S.
#[derive(Clone, Debug)]
pub(super) struct Regression {
    pub information: Vec<Each>,
    pub score: Each,
}

impl Regression {
    pub fn new() -> Regression {
        Regression {
            information: vec![[0.0; COUNT]; COUNT],
            score: [0.0; COUNT],
        }
    }

    /// The likeliest of spectra, of which `likelihood` sees the fall of the squares and the rise of ln |S|.
    pub fn likeliest(&self, likelihood: impl Fn(&Posterior) -> f64) -> Option<Spectrum> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let told = (0..COUNT)
            .map(|j| self.information[j][j])
            .fold(0.0, f64::max);
        let at = |log: f64, order: i32| {
            let spectrum = Spectrum {
                size: log.exp() / told.sqrt(),
                order,
            };
            let found = self.solved(spectrum).map(|found| likelihood(&found));
            (found.unwrap_or(f64::NEG_INFINITY), spectrum)
        };
        let of_order = |order: i32| {
            // From nothing that is told to 1e13 times that.
            let (mut low, mut high) = (-2.0, 30.0);
            let inner = |low: f64, high: f64| {
                [high, low].map(|end| end + GOLDEN * (low + high - 2.0 * end))
            };
            let [mut a, mut b] = inner(low, high).map(|log| (log, at(log, order)));
            while high - low > 0.3 {
                if a.1.0 > b.1.0 {
                    (high, b) = (b.0, a);
                    let next = inner(low, high)[0];
                    a = (next, at(next, order));
                } else {
                    (low, a) = (a.0, b);
                    let next = inner(low, high)[1];
                    b = (next, at(next, order));
                }
            }
            if a.1.0 > b.1.0 { a.1 } else { b.1 }
        };
        let best = (1..=ORDERS)
            .map(of_order)
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        best.0.is_finite().then_some(best.1)
    }

    /// The coefficients given the samples.
    pub fn solved(&self, spectrum: Spectrum) -> Option<Posterior> {
        let deviations = spectrum.deviations();
        let scaled = DMatrix::from_fn(COUNT, COUNT, |i, j| {
            let (low, high) = (i.min(j), i.max(j));
            let unit = if i == j { 1.0 } else { 0.0 };
            unit + deviations[i] * self.information[high][low] * deviations[j]
        });
        let cholesky = Cholesky::new(scaled)?;
        let right = DVector::from_fn(COUNT, |j, _| deviations[j] * self.score[j]);
        let solved = cholesky.solve(&right);
        let diagonal = cholesky.l_dirty().diagonal();
        Some(Posterior {
            fall: right.dot(&solved),
            log_determinant: 2.0 * diagonal.iter().map(|d| d.ln()).sum::<f64>(),
            coefficients: std::array::from_fn(|j| deviations[j] * solved[j]),
            deviations,
            cholesky,
        })
    }
}

/// The coefficients given the samples, in units of σ.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    /// By how much the squares of the prediction errors fall.
    pub fall: f64,
    /// ln |I + D½ information D½|
    pub log_determinant: f64,
    pub coefficients: Each,
    deviations: Each,
    cholesky: Cholesky<f64, Dyn>,
}

impl Posterior {
    /// A factor L of the covariance L Lᵀ, row by row.
    pub fn factor(&self) -> Vec<Each> {
        let mut inverse = DMatrix::identity(COUNT, COUNT);
        let solved = self
            .cholesky
            .l_dirty()
            .tr_solve_lower_triangular_mut(&mut inverse);
        debug_assert!(solved);
        let row = |i: usize| std::array::from_fn(|j| self.deviations[i] * inverse[(i, j)]);
        (0..COUNT).map(row).collect()
    }
}
