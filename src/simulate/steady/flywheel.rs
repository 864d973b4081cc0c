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
    // Nearly linear in the inertia: the fluctuation is nearly proportional to its inverse.
    let excess_of = |fluctuation: f64| 1.0 - wanted / fluctuation;
    let excess = |added: f64| -> Result<f64, Error> {
        let found = find(&with(scene, added), speed, options)?;
        Ok(excess_of(found.fluctuation()))
    };
    let now = (0.0, excess_of(present.value));
    let ends = match now.1 > 0.0 {
        true => heavier(scene, now, &excess)?,
        false => lighter(scene, wanted, now, &excess)?,
    };
    let Some(added) = root::between(excess, ends, 0.0)? else {
        return Err(Error::refused(
            format!("no flywheel was found for a coefficient of fluctuation of {wanted}"),
            "ask for another coefficient",
        ));
    };
    let scene = with(scene, added);
    scene.check()?;
    let verified = Verified::new(&scene, find(&scene, speed, options)?, options)?;
    let fluctuation = verified.fluctuation();
    let crank = scene.crank.map_or(0.0, |crank| crank.inertia);
    let step = 1e-4 * Equation::new(&scene).terms(scene.motion.angle).m;
    let slope = (excess(added + step)? - excess_of(fluctuation.value)) / step;
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

/// Inertia added, kg m², and the excess of the fluctuation.
type End = (f64, f64);
type Excess<'a> = dyn Fn(f64) -> Result<f64, Error> + 'a;

/// Brackets the inertia to be added, kg m², for a smaller fluctuation, from none upwards.
fn heavier(scene: &Scene, mut low: End, excess: &Excess<'_>) -> Result<[End; 2], Error> {
    let own = Equation::new(scene).terms(scene.motion.angle).m;
    // A tenth more than a fluctuation in proportion to the inverse of the inertia needs.
    let mut high = 1.1 * own * low.1 / (1.0 - low.1);
    // With a trillion times the inertia the fluctuation is next to rounding.
    let largest = 1e12 * own;
    while high < largest {
        let end = (high, excess(high)?);
        if end.1 <= 0.0 {
            return Ok([low, end]);
        }
        (low, high) = (end, 2.0 * high);
    }
    Err(Error::refused(
        format!(
            "no flywheel up to {largest:.1e} kg m2 makes the coefficient of fluctuation so small"
        ),
        "ask for a larger coefficient",
    ))
}

/// Brackets the inertia to be taken away, kg m² and negative, for a larger fluctuation: from all that can be taken
/// away, or where the crank then stops, from as much as lets it go on.
fn lighter(scene: &Scene, wanted: f64, now: End, excess: &Excess<'_>) -> Result<[End; 2], Error> {
    let crank = scene.crank.unwrap_or_default();
    let most = crank.inertia - crank.mass * (crank.cg.powi(2) + crank.cg_lateral.powi(2));
    let (mut kept, mut stops, mut tried) = (now, -most, -most);
    let mut largest = now.1;
    // Bisection towards an inertia with which the crank stops, to the last digit.
    for _ in 0..f64::MANTISSA_DIGITS {
        match excess(tried) {
            Ok(excess) if excess >= 0.0 => return Ok([(tried, excess), kept]),
            Ok(excess) => {
                largest = largest.max(excess);
                if tried == -most {
                    break;
                }
                kept = (tried, excess);
            }
            Err(_) => stops = tried,
        }
        tried = 0.5 * (kept.0 + stops);
    }
    Err(Error::refused(
        format!(
            "a coefficient of fluctuation of {wanted} needs a crank of less inertia than its mass has, or less than none; the largest that was reached is {:.6}",
            wanted / (1.0 - largest)
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
