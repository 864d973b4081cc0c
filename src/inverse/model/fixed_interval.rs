//! Fixed-interval smoother: the distribution of the state at each node by all samples, in units of the variance σ² of a
//! sample.
//!
//! On the way back, the correction by the later samples (Bryson and Frazier; Särkkä and Svensson, 2nd ed. 2023, chapter 12)
//! and their information (Fraser and Potter, IEEE Trans. Autom. Control 14 (1969) 387) follow recursions that are as stable
//! as the filter; to run the state itself back, by Φ⁻¹, lets rounding grow in a mechanism with losses.

// Sums over rows and columns, as the textbook writes them.
#![allow(clippy::needless_range_loop)]

use super::kalman::{Filtered, Gaussian, Innovation, Sample, Step, run};
use super::matrix::{Matrix, Vector, congruent, dot, informed, sum, times, transposed};
use super::state_space::Deviations;

/// What the samples from a node on tell of its state.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Later<const N: usize> {
    /// r: the smoothed mean is x̂ + P̂ r, where the filter predicts x̂ with P̂.
    pub correction: Vector<N>,
    /// Y: their information on the state, by themselves.
    pub information: Matrix<N>,
}

/// Observer of the smoother.
pub(in crate::inverse) trait Companion<const N: usize> {
    /// Called when the filter has taken the sample of a node.
    fn filtered(&mut self, _node: usize, _at: &Filtered<'_, N>) {}

    /// Called when the smoother returns to a node, with what the samples from it on tell and the distribution by all.
    fn returned(
        &mut self,
        node: usize,
        at: &Filtered<'_, N>,
        later: &Later<N>,
        smoothed: &Gaussian<N>,
    );
}

impl<const N: usize> Companion<N> for () {
    fn returned(&mut self, _: usize, _: &Filtered<'_, N>, _: &Later<N>, _: &Gaussian<N>) {}
}

impl<const N: usize> Gaussian<N> {
    /// Returns the distribution by all samples.
    #[inline(always)]
    fn with(&self, later: &Later<N>) -> Gaussian<N> {
        Gaussian {
            mean: sum(self.mean, times(&self.covariance, &later.correction)),
            covariance: informed(&self.covariance, &later.information).covariance,
        }
    }
}

impl<const N: usize> Later<N> {
    /// After the last sample.
    pub const NONE: Later<N> = Later {
        correction: [0.0; N],
        information: [[0.0; N]; N],
    };

    /// Adds the sample of the node.
    #[inline(always)]
    fn add(&mut self, sample: &Sample, found: &Innovation<N>) {
        let row: Vector<N> = sample.row();
        let change = found.error / found.variance - dot(&found.gain, &self.correction);
        let per = 1.0 / sample.variance;
        for i in 0..N {
            self.correction[i] += row[i] * change;
            for j in 0..N {
                self.information[i][j] += row[i] * row[j] * per;
            }
        }
    }

    /// Returns what they tell of the state before a step. Each column of a triangular factor of Q takes information as a
    /// sample takes variance.
    #[inline(always)]
    fn before(mut self, step: &Step<N>) -> Later<N> {
        let mut noise = step.noise;
        for k in 0..N {
            let column = noise[k];
            if column[k] <= 0.0 {
                continue;
            }
            let shared = times(&self.information, &column);
            let per = 1.0 / (column[k] + dot(&column, &shared));
            let part = 1.0 / column[k];
            for i in 0..N {
                for j in 0..N {
                    self.information[i][j] -= shared[i] * shared[j] * per;
                    noise[i][j] -= column[i] * column[j] * part;
                }
            }
        }
        let back = transposed(&step.transition);
        Later {
            correction: times(&back, &self.correction),
            information: congruent(&back, &self.information, &[[0.0; N]; N]),
        }
    }
}

/// Returns the distribution of the state at each node, given all samples, and the prediction errors over their standard
/// deviations (in units of σ), by node.
pub(in crate::inverse) fn smooth<const N: usize>(
    model: &Deviations<'_>,
    companion: &mut impl Companion<N>,
) -> (Vec<Gaussian<N>>, Vec<Option<f64>>) {
    let nodes = model.stretch.observed.len();
    let (mut path, mut innovations) = (Vec::with_capacity(nodes), Vec::with_capacity(nodes));
    run(model, None, |node, at| {
        path.push(*at.predicted);
        let found = at.sample.map(|(_, found)| found);
        innovations.push(found.map(|found| found.error / found.variance.sqrt()));
        companion.filtered(node, at);
    });
    let mut later = Later::NONE;
    for node in (0..nodes).rev() {
        let predicted = path[node];
        let sample = model.sample(node);
        let sample = sample.map(|sample| (sample, predicted.innovation(&sample)));
        if let Some((sample, found)) = &sample {
            later.add(sample, found);
        }
        path[node] = predicted.with(&later);
        let step = (node > 0).then(|| model.step(node - 1));
        let at = Filtered {
            step: step.as_ref(),
            predicted: &predicted,
            sample: sample.as_ref(),
        };
        companion.returned(node, &at, &later, &path[node]);
        if let Some(step) = &step {
            later = later.before(step);
        }
    }
    (path, innovations)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, Matrix3, RowVector3, Vector3};

    use super::*;
    use crate::inverse::model::linearised::Linearised;
    use crate::inverse::model::prior::{FOLLOWING, Prior, Unknown};
    use crate::inverse::model::state_space::{Observed, Stretch};
    use crate::inverse::model::transition::transition;

    const STEPS: usize = 800;

    /// Returns samples of a crank with losses under an unknown torque; `STEPS` are 80 of its time constants.
    fn stretch(steps: usize) -> Stretch {
        let step = Linearised {
            h: 0.1,
            top: transition(0.1, [0.0, -1.0, 1.7], [0.0; 3]),
            lever: 1.7,
            ..Linearised::default()
        };
        let observed = |k: usize| Observed {
            residual: (1.7 * k as f64).sin() + 0.01 * k as f64,
            slope: 1.0,
            variance: 1.0,
            ..Observed::default()
        };
        Stretch {
            steps: vec![step; steps].into(),
            intensities: vec![1.0; steps],
            observed: Vec::from_iter((0..=steps).map(observed)).into(),
            ..Stretch::default()
        }
    }

    fn model(stretch: &Stretch, noise: f64) -> Deviations<'_> {
        Deviations {
            stretch,
            prior: Prior::new(Unknown::Torque, 1),
            noise,
            speed_noise: 0.0,
            law_noise: 0.0,
            correlated: None,
            spread: [1e3, 1e4, 1e5, 0.0, 0.0, 0.0, 0.0],
        }
    }

    fn agrees(found: &Gaussian<3>, k: usize, mean: f64, error: f64, within: f64) {
        assert!((found.mean[k] - mean).abs() < within * error);
        assert!((found.covariance[k][k].sqrt() - error).abs() < within * error);
    }

    /// Without process noise the smoothed motion is that of the start that least squares find, but for the rounding of a
    /// start as wide as 1e5 σ.
    #[test]
    fn the_smoother_is_as_stable_as_the_mechanism() {
        let stretch = stretch(STEPS);
        let model = model(&stretch, 0.0);
        let (found, _) = smooth::<3>(&model, &mut ());
        let transition = Matrix3::from_fn(|i, j| model.step::<3>(0).transition[i][j]);
        let mut powers = vec![Matrix3::identity()];
        (0..STEPS).for_each(|k| powers.push(transition * powers[k]));
        let spread = Vector3::new(1e3, 1e4, 1e5).map(|spread| f64::powi(spread, -2));
        let mut information = Matrix3::from_diagonal(&spread);
        let mut sum = Vector3::zeros();
        for (power, observed) in powers.iter().zip(stretch.observed.iter()) {
            let row: RowVector3<f64> = power.row(0).into();
            information += row.transpose() * row;
            sum += row.transpose() * observed.residual;
        }
        let covariance = information.try_inverse().expect("regular");
        let begin = covariance * sum;
        for (power, found) in powers.iter().zip(&found) {
            let (mean, spread) = (power * begin, power * covariance * power.transpose());
            for k in 0..3 {
                agrees(found, k, mean[k], spread[(k, k)].sqrt(), 1e-4);
            }
        }
    }

    /// With process noise the smoothed motion solves the normal equations of all states together.
    #[test]
    fn the_smoother_solves_the_normal_equations() {
        const NODES: usize = 30;
        let stretch = stretch(NODES - 1);
        let model = model(&stretch, 0.3);
        let (found, _) = smooth::<3>(&model, &mut ());
        let [transition, noise] = [model.step::<3>(0).transition, model.step::<3>(0).noise]
            .map(|matrix| Matrix3::from_fn(|i, j| matrix[i][j]));
        let precision = noise.try_inverse().expect("regular");
        let mut information = DMatrix::<f64>::zeros(3 * NODES, 3 * NODES);
        let mut right = DVector::<f64>::zeros(3 * NODES);
        for k in 0..3 {
            information[(k, k)] = model.spread[k].powi(-2);
        }
        for node in 0..NODES {
            information[(3 * node, 3 * node)] += 1.0;
            right[3 * node] = stretch.observed[node].residual;
        }
        // What a step leaves: the state after it less what follows from the state before.
        let sides = [-transition, Matrix3::identity()];
        for (node, a, b) in (1..NODES).flat_map(|n| [(n, 0, 0), (n, 0, 1), (n, 1, 0), (n, 1, 1)]) {
            let [row, column] = [a, b].map(|side| 3 * (node - 1 + side));
            let mut part = information.fixed_view_mut::<3, 3>(row, column);
            part += sides[a].transpose() * precision * sides[b];
        }
        let covariance = information.try_inverse().expect("regular");
        let mean = &covariance * right;
        for (node, found) in found.iter().enumerate() {
            for i in 0..3 {
                let at = 3 * node + i;
                agrees(found, i, mean[at], covariance[(at, at)].sqrt(), 1e-5);
            }
        }
    }

    /// Later samples narrow a diffuse state: here five numbers after few samples of correlated noise.
    struct Narrowing;
    impl Companion<5> for Narrowing {
        fn returned(
            &mut self,
            node: usize,
            at: &Filtered<'_, 5>,
            _: &Later<5>,
            smoothed: &Gaussian<5>,
        ) {
            let [before, after] = [at.predicted, smoothed].map(|g| &g.covariance);
            assert!((0..5).all(|k| after[k][k] < 1.01 * before[k][k]), "{node}");
        }
    }

    #[test]
    fn later_samples_narrow_a_diffuse_state() {
        let mut stretch = stretch(400);
        let step = Linearised {
            h: 1e-3,
            tilt: [90.0, 0.0],
            lever: 40.0,
            top: transition(1e-3, [200.0, -3.0, 40.0], [0.0; 3]),
            ..Linearised::default()
        };
        stretch.steps = vec![step; 400].into();
        for log in -40..40 {
            let model = Deviations {
                prior: FOLLOWING,
                correlated: Some(100.0),
                spread: [1e3, 1e6, 2e7, 2e6, 0.0, 0.0, 0.0],
                ..model(&stretch, (0.5 * f64::from(log)).exp())
            };
            smooth(&model, &mut Narrowing);
        }
    }
}
