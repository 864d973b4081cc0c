//! Linear model of the deviations from a nominal path, with its Kalman filter and smoother.

pub(super) mod fixed_interval;
pub(super) mod harmonics;
pub(super) mod kalman;
pub(super) mod linearised;
pub(super) mod matrix;
pub(super) mod prediction;
pub(super) mod prior;
pub(super) mod regressors;
pub(super) mod repeating;
pub(super) mod sensitivity;
pub(super) mod state_space;
pub(super) mod tone;
pub(super) mod transition;
