//! Weights against outliers: noise as a mixture of two normal distributions, the wider one with few samples (variance
//! inflation; Box and Tiao, Biometrika 55 (1968) 119). A weight is the probability of the narrow one.

use std::ops::Range;

use super::problem::Problem;
use super::residual_tests::NORMAL;
use super::smoother::Smoothed;
use crate::numeric::median::median;

/// Residual, in standard deviations, above which a sample is examined: one in 10⁸ of noise.
const FAR: f64 = 5.7;

/// Leverage on the path above which a sample between others is not judged.
const TIED: f64 = 0.5;

/// Fraction of the samples above which far ones are no outliers.
const MOST_OUTLIERS: f64 = 0.1;

/// Weight below which a sample is left out.
const LEAST_WEIGHT: f64 = 1e-6;

/// Weights of the samples by a smoothed motion.
pub(super) struct Judgement {
    pub weights: Vec<f64>,
    /// True if the far samples are few enough for outliers. Outliers that pull the motion to themselves put many samples
    /// far from it: the farthest are then left out, for the next motion to judge the others.
    pub few: bool,
}

/// Judges the samples, quantised in `step`, rad, by a smoothed motion; none if all weights are and stay 1.
pub(super) fn judge(problem: &Problem<'_>, smoothed: &Smoothed, step: f64) -> Option<Judgement> {
    let record = problem.single();
    let sigma = smoothed.noise.sigma;
    let mut standardised: Vec<f64> = (0..record.times.len())
        .map(|i| {
            let estimate = problem.at(smoothed, record.times[i]);
            let (residual, shown) = record.sensor.residual(record.values[i], estimate.turning());
            // Part of the error of a weighted sample is in the path.
            let variance = record.sensor.variance(&shown, &estimate.covariance) / (sigma * sigma);
            let leverage = record.weights[i] * variance;
            // The path between samples follows one of large leverage, right or wrong; at an end the prior predicts it.
            let is_end = i == 0 || i + 1 == record.times.len();
            if leverage > TIED && !is_end {
                return 0.0;
            }
            // Residual from the prediction by all other samples.
            let left = 1.0 - leverage;
            residual / (sigma * left * (1.0 + variance / left).sqrt())
        })
        .collect();
    let told = standardised.iter().filter(|r| **r != 0.0);
    let scale = NORMAL * median(told.map(|r| r.abs()))?;
    let scale = scale.max(record.floor / sigma);
    // An angle within a step of its code is not off.
    for r in &mut standardised {
        *r -= r.clamp(-step / sigma, step / sigma);
    }
    // Samples of a sensor that holds are one.
    let is_held = |i: &usize| record.intervals.is_empty() && record.repeats(*i);
    let single = (0..standardised.len()).filter(|i| !is_held(i));
    let mut sizes: Vec<f64> = single.map(|i| standardised[i].abs()).collect();
    let most = (MOST_OUTLIERS * sizes.len() as f64) as usize;
    let (_, next, _) = sizes.select_nth_unstable_by(most, |a, b| b.total_cmp(a));
    let few = *next <= FAR * scale;
    let limit = next.max(FAR * scale);
    let far = || standardised.iter().filter(|r| r.abs() > limit);
    let count = far().count() as f64;
    if count == 0.0 {
        let weighted = record.weights.iter().any(|w| *w < 1.0);
        return weighted.then(|| Judgement {
            weights: record.weights.clone(),
            few,
        });
    }
    let part = count / standardised.len() as f64;
    let wide = far().map(|r| r * r).sum::<f64>() / count / (scale * scale);
    let weight = |r: &f64| {
        if !few && r.abs() <= limit {
            return 1.0;
        }
        let square = (r / scale).powi(2);
        let odds = part / (1.0 - part) / wide.sqrt() * (0.5 * square * (1.0 - 1.0 / wide)).exp();
        let weight = 1.0 / (1.0 + odds);
        if weight < LEAST_WEIGHT { 0.0 } else { weight }
    };
    let mut weights: Vec<f64> = standardised.iter().map(weight).collect();
    for run in runs(weights.len(), is_held) {
        if run.len() > 1 && weights[run.clone()].iter().any(|weight| *weight < 0.5) {
            weights[run].fill(0.0);
        }
    }
    Some(Judgement { weights, few })
}

/// Returns the runs of a number of samples, each with those after its first one that are held.
fn runs(count: usize, is_held: impl Fn(&usize) -> bool) -> Vec<Range<usize>> {
    let mut first: Vec<usize> = (0..count).filter(|i| !is_held(i)).collect();
    first.push(count);
    first.windows(2).map(|w| w[0]..w[1]).collect()
}

impl Problem<'_> {
    /// Weighs the samples, and forms their means anew about a smoothed motion; true if that changes weights.
    pub fn weigh(&mut self, weights: Vec<f64>, about: &Smoothed) -> bool {
        let weighed = match &mut self.condensed {
            None => &mut self.record,
            Some(condensed) => &mut condensed.record,
        };
        let is_alike = alike(&weighed.weights, &weights);
        weighed.weights = weights;
        if let Some(condensed) = &self.condensed {
            self.record = condensed.about(&about.course(&self.grid));
        }
        !is_alike
    }
}

/// True if two lists of weights differ by less than 0.1.
fn alike(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() < 0.1)
}
