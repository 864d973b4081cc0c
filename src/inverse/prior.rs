//! The priors among which the likelihood chooses.

use super::linearised::{ORDERS, Prior, Unknown};
use super::scales::{Noise, Scales};

/// The prior without mechanics: a smoothing spline of degree seven in state-space form.
pub(super) const KINEMATIC: Prior = Prior {
    unknown: Unknown::Acceleration,
    order: 2,
    follows_speed: false,
};

/// A torque in proportion to the speed and a Wiener process beside it.
const FOLLOWING: Prior = Prior {
    unknown: Unknown::Torque,
    order: 2,
    follows_speed: true,
};

/// An unknown as a Wiener process integrated to this order.
const fn wiener(unknown: Unknown, order: usize) -> Prior {
    Prior {
        unknown,
        order,
        follows_speed: false,
    }
}

/// The priors of an unknown by their order.
const fn ladder(unknown: Unknown) -> [Prior; ORDERS] {
    [
        wiener(unknown, 1),
        wiener(unknown, 2),
        wiener(unknown, 3),
        wiener(unknown, 4),
    ]
}

/// All priors, in lists along which the order rises.
pub(super) const LADDERS: [&[Prior]; 4] = [
    &ladder(Unknown::Force),
    &ladder(Unknown::Torque),
    &[FOLLOWING],
    &[KINEMATIC],
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
