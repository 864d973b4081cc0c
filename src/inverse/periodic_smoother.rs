//! Smoothed motion about stretches of a path that share a torque that repeats.

use std::ops::Range;

use super::estimate::Estimate;
use super::grid::Path;
use super::likelihood::Linear;
use super::linearised::Motion;
use super::matrix::{Matrix, sum};
use super::periodic::{Derivatives, Regressed};
use super::problem::Problem;
use super::regression::Regression;
use super::repeating::Repeating;
use super::scales::Noise;
use super::state_space::Stretch;
use super::{fixed_interval, kalman};
use crate::numeric::parallel;

impl Problem<'_> {
    /// Returns the smoothed motion about all stretches of a path, and leaves the torque that repeats in the path.
    pub fn smoothed_together<const N: usize>(
        &self,
        motion: &Motion<'_>,
        path: &mut Path,
        linear: &Linear<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let of = |stretch: &Stretch| {
            let model = linear.deviations(stretch, noise);
            let mut to = Regression::new(motion.prior);
            let mut derivatives = Derivatives::new(&model, N);
            let mut regressed = Regressed::<N>::new(&model, &mut to, Some(&mut derivatives));
            let (deviations, innovations) = fixed_interval::smooth(&model, &mut regressed);
            to.multiply();
            ((deviations, innovations, derivatives), to)
        };
        let (stretches, equations): (Vec<_>, Vec<_>) = parallel::map(linear.stretches.iter(), of)
            .into_iter()
            .unzip();
        let to = Regression::of_all(motion.prior, equations);
        let posterior = noise.spectrum.and_then(|spectrum| to.solved(spectrum));
        // Factor A of the covariance Aᵀ A of the coefficients.
        let found = posterior.map(|found| (found.factor(), found));
        let estimated = |(range, (mut deviations, mut innovations, derivatives)): (
            &Range<usize>,
            (Vec<_>, Vec<_>, Derivatives),
        )| {
            let mut covariance = [[0.0; 3]; 3];
            if let Some((factor, found)) = &found {
                add(&mut covariance, &deviations, -1.0);
                let coefficients = &found.coefficients;
                derivatives.add(coefficients, factor, &mut deviations, &mut innovations);
                add(&mut covariance, &deviations, 1.0);
            }
            let first = range.start;
            let estimates = self.estimated(motion, path, first, &deviations, &innovations, noise);
            (estimates, covariance)
        };
        let both = |a: Matrix<3>, b: Matrix<3>| std::array::from_fn(|i| sum(a[i], b[i]));
        let pairs = path.ranges.iter().zip(stretches);
        let (estimates, covariances): (Vec<_>, Vec<_>) =
            parallel::map(pairs, estimated).into_iter().unzip();
        let covariance = covariances.into_iter().reduce(both).unwrap_or_default();
        let mean = noise.sigma * noise.sigma / path.states.len() as f64;
        path.repeating = found.map(|(factor, found)| {
            let told = found.told(&factor, motion.prior);
            let covariance = covariance.map(|row| row.map(|value| mean * value));
            Repeating::new(
                motion.prior,
                found.coefficients,
                path.speed(),
                told,
                covariance,
            )
        });
        estimates.concat()
    }
}

/// Adds a multiple of the covariances of θ, ω and u.
fn add<const N: usize>(to: &mut Matrix<3>, states: &[kalman::Gaussian<N>], factor: f64) {
    for state in states {
        for (row, values) in to.iter_mut().zip(&state.covariance) {
            let pairs = row.iter_mut().zip(values);
            pairs.for_each(|(to, value)| *to += factor * value);
        }
    }
}
