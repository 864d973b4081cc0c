//! Errors of the motion by those of its tones. With a coefficient of a tone the smoothed motion changes, too: it follows what the
//! tone does not explain.

use nalgebra::{Matrix3, Vector3};

use super::fixed_interval;
use super::problem::Problem;
use super::scales::{Noise, root_mean_square};
use super::sinusoid::Beside;
use super::smoother::Smoothed;
use super::state_space::with_dimension;
use super::tone_search::BesideKnown;
use crate::numeric::parallel;

impl Problem<'_> {
    /// Returns the size of the torque that accelerates the crank along a smoothed motion, N m: the root mean square of M θ̈.
    pub fn accelerating_torque(&self, smoothed: &Smoothed) -> f64 {
        root_mean_square(smoothed.estimates.iter().map(|one| {
            let terms = self.equation.terms(one.state[0]);
            terms.inertia.m * one.alpha
        }))
    }

    /// Returns a smoothed motion with the errors of the tones in its covariance.
    pub fn with_errors_of_tones(&self, mut smoothed: Smoothed) -> Smoothed {
        let tones = &self.record.tones;
        if tones.is_empty() {
            return smoothed;
        }
        let BesideKnown {
            linear,
            noise,
            path,
        } = self.beside_known(&smoothed);
        let motion = self.motion(linear.prior);
        for tone in tones {
            let Some(beside) = self.beside(&linear, tone.carrier) else {
                continue;
            };
            let changes = parallel::map(0..3, |k| beside.smoothed(&noise, |t| tone.slopes(t)[k]));
            for (node, estimate) in smoothed.estimates.iter_mut().enumerate() {
                let (t, state) = (self.grid.times[node], &path.states[node]);
                let rates = motion.rates_following(path.repeating.as_ref(), t, state);
                let by_state = Vector3::new(rates.by_theta, rates.by_omega, rates.by_unknown);
                let change = Matrix3::from_columns(&[0, 1, 2].map(|k| changes[k][node]));
                // u has the torque of the tone in it.
                let alpha = by_state.tr_mul(&change);
                let change = Matrix3::from_rows(&[
                    change.row(0).into_owned(),
                    change.row(1).into_owned(),
                    alpha,
                ]);
                let more = change * tone.covariance * change.transpose();
                let entries = (0..3).flat_map(|row| (0..=row).map(move |column| (row, column)));
                for (value, entry) in estimate.covariance.iter_mut().zip(entries) {
                    *value += more[entry];
                }
            }
        }
        smoothed
    }
}

impl Beside<'_> {
    /// The smoothed deviations of θ, ω and u that a wave alone makes at the nodes.
    fn smoothed(&self, noise: &Noise, wave: impl Fn(f64) -> f64) -> Vec<Vector3<f64>> {
        let stretch = self.with(0.0, wave);
        let model = self.linear.deviations(&stretch, noise);
        with_dimension!(model.dimension(), N => {
            let (path, _) = fixed_interval::smooth::<N>(&model, &mut ());
            let first = path.iter().map(|state| Vector3::from_column_slice(&state.mean[..3]));
            first.collect()
        })
    }
}
