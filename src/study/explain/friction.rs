//! What friction at the guide does at one crank angle.

use serde::Serialize;

use crate::error::Error;
use crate::mechanism::{Constrained, Curve, Equation, FromRest, Statics};
use crate::numeric::angle::Angle;
use crate::scene::Scene;

/// Friction at the guide.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FrictionAt {
    /// Force on the slider along +x as it moves or is held by friction alone, N; none where the guide jams
    pub force_n: Option<f64>,
    /// Least torque that keeps the crank at this speed, beside the loads, N m; none where the guide locks itself
    pub holding_min_nm: Option<f64>,
    /// Greatest; the same as the least unless the crank is at rest
    pub holding_max_nm: Option<f64>,
}

/// θ̈ and the holding torque with friction, for a scene that has it.
pub(super) fn friction_at(
    scene: &Scene,
    equation: &Equation,
    theta: f64,
) -> Result<Option<(Option<f64>, FrictionAt)>, Error> {
    let guide = Constrained::new(scene, Curve::on_crank(equation.linkage()));
    let Some(friction) = guide.friction() else {
        return Ok(None);
    };
    let (mu, mu_static) = (friction.coefficient, friction.static_coefficient);
    let (angle, omega) = (Angle::from(theta), scene.motion.speed);
    let free = guide.free(0.0, angle, omega);
    let sliding = |direction: f64| {
        let (alpha, touch) = free.sliding(free.opposing(mu, direction));
        (free.clear_of_jam(mu) > 0.0).then_some((alpha, touch.friction))
    };
    if omega != 0.0 {
        let found = sliding(free.velocity(omega).signum());
        let dx = equation.terms(theta).pose.dx;
        let driven = guide.driven(0.0, angle, omega, 0.0);
        let without = equation.driving_torque(0.0, theta, omega, 0.0);
        let holding = driven.map(|touch| without - touch.friction * dx);
        let at = FrictionAt {
            force_n: found.map(|(_, force)| force),
            holding_min_nm: holding,
            holding_max_nm: holding,
        };
        return Ok(Some((found.map(|(alpha, _)| alpha), at)));
    }
    let found = match free.from_rest(mu, mu_static) {
        FromRest::Hold(touch) => Some((0.0, touch.friction)),
        FromRest::Move(direction) => sliding((direction * free.velocity(1.0)).signum()),
        FromRest::Jam(_) => None,
    };
    let band = Statics::new(scene, mu_static)?.crank_torque(theta).band;
    let at = FrictionAt {
        force_n: found.map(|(_, force)| force),
        holding_min_nm: band.and_then(|band| band.min),
        holding_max_nm: band.and_then(|band| band.max),
    };
    Ok(Some((found.map(|(alpha, _)| alpha), at)))
}
