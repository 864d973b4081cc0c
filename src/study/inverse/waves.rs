//! Waves in the residuals of a fit that are too fast for it: lines of their spectrum that stand out of the noise.
//!
//! A smooth curve takes a wave of a few samples for noise, however strong it is. Noise has no lines: its periodogram at the
//! frequencies of a stretch of samples is independent numbers of one exponential distribution (Priestley, Spectral Analysis
//! and Time Series, Academic Press 1981, section 6.1).

use std::f64::consts::TAU;

use crate::numeric::fit::{Samples, State};
use crate::numeric::median::median;
use crate::numeric::parallel;

/// Samples of a stretch of many, and the most stretches.
const LONG: usize = 512;
const STRETCHES: usize = 16;

/// Fewest frequencies that show the level of noise.
const FEWEST: usize = 8;

/// Standard deviations beyond which a line stands out.
const OUT: f64 = 5.0;

/// Waves that a fit does not follow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Waves {
    /// Root mean squares of their value and derivatives by time.
    sizes: [f64; 3],
    /// Samples to one of them, of mean acceleration.
    pub samples: f64,
}

/// A line of a spectrum.
struct Line {
    /// Angular frequency, rad/s.
    rate: f64,
    /// Mean square of the wave.
    square: f64,
}

impl Waves {
    /// Those of the residuals that a fit leaves of samples, in terms of the fit, but for the lowest part of the frequencies,
    /// which it follows; none if none stands out.
    pub fn of(residuals: &[f64], samples: &Samples<'_>, followed: f64) -> Option<Waves> {
        let rows = residuals.len() as f64;
        let spacing = (samples.t[samples.t.len() - 1] - samples.t[0]) / (rows - 1.0);
        let stretches = Stretches::of(residuals.len());
        let lines = stretches.spectrum(residuals, samples.t, spacing, followed);
        let level = median(lines.iter().map(|line| line.square))?;
        let mean = Mean::of(stretches.number);
        let out = |line: &&Line| mean.deviations(line.square / level) > OUT;
        if lines.len() < FEWEST {
            return None;
        }
        let mut squares = [0.0; 3];
        for line in lines.iter().filter(out) {
            for (square, power) in squares.iter_mut().zip([0, 2, 4]) {
                *square += line.square * line.rate.powi(power);
            }
        }
        let [value, _, acceleration] = squares;
        let weight = samples.weight.map_or(1.0, |weight| {
            weight.iter().map(|weight| weight * weight).sum::<f64>() / rows
        });
        (value > 0.0).then(|| Waves {
            sizes: squares.map(|square| (square / weight).sqrt()),
            samples: TAU / (acceleration / value).powf(0.25) / spacing,
        })
    }

    /// A state of a motion that may have them: value and acceleration of a wave are of opposite sign, and the speed depends on
    /// neither.
    pub fn beside(&self, state: State) -> State {
        let [value, speed, acceleration] = self.sizes;
        state
            .off_by(&[value, 0.0, -acceleration])
            .off_by(&[0.0, speed, 0.0])
    }
}

/// Stretches of samples.
struct Stretches {
    /// Samples of each.
    long: usize,
    number: usize,
    /// Where the last one starts.
    last: usize,
}

impl Stretches {
    /// Of so many samples: few of them have all in theirs.
    fn of(rows: usize) -> Stretches {
        let number = (rows / LONG).max(1);
        let long = if number > STRETCHES {
            LONG
        } else {
            rows / number
        };
        Stretches {
            long,
            number: number.min(STRETCHES),
            last: rows - long,
        }
    }

    /// The mean periodogram of residuals at rising times that are about so far apart: without this part of the frequencies
    /// from the lowest on, which the fit follows, and below half a wave for each sample.
    fn spectrum(&self, residuals: &[f64], t: &[f64], spacing: f64, followed: f64) -> Vec<Line> {
        let lowest = TAU / (self.long as f64 * spacing);
        let number = self.long.div_ceil(2);
        let of_stretch = |start: usize| {
            let mut sums = vec![[0.0; 2]; number];
            for i in start..start + self.long {
                let (sin, cos) = (lowest * (t[i] - t[start])).sin_cos();
                let [mut re, mut im] = [residuals[i], 0.0];
                for sum in &mut sums {
                    sum[0] += re;
                    sum[1] += im;
                    [re, im] = [re * cos - im * sin, re * sin + im * cos];
                }
            }
            sums
        };
        let starts = (0..self.number).map(|i| i * self.last / (self.number - 1).max(1));
        let found = parallel::map(starts, of_stretch);
        let per = 2.0 / ((self.long * self.long) as f64 * self.number as f64);
        let line = |k: usize| {
            let squares = found.iter().map(|sums| sums[k]);
            Line {
                rate: lowest * k as f64,
                square: per * squares.map(|[re, im]| re * re + im * im).sum::<f64>(),
            }
        };
        let first = (followed * number as f64).ceil() as usize;
        (first.max(1)..number).map(line).collect()
    }
}

/// The mean of independent numbers of an exponential distribution: its cube root is about normal (Wilson and Hilferty, Proc.
/// Nat. Acad. Sci. 17 (1931) 684).
struct Mean {
    root: f64,
    deviation: f64,
}

impl Mean {
    /// Of so many numbers.
    fn of(numbers: usize) -> Mean {
        let ninth = 1.0 / (9.0 * numbers as f64);
        Mean {
            root: 1.0 - ninth,
            deviation: ninth.sqrt(),
        }
    }

    /// Standard deviations by which one lies above what is usual, from its ratio to the median.
    fn deviations(&self, ratio: f64) -> f64 {
        self.root * (ratio.cbrt() - 1.0) / self.deviation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even numbers from −0.5 to 0.5, by xorshift.
    fn random(state: &mut u64) -> f64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    }

    /// Waves in residuals at these times.
    fn found(residuals: &[f64], t: &[f64]) -> Option<Waves> {
        let samples = Samples {
            t,
            target: residuals,
            weight: None,
            floor: 0.0,
        };
        Waves::of(residuals, &samples, 0.05)
    }

    /// A wave between two frequencies of the spectrum at uneven times, in noise of a quarter of its size.
    #[test]
    fn a_wave_has_its_size_and_that_of_its_derivatives() {
        let mut state = 88_172_645_463_325_252u64;
        let mut random = || random(&mut state);
        for rows in [120u32, 1200, 12_000] {
            let t: Vec<f64> = (0..rows)
                .map(|i| 0.01 * (f64::from(i) + 0.4 * random()))
                .collect();
            let rate = TAU / 0.0287;
            let noise: Vec<f64> = (0..rows).map(|_| 0.6 * random()).collect();
            let wave = t
                .iter()
                .zip(&noise)
                .map(|(t, noise)| (rate * t).sin() + noise);
            let wave: Vec<f64> = wave.collect();
            assert_eq!(found(&noise, &t), None, "{rows}");
            let found = found(&wave, &t).expect("a wave");
            for (power, size) in found.sizes.into_iter().enumerate() {
                let part = size / (rate.powi(power as i32) * 0.5f64.sqrt());
                assert!((0.8..=1.1).contains(&part), "{rows}, {power}: {part}");
            }
            assert!((found.samples - 2.87).abs() < 0.1, "{}", found.samples);
        }
    }

    /// A wave of two fifths of the noise, which half of the samples would hardly show.
    #[test]
    fn few_samples_tell_all_of_a_wave() {
        let mut state = 88_172_645_463_325_252u64;
        let t: Vec<f64> = (0..1020u32).map(f64::from).collect();
        let rate = 250.0 * TAU / 1020.0;
        for draw in 0..8 {
            let wave = t
                .iter()
                .map(|t| 0.07 * (rate * t).sin() + 0.6 * random(&mut state));
            let wave: Vec<f64> = wave.collect();
            assert!(found(&wave, &t).is_some(), "{draw}");
        }
    }
}
