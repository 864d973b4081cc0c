//! Acceleration, friction force and holding torque at one crank angle of a scene with friction or dry loads.

use serde::Serialize;

use crate::error::Error;
use crate::mechanism::{Curve, CurveEquation, Equation, FromRest, Sense, Statics};
use crate::numeric::angle::Angle;
use crate::scene::Scene;

/// Friction force at the guide and range of the holding torque.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FrictionAt {
    /// Friction force on the slider along +x, sliding or held by friction alone, N; none where the guide jams
    pub force_n: Option<f64>,
    /// Least crank torque beside the loads that keeps the speed, N m; none where the guide locks itself
    pub holding_min_nm: Option<f64>,
    /// Greatest crank torque beside the loads that keeps the speed, N m; equal to the least unless at rest
    pub holding_max_nm: Option<f64>,
}

/// Returns θ̈ (none where the guide jams) and the friction values; nothing for a scene without friction and dry loads.
pub(super) fn friction_at(
    scene: &Scene,
    equation: &Equation,
    theta: f64,
) -> Result<Option<(Option<f64>, FrictionAt)>, Error> {
    let guide = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
    if guide.friction.is_none() && !guide.loads().are_dry() {
        return Ok(None);
    }
    let friction = guide.friction;
    let [mu, mu_static] = friction.map_or([0.0; 2], |f| [f.coefficient, f.static_coefficient]);
    let (angle, omega) = (Angle::from(theta), scene.motion.speed);
    let dx = equation.terms(theta).pose.dx;
    let sliding = |direction: f64| {
        let sense = Sense::of(direction, dx * direction);
        let free = guide.free_against(0.0, angle, omega, sense);
        let sgn_v = (free.dx * direction).signum();
        let (alpha, touch) = free.sliding(free.opposing(mu, sgn_v));
        (free.clear_of_jam(mu) > 0.0).then_some((alpha, touch.friction))
    };
    let (found, holding) = if omega != 0.0 {
        let driven = guide.driven(0.0, angle, omega, 0.0);
        let without = equation.driving_torque(0.0, theta, omega, 0.0);
        let holding = driven.map(|touch| without - touch.friction * dx);
        (sliding(omega.signum()), [holding; 2])
    } else {
        let found = match guide.at_rest(angle).held(0.0).free.from_rest(mu, mu_static) {
            FromRest::Hold(touch) => Some((0.0, touch.friction)),
            FromRest::Move(direction) => sliding(direction),
            FromRest::Jam => None,
        };
        let band = Statics::new(scene, mu_static)?.crank_torque(theta).band;
        (found, band.map_or([None; 2], |band| [band.min, band.max]))
    };
    let at = FrictionAt {
        force_n: found.map(|(_, force)| force),
        holding_min_nm: holding[0],
        holding_max_nm: holding[1],
    };
    Ok(Some((found.map(|(alpha, _)| alpha), at)))
}
