//! Flywheel for a wanted coefficient of fluctuation, by root finding in the added inertia.

use super::super::options::Options;
use super::Verified;
use super::periodic_orbit::find;
use super::result::{Estimated, Flywheel};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::numeric::root;
use crate::scene::{Crank, Scene};

/// Finds the flywheel that gives the steady state near a start speed (rad/s) the `wanted` coefficient of fluctuation:
/// inertia is added if the present coefficient is larger, otherwise taken away.
pub(super) fn size(
    scene: &Scene,
    speed: f64,
    present: &Estimated,
    wanted: f64,
    options: &Options,
) -> Result<Flywheel, Error> {
    if present.value <= present.error {
        return Err(Error::refused(
            format!(
                "no flywheel gives a coefficient of fluctuation of {wanted}: the speed is constant without one"
            ),
            "a flywheel is for a speed that varies",
        ));
    }
    let excess = |added: f64| -> Result<f64, Error> {
        let found = find(&with(scene, added), speed, options)?;
        Ok((found.fluctuation() / wanted).ln())
    };
    let (low, high) = match present.value > wanted {
        true => heavier(scene, &excess)?,
        false => lighter(scene, wanted, &excess)?,
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
        return Err(failed.unwrap_or_else(|| {
            Error::refused(
                format!("no flywheel was found for a coefficient of fluctuation of {wanted}"),
                "ask for another coefficient",
            )
        }));
    };
    let scene = with(scene, added);
    scene.check()?;
    let found = find(&scene, speed, options)?;
    let verified = Verified::new(&scene, found, options)?;
    let fluctuation = verified.fluctuation();
    let crank = scene.crank.map_or(0.0, |crank| crank.inertia);
    let step = 1e-4 * Equation::new(&scene).terms(scene.motion.angle).inertia.m;
    let slope = (excess(added + step)? - excess(added)?) / step;
    let off = (fluctuation.value - wanted).abs() + fluctuation.error;
    Ok(Flywheel {
        wanted_fluctuation: wanted,
        added_inertia_kg_m2: Estimated {
            value: added,
            error: off / (wanted * slope.abs()) + 2.0 * f64::EPSILON * crank,
        },
        crank_inertia_kg_m2: crank,
        fluctuation,
        omega_mean_rad_per_s: verified.mean_speed(),
    })
}

type Excess<'a> = dyn Fn(f64) -> Result<f64, Error> + 'a;

/// Brackets the inertia to be added, kg m², for a smaller fluctuation, from none upwards.
fn heavier(scene: &Scene, excess: &Excess<'_>) -> Result<(f64, f64), Error> {
    let own = Equation::new(scene).terms(scene.motion.angle).inertia.m;
    let (mut low, mut high) = (0.0, 0.1 * own);
    // With a trillion times the inertia the fluctuation is next to rounding.
    let largest = 1e12 * own;
    while high < largest {
        if excess(high)? <= 0.0 {
            return Ok((low, high));
        }
        (low, high) = (high, 2.0 * high);
    }
    Err(Error::refused(
        format!("no flywheel up to {high:.1e} kg m2 makes the coefficient of fluctuation so small"),
        "ask for a larger coefficient",
    ))
}

/// Brackets the inertia to be taken away, kg m² and negative, for a larger fluctuation: from all that can be taken
/// away, or where the crank then stops, from as much as lets it go on.
fn lighter(scene: &Scene, wanted: f64, excess: &Excess<'_>) -> Result<(f64, f64), Error> {
    let crank = scene.crank.unwrap_or_default();
    let most = crank.inertia - crank.mass * (crank.cg.powi(2) + crank.cg_lateral.powi(2));
    let (mut kept, mut stops, mut tried) = (0.0, -most, -most);
    let mut largest = excess(0.0)?;
    // Bisection towards an inertia with which the crank stops, to the last digit.
    for _ in 0..f64::MANTISSA_DIGITS {
        match excess(tried) {
            Ok(excess) if excess >= 0.0 => return Ok((tried, kept)),
            Ok(excess) => {
                largest = largest.max(excess);
                if tried == -most {
                    break;
                }
                kept = tried;
            }
            Err(_) => stops = tried,
        }
        tried = 0.5 * (kept + stops);
    }
    Err(Error::refused(
        format!(
            "a coefficient of fluctuation of {wanted} needs a crank of less inertia than its mass has, or less than none; the largest that was reached is {:.6}",
            wanted * largest.exp()
        ),
        "ask for a smaller coefficient",
    ))
}

/// Returns the scene with inertia added to the crank, kg m².
fn with(scene: &Scene, added: f64) -> Scene {
    let mut scene = scene.clone();
    let crank = scene.crank.get_or_insert_with(Crank::default);
    crank.inertia = (crank.inertia + added).max(0.0);
    scene
}
