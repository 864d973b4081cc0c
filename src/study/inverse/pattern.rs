//! Whether residuals look like noise.

/// What the order of the residuals tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pattern {
    /// Correlation of each residual with the next.
    pub lag_one: f64,
    /// Runs of one sign, as standard deviations from the number expected of noise; below zero: too few.
    pub runs: f64,
    /// Factor on standard errors for residuals that are not independent; 1 where they look so.
    pub widening: f64,
    /// Whether the residuals are more than the digits of the samples.
    pub shown: bool,
}

/// Products that are summed at most: of a million residuals, the lags up to 200.
const MOST_PRODUCTS: usize = 200_000_000;

/// Standard deviations beyond which a pattern is one.
const CLEAR: f64 = 4.0;

impl Pattern {
    /// Reads the residuals of a fit that is worth this many parameters; those within the digits of the samples, whose
    /// standard deviation is `floor`, tell nothing about the fit, but may depend on each other as well.
    pub fn of(residuals: &[f64], parameters: f64, floor: f64) -> Pattern {
        let n = residuals.len() as f64;
        let square: f64 = residuals.iter().map(|r| r * r).sum();
        let lag = |k: usize| {
            let products = residuals.iter().zip(&residuals[k..]).map(|(a, b)| a * b);
            products.sum::<f64>() / square
        };
        if square == 0.0 || residuals.len() < 4 {
            return Pattern {
                lag_one: 0.0,
                runs: 0.0,
                widening: 1.0,
                shown: false,
            };
        }
        let shown = square > n * (1.5 * floor).powi(2);
        let lag_one = lag(1);
        let runs = runs(residuals);
        // Residuals of noise are correlated by about −(parameters)/n through the fit itself.
        let deviations = (lag_one + parameters / n) * n.sqrt();
        let mut widening = 1.0;
        // Rounding follows the value that is rounded: it is not taken for noise.
        if deviations > CLEAR || runs < -CLEAR || !shown {
            // Integrated correlation, as long as pairs of lags add to it (Geyer, Statist. Sci. 7 (1992) 473).
            let mut time = 1.0 + 2.0 * lag_one.max(0.0);
            let mut k = 2;
            let most = (residuals.len() / 2).min(MOST_PRODUCTS / residuals.len());
            while k + 1 < most {
                let pair = lag(k) + lag(k + 1);
                if pair <= 0.0 {
                    break;
                }
                time += 2.0 * pair;
                k += 2;
            }
            let free = (n - parameters).max(1.0);
            widening = (time * n / free).sqrt().max(1.0);
        }
        Pattern {
            lag_one,
            runs,
            widening,
            shown,
        }
    }

    /// Whether the residuals have a pattern.
    pub fn is_clear(&self) -> bool {
        self.shown && self.widening > 1.0
    }
}

/// Test of Wald and Wolfowitz (Ann. Math. Statist. 11 (1940) 147).
fn runs(residuals: &[f64]) -> f64 {
    let plus = residuals.iter().filter(|r| **r > 0.0).count() as f64;
    let n = residuals.len() as f64;
    let minus = n - plus;
    let runs = 1.0
        + residuals
            .windows(2)
            .filter(|w| (w[0] > 0.0) != (w[1] > 0.0))
            .count() as f64;
    let mean = 1.0 + 2.0 * plus * minus / n;
    let variance = (mean - 1.0) * (mean - 2.0) / (n - 1.0);
    if variance > 0.0 {
        (runs - mean) / variance.sqrt()
    } else {
        // All of one sign.
        -n.sqrt()
    }
}
