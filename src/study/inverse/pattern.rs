//! Whether residuals look like noise.

use crate::numeric::fit::Curve;

/// What the order of the residuals tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pattern {
    /// Correlation of each residual with the next.
    pub lag_one: f64,
    /// Runs of one sign, as standard deviations from the number expected of noise; below zero: too few.
    pub runs: f64,
    /// Factor on standard errors for residuals that are not independent; 1 where they look so.
    pub widening: f64,
    /// Whether the residuals have a pattern, and are more than the digits of the samples.
    pub clear: bool,
    /// Whether the residuals are more than the digits of the samples.
    pub shown: bool,
}

/// Standard deviations beyond which a pattern is one.
const CLEAR: f64 = 4.0;

impl Pattern {
    /// Reads the residuals that a curve leaves of samples at rising times; those within what samples and curve are known
    /// to, of standard deviation `floor`, tell nothing about the fit.
    pub fn of(residuals: &[f64], curve: &Curve, times: &[f64], floor: f64) -> Pattern {
        let n = residuals.len() as f64;
        let parameters = curve.quality().parameters;
        let square: f64 = residuals.iter().map(|r| r * r).sum();
        if square == 0.0 || residuals.len() < 4 {
            return Pattern {
                lag_one: 0.0,
                runs: 0.0,
                widening: 1.0,
                clear: false,
                shown: false,
            };
        }
        let shown = square > n * (1.5 * floor).powi(2);
        let neighbours = residuals.iter().zip(&residuals[1..]);
        let lag_one = neighbours.map(|(a, b)| a * b).sum::<f64>() / square;
        let runs = runs(residuals);
        // Residuals of noise are correlated by about −shared/n through the fit itself.
        let shared = curve.shared((times[times.len() - 1] - times[0]) / (n - 1.0));
        let deviations = (lag_one + shared / n) * n.sqrt();
        let mut widening = 1.0;
        if shown && (deviations > CLEAR || runs < -CLEAR) {
            let time = correlation_time(residuals);
            let free = (n - parameters).max(1.0);
            widening = (time * n / free).sqrt().max(1.0);
        }
        Pattern {
            lag_one,
            runs,
            clear: widening > 1.0,
            shown,
            widening,
        }
    }
}

/// By how much more residuals of a fit of so many parameters vary in waves about as long as the fit just follows than noise
/// does; at least 1.
pub(super) fn in_waves(residuals: &[f64], parameters: f64) -> f64 {
    let n = residuals.len() as f64;
    let square: f64 = residuals.iter().map(|r| r * r).sum();
    let length = (n / (BLOCKS * parameters)) as usize;
    if square == 0.0 || length < 2 {
        return 1.0;
    }
    let sums = residuals.chunks_exact(length).map(|some| some.iter().sum());
    let squares: f64 = sums.map(|sum: f64| sum * sum).sum();
    // The fit takes its part of the sums, and of the residuals.
    let blocks = (residuals.len() / length) as f64;
    let in_blocks = squares / ((blocks - parameters) * length as f64);
    (in_blocks * (n - parameters) / square).sqrt().max(1.0)
}

/// Blocks of residuals for each parameter.
const BLOCKS: f64 = 2.0;

/// Lags that are summed before neighbours are taken together.
const LAGS: usize = 64;

/// One and twice the sum of the correlations of residuals with those after them, as long as pairs of lags add to it
/// (Geyer, Statist. Sci. 7 (1992) 473).
///
/// Residuals that are correlated for long are summed two by two, which takes the same to half as many lags: the variance
/// of long sums stays what it is, and the cost linear in the residuals.
fn correlation_time(residuals: &[f64]) -> f64 {
    let square: f64 = residuals.iter().map(|r| r * r).sum();
    let mut sums = residuals.to_vec();
    loop {
        let product =
            |lag: usize| -> f64 { sums.iter().zip(&sums[lag..]).map(|(a, b)| a * b).sum() };
        let mut total = product(0) + 2.0 * product(1).max(0.0);
        let (mut lag, mut adds) = (2, true);
        while adds && lag + 1 < (sums.len() / 2).min(LAGS) {
            let pair = product(lag) + product(lag + 1);
            adds = pair > 0.0;
            total += 2.0 * pair.max(0.0);
            lag += 2;
        }
        if !adds || sums.len() < 2 * LAGS {
            return total / square;
        }
        sums = sums.chunks(2).map(|pair| pair.iter().sum()).collect();
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
