//! What friction at the guide and dry loads do at one crank angle.

use serde::Serialize;

use crate::error::Error;
use crate::mechanism::{Curve, CurveEquation, Equation, FromRest, Sense, Statics};
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

/// θ̈ and the holding torque with friction or dry loads, for a scene that has them.
pub(super) fn friction_at(
    scene: &Scene,
    equation: &Equation,
    theta: f64,
) -> Result<Option<(Option<f64>, FrictionAt)>, Error> {
    let guide = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
    if guide.friction().is_none() && !guide.loads().are_dry() {
        return Ok(None);
    }
    let friction = guide.friction();
    let [mu, mu_static] = friction.map_or([0.0; 2], |f| [f.coefficient, f.static_coefficient]);
    let (angle, omega) = (Angle::from(theta), scene.motion.speed);
    let dx = equation.terms(theta).pose.dx;
    let sliding = |direction: f64| {
        let sense = Sense::of(direction, dx * direction);
        let free = guide.free_against(0.0, angle, omega, sense);
        let sgn_v = free.velocity(direction).signum();
        let (alpha, touch) = free.sliding(free.opposing(mu, sgn_v));
        (free.clear_of_jam(mu) > 0.0).then_some((alpha, touch.friction))
    };
    if omega != 0.0 {
        let found = sliding(omega.signum());
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
    let found = match guide.at_rest(angle).held(0.0).free.from_rest(mu, mu_static) {
        FromRest::Hold(touch) => Some((0.0, touch.friction)),
        FromRest::Move(direction) => sliding(direction),
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
