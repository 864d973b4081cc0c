//! The periodic steady state: its speeds, its work, and the flywheel for a wanted coefficient of fluctuation.

mod flywheel;
mod loads;
mod orders;
mod periodic_orbit;
mod refusal;
mod result;
mod round;
mod timed;

use super::error_estimate::MARGIN;
use crate::engine::WorkLimit;
use crate::error::Error;
use crate::numeric::stop::Stop;
use crate::scene::Scene;
pub use orders::SpeedOrder;
use periodic_orbit::{Found, Seeker};
use refusal::Refusal;
pub use result::{Estimated, Flywheel, LoadWork, SpeedExtreme, SteadyState};

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct SteadyOptions {
    /// Coefficient of fluctuation for which the flywheel is wanted.
    pub fluctuation: Option<f64>,
    /// Most evaluations of the loads in each search.
    pub max_evaluations: u64,
    /// A request to stop; the search is refused then.
    pub stop: Option<Stop>,
}

impl Default for SteadyOptions {
    fn default() -> SteadyOptions {
        SteadyOptions {
            fluctuation: None,
            max_evaluations: super::Options::default().max_evaluations,
            stop: None,
        }
    }
}

impl SteadyOptions {
    fn limit(&self) -> WorkLimit<'_> {
        WorkLimit {
            evaluations: self.max_evaluations,
            stop: self.stop.as_ref(),
        }
    }
}

/// Finds the periodic motion that the scene's start approaches, or the next faster one if the crank would stop.
/// The motion turns as the start speed does; a start at rest leaves the sense of rotation open.
///
/// Where no load depends on the speed and a turn gains no energy, every speed is periodic: then the start speed is
/// the steady one.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] with the reason where there is no periodic motion
/// or no flywheel, or where the crank angle cannot be the independent variable; [`Error::Interrupted`].
///
/// ```
/// use slider_crank::scene::{Crank, Load, Scene};
/// use slider_crank::simulate::{SteadyOptions, steady_state};
/// let scene = Scene::new(0.05, 0.15)
///     .crank(Crank { inertia: 0.02, ..Crank::default() })
///     .torque(Load::Constant(3.0))
///     .torque(Load::Viscous(0.1))
///     .start(0.0, 5.0);
/// let steady = steady_state(&scene, &SteadyOptions::default()).unwrap();
/// assert!((steady.omega_mean_rad_per_s.value - 30.0).abs() < 1e-11);
/// ```
pub fn steady_state(scene: &Scene, options: &SteadyOptions) -> Result<SteadyState, Error> {
    let found = search(scene, options);
    match &options.stop {
        // Cycles that were cut off look like those of a crank that stops.
        Some(stop) if stop.is_requested() => Err(Error::Interrupted),
        _ => found,
    }
}

fn search(scene: &Scene, options: &SteadyOptions) -> Result<SteadyState, Error> {
    refusal::refuse_what_has_none(scene)?;
    let rests = scene.motion.speed == 0.0;
    let limit = options.limit();
    let found = first(scene, rests, limit)?;
    let check = Seeker::new(scene, found.speed, limit).again()?;
    let starts = (!rests).then_some(found.approached);
    let mut notes = Vec::new();
    if rests {
        notes
            .push("the scene starts at rest, so its loads decide the sense of rotation".to_owned());
    }
    if starts == Some(false) {
        notes.push(
            "the motion from the scene's start stops; this is the next faster periodic one"
                .to_owned(),
        );
    }
    if found.any_speed {
        notes.push(
            "no load depends on the speed: every speed at which the crank turns fully is periodic, and the scene's start says which"
                .to_owned(),
        );
    }
    let mut steady = describe(scene, &found, &check);
    steady.approached_from_start = starts;
    steady.flywheel = options
        .fluctuation
        .map(|wanted| flywheel::size(scene, &found, &steady.fluctuation, wanted, limit))
        .transpose()?;
    steady.notes = notes;
    Ok(steady)
}

/// The steady state in the sense of the start speed; both senses are tried for a start at rest.
fn first(scene: &Scene, rests: bool, limit: WorkLimit<'_>) -> Result<Found, Error> {
    if !rests {
        return Seeker::new(scene, scene.motion.speed, limit).find();
    }
    // Any speed serves to begin with.
    match [1.0, -1.0].map(|speed| Seeker::new(scene, speed, limit).find()) {
        [Ok(found), _] | [_, Ok(found)] if found.any_speed => Err(Refusal::AnySpeed.into()),
        [Ok(_), Ok(_)] => Err(Refusal::EitherSense.into()),
        [Ok(found), Err(_)] | [Err(_), Ok(found)] => Ok(found),
        [Err(error), Err(_)] => Err(error),
    }
}

/// The numbers, with errors from another computation of the same motion.
fn describe(scene: &Scene, found: &Found, check: &Found) -> SteadyState {
    let of = |value: &dyn Fn(&Found) -> f64, floor: f64| Estimated {
        value: value(found),
        error: MARGIN * (value(found) - value(check)).abs() + floor,
    };
    // What is left open of an energy moves the speed by half as much, relative to them.
    let relative = 0.5 * found.uncertain + periodic_orbit::SPEED_ROUNDING;
    let fluctuation = of(&|f| f.fluctuation(), relative * (2.0 + found.fluctuation()));
    let speed = |value: &dyn Fn(&Found) -> f64| of(value, relative * value(found).abs());
    let varies = found.fluctuation() > 4.0 * fluctuation.error;
    let extreme = |which: usize| SpeedExtreme {
        omega_rad_per_s: speed(&|f| f.extremes[which].omega),
        theta_rad: varies.then(|| periodic_orbit::place(found, check, which, relative)),
    };
    let loads = loads::works(scene, found, check, relative);
    let (power_in_w, power_out_w) = loads::powers(&loads);
    let multiplier = Estimated {
        value: found.multiplier,
        error: MARGIN * (found.multiplier - check.multiplier).abs()
            + found.multiplier_error.max(check.multiplier_error),
    };
    SteadyState {
        scene: scene.title.clone().unwrap_or_default(),
        theta_rad: scene.motion.angle,
        omega_rad_per_s: speed(&|f| f.speed),
        cycle_turns: found.turns as u32,
        period_s: of(&|f| f.period, relative * found.period),
        omega_mean_rad_per_s: speed(&|f| f.speed.signum() * f.way() / f.period),
        slowest: extreme(0),
        fastest: extreme(1),
        fluctuation,
        stable: multiplier.value + multiplier.error < 1.0,
        multiplier,
        approached_from_start: None,
        speed_orders: orders::orders(found, check, relative),
        power_in_w,
        power_out_w,
        loads,
        flywheel: None,
        notes: Vec::new(),
    }
}
