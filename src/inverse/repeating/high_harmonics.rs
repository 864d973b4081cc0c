//! Harmonics of the torque that are too high for the first ones to lead to them, as those of cogging with many slots: they stand out
//! of the periodogram of the prediction errors over the crank angle.

use std::f64::consts::TAU;

use super::super::candidates::{About, Candidate};
use super::super::likelihood::Linear;
use super::super::model::harmonics::Increments;
use super::super::model::kalman;
use super::super::model::prior::{High, Prior};
use super::super::model::state_space::{Stretch, with_dimension};
use super::periodogram::Periodogram;

impl About {
    /// Returns the harmonics of a turn above one that stand out of what a model without harmonics leaves, among those that the
    /// samples can tell: one after the other, each beside the torque of the former ones.
    pub fn standing_out(&self, of: &Candidate, above: usize) -> High {
        let mut high = High::default();
        let mut linear = self.of(of.prior);
        for k in 0..high.len() {
            high[k] = self.periodogram(&linear, of).largest(above);
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

    /// The periodogram of a model's errors, of all harmonics with two samples in a wave and two samples for each coefficient.
    fn periodogram(&self, linear: &Linear, of: &Candidate) -> Periodogram {
        let samples: usize = linear.stretches.iter().map(|one| one.observed.len()).sum();
        let waves = 0.5 * TAU / (of.scales.speed * of.scales.spacing);
        let most = samples / (2 * of.prior.of_harmonic());
        let mut sums = Periodogram::of(most.min(waves as usize));
        for (range, stretch) in self.path.ranges.iter().zip(linear.stretches.iter()) {
            let states = self.path.part(range);
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
