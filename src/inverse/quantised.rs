//! Quantised values: detection of encoder codes or rounded numbers, and the intervals of the angle that they stand for.

use std::ops::Range;

use crate::numeric::ROUNDING_DEVIATION;
use crate::numeric::median::median;

/// Quantisation of the crank angle: codes of an encoder, or rounded numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Codes {
    /// Width of a step, rad.
    pub step: f64,
}

/// Interval that contains the crank angle at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    /// Time, s.
    pub t: f64,
    /// Middle of the interval, rad.
    pub middle: f64,
    /// Width of the interval, rad.
    pub width: f64,
    /// Index of the sample in the interval, or of the sample before it.
    pub sample: usize,
}

impl Codes {
    /// Detects values quantised by an encoder, or rounded to digits of this size, rad.
    pub fn of(values: &[f64], digits: f64) -> Option<Codes> {
        Codes::of_encoder(values, digits).or_else(|| Codes::rounded(values, digits))
    }

    /// Detects values rounded to digits of one size, rad.
    fn rounded(values: &[f64], digits: f64) -> Option<Codes> {
        let is_multiple = |v: &f64| (v / digits - (v / digits).round()).abs() < MULTIPLE;
        let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        (digits > 1e-12 * largest && values.iter().all(is_multiple))
            .then_some(Codes { step: digits })
    }

    /// Detects values whose differences are all multiples of a step that is far wider than the digits, rad.
    fn of_encoder(values: &[f64], digits: f64) -> Option<Codes> {
        let largest = values.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let digits = (4.0 * digits).max(1e-13 * largest);
        let differences = || values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
        let mut step = Step::default();
        for difference in differences().filter(|difference| *difference > digits) {
            step.take(difference, digits);
            if step.width() < WIDE * digits {
                return None;
            }
        }
        if step.squares == 0.0 {
            return None;
        }
        let most = differences().map(|difference| step.count(difference));
        let most = most.reduce(f64::max)?;
        // Equal differences are a steady speed.
        (most > 1.0 || values.windows(2).any(|pair| pair[0] == pair[1]))
            .then(|| Codes { step: step.width() })
    }

    /// Returns the independent information of the samples: passages from step to step, and codes shown next to skipped
    /// steps, at both ends, and within a stay, one for each median duration of a stay, for a crank at rest could leave
    /// the step between. Returns all samples where these are no more.
    pub fn intervals(&self, times: &[f64], values: &[f64]) -> Vec<Interval> {
        let shown = |sample: usize| Interval {
            t: times[sample],
            middle: values[sample],
            width: self.step,
            sample,
        };
        let mut ends = vec![0];
        ends.extend((1..values.len()).filter(|i| self.count(values, *i) != 0));
        ends.push(values.len());
        let stays: Vec<Range<usize>> = ends.windows(2).map(|w| w[0]..w[1]).collect();
        let skips = |i: usize| i == 0 || i == values.len() || self.count(values, i).abs() > 1;
        let usual = median(stays.iter().map(|stay| stay.len() as f64)).unwrap_or(1.0) as usize;
        let mut list = Vec::new();
        for (k, stay) in stays.iter().enumerate() {
            let last = stay.end - 1;
            let parts = if stay.len() > 2 {
                stay.len().div_ceil(usual.max(1))
            } else {
                0
            };
            let mut seen: Vec<usize> = (1..=parts)
                .map(|part| stay.start + stay.len() * part / (parts + 1))
                .collect();
            seen.extend(skips(stay.start).then_some(stay.start));
            seen.extend(skips(stay.end).then_some(last));
            seen.sort_unstable();
            seen.dedup();
            list.extend(seen.into_iter().map(shown));
            if let Some(next) = stays.get(k + 1)
                && !skips(stay.end)
            {
                // The time of a passage is known to one sample spacing: in a long stay a small part of the step.
                list.push(Interval {
                    t: 0.5 * (times[last] + times[last + 1]),
                    middle: 0.5 * (values[last] + values[last + 1]),
                    width: self.step / stay.len().min(next.len()) as f64,
                    sample: last,
                });
            }
        }
        match list.len() < values.len() {
            true => list,
            false => (0..values.len()).map(shown).collect(),
        }
    }

    /// Returns the number of steps from the preceding sample to this one.
    fn count(&self, values: &[f64], sample: usize) -> i64 {
        ((values[sample] - values[sample - 1]) / self.step).round() as i64
    }

    /// Returns the standard error of the zero of an encoder, rad; none for rounded numbers. An encoder has a whole
    /// number of steps in a turn. Its index mark was seen between two codes, and a code may stand for the begin or the
    /// middle of its step: the error is uniform within a step on both sides.
    pub fn zero_error(&self) -> Option<f64> {
        let count = std::f64::consts::TAU / self.step;
        (count < MOST_COUNTS && (count - count.round()).abs() < MULTIPLE)
            .then(|| self.step / 3f64.sqrt())
    }

    /// Returns the standard deviation of an error that is uniform within a step, rad.
    pub fn spread(self) -> f64 {
        ROUNDING_DEVIATION * self.step
    }
}

/// Step of which differences are multiples, by least squares.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    squares: f64,
    products: f64,
}

impl Step {
    /// Returns the width, rad, after a first difference.
    fn width(self) -> f64 {
        self.products / self.squares
    }

    fn count(self, difference: f64) -> f64 {
        (difference / self.width()).round()
    }

    /// Takes a difference with an error of some digits, rad: one more multiple, or the step becomes what divides both
    /// (Euclid). The error of the step grows with the multiple.
    fn take(&mut self, difference: f64, digits: f64) {
        if self.squares == 0.0 {
            (self.squares, self.products) = (1.0, difference);
            return;
        }
        let count = self.count(difference);
        let error = digits * (1.0 + count / self.squares.sqrt());
        let (mut step, mut rest) = (self.width(), (difference - count * self.width()).abs());
        if rest <= error {
            self.squares += count * count;
            self.products += count * difference;
            return;
        }
        while rest > error {
            (step, rest) = (rest, step % rest);
            rest = rest.min(step - rest);
        }
        (self.squares, self.products) = (1.0, step);
    }
}

/// Largest number of steps per turn of an encoder.
const MOST_COUNTS: f64 = 1e6;

/// Tolerance of a whole number of steps, in steps.
const MULTIPLE: f64 = 0.01;

/// Least ratio of the step of an encoder to the size of the digits; smaller steps are rounding.
const WIDE: f64 = 100.0;

#[cfg(test)]
mod tests {
    use super::Codes;

    /// Twelve digits leave more error in a multiple of the step than in the step.
    #[test]
    fn codes_written_to_twelve_digits_are_steps_of_an_encoder() {
        let step = std::f64::consts::TAU / 1024.0;
        let counts = [472, 471, 465, 387, 361, 361, 250, 11, -3, -2, -2, -2, 184];
        let written = counts.map(|count| format!("{:.11e}", f64::from(count) * step));
        let values = written.map(|text| text.parse().expect("a number"));
        let found = Codes::of(&values, 7e-12).expect("an encoder");
        assert!((found.step / step - 1.0).abs() < 1e-11, "{found:?}");
        assert!(
            Codes::of_encoder(&values.map(|value| value + 1e-5 * value.sin()), 7e-12).is_none()
        );
    }

    #[test]
    fn rounded_numbers_go_in_steps_of_their_last_digit() {
        let rounded = [0.0, 0.012, 0.025, 0.031, 0.055];
        assert!(Codes::of_encoder(&rounded, 1e-3).is_none());
        let found = Codes::of(&rounded, 1e-3).expect("rounded numbers");
        assert_eq!(found.step, 1e-3);
        assert_eq!(found.zero_error(), None);
        // The last number has a digit more.
        assert!(Codes::of(&[0.0, 0.012, 0.0253], 1e-3).is_none());
    }
}
