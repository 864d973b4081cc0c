//! Linear smoother about a path, by the models of its stretches, which share a torque that repeats, or of pieces of a long record
//! side by side.

use std::ops::Range;

use super::candidates::Candidate;
use super::estimate::Estimate;
use super::grid::Path;
use super::likelihood::Linear;
use super::model::fixed_interval;
use super::model::kalman::Gaussian;
use super::model::matrix::{Matrix, sum};
use super::model::repeating::Repeating;
use super::model::state_space::{Stretch, with_dimension};
use super::problem::Problem;
use super::repeating::periodic::{Derivatives, Regressed};
use super::repeating::regression::Regression;
use super::scales::Noise;
use crate::numeric::parallel;

/// Nodes that one thread smooths at a time, at least, beside those at both ends that are shared with its neighbours.
pub(super) const NODES_OF_A_THREAD: usize = 8192;

/// Time constants of the smoother after which nothing is left of what was before.
const MEMORY_TIME_CONSTANTS: f64 = 60.0;

impl Problem<'_> {
    /// Returns the smoothed motion about a path.
    pub fn smoothed(&self, path: &mut Path, of: &Candidate) -> Vec<Estimate> {
        if path.ranges != self.sampled() {
            return self.smoothed_in_pieces(path, of);
        }
        let linear = self.linear(of.prior, of.scales, path, of.noise.sigma);
        self.smoothed_along(path, &linear, &of.noise)
    }

    /// Returns the smoothed motion about a path, by its linear model if it is one along the sampled stretches. What repeats is
    /// found there, and left in the path; along all nodes of a longer record it is known.
    pub fn smoothed_along(&self, path: &mut Path, linear: &Linear, noise: &Noise) -> Vec<Estimate> {
        if self.is_stopped() {
            return vec![Estimate::default(); path.states.len()];
        }
        if path.ranges != self.sampled() {
            return self.smoothed_in_pieces(path, &linear.with(*noise));
        }
        let states = linear.prior.states() + usize::from(noise.correlated.is_some());
        with_dimension!(states, N => self.smoothed_together::<N>(path, linear, noise))
    }

    /// Returns the smoothed motion about all stretches of a path, and leaves a torque that repeats in the path.
    fn smoothed_together<const N: usize>(
        &self,
        path: &mut Path,
        linear: &Linear,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let prior = linear.prior;
        let of = |stretch: &Stretch| {
            let model = linear.deviations(stretch, noise);
            let mut regressed = Regressed::<N>::new(&model, true);
            let (deviations, innovations) = fixed_interval::smooth(&model, &mut regressed);
            let (equations, derivatives) = regressed.into_parts();
            ((deviations, innovations, derivatives), equations)
        };
        let (stretches, equations): (Vec<_>, Vec<_>) = parallel::map(linear.stretches.iter(), of)
            .into_iter()
            .unzip();
        let to = Regression::of_all(prior, equations);
        let spectrum = noise.spectrum.filter(|_| prior.cycle > 0);
        let over = linear.over_spectra.as_ref();
        let posterior = match over {
            Some(over) => to.solved_with(over.told.clone()),
            None => spectrum.and_then(|spectrum| to.solved(spectrum, &linear.rest(&to.evidence))),
        };
        let with_hidden = over.and_then(|over| to.solved_with(over.all.clone()));
        // Factor A of the covariance Aᵀ A of the coefficients.
        let found = posterior.map(|found| (with_hidden.as_ref().unwrap_or(&found).factor(), found));
        let estimated = |(range, (mut deviations, mut innovations, derivatives)): (
            &Range<usize>,
            (Vec<_>, Vec<_>, Option<Derivatives>),
        )| {
            let mut covariance = [[0.0; 3]; 3];
            if let (Some((factor, found)), Some(derivatives)) = (&found, derivatives) {
                add(&mut covariance, &deviations, -1.0);
                let coefficients = &found.coefficients;
                derivatives.add(coefficients, factor, &mut deviations, &mut innovations);
                add(&mut covariance, &deviations, 1.0);
            }
            let first = range.start;
            let estimates = self.estimated(prior, path, first, &deviations, &innovations, noise);
            (estimates, covariance)
        };
        let both = |a: Matrix<3>, b: Matrix<3>| std::array::from_fn(|i| sum(a[i], b[i]));
        let pairs = path.ranges.iter().zip(stretches);
        let (estimates, covariances): (Vec<_>, Vec<_>) =
            parallel::map(pairs, estimated).into_iter().unzip();
        if prior.cycle > 0 {
            let covariance = covariances.into_iter().reduce(both).unwrap_or_default();
            let mean = noise.sigma * noise.sigma / path.states.len() as f64;
            path.repeating = found.map(|(factor, found)| {
                let told = found.told(&factor, prior);
                let covariance = covariance.map(|row| row.map(|value| mean * value));
                Repeating::new(prior, found.coefficients, path.speed(), told, covariance)
            });
        }
        estimates.concat()
    }

    /// Returns the smoothed motion about a path along all nodes, computed in pieces side by side.
    fn smoothed_in_pieces(&self, path: &Path, of: &Candidate) -> Vec<Estimate> {
        let (prior, noise) = (of.prior.beside_known(), &of.noise);
        let linear = Linear::of(prior, of.scales);
        let (times, nodes) = (&self.grid.times, self.grid.len());
        let shared = MEMORY_TIME_CONSTANTS / noise.corner;
        let density = nodes as f64 / of.scales.duration;
        let length = NODES_OF_A_THREAD.max((4.0 * shared * density).min(nodes as f64) as usize);
        let mut found = vec![Estimate::default(); nodes];
        let pieces = (0..nodes).step_by(length).zip(found.chunks_mut(length));
        parallel::map(pieces, |(first, piece)| {
            if self.is_stopped() {
                return;
            }
            let last = first + piece.len() - 1;
            let from = times.partition_point(|t| *t < times[first] - shared);
            let to = times.partition_point(|t| *t <= times[last] + shared);
            let stretch = Stretch {
                // The whole record tells them, a piece beside it little.
                constants: [0.0; 2],
                ..self.stretch(prior, path, from..to, noise.sigma)
            };
            let model = linear.deviations(&stretch, noise);
            let all = with_dimension!(model.dimension(), N => {
                let (deviations, innovations) = fixed_interval::smooth::<N>(&model, &mut ());
                self.estimated(prior, path, from, &deviations, &innovations, noise)
            });
            piece.copy_from_slice(&all[first - from..=last - from]);
        });
        found
    }
}

/// Adds a multiple of the covariances of θ, ω and u.
fn add<const N: usize>(to: &mut Matrix<3>, states: &[Gaussian<N>], factor: f64) {
    for state in states {
        for (row, values) in to.iter_mut().zip(&state.covariance) {
            let pairs = row.iter_mut().zip(values);
            pairs.for_each(|(to, value)| *to += factor * value);
        }
    }
}
