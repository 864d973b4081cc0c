//! Tests of residuals for white noise, and the noise of samples about any smooth motion.

use crate::numeric::median::median;

/// Statistics of tests for white noise.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Whiteness {
    /// Lag-one autocorrelation of the residuals.
    pub lag_one: f64,
    /// Runs of one sign, in standard deviations from the number expected of noise (Wald and Wolfowitz).
    pub runs: f64,
    /// Ljung-Box statistic (Biometrika 65 (1978) 297) of the first autocorrelations, as a standard normal deviate of χ².
    pub ljung_box: f64,
}

/// Normal deviate above which residuals are not white noise: one in 10 000 records of noise exceeds it.
pub(super) const DEVIATIONS: f64 = 3.7;

/// Maximum number of autocorrelations that are tested.
const LAGS: usize = 20;

impl Whiteness {
    /// Tests residuals; values that are not finite are left out.
    pub fn of(residuals: impl Iterator<Item = f64>) -> Whiteness {
        let list: Vec<f64> = residuals.filter(|r| r.is_finite()).collect();
        let n = list.len() as f64;
        let lags = LAGS.min(list.len() / 5);
        let own: f64 = list.iter().map(|r| r * r).sum();
        if lags == 0 || own == 0.0 {
            return Whiteness::default();
        }
        let correlation = |lag: usize| {
            let pairs = list.iter().zip(&list[lag..]);
            pairs.map(|(a, b)| a * b).sum::<f64>() / own
        };
        let statistic: f64 = (1..=lags)
            .map(|lag| correlation(lag).powi(2) / (n - lag as f64))
            .sum::<f64>()
            * n
            * (n + 2.0);
        Whiteness {
            lag_one: correlation(1),
            runs: Runs::of(&list).deviation(),
            ljung_box: deviate(statistic, lags),
        }
    }

    /// True if the residuals are plainly not white.
    pub fn is_violated(&self) -> bool {
        self.ljung_box > DEVIATIONS
    }
}

/// Returns a sum of so many squares of standard normal numbers, χ², as a standard normal deviate (Wilson and Hilferty, Proceedings
/// of the National Academy of Sciences 17 (1931) 684).
pub(super) fn deviate(squares: f64, count: usize) -> f64 {
    let part = 2.0 / (9.0 * count as f64);
    ((squares / count as f64).cbrt() - (1.0 - part)) / part.sqrt()
}

/// Number of runs of one sign (Wald and Wolfowitz).
#[derive(Clone, Copy, Debug)]
pub(super) struct Runs {
    pub found: f64,
    /// Number expected of noise.
    pub expected: f64,
    /// Variance of the number for noise.
    variance: f64,
}

impl Runs {
    /// Counts the runs of residuals.
    pub fn of(list: &[f64]) -> Runs {
        let positive = list.iter().filter(|r| **r > 0.0).count() as f64;
        let all = list.len() as f64;
        let expected = 1.0 + 2.0 * positive * (all - positive) / all;
        let pairs = list.windows(2);
        Runs {
            found: 1.0 + pairs.filter(|w| (w[0] > 0.0) != (w[1] > 0.0)).count() as f64,
            expected,
            variance: (expected - 1.0) * (expected - 2.0) / (all - 1.0),
        }
    }

    /// Returns the difference from the number expected of noise, in standard deviations.
    fn deviation(&self) -> f64 {
        match self.variance > 0.0 {
            true => (self.found - self.expected) / self.variance.sqrt(),
            false => 0.0,
        }
    }
}

/// Standard deviation of normal noise over the median of its absolute values.
pub(super) const NORMAL: f64 = 1.4826;

/// Residual, in standard deviations, above which a sample is examined: one in 10⁸ of noise.
pub(super) const FAR: f64 = 5.7;

/// Maximum number of differences of an order, and largest order.
const DIFFERENCES: usize = 250;
const DIFFERENCE_ORDERS: usize = 10;

/// True for a sample that repeats the value before it, as a sensor does that holds or is at the end of its range.
pub(super) fn repeats(values: &[f64], sample: usize) -> bool {
    sample > 0 && values[sample] == values[sample - 1]
}

/// Returns the standard deviation of the noise of samples by variate differences (Anderson, Biometrika 18 (1926) 293): the
/// least of all orders, by divided differences and their median size, which a few jumps of a force do not move. Values that repeat
/// tell nothing of it.
pub(super) fn noise(times: &[f64], values: &[f64]) -> f64 {
    let told: Vec<usize> = (0..values.len()).filter(|i| !repeats(values, *i)).collect();
    if told.len() == 1 {
        return 0.0;
    }
    let of = |list: &[f64]| -> Vec<f64> { told.iter().map(|i| list[*i]).collect() };
    let (times, values) = (of(times), of(values));
    let of_order = |order: usize| {
        let difference = |first: usize| {
            let samples = first..=first + order;
            let (mut sum, mut square) = (0.0, 0.0);
            for i in samples.clone() {
                let others = samples.clone().filter(|j| *j != i);
                let divisor: f64 = others.map(|j| times[i] - times[j]).product();
                sum += values[i] / divisor;
                square += 1.0 / (divisor * divisor);
            }
            sum.abs() / square.sqrt()
        };
        let firsts = 0..times.len().saturating_sub(order);
        let some = firsts.step_by(times.len().div_ceil(DIFFERENCES));
        median(some.map(difference)).map_or(f64::INFINITY, |size| NORMAL * size)
    };
    let orders = (1..=DIFFERENCE_ORDERS).map(of_order);
    orders.fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of a linear congruence (Knuth's MMIX), uniform in ±½.
    fn numbers(count: usize) -> Vec<f64> {
        let mut state = 1u64;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
        };
        (0..count).map(|_| next()).collect()
    }

    /// An autoregression of n samples has a correlation of c ± √((1 − c²)/n) of each with the next.
    #[test]
    fn white_noise_passes_and_correlated_noise_does_not() {
        let (count, correlation) = (5000, 0.4f64);
        let white = numbers(count);
        assert!(!Whiteness::of(white.iter().copied()).is_violated());
        let mut last = 0.0;
        let correlated = white.iter().map(|w| {
            last = correlation * last + w;
            last
        });
        let found = Whiteness::of(correlated);
        let error = ((1.0 - correlation * correlation) / count as f64).sqrt();
        assert!(found.is_violated() && found.runs < -4.0);
        assert!((found.lag_one - correlation).abs() < 4.0 * error);
    }

    /// A motion whose acceleration jumps twice a second, with uniform noise of this width, whose deviation is width/√12. The
    /// median of 250 differences is right to 7 %, and the differences are not independent.
    #[test]
    fn differences_tell_the_noise_of_a_motion_whose_acceleration_jumps() {
        let times: Vec<f64> = (0..1000).map(|k| 2e-3 * f64::from(k)).collect();
        let motion = |t: &f64| (7.0 * t).sin() + 3.0 * (t % 0.5) * (0.5 - t % 0.5);
        for width in [1e-3, 1e-6] {
            let pairs = times.iter().zip(numbers(1000));
            let values: Vec<f64> = pairs
                .map(|(t, number)| motion(t) + width * number)
                .collect();
            let found = noise(&times, &values) * 12f64.sqrt() / width;
            assert!((found - 1.0).abs() < 0.2, "{width}: {found}");
        }
        let exact: Vec<f64> = times.iter().map(motion).collect();
        assert!(noise(&times, &exact) < 1e-13);
    }
}
