//! The priors among which the likelihood chooses.

use super::linearised::{Prior, Unknown};
use super::scales::{Noise, Scales};

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior {
    unknown: Unknown::Acceleration,
    order: 2,
    follows_speed: false,
};

/// The priors of an unknown by their order.
const fn ladder(unknown: Unknown) -> [Prior; 3] {
    let first = Prior {
        unknown,
        order: 1,
        follows_speed: false,
    };
    [
        first,
        Prior { order: 2, ..first },
        Prior { order: 3, ..first },
    ]
}

/// A torque in proportion to the speed, and a Wiener process.
const FOLLOWING: Prior = Prior {
    unknown: Unknown::Torque,
    order: 1,
    follows_speed: true,
};

/// All priors, in lists along which the order rises.
pub(super) const LADDERS: [&[Prior]; 4] = [
    &ladder(Unknown::Force),
    &ladder(Unknown::Torque),
    &[FOLLOWING],
    &[
        KINEMATIC,
        Prior {
            order: 3,
            ..KINEMATIC
        },
    ],
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
