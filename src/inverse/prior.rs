//! The priors among which the likelihood chooses.

use super::likelihood::{Noise, Scales};
use super::linearised::{Prior, Unknown};

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior {
    unknown: Unknown::Acceleration,
    order: 2,
    follows_speed: false,
};

/// Priors through the equation of motion.
pub(super) const MECHANICAL: [Prior; 5] = [
    Prior {
        unknown: Unknown::Torque,
        order: 2,
        follows_speed: true,
    },
    Prior {
        unknown: Unknown::Torque,
        order: 1,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Torque,
        order: 2,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 1,
        follows_speed: false,
    },
    Prior {
        unknown: Unknown::Force,
        order: 2,
        follows_speed: false,
    },
];

/// A prior with its noise, about a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub prior: Prior,
    pub noise: Noise,
    pub scales: Scales,
}

/// ln of the likelihood of the likeliest.
pub(super) fn likelihood(tried: &[Candidate]) -> f64 {
    let best = tried.first();
    best.map_or(f64::NEG_INFINITY, |best| best.noise.likelihood)
}

/// Priors with the ln of their likelihoods.
pub(super) fn listed(tried: &[Candidate]) -> Vec<(Prior, f64)> {
    tried
        .iter()
        .map(|candidate| (candidate.prior, candidate.noise.likelihood))
        .collect()
}
