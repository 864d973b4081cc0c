//! Periodogram of prediction errors over an angle or the time (Schuster, Terrestrial Magnetism 3 (1898) 13).

use std::f64::consts::PI;
use std::iter;

use super::repeating::cosines_and_sines;

/// Σ e cos kφ and Σ e sin kφ of eight harmonics side by side.
type Waves = [[f64; 8]; 2];

/// Sums over prediction errors e at angles φ.
pub(super) struct Periodogram {
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

    /// Returns the harmonics that stand out of their neighbours, the sharpest first, by the likelihood ratio of a variance of their
    /// own, against the cost of a number and a size. Harmonics of half the resolution are two for each independent ordinate.
    fn lines(&self) -> Vec<u16> {
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
        let peaks = (1..all.len()).filter(is_peak).map(|k| (gain(&k), k));
        let mut lines: Vec<(f64, usize)> =
            peaks.filter(|(gain, _)| *gain > self.count.ln()).collect();
        lines.sort_by(|a, b| b.0.total_cmp(&a.0));
        lines
            .into_iter()
            .filter_map(|(_, k)| u16::try_from(k + 1).ok())
            .collect()
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

/// Returns the angular frequencies, rad/s, of the lines of prediction errors at times, s, the sharpest first: by the first ones, up
/// to a number, then next to it by all.
pub(super) fn lines(errors: &[[f64; 2]], most: usize) -> Vec<f64> {
    let some = &errors[..errors.len().min(most)];
    let [width, of_all] = [some, errors].map(half_width);
    let mut coarse = Periodogram::of(some.len());
    for [t, error] in some {
        coarse.add(*error, width * t);
    }
    let ordinate = |frequency: f64| {
        let mut fine = Periodogram::of(1);
        errors
            .iter()
            .for_each(|[t, error]| fine.add(*error, frequency * t));
        fine.ordinates().map(|(_, ordinate)| ordinate).sum::<f64>()
    };
    let highest = |number: u16| {
        let line = f64::from(number) * width;
        let places = iter::successors(Some(line - width), |place| Some(place + of_all));
        let places = places.take_while(|place| *place <= line + width);
        let fine = places.map(|place| (place, ordinate(place)));
        let highest = fine.max_by(|a, b| a.1.total_cmp(&b.1));
        highest.map_or(line, |highest| highest.0)
    };
    coarse.lines().into_iter().map(highest).collect()
}

/// Half the distance of two frequencies that samples from the first to the last tell apart, rad/s.
fn half_width(errors: &[[f64; 2]]) -> f64 {
    match errors {
        [[first, _], .., [last, _]] => PI / (last - first),
        _ => f64::INFINITY,
    }
}
