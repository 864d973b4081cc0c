//! The flywheel for a wanted coefficient of fluctuation.

use super::describe;
use super::periodic_orbit::{Found, Seeker};
use super::refusal::Refusal;
use super::result::{Estimated, Flywheel};
use crate::engine::WorkLimit;
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::root;
use crate::scene::{Crank, Scene};

/// Steps into which the inertia that could be taken away is divided.
const STEPS: u32 = 16;
/// Largest inertia that is tried, in units of that of the mechanism.
const LARGEST_INERTIA: f64 = 1e12;
/// Halvings towards an inertia with which the crank stops.
const HALVINGS: u32 = 40;

/// Finds the flywheel with which the steady state has the `wanted` coefficient of fluctuation: the nearest on the way
/// up from the crank's own inertia, or down.
pub(super) fn size(
    scene: &Scene,
    found: &Found,
    present: &Estimated,
    wanted: f64,
    limit: WorkLimit<'_>,
) -> Result<Flywheel, Error> {
    if !(wanted > 0.0 && wanted < 2.0) {
        return Err(Refusal::NoCoefficient(wanted).into());
    }
    let excess = |added: f64| -> Result<f64, Error> {
        let found = Seeker::new(&with(scene, added), found.speed, limit).find()?;
        Ok((found.fluctuation() / wanted).ln())
    };
    if present.value <= present.error {
        return Err(Refusal::ConstantSpeed(wanted).into());
    }
    let (low, high) = if present.value > wanted {
        heavier(scene, &excess)?
    } else {
        lighter(scene, wanted, &excess)?
    };
    let mut failed = None;
    let added = root::bracketed(
        |added| {
            excess(added).unwrap_or_else(|error| {
                failed = Some(error);
                f64::NAN
            })
        },
        low,
        high,
    );
    let Some(added) = added else {
        return Err(failed.unwrap_or_else(|| Refusal::NotFound(wanted).into()));
    };
    let scene = with(scene, added);
    scene.check()?;
    let found = Seeker::new(&scene, found.speed, limit).find()?;
    let check = Seeker::new(&scene, found.speed, limit).again()?;
    let steady = describe(&scene, &found, &check);
    let crank = scene.crank.map_or(0.0, |crank| crank.inertia);
    let step = 1e-4 * Equation::new(&scene).terms(scene.motion.angle).inertia.m;
    let slope = (excess(added + step)? - excess(added)?) / step;
    let off = (steady.fluctuation.value - wanted).abs() + steady.fluctuation.error;
    Ok(Flywheel {
        wanted_fluctuation: wanted,
        added_inertia_kg_m2: Estimated {
            value: added,
            error: off / (wanted * slope.abs()) + 2.0 * f64::EPSILON * crank,
        },
        crank_inertia_kg_m2: crank,
        fluctuation: steady.fluctuation,
        omega_mean_rad_per_s: steady.omega_mean_rad_per_s,
    })
}

type Excess<'a> = dyn Fn(f64) -> Result<f64, Error> + 'a;

/// Inertias between which the fluctuation falls to the wanted one, from none added.
fn heavier(scene: &Scene, excess: &Excess<'_>) -> Result<(f64, f64), Error> {
    let own = Equation::new(scene).terms(scene.motion.angle).inertia.m;
    let (mut low, mut high) = (0.0, 0.1 * own);
    while high < LARGEST_INERTIA * own {
        if excess(high)? <= 0.0 {
            return Ok((low, high));
        }
        (low, high) = (high, 2.0 * high);
    }
    Err(Refusal::TooHeavy(high).into())
}

/// Inertias between which it rises to the wanted one, as far as inertia can be taken away.
fn lighter(scene: &Scene, wanted: f64, excess: &Excess<'_>) -> Result<(f64, f64), Error> {
    let crank = scene.crank.unwrap_or_default();
    let most = crank.inertia - crank.mass * (crank.cg.powi(2) + crank.cg_lateral.powi(2));
    let mut kept = 0.0;
    let mut largest = excess(0.0)?;
    for i in 1..=STEPS {
        let mut tried = -most * f64::from(i) / f64::from(STEPS);
        for _ in 0..HALVINGS {
            match excess(tried) {
                Ok(excess) if excess >= 0.0 => return Ok((tried, kept)),
                Ok(excess) => {
                    largest = largest.max(excess);
                    kept = tried;
                    break;
                }
                Err(_) => tried = 0.5 * (tried + kept),
            }
        }
    }
    let largest = wanted * largest.exp();
    Err(Refusal::TooLight { wanted, largest }.into())
}

/// The scene with more inertia of the crank, kg m².
pub(super) fn with(scene: &Scene, added: f64) -> Scene {
    let mut scene = scene.clone();
    let crank = scene.crank.get_or_insert_with(Crank::default);
    crank.inertia = (crank.inertia + added).max(0.0);
    scene
}
