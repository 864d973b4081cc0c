//! Periodogram of the prediction errors over the crank angle (Schuster, Terrestrial Magnetism 3 (1898) 13): harmonics that are too
//! high for the first ones to lead to them, as those of cogging with many slots.

use std::f64::consts::TAU;

use super::candidates::{About, Candidate};
use super::harmonics::Increments;
use super::kalman;
use super::likelihood::Linear;
use super::prior::{High, Prior};
use super::repeating::cosines_and_sines;
use super::state_space::{Stretch, with_dimension};

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
    /// Returns the harmonics of a turn above one that stand out of what a model without harmonics leaves, among those that the
    /// samples can tell: one after the other, each beside the torque of the former ones.
    pub fn standing_out(&self, of: &Candidate, above: usize) -> High {
        let mut high = High::default();
        let mut linear = self.of(of.prior);
        for k in 0..high.len() {
            high[k] = self.sums(&linear, of).largest(above);
            match high[k].and_then(|_| self.beside(high, of)) {
                Some(next) => linear = next,
                None => break,
            }
        }
        high
    }

    /// The linear model beside the torque of high harmonics, by least squares.
    fn beside(&self, high: High, of: &Candidate) -> Option<Linear> {
        let prior = Prior {
            cycle: 1,
            high,
            ..of.prior
        };
        let linear = self.repeating(prior);
        let regression = linear.regression(&of.noise);
        // No amplitude is larger in its standard errors than the root of the number of samples.
        let wide = regression.least_error() * (regression.evidence.samples as f64).sqrt();
        let found = regression.solved_with(vec![wide; prior.coefficients()])?;
        let opposite: Vec<f64> = found.coefficients.iter().map(|one| -one).collect();
        let with = |stretch: &Stretch| {
            let mut steps = stretch.steps.to_vec();
            stretch.increments.take_out(&opposite, &mut steps);
            Stretch {
                steps: steps.into(),
                increments: Increments::default(),
                ..stretch.clone()
            }
        };
        let stretches = linear.stretches.iter().map(with).collect();
        Some(Linear {
            stretches,
            ..Linear::of(of.prior, linear.scales)
        })
    }

    /// The sums of a model's errors, of all harmonics with two samples in a wave and two samples for each coefficient.
    fn sums(&self, linear: &Linear, of: &Candidate) -> Sums {
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

    /// Returns the harmonic above one that gains most; none where its number and its size cost more (Schwarz, Ann. Statist. 6 (1978)
    /// 461).
    fn largest(&self, above: usize) -> Option<u16> {
        let square = |[cos, sin]: &[f64; 2]| cos * cos + sin * sin;
        let ordinates = self.waves.iter().map(|wave| square(wave) / self.squares);
        let high = (1..).zip(ordinates).skip(above);
        let (number, ordinate) = high.max_by(|a, b| a.1.total_cmp(&b.1))?;
        // The rise of ln of the marginal likelihood by two amplitudes with their likeliest variance.
        let gains = ordinate > 1.0 && ordinate - 1.0 - ordinate.ln() > self.count.ln();
        gains.then_some(number)
    }
}
