//! Which engine computes a motion with Coulomb friction at the guide.

use std::f64::consts::TAU;

use super::choice::{self, Choice};
use super::{Engine, Method, Stepper};
use crate::error::Error;
use crate::mechanism::{Class, Curve, CurveEquation, Linkage};
use crate::scene::Scene;

/// Angles of a turn at which the guide is looked at.
const PLACES: u32 = 64;

/// The engine of a scene with friction.
pub(super) fn engine(method: Method, scene: &Scene, class: Class) -> Result<Choice, Error> {
    if method == Method::Energy {
        return Err(Error::refused(
            "method energy cannot serve Coulomb friction, whose work depends on the speed",
            "use --method auto, angle, time, dop853 or dopri5",
        ));
    }
    match why_not_angle(scene, class) {
        None => Ok(Choice::of(
            Engine::Angle,
            "the crank turns: its energy and the time over the crank angle, with Coulomb friction piece by piece between its changes; where it comes near to rest, integration in time takes over",
        )),
        Some(why) if method == Method::Angle => Err(Error::refused(
            format!("method angle cannot serve this motion with Coulomb friction: {why}"),
            "use --method auto, time, dop853 or dopri5",
        )),
        Some(why) => Ok(Choice::in_time(
            Stepper::Picard,
            format!(
                "Coulomb friction, and {why}: integration in time, piece by piece between its changes"
            ),
        )),
    }
}

fn why_not_angle(scene: &Scene, class: Class) -> Option<String> {
    if class != Class::RotatingCrank {
        return Some("the crank cannot turn fully".to_owned());
    }
    let jams =
        || jams(scene).then(|| "the slider jams in its guide at an angle of the turn".to_owned());
    choice::why_not_angle(scene).or_else(jams)
}

/// Whether rigid bodies jam at one of some angles of the turn.
fn jams(scene: &Scene) -> bool {
    let linkage = Linkage::new(&scene.geometry);
    let guide = CurveEquation::new(scene, Curve::on_crank(&linkage));
    let mu = guide
        .friction()
        .map_or(0.0, |friction| friction.coefficient);
    let theta = |i: u32| TAU * f64::from(i) / f64::from(PLACES);
    (0..PLACES).any(|i| guide.across(theta(i)).normal().grip(mu).is_none())
}
