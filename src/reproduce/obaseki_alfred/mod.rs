//! Obaseki and Alfred 2020: offset slider-crank at constant speed, equations (1)-(53), tables 1 to 3.

mod equations;
mod figures;
mod forces;
mod on_bodies;
mod printed;
mod results;

use super::Drawing;
use super::entry::Claim;
use crate::error::Error;
use crate::scene::{Crank, Rod, RodModel, Scene, Slider};

/// Table 1, SI.
const CRANK: f64 = 0.04;
const ROD: f64 = 0.064;
const OFFSET: f64 = 0.02;
/// The paper's rounding of 2400 rev/min, rad/s.
const SPEED: f64 = 251.0;
const CRANK_MASS: f64 = 0.2;
const ROD_MASS: f64 = 0.5;
const SLIDER_MASS: f64 = 0.8;

/// The engine of table 1 with another offset, and uniform crank and rod; the rod as two masses, (31)-(33).
fn engine(offset: f64) -> Scene {
    Scene::new(CRANK, ROD)
        .offset(offset)
        .crank(Crank {
            mass: CRANK_MASS,
            cg: 0.5 * CRANK,
            cg_lateral: 0.0,
            inertia: CRANK_MASS * CRANK * CRANK / 3.0,
        })
        .rod(Rod {
            model: RodModel::TwoMass,
            mass: ROD_MASS,
            cg: 0.5 * ROD,
            inertia: ROD_MASS * ROD * ROD / 12.0,
            ..Rod::default()
        })
        .slider(Slider { mass: SLIDER_MASS })
        .constant_speed(0.0, SPEED)
}

pub(super) fn claims() -> Result<Vec<Claim>, Error> {
    let mut claims = equations::claims();
    claims.extend(forces::claims()?);
    claims.extend(results::claims()?);
    Ok(claims)
}

pub(super) fn drawings() -> Result<Vec<Drawing>, Error> {
    figures::drawings()
}
