//! Derivatives of the state of the filter by the numbers of the tones: they follow its recursion (augmented Kalman filter; de Jong,
//! Ann. Statist. 19 (1991) 1073).

use super::kalman::{Filtered, Innovation, Sample, Step};
use super::matrix::{Vector, times};
use super::regressors::Regressors;

/// Derivatives along the filter.
#[derive(Clone)]
pub(in crate::inverse) struct Sensitivity<const N: usize> {
    states: Vec<Vector<N>>,
    /// Derivatives of the last prediction error.
    pub errors: Vec<f64>,
}

impl<const N: usize> Sensitivity<N> {
    /// Those by so many numbers before the first sample.
    pub fn new(count: usize) -> Self {
        Sensitivity {
            states: vec![[0.0; N]; count],
            errors: vec![0.0; count],
        }
    }

    /// Takes them to a node; returns those of the prediction error of its sample.
    #[inline(always)]
    pub fn filtered(&mut self, by: &Regressors, node: usize, at: &Filtered<'_, N>) -> &[f64] {
        if let Some(step) = at.step {
            self.step(by.of_step(node - 1), step);
        }
        if let Some((sample, found)) = at.sample {
            self.update(by.of_sample(node), sample, found);
        }
        &self.errors
    }

    #[inline(always)]
    fn step(&mut self, added: &[[f64; 2]], step: &Step<N>) {
        for (state, [theta, omega]) in self.states.iter_mut().zip(added) {
            *state = times(&step.transition, state);
            state[0] += theta;
            state[1] += omega;
        }
    }

    #[inline(always)]
    fn update(&mut self, own: &[f64], sample: &Sample, found: &Innovation<N>) {
        let errors = self.states.iter_mut().zip(&mut self.errors).zip(own);
        for ((state, error), own) in errors {
            *error = -own - sample.shown(state);
            for (value, gain) in state.iter_mut().zip(&found.gain) {
                *value += gain * *error;
            }
        }
    }
}
