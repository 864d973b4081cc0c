//! Smoothed motion about stretches of a path that share a torque that repeats.

use super::estimate::Estimate;
use super::grid::Path;
use super::likelihood::Linear;
use super::linearised::Motion;
use super::matrix::Matrix;
use super::periodic::{Derivatives, Regressed};
use super::problem::Problem;
use super::regression::Regression;
use super::repeating::Repeating;
use super::scales::Noise;
use super::{fixed_interval, kalman};

impl Problem<'_> {
    /// Returns the smoothed motion about all stretches of a path, and leaves the torque that repeats in the path.
    pub fn smoothed_together<const N: usize>(
        &self,
        motion: &Motion<'_>,
        path: &mut Path,
        linear: &Linear<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let mut to = Regression::new(motion.prior);
        let stretches = path.ranges.iter().map(|range| {
            let stretch = self.stretch(motion, path, range.clone(), noise.sigma);
            let model = linear.deviations(&stretch, noise);
            let mut derivatives = Derivatives::new(&model, N);
            let mut regressed = Regressed::<N>::new(&model, &mut to, Some(&mut derivatives));
            let (deviations, innovations) = fixed_interval::smooth(&model, &mut regressed);
            (deviations, innovations, derivatives)
        });
        let stretches: Vec<_> = stretches.collect();
        to.multiply();
        let posterior = noise.spectrum.and_then(|spectrum| to.solved(spectrum));
        // Factor A of the covariance Aᵀ A of the coefficients.
        let found = posterior.map(|found| (found.factor(), found));
        let mut covariance = [[0.0; 3]; 3];
        let mut estimates = Vec::with_capacity(path.states.len());
        for (range, (mut deviations, mut innovations, derivatives)) in
            path.ranges.iter().zip(stretches)
        {
            if let Some((factor, found)) = &found {
                add(&mut covariance, &deviations, -1.0);
                let coefficients = &found.coefficients;
                derivatives.add(coefficients, factor, &mut deviations, &mut innovations);
                add(&mut covariance, &deviations, 1.0);
            }
            let first = range.start;
            estimates.extend(self.estimated(motion, path, first, &deviations, &innovations, noise));
        }
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
        estimates
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
