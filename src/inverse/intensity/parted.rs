//! Likelihood of a stretch in which some steps change: of the samples before them it stays, of those after them it follows from
//! the distribution of the state to which they lead (two-filter formula; Fraser and Potter 1969).

use std::ops::Range;

use super::super::model::fixed_interval::Later;
use super::super::model::kalman::{Evidence, Filtered, Gaussian};
use super::super::model::matrix::{dot, informed, sum, times};
use super::super::model::state_space::Deviations;

/// A stretch, parted before the sample of each node.
#[derive(Clone, Debug, Default)]
pub(in crate::inverse) struct Parted<const N: usize> {
    pub nodes: Vec<Part<N>>,
    /// Likelihood terms of all samples.
    all: Evidence,
}

/// A node with what the samples before its own and those from its own on tell.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Part<const N: usize> {
    /// The state by the samples before.
    predicted: Gaussian<N>,
    /// Likelihood terms of the samples before.
    before: Evidence,
    pub later: Later<N>,
}

impl<const N: usize> Parted<N> {
    /// Adds the next node of the filter.
    pub fn take(&mut self, at: &Filtered<'_, N>) {
        self.nodes.push(Part {
            predicted: *at.predicted,
            before: self.all,
            later: Later::NONE,
        });
        self.all.add(at);
    }

    /// Returns the likelihood terms of all samples by a model in which these steps are others.
    pub fn with_other_steps(&self, model: &Deviations<'_>, steps: &Range<usize>) -> Evidence {
        let (begin, end) = (&self.nodes[steps.start], &self.nodes[steps.end]);
        let (mut now, mut evidence) = (begin.predicted, begin.before);
        for node in steps.clone() {
            if let Some(sample) = model.sample(node) {
                evidence.take(&now.update(&sample));
            }
            now = now.predicted(&model.step(node));
        }
        let [squares, log_variances] = end.change(&now);
        evidence += Evidence {
            squares: self.all.squares - end.before.squares + squares,
            log_variances: self.all.log_variances - end.before.log_variances + log_variances,
            samples: self.all.samples - end.before.samples,
        };
        evidence
    }
}

impl<const N: usize> Part<N> {
    /// Returns the changes of Σ v²/S and Σ ln S of the samples from the node on, if its state by the samples before is another.
    ///
    /// As a function of the state x these samples have ln of the likelihood −½ xᵀ Y x + yᵀ x. With N(m, P) of the state, and the
    /// slope z = y − Y m at the mean, Σ v²/S is mᵀ Y m − 2 yᵀ m − zᵀ (P⁻¹ + Y)⁻¹ z, and Σ ln S is ln |I + P Y|, but for constants.
    fn change(&self, other: &Gaussian<N>) -> [f64; 2] {
        let Later {
            correction,
            information,
        } = &self.later;
        let smoothed = times(&self.predicted.covariance, correction);
        let slope = sum(*correction, times(information, &smoothed));
        let moved: [f64; N] = std::array::from_fn(|k| other.mean[k] - self.predicted.mean[k]);
        let told = times(information, &moved);
        let next: [f64; N] = std::array::from_fn(|k| slope[k] - told[k]);
        let [before, after] =
            [&self.predicted, other].map(|at| informed(&at.covariance, information));
        let ratio = after.root_determinant / before.root_determinant;
        [
            dot(&moved, &told) - 2.0 * dot(&slope, &moved) + dot(&slope, &smoothed)
                - dot(&next, &times(&after.covariance, &next)),
            2.0 * ratio.abs().ln(),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::intensity::intensities::{Scores, scores};
    use crate::inverse::model::kalman::run;
    use crate::inverse::model::linearised::Linearised;
    use crate::inverse::model::prior::{FOLLOWING, TORQUE};
    use crate::inverse::model::state_space::{Observed, Stretch, with_dimension};
    use crate::inverse::model::transition::transition;

    /// Compares with a run of the filter along the whole stretch, by a model whose stretch is replaced.
    fn agrees<const N: usize>(model: Deviations<'_>, within: f64) {
        let step = Linearised {
            h: 0.02,
            tilt: [90.0, 0.0],
            lever: 40.0,
            top: transition(0.02, [20.0, -3.0, 40.0], [0.0; 3]),
            ..Linearised::default()
        };
        let sample = |k: usize| Observed {
            residual: (0.3 * k as f64).sin() + (1.7 * (k * k) as f64).sin(),
            slope: 1.0,
            variance: if k % 7 == 4 { f64::INFINITY } else { 1.0 },
            ..Observed::default()
        };
        let usual = Stretch {
            steps: vec![step; 300].into(),
            intensities: vec![1.0; 300],
            observed: Vec::from_iter((0..301).map(sample)).into(),
            ..Stretch::default()
        };
        let along = Deviations {
            stretch: &usual,
            ..model.clone()
        };
        let Scores { parted, .. } = scores::<N>(&along, 1.0);
        for (steps, factor) in [
            (0..1, 1e6),
            (299..300, 1e-3),
            (3..40, 50.0),
            (0..300, 0.1),
            (100..230, 1e-9),
        ] {
            let mut other = usual.clone();
            other.intensities[steps.clone()].fill(factor);
            let model = Deviations {
                stretch: &other,
                ..model.clone()
            };
            let found = parted.with_other_steps(&model, &steps);
            let mut expected = Evidence::default();
            run::<N>(&model, None, |_, at| expected.add(at));
            let off = (found.squares - expected.squares).abs() / expected.squares;
            let logs = (found.log_variances - expected.log_variances).abs();
            assert!(
                off.max(logs) < within,
                "{steps:?} {factor}: {off:e} {logs:e}"
            );
            assert_eq!(found.samples, expected.samples);
        }
    }

    #[test]
    fn other_steps_leave_the_likelihood_of_the_whole_filter() {
        for (prior, correlated) in [
            (TORQUE, None),
            (TORQUE, Some(30.0)),
            (FOLLOWING, None),
            (FOLLOWING, Some(30.0)),
        ] {
            // A start as wide as 2e7 σ leaves more rounding than one of 20 σ.
            for (width, within) in [(1e-6, 1e-10), (1.0, 1e-4)] {
                let model = Deviations {
                    stretch: &Stretch::default(),
                    prior,
                    noise: 0.3,
                    speed_noise: 0.0,
                    law_noise: 0.0,
                    correlated,
                    spread: [1e3, 1e6, 2e7, 2e6, 0.0, 0.0, 0.0].map(|spread| width * spread),
                };
                with_dimension!(model.dimension(), N => agrees::<N>(model, within));
            }
        }
    }
}
