//! Errors of the motion by those of its tones. With a coefficient of a tone the smoothed motion changes, too: it follows what the
//! tone does not explain.

use nalgebra::{Matrix3xX, Vector3};

use super::super::model::fixed_interval;
use super::super::model::state_space::with_dimension;
use super::super::model::tone::Carrier;
use super::super::problem::Problem;
use super::super::scales::root_mean_square;
use super::super::smoother::Smoothed;
use super::sinusoid::Beside;
use crate::numeric::parallel;

impl Problem<'_> {
    /// Returns the size of the torque that accelerates the crank along a smoothed motion, N m: the root mean square of M θ̈.
    pub fn accelerating_torque(&self, smoothed: &Smoothed) -> f64 {
        root_mean_square(smoothed.estimates.iter().map(|one| {
            let terms = self.equation.terms(one.state[0]);
            terms.m * one.alpha
        }))
    }

    /// Returns a smoothed motion with the errors of the tones in its covariance.
    pub fn with_errors_of_tones(&self, mut smoothed: Smoothed) -> Smoothed {
        let tones = &self.record.tones;
        if tones.is_empty() {
            return smoothed;
        }
        let known = self.beside_known(&smoothed);
        let Beside {
            path,
            linear,
            noise,
            ..
        } = &known;
        let Some(found) = linear.normal_equations(noise).tones(&[]) else {
            return smoothed;
        };
        let covariance = found.information.inverse() * noise.sigma.powi(2);
        let motion = self.motion(linear.prior);
        let waves = tones.iter().flat_map(|tone| (0..3).map(move |k| (tone, k)));
        let changes = parallel::map(waves, |(tone, k)| {
            known.smoothed(tone.carrier, |t| tone.slopes(t)[k])
        });
        for (node, estimate) in smoothed.estimates.iter_mut().enumerate() {
            let (t, state) = (self.grid.times[node], &path.states[node]);
            let rates = motion.rates_following(path.repeating.as_ref(), t, state);
            // u has the torque of the tones in it.
            let by_state = Vector3::new(rates.by_theta, rates.by_omega, rates.by_unknown);
            let columns = changes.iter().map(|change| {
                let change = &change[node];
                Vector3::new(change.x, change.y, by_state.dot(change))
            });
            let change = Matrix3xX::from_columns(&Vec::from_iter(columns));
            let more = &change * &covariance * change.transpose();
            let entries = (0..3).flat_map(|row| (0..=row).map(move |column| (row, column)));
            for (value, entry) in estimate.covariance.iter_mut().zip(entries) {
                *value += more[entry];
            }
        }
        smoothed
    }
}

impl Beside<'_> {
    /// The smoothed deviations of θ, ω and u that a wave of a carrier alone makes at the nodes.
    fn smoothed(&self, carrier: Carrier, wave: impl Fn(f64) -> f64) -> Vec<Vector3<f64>> {
        let stretch = self.with(carrier, 0.0, wave);
        let model = self.linear.deviations(&stretch, &self.noise);
        with_dimension!(model.dimension(), N => {
            let (path, _) = fixed_interval::smooth::<N>(&model, &mut ());
            let first = path.iter().map(|state| Vector3::from_column_slice(&state.mean[..3]));
            first.collect()
        })
    }
}
