//! Times of even samples that were rounded: to the decimals of a file, or to what doubles hold of times far from zero.
//!
//! Even times that are rounded to steps are up to half a step off a line, and go on by one of two multiples of the step
//! (Morse and Hedlund, Amer. J. Math. 62 (1940) 1: sequences of such kind are those of lines). Their errors depend on each
//! other, and look like a motion where the samples go on by almost a multiple of the step.

use super::Measurement;
use crate::scene::number::computed;

/// Rounding of doubles over the whole time above which a step is one.
const PLAIN: f64 = 1e3 * f64::EPSILON;

/// Part of the time from sample to sample above which a step may be one of the samples themselves.
const COARSE: f64 = 0.5;

/// Part of a step by which times that go on by multiples of it may be off: the rounding of doubles is a thousandth of a step
/// at most, and half a step would tell nothing.
const ALIKE: f64 = 0.1;

/// Fewest times that the longer and the shorter step occur: fewer may be those of a clock that was late.
const FEWEST: usize = 4;

/// Even times that were rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Even {
    /// Time of the first sample after its rounded one, s.
    first: f64,
    /// Time from sample to sample, s.
    period: f64,
    /// The step to which they are rounded, s.
    step: f64,
    /// Part by which the period may be off.
    pub uncertain: f64,
}

impl Even {
    /// The even times of which these are the rounded ones, if they are.
    pub fn of(times: &[f64]) -> Option<Even> {
        let (first, last) = (*times.first()?, *times.last()?);
        let gaps = || times.windows(2).map(|pair| pair[1] - pair[0]);
        let ends = (f64::INFINITY, 0.0f64);
        let (short, long) = gaps().fold(ends, |(a, b), gap| (a.min(gap), b.max(gap)));
        let step = long - short;
        if step < PLAIN * (last - first) || step > COARSE * short {
            return None;
        }
        let is_one = |gap: f64| (gap - short).min(long - gap) < ALIKE * step;
        let longer = gaps().filter(|gap| *gap - short > 0.5 * step).count();
        let rarer = longer.min(times.len() - 1 - longer);
        if rarer < FEWEST || !gaps().all(is_one) {
            return None;
        }
        let (offset, period) = line(times);
        // The line through a sawtooth of so many teeth is off as well.
        let within = step * (0.5 + ALIKE + 1.0 / rarer as f64);
        let even = Even {
            first: offset,
            period,
            step,
            // That of as many teeth, or of errors that are independent.
            uncertain: step / ((rarer as f64).min((times.len() as f64).sqrt()) * (last - first)),
        };
        let near = |(i, time): (usize, &f64)| (time - first - even.since(i)).abs() < within;
        times.iter().enumerate().all(near).then_some(even)
    }

    /// The time of a sample since the first rounded one, s.
    fn since(&self, sample: usize) -> f64 {
        self.first + self.period * sample as f64
    }
}

impl Measurement {
    /// Takes times that are even but for rounding as even; what is to be known of it.
    pub(super) fn space_evenly(&mut self) -> Option<String> {
        let even = Even::of(self.elapsed())?;
        if self.lost().is_some() {
            self.origin = self.times[0];
        }
        let first = self.times[0] - self.origin;
        let spaced = (0..self.times.len()).map(|i| first + even.since(i));
        self.elapsed = Some(spaced.collect());
        self.spacing = even.uncertain;
        Some(format!(
            "the times are those of samples {} s apart, rounded to {} s: the fit takes them as even",
            computed(even.period),
            computed(even.step)
        ))
    }
}

/// What the line through values (least squares) is above the first one there, and its slope.
fn line(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let about = values[0];
    let (mut sum, mut moment) = (0.0, 0.0);
    for (i, value) in values.iter().enumerate() {
        sum += value - about;
        moment += (i as f64 - middle) * (value - about);
    }
    let slope = 12.0 * moment / (count * (count * count - 1.0));
    (sum / count - slope * middle, slope)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rounded(start: f64, period: f64, step: f64) -> Vec<f64> {
        let time = |i: u32| (start + period * f64::from(i)) / step;
        (0..500).map(|i| time(i).round() * step).collect()
    }

    #[test]
    fn rounded_even_times_are_seen() {
        for (start, period, step) in [
            (0.0, 1.0 / 3000.0, 1e-6),
            (0.2, 1.0 / 300.0, 1e-3),
            (0.0, 1.00002e-3, 1e-6),
            // The first one is rounded by almost half a step.
            (4e-7, 1.0 / 3000.0, 1e-6),
        ] {
            let times = rounded(start, period, step);
            let found = Even::of(&times).expect("even times");
            let off = (found.period / period - 1.0).abs();
            assert!(off < found.uncertain, "{off} of {}", found.uncertain);
            assert!((found.step / step - 1.0).abs() < 1e-6);
            let first = times[0] + found.first;
            assert!((first - start).abs() < 0.2 * step, "{first}");
        }
    }

    #[test]
    fn other_times_are_left() {
        // Exact ones.
        assert_eq!(Even::of(&rounded(0.0, 1e-3, 1e-3)), None);
        assert_eq!(Even::of(&rounded(0.0, 1.0 / 3.0, 1e-14)), None);
        // A missing sample, late ones, and a rate that changes.
        let mut missing = rounded(0.0, 1e-3, 1e-3);
        missing.remove(250);
        assert_eq!(Even::of(&missing), None);
        let late = |i: usize, time: f64| time + if i > 100 { 2e-4 } else { 0.0 };
        let times = rounded(0.0, 1e-3, 1e-3).into_iter().enumerate();
        let times: Vec<f64> = times.map(|(i, time)| late(i, time)).collect();
        assert_eq!(Even::of(&times), None);
        let mut slower = rounded(0.0, 1e-3, 1e-4);
        slower.extend(rounded(0.6, 1.3e-3, 1e-4));
        assert_eq!(Even::of(&slower), None);
        // One that goes on by the same two multiples of a step.
        let mut slower = rounded(0.0, 1.0002e-3, 1e-6);
        slower.extend(rounded(0.500_1 + 1.0008e-3, 1.0008e-3, 1e-6));
        assert_eq!(Even::of(&slower), None);
        // Ones that may be times of some samples of more.
        assert_eq!(Even::of(&rounded(0.0, 1.3, 1.0)), None);
    }
}
