//! The priors among which the likelihood chooses.

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
