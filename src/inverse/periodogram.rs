//! Periodogram of the prediction errors over the crank angle (Schuster, Terrestrial Magnetism 3 (1898) 13): harmonics that are too
//! high for the first ones to lead to them, as those of cogging with many slots.

use std::f64::consts::TAU;

use super::candidates::{About, Candidate};
use super::kalman;
use super::repeating::cosines_and_sines;
use super::state_space::with_dimension;

/// Sums over the prediction errors e of a model, in their standard deviations.
#[derive(Default)]
struct Sums {
    /// Number of errors.
    count: f64,
    /// Σ e²
    squares: f64,
    /// Σ e cos kθ and Σ e sin kθ of each harmonic k, from the first one on.
    waves: Vec<[f64; 2]>,
}

impl About {
    /// Returns the highest harmonic of a turn that stands out of what a model without harmonics leaves, among those that the samples
    /// can tell; none where its number and its size cost more than it gains (Schwarz, Ann. Statist. 6 (1978) 461).
    pub fn standing_out(&self, of: &Candidate) -> Option<usize> {
        let Sums {
            count,
            squares,
            waves,
        } = self.sums(of);
        let stands_out = |[cos, sin]: &[f64; 2]| {
            let ordinate = (cos * cos + sin * sin) / squares;
            // The rise of ln of the marginal likelihood by two amplitudes with their likeliest variance.
            ordinate > 1.0 && ordinate - 1.0 - ordinate.ln() > count.ln()
        };
        waves.iter().rposition(stands_out).map(|index| index + 1)
    }

    /// The sums of a model's errors, of all harmonics with two samples in a wave and two samples for each coefficient.
    fn sums(&self, of: &Candidate) -> Sums {
        let linear = self.of(of.prior);
        let samples: usize = linear.stretches.iter().map(|one| one.observed.len()).sum();
        let waves = 0.5 * TAU / (of.scales.speed * of.scales.spacing);
        let most = samples / (2 * of.prior.of_harmonic());
        let mut sums = Sums {
            waves: vec![[0.0; 2]; most.min(waves as usize)],
            ..Sums::default()
        };
        for (range, stretch) in self.path.ranges.iter().zip(linear.stretches.iter()) {
            let states = self.path.piece(range).states;
            let model = linear.deviations(stretch, &of.noise);
            with_dimension!(model.dimension(), N => {
                kalman::run::<N>(&model, None, |node, at| {
                    if let Some((_, found)) = at.sample {
                        sums.add(found.error / found.variance.sqrt(), states[node][0]);
                    }
                });
            });
        }
        sums
    }
}

impl Sums {
    /// Adds the error of a sample at a crank angle, rad.
    fn add(&mut self, error: f64, theta: f64) {
        self.count += 1.0;
        self.squares += error * error;
        let pairs = cosines_and_sines(theta, self.waves.len());
        for (sum, [cos, sin]) in self.waves.iter_mut().zip(pairs) {
            *sum = [sum[0] + error * cos, sum[1] + error * sin];
        }
    }
}
