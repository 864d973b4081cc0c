//! Periodogram of prediction errors over an angle or the time (Schuster, Terrestrial Magnetism 3 (1898) 13).

use std::f64::consts::PI;
use std::iter;

use super::super::model::repeating::cosines_and_sines;

/// Σ e cos kφ and Σ e sin kφ of eight harmonics side by side.
type Waves = [[f64; 8]; 2];

/// Sums over prediction errors e at angles φ.
pub(in crate::inverse) struct Periodogram {
    /// Number of errors.
    count: f64,
    /// Σ e²
    squares: f64,
    /// Number of harmonics.
    harmonics: usize,
    /// The waves of the harmonics, from the first one on.
    waves: Vec<Waves>,
}

impl Periodogram {
    /// The sums of no errors yet, of so many harmonics.
    pub fn of(harmonics: usize) -> Periodogram {
        Periodogram {
            count: 0.0,
            squares: 0.0,
            harmonics,
            waves: vec![Waves::default(); harmonics.div_ceil(8)],
        }
    }

    /// Adds the error of a sample at an angle, rad.
    pub fn add(&mut self, error: f64, angle: f64) {
        self.count += 1.0;
        self.squares += error * error;
        let mut wave = Waves::default();
        for (k, [cos, sin]) in cosines_and_sines(angle, 8).enumerate() {
            (wave[0][k], wave[1][k]) = (error * cos, error * sin);
        }
        let (sin, cos) = (8.0 * angle).sin_cos();
        for sums in &mut self.waves {
            for k in 0..8 {
                let [c, s] = [wave[0][k], wave[1][k]];
                sums[0][k] += c;
                sums[1][k] += s;
                (wave[0][k], wave[1][k]) = (c * cos - s * sin, s * cos + c * sin);
            }
        }
    }

    /// Returns the number and the ordinate of each harmonic, whose mean is one half for white noise.
    fn ordinates(&self) -> impl Iterator<Item = (u16, f64)> {
        let waves = self.waves.iter();
        let squares = waves.flat_map(|[c, s]| (0..8).map(|k| c[k] * c[k] + s[k] * s[k]));
        let ordinates = squares.map(|square| square / self.squares);
        (1..).zip(ordinates.take(self.harmonics))
    }

    /// Returns the harmonics that stand out of their neighbours, by the likelihood ratio of a variance of their own, against the cost
    /// of a number and a size. Harmonics of this frequency, rad/s, half the resolution, are two for each independent ordinate.
    fn lines(&self, width: f64) -> Vec<Line> {
        let all: Vec<f64> = self.ordinates().map(|(_, ordinate)| ordinate).collect();
        let gain = |k: &usize| {
            let side = |from: usize, to: usize| all.iter().take(to).skip(from);
            let beside = side(k.saturating_sub(18), k.saturating_sub(2)).chain(side(k + 3, k + 19));
            let (sum, count) = beside.fold((0.0, 0.0), |(sum, n), one| (sum + one, n + 1.0));
            let (ratio, independent) = ((all[*k] * count / sum).max(1.0), 0.5 * count);
            let common = (independent + ratio) / (independent + 1.0);
            (independent + 1.0) * common.ln() - ratio.ln()
        };
        let is_peak =
            |k: &usize| all[*k] >= all[k - 1] && all.get(k + 1).is_none_or(|next| all[*k] > *next);
        let peaks = (1..all.len()).filter(is_peak).map(|k| Line {
            frequency: (k + 1) as f64 * width,
            width,
            gain: gain(&k),
        });
        let found = peaks.filter(|line| line.gain > self.count.ln());
        found.collect()
    }

    /// Returns the harmonic above one that gains most; none where its number and its size cost more (Schwarz, Ann. Statist. 6 (1978)
    /// 461).
    pub fn largest(&self, above: usize) -> Option<u16> {
        let high = self.ordinates().skip(above);
        let (number, ordinate) = high.max_by(|a, b| a.1.total_cmp(&b.1))?;
        // The rise of ln of the marginal likelihood by two amplitudes with their likeliest variance.
        let gains = ordinate > 1.0 && ordinate - 1.0 - ordinate.ln() > self.count.ln();
        gains.then_some(number)
    }
}

/// A frequency that stands out of its neighbours.
pub(in crate::inverse) struct Line {
    /// Angular frequency, rad/s.
    frequency: f64,
    /// Half the distance of two frequencies that are told apart, rad/s.
    width: f64,
    /// Rise of ln of the likelihood.
    gain: f64,
}

/// Returns the lines of prediction errors at times, s, the sharpest first: of the first ones, up to a number, and of as many means of
/// two, of four and of more of them.
pub(in crate::inverse) fn lines(errors: &[[f64; 2]], most: usize) -> Vec<Line> {
    let means = |finer: &Vec<[f64; 2]>| {
        let mean = |pair: &[[f64; 2]]| [0, 1].map(|k| 0.5 * (pair[0][k] + pair[1][k]));
        (finer.len() > most).then(|| finer.chunks_exact(2).map(mean).collect())
    };
    let levels = iter::successors(Some(errors.to_vec()), means);
    let of_first = |level: Vec<[f64; 2]>| {
        let some = &level[..most.min(level.len())];
        let width = half_width(some);
        let mut sums = Periodogram::of(some.len());
        some.iter()
            .for_each(|[t, error]| sums.add(*error, width * t));
        sums.lines(width)
    };
    let mut lines: Vec<Line> = levels.flat_map(of_first).collect();
    lines.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    lines
}

impl Line {
    /// Returns the frequency next to its own, rad/s, at which prediction errors at times, s, have the largest ordinate.
    pub fn highest(&self, errors: &[[f64; 2]]) -> f64 {
        let ordinate = |frequency: f64| {
            let mut sums = Periodogram::of(1);
            let pairs = errors.iter();
            pairs.for_each(|[t, error]| sums.add(*error, frequency * t));
            sums.ordinates().map(|(_, ordinate)| ordinate).sum::<f64>()
        };
        let step = half_width(errors);
        let places = iter::successors(Some(self.frequency - self.width), |place| {
            Some(place + step)
        });
        let places = places.take_while(|place| *place <= self.frequency + self.width);
        let fine = places.map(|place| (place, ordinate(place)));
        let highest = fine.max_by(|a, b| a.1.total_cmp(&b.1));
        highest.map_or(self.frequency, |highest| highest.0)
    }
}

/// Half the distance of two frequencies that samples from the first to the last tell apart, rad/s.
fn half_width(errors: &[[f64; 2]]) -> f64 {
    match errors {
        [[first, _], .., [last, _]] => PI / (last - first),
        _ => f64::INFINITY,
    }
}
