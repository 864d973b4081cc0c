//! Stretches of the record with stronger or weaker process noise than elsewhere: a machine that stands still between
//! its moves, a force that jumps. Each stretch has three parameters, and is accepted where the likelihood gains more
//! than they cost (Schwarz 1978; as in circular binary segmentation: Olshen et al., Biostatistics 5 (2004) 557).
//! A search for them begins at the scores of the intensity of each step, by-products of the smoother (Koopman and Shephard,
//! Biometrika 79 (1992) 823).

use std::ops::Range;

use super::super::maximum::ENOUGH_RISE;
use super::super::model::fixed_interval::{self, Companion, Later};
use super::super::model::kalman::{Filtered, Gaussian, Step};
use super::super::model::matrix::{Matrix, product, times};
use super::super::model::state_space::{Deviations, Stretch, with_dimension};
use super::super::outliers;
use super::super::problem::Problem;
use super::super::rotation::Rotation;
use super::super::smoother::Smoothed;
use super::Span;
use super::parted::Parted;
use super::stretch_search::{Guess, Trial};

/// Number of parameters of a stretch: begin, end, factor.
const PARAMETERS: f64 = 3.0;

/// Score of a step: derivative of ln of the likelihood by ln of its intensity, with the variance of the score.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    slope: f64,
    information: f64,
}

/// Companion of the smoother that collects the scores of all steps, and what parts the stretch at each node.
pub(in crate::inverse) struct Scores<const N: usize> {
    per_variance: f64,
    list: Vec<Score>,
    pub parted: Parted<N>,
}

impl<const N: usize> Companion<N> for Scores<N> {
    fn filtered(&mut self, _: usize, at: &Filtered<'_, N>) {
        self.parted.take(at);
    }

    /// Collects the slope ½ (rᵀ Q r − tr QN) for the smoother's correction r and its variance N = Y − Y P Y.
    fn returned(&mut self, node: usize, at: &Filtered<'_, N>, later: &Later<N>, all: &Gaussian<N>) {
        self.parted.nodes[node].later = *later;
        let Some(Step { noise, .. }) = at.step else {
            return;
        };
        let (r, told) = (&later.correction, &later.information);
        let known = product(told, &product(&all.covariance, told));
        let variance: Matrix<N> =
            std::array::from_fn(|i| std::array::from_fn(|j| told[i][j] - known[i][j]));
        let share = product(noise, &variance);
        let noisy = times(noise, r);
        let square: f64 = r.iter().zip(noisy).map(|(a, b)| a * b).sum();
        let trace: f64 = (0..N).map(|k| share[k][k]).sum();
        let both = product(&share, &share);
        self.list[node - 1] = Score {
            slope: 0.5 * (square * self.per_variance - trace),
            information: 0.5 * (0..N).map(|k| both[k][k]).sum::<f64>(),
        };
    }
}

pub(in crate::inverse) fn scores<const N: usize>(model: &Deviations<'_>, sigma: f64) -> Scores<N> {
    let mut scores = Scores {
        per_variance: 1.0 / (sigma * sigma),
        list: vec![Score::default(); model.stretch.steps.len()],
        parted: Parted::default(),
    };
    fixed_interval::smooth::<N>(model, &mut scores);
    scores
}

/// Returns the steps of each power of two in number whose intensity deviates most from the usual, by the rise of ln of the
/// likelihood that their scores promise: at least this one.
fn furthest(scores: &[Score], least: f64) -> Vec<Guess> {
    let mut sums = vec![[0.0; 2]];
    for score in scores {
        let [slope, information] = sums[sums.len() - 1];
        sums.push([slope + score.slope, information + score.information]);
    }
    let lengths = std::iter::successors(Some(1), |length| Some(2 * length));
    let lengths = lengths.take_while(|length| 2 * length <= scores.len());
    let of_length = |length: usize| {
        let sums = sums.windows(length + 1).enumerate();
        let all = sums.map(|(first, pair)| {
            let [slope, information] = [0, 1].map(|k| pair[length][k] - pair[0][k]);
            Guess {
                steps: first..first + length,
                log: 0.0,
                sense: slope.signum(),
                likelihood: 0.5 * slope * slope / information,
            }
        });
        let all = all.filter(|guess| guess.likelihood.is_finite() && guess.likelihood > least);
        let best = all.max_by(|a, b| a.likelihood.total_cmp(&b.likelihood))?;
        Some(Guess {
            likelihood: f64::NEG_INFINITY,
            ..best
        })
    };
    lengths.filter_map(of_length).collect()
}

impl Problem<'_> {
    /// Finds the stretches in which the process noise under a prior has another intensity. With one in each passage of the crank as
    /// good as the last the samples would be likelier than a least value: what is in each passage repeats.
    fn intensities_of(&self, found: &Smoothed, least: f64) -> Vec<Span> {
        let mut intensities = Vec::new();
        let Smoothed { prior, scales, .. } = *found;
        let mut linear = self.linear(prior, scales, &found.path(), found.noise.sigma);
        linear.stretches = linear
            .stretches
            .iter()
            .map(Stretch::beside_known_tones)
            .collect();
        let mut noise = found.noise;
        let passes = Rotation::of(found.angles()).passes;
        while intensities.len() < self.record.counted() as usize / 10 {
            noise = linear.renewed(noise);
            let Some(stretch) = linear.stretches.first() else {
                break;
            };
            let model = linear.deviations(stretch, &noise);
            // Far from the usual intensity the likelihood rises by more than the scores promise there.
            let promised = 0.5 * self.cost(PARAMETERS);
            let best = with_dimension!(model.dimension(), N => {
                let Scores { list, parted, .. } = scores::<N>(&model, noise.sigma);
                let trial = Trial { linear: &linear, stretch, noise, parted };
                trial.likeliest(furthest(&list, promised))
            });
            let left = passes - intensities.len() as f64;
            let rises = |guess: &Guess| {
                let rise = guess.likelihood - noise.likelihood - self.cost(PARAMETERS);
                rise > 0.0 && noise.likelihood + rise * left.max(1.0) > least
            };
            let Some(best) = best.filter(rises) else {
                break;
            };
            let Range { start, end } = best.steps;
            let [from, to] = [start, end].map(|node| self.grid.times[node]);
            let factor = best.factor();
            intensities.push(Span { from, to, factor });
            linear.stretches = vec![best.taken(stretch)].into();
        }
        intensities
    }

    /// Returns the likeliest smoothed motion, of noise that is `suspected` to be correlated or not; stretches are added while
    /// the likelihood gains.
    pub fn likeliest_with_intensities(
        &mut self,
        kinematic: &Smoothed,
        first: &Smoothed,
        suspected: bool,
    ) -> Smoothed {
        let mut best = self.likeliest(kinematic, first, suspected);
        if self.judges_again(&best) {
            let plain = self.likeliest_plain(&best);
            let first = plain.as_ref().unwrap_or(first);
            best = self.likeliest(kinematic, first, suspected);
        }
        // Computed samples, noise below that of instruments and long records represented by stretches have no intensities: what
        // interpolates computed samples smoothly errs least.
        while best.noise.sigma > self.record.instrument_noise()
            && self.sampled() == self.all()
            && !self.is_computed()
        {
            let sites = self.sites();
            let Some(plain) = self.likeliest_plain(&best) else {
                break;
            };
            let least = match best.prior.cycle {
                0 => f64::NEG_INFINITY,
                _ => best.noise.likelihood,
            };
            let before = std::mem::take(&mut self.intensities);
            self.intensities = self.intensities_of(&plain, least);
            if !self.intensities.is_empty() {
                let more = self.intensities.len() as f64 - before.len() as f64;
                let next = self.likeliest(kinematic, &plain, suspected);
                let rise =
                    next.noise.likelihood - best.noise.likelihood - more * self.cost(PARAMETERS);
                if rise > ENOUGH_RISE {
                    best = next;
                    continue;
                }
            }
            self.intensities = before;
            (self.record.values, self.record.weights) = sites;
            break;
        }
        best
    }

    /// Weighs the samples by a motion through the equation, which follows fewer of them than one without mechanics; true if
    /// that changes weights.
    fn judges_again(&mut self, best: &Smoothed) -> bool {
        if self.record.codes.is_some() || self.sampled() != self.all() {
            return false;
        }
        let judged = outliers::judge(self, best);
        let judged = judged.filter(|judged| judged.few);
        judged.is_some_and(|judged| self.weigh(judged.weights, best))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::kalman::{self, Evidence};
    use crate::inverse::model::linearised::Linearised;
    use crate::inverse::model::prior::TORQUE;
    use crate::inverse::model::state_space::Observed;
    use crate::inverse::model::transition::transition;

    /// Returns a model of a stretch of samples.
    fn model(stretch: &Stretch) -> Deviations<'_> {
        Deviations {
            stretch,
            prior: TORQUE,
            noise: 3.0,
            speed_noise: 0.0,
            law_noise: 0.0,
            correlated: None,
            spread: [10.0; 7],
        }
    }

    /// The slope is that of the likelihood, by differences whose error is 1e-6 of it.
    #[test]
    fn scores_are_the_slopes_of_the_likelihood() {
        let step = Linearised {
            h: 0.3,
            top: transition(0.3, [-2.0, 0.7, 1.7], [0.0; 3]),
            lever: 1.7,
            ..Linearised::default()
        };
        let sample = |k: usize| Observed {
            residual: (3.0 * (k * k) as f64).sin() + 0.02 * (k * k) as f64,
            slope: 1.0,
            variance: 1.0,
            ..Observed::default()
        };
        let mut stretch = Stretch {
            steps: vec![step; 20].into(),
            intensities: vec![1.0; 20],
            observed: Vec::from_iter((0..21).map(sample)).into(),
            ..Stretch::default()
        };
        let found = scores::<3>(&model(&stretch), 1.0).list;
        for k in [0, 7, 19] {
            let mut at = |log: f64| {
                stretch.intensities[k] = log.exp();
                let mut evidence = Evidence::default();
                kalman::run::<3>(&model(&stretch), None, |_, at| evidence.add(at));
                stretch.intensities[k] = 1.0;
                -0.5 * (evidence.squares + evidence.log_variances)
            };
            let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
            let off = (found[k].slope - slope).abs();
            assert!(off < 1e-5 * slope.abs().max(0.01), "{k}: {slope}");
        }
    }
}
