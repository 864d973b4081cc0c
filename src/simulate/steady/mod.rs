//! Periodic steady state: fixed point of the cycle map (Poincare), speeds, work of the loads, and a flywheel.

mod cycles;
mod fixed_point;
mod flywheel;
mod loads;
mod periodic_orbit;
mod result;

use std::f64::consts::TAU;

use super::options::Options;
use super::second_run::MARGIN;
use crate::error::Error;
use crate::mechanism::{Class, Linkage};
use crate::numeric::fourier;
use crate::plan::Cycle;
use crate::scene::{MotionKind, Scene};
use periodic_orbit::{PeriodicOrbit, find};
pub use result::{Estimated, Flywheel, LoadWork, SpeedExtreme, SpeedOrder, SteadyState};

/// Refuses a coefficient of fluctuation that no flywheel gives.
pub(crate) fn check_fluctuation(wanted: Option<f64>) -> Result<(), Error> {
    match wanted {
        Some(wanted) if !(wanted > 0.0 && wanted < 2.0) => Err(Error::refused(
            format!("a coefficient of fluctuation of {wanted} is asked for"),
            "give a number between 0 and 2, like 0.02",
        )),
        _ => Ok(()),
    }
}

/// Finds the periodic motion that the scene's start approaches, or the next faster one if the crank would stop. The
/// motion turns in the sense of the start speed; a start at rest leaves the sense of rotation open.
///
/// Where no load depends on the speed and a turn gains no energy, every speed is periodic: the start speed is then the
/// steady one.
///
/// `fluctuation` is the coefficient of fluctuation for which a flywheel is wanted. Of the options, the work limit holds
/// for each search, and a request to stop ends it.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] with the reason where there is no periodic motion
/// or no flywheel, or where the crank angle cannot be the independent variable; [`Error::Incomplete`] at the work limit;
/// [`Error::Interrupted`].
///
/// ```
/// use slider_crank::scene::{Crank, Load, Scene};
/// use slider_crank::simulate::{Options, steady_state};
/// let scene = Scene::new(0.05, 0.15)
///     .crank(Crank { inertia: 0.02, ..Crank::default() })
///     .torque(Load::Constant(3.0))
///     .torque(Load::Viscous(0.1))
///     .start(0.0, 5.0);
/// let steady = steady_state(&scene, None, &Options::default()).unwrap();
/// assert!((steady.omega_mean_rad_per_s.value - 30.0).abs() < 1e-11);
/// ```
pub fn steady_state(
    scene: &Scene,
    fluctuation: Option<f64>,
    options: &Options,
) -> Result<SteadyState, Error> {
    let found = search(scene, fluctuation, options);
    match &options.stop {
        // Interrupted cycles look like those of a crank that stops.
        Some(stop) if stop.is_requested() => Err(Error::Interrupted),
        _ => found,
    }
}

fn search(
    scene: &Scene,
    fluctuation: Option<f64>,
    options: &Options,
) -> Result<SteadyState, Error> {
    check_fluctuation(fluctuation)?;
    refuse_what_has_none(scene)?;
    let rests = scene.motion.speed == 0.0;
    let of_runs = &Options {
        max_evaluations: options.max_evaluations,
        stop: options.stop.clone(),
        events_kept: 0,
        ..Options::default()
    };
    let found = first(scene, rests, of_runs)?;
    let (any_speed, approached) = (found.any_speed, found.fixed.approached);
    let speed = found.cycle.speed;
    let mut steady = Verified::new(scene, found, of_runs)?.described(scene);
    steady.approached_from_start = (!rests).then_some(approached);
    steady.flywheel = fluctuation
        .map(|wanted| flywheel::size(scene, speed, &steady.fluctuation, wanted, of_runs))
        .transpose()?;
    let notes = [
        rests.then_some("the scene starts at rest, so its loads decide the sense of rotation"),
        (!rests && !approached).then_some("the motion from the scene's start stops; this is the next faster periodic one"),
        any_speed.then_some("no load depends on the speed: every speed at which the crank turns fully is periodic, and the scene's start says which"),
    ];
    steady.notes = notes.into_iter().flatten().map(str::to_owned).collect();
    Ok(steady)
}

fn refuse_what_has_none(scene: &Scene) -> Result<(), Error> {
    scene.check()?;
    let class = Class::of(&Linkage::new(&scene.geometry));
    let (what, help) = if scene.motion.kind == MotionKind::ConstantSpeed {
        (
            "a steady state is sought, but the scene prescribes the crank's speed".to_owned(),
            "use motion kind = \"free\"; the prescribed motion is steady already",
        )
    } else if let Some(why) = Cycle::of(scene).why_not {
        (
            format!("a steady state is sought, but no cycle is like the next: {why}"),
            "use loads of theta that repeat, and loads of omega, x and v",
        )
    } else if scene.reduced().clearance.is_some() {
        (
            "a steady state cannot be found directly with clearance in a joint".to_owned(),
            "take [clearance] out of the scene, or simulate until the motion repeats",
        )
    } else if class != Class::RotatingCrank {
        (
            format!("a steady state needs a crank that turns fully; these lengths make a {class}"),
            "the crank turns fully if the rod is longer than crank and offset together",
        )
    } else {
        return Ok(());
    };
    Err(Error::refused(what, help))
}

/// Finds the steady state in the sense of the start speed; from rest both senses are tried.
fn first(scene: &Scene, rests: bool, options: &Options) -> Result<PeriodicOrbit, Error> {
    if !rests {
        return find(scene, scene.motion.speed, options);
    }
    // Any speed serves as a first guess.
    match [1.0, -1.0].map(|speed| find(scene, speed, options)) {
        [Ok(found), _] | [_, Ok(found)] if found.any_speed => Err(Error::refused(
            "the start is at rest, and no load depends on the speed: every speed is periodic",
            "give a start speed: motion.speed",
        )),
        [Ok(_), Ok(_)] => Err(Error::refused(
            "the start is at rest, and the crank has a steady state in either sense of rotation",
            "give motion.speed the sign of the rotation that is meant",
        )),
        [Ok(found), Err(_)] | [Err(_), Ok(found)] => Ok(found),
        [Err(error), Err(_)] => Err(error),
    }
}

/// Two computations of one periodic motion: their difference gives the error.
struct Verified {
    found: PeriodicOrbit,
    check: PeriodicOrbit,
    /// Relative uncertainty of the speeds: half that of the energies, and rounding.
    relative_error: f64,
}

impl Verified {
    fn new(scene: &Scene, found: PeriodicOrbit, options: &Options) -> Result<Verified, Error> {
        let rounding = 8.0 * f64::EPSILON;
        Ok(Verified {
            check: periodic_orbit::again(scene, found.cycle.speed, options)?,
            relative_error: 0.5 * found.cycle.relative_error + rounding,
            found,
        })
    }

    /// Estimates a value from both computations; `floor` adds to the error.
    fn of(&self, value: impl Fn(&PeriodicOrbit) -> f64, floor: f64) -> Estimated {
        let found = value(&self.found);
        Estimated {
            value: found,
            error: MARGIN * (found - value(&self.check)).abs() + floor,
        }
    }

    /// Estimates a speed or a time.
    fn relative(&self, value: impl Fn(&PeriodicOrbit) -> f64) -> Estimated {
        let size = value(&self.found).abs();
        self.of(value, self.relative_error * size)
    }

    fn mean_speed(&self) -> Estimated {
        self.relative(|f| f.cycle.speed.signum() * f.cycle.rotation() / f.cycle.period)
    }

    fn fluctuation(&self) -> Estimated {
        self.of(
            PeriodicOrbit::fluctuation,
            self.relative_error * (2.0 + self.found.fluctuation()),
        )
    }

    fn described(&self, scene: &Scene) -> SteadyState {
        let Verified { found, check, .. } = self;
        let fluctuation = self.fluctuation();
        let varies = found.fluctuation() > 4.0 * fluctuation.error;
        let extreme = |which: usize| SpeedExtreme {
            omega_rad_per_s: self.relative(|f| f.extremes[which].omega),
            theta_rad: varies.then(|| self.extreme_angle(which)),
        };
        let loads = loads::works(scene, self);
        let power = |sign: f64| {
            let none = Estimated::default();
            loads.iter().fold(none, |sum, load| Estimated {
                value: sum.value + (sign * load.power_w.value).max(0.0),
                error: sum.error + load.power_w.error,
            })
        };
        let error = found.fixed.slope_error.max(check.fixed.slope_error);
        let multiplier = self.of(PeriodicOrbit::multiplier, error);
        SteadyState {
            scene: scene.title.clone().unwrap_or_default(),
            theta_rad: scene.motion.angle,
            omega_rad_per_s: self.relative(|f| f.cycle.speed),
            cycle_turns: found.cycle.turns,
            period_s: self.relative(|f| f.cycle.period),
            omega_mean_rad_per_s: self.mean_speed(),
            slowest: extreme(0),
            fastest: extreme(1),
            fluctuation,
            stable: multiplier.value + multiplier.error < 1.0,
            multiplier,
            approached_from_start: None,
            speed_orders: self.orders(),
            power_in_w: power(1.0),
            power_out_w: power(-1.0),
            loads,
            flywheel: None,
            notes: Vec::new(),
        }
    }

    /// Estimates the crank angle of an extreme of the speed: an error of the acceleration by a part `relative` of the
    /// speed moves the extreme the more, the less the speed varies.
    fn extreme_angle(&self, which: usize) -> Estimated {
        let Verified { found, check, .. } = self;
        let [here, there] = [found, check].map(|f| f.extremes[which].turned);
        let apart = (here - there).abs();
        let apart = apart.min((found.cycle.rotation() - apart).abs());
        let angle = found.cycle.angle(here);
        Estimated {
            value: angle.radians().rem_euclid(found.cycle.rotation()),
            error: MARGIN * apart
                + self.relative_error * TAU / found.fluctuation().clamp(1e-12, 1.0),
        }
    }

    /// Returns the amplitudes of the Fourier series of the speed over the crank angle of a cycle.
    fn orders(&self) -> Vec<SpeedOrder> {
        let turns = self.found.cycle.turns;
        // The rectangle rule is exact for signals of orders below this number per turn less the highest order.
        let count = 1024 * turns;
        let speed = |k: u32| {
            let at = f64::from(k) / f64::from(count);
            fourier::Sample {
                at,
                weight: 1.0 / f64::from(count),
                values: [&self.found, &self.check].map(|f| f.cycle.omega(at * f.cycle.rotation())),
            }
        };
        let speeds: Vec<_> = (0..count).map(speed).collect();
        // Every other sample weighs twice as much.
        let amplitudes = |stride: usize, k: u32| {
            let samples = speeds.iter().step_by(stride).copied();
            fourier::coefficients(samples, k).map(|[c, s]| 2.0 * stride as f64 * c.hypot(s))
        };
        let rounding = self.relative_error * self.found.cycle.speed.abs();
        let order = |k: u32| {
            let [value, other] = amplitudes(1, k);
            // Corners of the speed alias higher orders onto this one.
            let folded = (value - amplitudes(2, k)[0]).abs();
            SpeedOrder {
                order: f64::from(k) / f64::from(turns),
                amplitude_rad_per_s: Estimated {
                    value,
                    error: MARGIN * (value - other).abs() + folded + rounding,
                },
            }
        };
        (1..=fourier::HIGHEST_ORDER * turns).map(order).collect()
    }
}
