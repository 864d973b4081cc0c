//! Times of even samples that were rounded to the decimals of a file.

use super::Measurement;
use crate::scene::number::computed;

/// Part of a step of rounding by which rounded times may be off an even one: half of it, and a tenth of it for the line
/// through them.
const WITHIN: f64 = 0.6;

/// Rounding of doubles over the whole time above which times are not even.
const PLAIN: f64 = 1e3 * f64::EPSILON;

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
    /// The even times of which these are the rounded ones, if they are: those of their line by least squares.
    pub fn of(times: &[f64]) -> Option<Even> {
        let count = times.len() as f64;
        let length = times.last()? - times.first()?;
        let gaps = || times.windows(2).map(|pair| pair[1] - pair[0]);
        let ends = (f64::INFINITY, 0.0f64);
        let (short, long) = gaps().fold(ends, |(a, b), gap| (a.min(gap), b.max(gap)));
        // Rounding makes gaps that differ by one step, which leaves the order of the samples.
        let step = long - short;
        if step < PLAIN * length || step > 0.5 * short {
            return None;
        }
        let middle = 0.5 * (count - 1.0);
        let sums = times
            .iter()
            .enumerate()
            .fold([0.0; 2], |[sum, moment], (i, time)| {
                let since = time - times[0];
                [sum + since, moment + (i as f64 - middle) * since]
            });
        let period = 12.0 * sums[1] / (count * (count * count - 1.0));
        let first = sums[0] / count - period * middle;
        let off = |(i, time): (usize, &f64)| (time - times[0] - first - period * i as f64).abs();
        let is_rounded = |gap: f64| (gap - short).min(long - gap) < (WITHIN - 0.5) * step;
        let is_even = times
            .iter()
            .enumerate()
            .all(|sample| off(sample) < WITHIN * step);
        (is_even && gaps().all(is_rounded)).then(|| Even {
            first,
            period,
            step,
            uncertain: step / (count.sqrt() * length),
        })
    }
}

impl Measurement {
    /// Takes times that are even but for rounding as even; what is to be known of it.
    pub(super) fn space_evenly(&mut self) -> Option<String> {
        let even = Even::of(self.elapsed())?;
        if self.lost().is_some() {
            self.origin = self.times[0];
        }
        let first = self.times[0] - self.origin + even.first;
        let spaced = (0..self.times.len()).map(|i| first + even.period * i as f64);
        self.elapsed = Some(spaced.collect());
        self.spacing = even.uncertain;
        Some(format!(
            "the times are those of samples {} s apart, rounded to {} s: the fit takes them as even",
            computed(even.period),
            computed(even.step)
        ))
    }
}
