//! Measured values with their noise.

/// Measured values of a motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Record<'a> {
    /// s
    pub times: &'a [f64],
    /// rad or m
    pub values: &'a [f64],
    /// Standard deviation of the noise.
    pub noise: f64,
    /// Standard deviation of errors that do not average out.
    pub rounding: f64,
}

/// Standard deviations between a value and a fold that may be one.
const FAR: f64 = 10.0;

/// Factor by which a value may change more between samples than at the rates seen.
const MARGIN: f64 = 2.0;

/// Fewer that a turning point may be from the next one, and part of the range of all values that is enough.
const LESS: f64 = 6.0;
const CHANGE: f64 = 0.2;

/// Standard deviations between what a parabola and one through half as many samples say, from which on it does not follow
/// the motion.
const BENT: f64 = 2.0;

impl Record<'_> {
    pub fn last(&self) -> usize {
        self.values.len() - 1
    }

    /// By how much a value is to change between turning points, and before the first of them or after the last.
    pub fn thresholds(&self) -> [f64; 2] {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let values = self.values.iter();
        let (least, most) = values.fold(ends, |(a, b), v| (a.min(*v), b.max(*v)));
        let noise = self.noise + self.rounding;
        // Few samples of a fast motion look noisier than they are.
        let plain = (FAR * noise).min((CHANGE * (most - least)).max(LESS * noise));
        [plain, plain.min(LESS * noise)]
    }

    /// Whether a sample is at a fold, for all that noise tells.
    pub fn is_at(&self, at: usize, fold: f64) -> bool {
        (self.values[at] - fold).abs() <= FAR * (self.noise + self.rounding)
    }

    /// Whether the motion may have been at a fold near a sample, between samples too.
    pub fn reaches(&self, at: usize, fold: f64) -> bool {
        let noise = FAR * (self.noise + self.rounding);
        (self.values[at] - fold).abs() <= noise + self.nearby(at)
    }

    /// How far from the value of a sample the motion may have been between it and those next to it, at the rates around
    /// it, with a margin: of uneven samples the longest time may be just there.
    pub fn nearby(&self, at: usize) -> f64 {
        let around = at.saturating_sub(2)..(at + 3).min(self.values.len());
        let time = |i: usize, j: usize| (self.times[i] - self.times[j]).abs();
        let change = |i: usize, j: usize| (self.values[i] - self.values[j]).abs();
        let (mut step, mut rate) = (0.0f64, 0.0f64);
        for i in around.clone() {
            for j in i + 1..around.end {
                let beyond_noise = (change(i, j) - FAR * self.noise).max(0.0);
                rate = rate.max(beyond_noise / time(i, j));
            }
            if i > around.start {
                step = step.max(change(i - 1, i));
            }
        }
        let next = [at.saturating_sub(1), (at + 1).min(self.last())];
        let longest = next.map(|i| time(i, at)).into_iter().fold(0.0, f64::max);
        MARGIN * step.max(rate * longest)
    }

    /// The value at a sample, from at most as many on either side of it as one parabola follows, with its standard deviation.
    pub fn value(&self, at: usize, around: usize) -> (f64, f64) {
        let around = around.min(at).min(self.last() - at);
        let range = at - around..at + around + 1;
        let found = (around >= 2)
            .then(|| smoothed(&self.times[range.clone()], &self.values[range], around))
            .flatten();
        let Some((value, spread)) = found else {
            return (self.values[at], self.noise + self.rounding);
        };
        let fewer = self.value(at, around / 2);
        if (value - fewer.0).abs() > BENT * fewer.1 {
            return fewer;
        }
        (value, self.noise * spread.sqrt() + self.rounding)
    }
}

/// The parabola through values, by least squares, at one of them, and what it makes of squared noise.
fn smoothed(times: &[f64], values: &[f64], at: usize) -> Option<(f64, f64)> {
    let span = times[times.len() - 1] - times[0];
    let (mut sums, mut shown) = ([0.0; 5], [0.0; 3]);
    for (t, value) in times.iter().zip(values) {
        let t = (t - times[at]) / span;
        let powers = [1.0, t, t * t, t * t * t, t * t * t * t];
        for (sum, power) in sums.iter_mut().zip(powers) {
            *sum += power;
        }
        for (sum, power) in shown.iter_mut().zip(powers) {
            *sum += power * (value - values[at]);
        }
    }
    // Cramer's rule for the constant of the parabola.
    let [n, a, b, c, d] = sums;
    let minors = [b * d - c * c, b * c - a * d, a * c - b * b];
    let whole = n * minors[0] + a * minors[1] + b * minors[2];
    let part: f64 = shown.iter().zip(minors).map(|(y, minor)| y * minor).sum();
    let spread = minors[0] / whole;
    let is_good = (0.0..1.0).contains(&spread) && part.is_finite();
    is_good.then_some((values[at] + part / whole, spread))
}
