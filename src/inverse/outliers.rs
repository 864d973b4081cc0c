//! Weights against outliers: noise as a mixture of two normal distributions, the wider one with few samples (variance
//! inflation; Box and Tiao, Biometrika 55 (1968) 119). A weight is the probability of the narrow one.

use super::estimate::Estimate;
use super::model::prior::KINEMATIC;
use super::problem::Problem;
use super::residual_tests::{FAR, NORMAL, deviate};
use super::smoother::Smoothed;
use crate::numeric::median::median;

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

/// Errors of the predictions of samples, each by all others.
struct Errors {
    /// Over their standard deviations; 0 for what is not judged, or within a step of its code.
    standardised: Vec<f64>,
    /// Their standard deviation, by the median.
    scale: f64,
}

/// Returns the errors of samples from a smoothed motion, less what is `allowed` of a sample and its motion, rad or m; none if
/// none is judged.
fn errors(
    problem: &Problem<'_>,
    smoothed: &Smoothed,
    allowed: impl Fn(usize, &Estimate) -> f64,
) -> Option<Errors> {
    let record = problem.single();
    let sigma = smoothed.noise.sigma;
    let full = record.full_weights();
    let mut within = vec![0.0; record.times.len()];
    let mut standardised: Vec<f64> = (0..record.times.len())
        .map(|i| {
            let estimate = problem.at(smoothed, record.times[i]);
            let (residual, shown) = record.sensor.residual(record.values[i], estimate.turning());
            // Part of the error of a weighted sample is in the path.
            let variance = record.sensor.variance(&shown, &estimate.covariance) / (sigma * sigma);
            let leverage = record.weights[i] * variance;
            // The path between samples follows one of large leverage, right or wrong; at an end the prior predicts it.
            let is_end = i == 0 || i + 1 == record.times.len();
            if leverage > TIED && !is_end || full[i] == 0.0 {
                return 0.0;
            }
            within[i] = allowed(i, &estimate) / sigma;
            // Residual from the prediction by all other samples.
            let left = 1.0 - leverage;
            residual / (sigma * left * (1.0 + variance / left).sqrt())
        })
        .collect();
    let counting = standardised.iter().zip(&record.weights);
    let told = counting.filter(|(r, weight)| **r != 0.0 && **weight > 0.0);
    let scale = NORMAL * median(told.map(|(r, _)| r.abs()))?;
    let scale = scale.max(record.floor / sigma);
    for (r, within) in standardised.iter_mut().zip(within) {
        *r -= r.clamp(-within, within);
    }
    Some(Errors {
        standardised,
        scale,
    })
}

/// Judges the samples by a smoothed motion; none if all weights are and stay 1.
pub(super) fn judge(problem: &Problem<'_>, smoothed: &Smoothed) -> Option<Judgement> {
    let record = problem.single();
    // A value within a step of its code is not off.
    let found = errors(problem, smoothed, |_, _| record.step)?;
    let (standardised, scale) = (found.standardised, found.scale);
    let full = record.full_weights();
    let told = standardised
        .iter()
        .zip(&full)
        .filter(|(_, full)| **full > 0.0);
    let mut sizes: Vec<f64> = told.map(|(r, _)| r.abs()).collect();
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
    let part = count / sizes.len() as f64;
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
    // Samples of a sensor that holds are one.
    let all = Vec::from_iter(0..weights.len());
    let is_held = |_: &usize, i: &usize| record.intervals.is_empty() && record.repeated[*i];
    for run in all.chunk_by(is_held) {
        if run.len() > 1 && run.iter().any(|i| weights[*i] < 0.5) {
            run.iter().for_each(|i| weights[*i] = 0.0);
        }
    }
    let pairs = weights.iter_mut().zip(full);
    pairs.for_each(|(weight, full)| *weight *= full);
    Some(Judgement { weights, few })
}

impl Problem<'_> {
    /// Finds out whether the sensor holds its positions, or repeats them at rest. Where it holds them, the second and the last of
    /// equal ones are off from the motion through the others: by more than two steps of the values, for both may be off by one, and
    /// by more than the motion leaves rest in the time to the value beside them. Repeated ones then do not count.
    pub fn finds_held(&mut self, first: &Smoothed) -> bool {
        let record = self.single();
        if record.sensor.is_of_speed() {
            return record.holds;
        }
        let count = record.values.len();
        let told = (0..count).filter(|i| !record.repeated[*i]).count();
        // Fewer samples than states leave no errors.
        if told == count || told <= KINEMATIC.states() || !record.intervals.is_empty() {
            return false;
        }
        self.set_held(true, first);
        let through = self.kinematic(first.path(), first.noise.sigma);
        self.single_mut().holds = false;
        let record = self.single();
        let last = count - 1;
        let is_second = |i: usize| i > 1 && !record.repeated[i - 1];
        let is_last = |i: usize| i < last && !record.repeated[i + 1];
        let is_judged = |i: &usize| record.repeated[*i] && (is_second(*i) || is_last(*i));
        let judged: Vec<usize> = (1..=last).filter(is_judged).collect();
        let from_rest = |i: usize, estimate: &Estimate| {
            let [before, own, after] =
                [i.saturating_sub(1), i, last.min(i + 1)].map(|i| record.times[i]);
            let beside = f64::max(own - before, after - own);
            let slope = record.sensor.shown(estimate.turning()).slope;
            2.0 * record.step + 0.5 * (slope * estimate.alpha).abs() * beside * beside
        };
        let holds = errors(self, &through, from_rest).is_some_and(|errors| {
            let size = |i: &usize| errors.standardised[*i] / errors.scale;
            let sizes = judged.iter().map(size);
            let squares: f64 = sizes.map(|size| size * size).sum();
            through.converged && deviate(squares, judged.len()) > FAR
        });
        self.set_held(holds, first);
        holds
    }

    /// Leaves out values that repeat the one before, or counts them.
    pub fn set_held(&mut self, holds: bool, about: &Smoothed) {
        self.single_mut().holds = holds;
        self.weigh(self.single().full_weights(), about);
    }

    /// Weighs the samples, and forms their means anew about a smoothed motion; true if that changes weights by 0.1.
    pub fn weigh(&mut self, weights: Vec<f64>, about: &Smoothed) -> bool {
        let weighed = self.single_mut();
        let mut pairs = weighed.weights.iter().zip(&weights);
        let is_alike = pairs.all(|(before, now)| (before - now).abs() < 0.1);
        weighed.weights = weights;
        if let Some(condensed) = &self.condensed {
            self.record = condensed.about(&about.course(&self.grid));
        }
        !is_alike
    }
}
