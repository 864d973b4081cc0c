//! The periodic motion itself: the root of the energy that a turn gains.
//!
//! The map of the kinetic energy over a turn rises, as two motions cannot cross. So a motion approaches the
//! nearest energy, up where it gains and down where it loses, whose turn gains nothing.

use super::march::March;
use super::{Driven, Resolution};
use crate::engine::energy::leg::Leg;
use crate::engine::energy::{Orbit, Unserved};
use crate::numeric::angle::Angle;
use crate::numeric::root;

/// How far from the first energy it is looked for: ln of the ratio.
const FARTHEST: f64 = 60.0;
/// The longest step in the logarithm of the energy.
const LONGEST: f64 = 0.4;
/// Halvings between an energy at which the crank stops in its turn and one that loses.
const HALVINGS: usize = 40;
/// Relative error of a turn's gain by rounding and by the tails of its series, against its largest energy.
const NOISE: f64 = 4e-15;

/// A turn, and where a motion that starts a little beside it comes to.
pub struct Cycle {
    /// The turn.
    pub orbit: Orbit,
    /// s
    pub period: f64,
    /// Speed at its start, rad/s.
    pub speed: f64,
    /// Kinetic energy it gains, J: rounding if it is periodic.
    pub gain: f64,
    /// Largest kinetic energy at the ends of its panels, J.
    pub largest: f64,
    /// What rounding leaves open of its energies, relative to them.
    pub uncertain: f64,
    /// Deviation from it after a turn, by that before.
    pub multiplier: f64,
    /// Error of the multiplier.
    pub multiplier_error: f64,
    /// Whether the motion from the first speed approaches it.
    pub approached: bool,
    /// How often the loads were evaluated.
    pub evaluations: u64,
}

/// Why there is no periodic motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoCycle {
    /// It cannot be computed over the angle.
    Unserved(Unserved),
    /// Every turn gains energy, up to the largest that was looked at.
    Gains,
    /// Every turn loses energy, or is not completed.
    Stops,
}

impl From<Unserved> for NoCycle {
    fn from(unserved: Unserved) -> NoCycle {
        NoCycle::Unserved(unserved)
    }
}

/// The periodic motion that a motion from `angle` with `speed` (rad/s) approaches, or the next faster one if it
/// stops; `step` is the first step in the logarithm of the energy.
///
/// # Errors
/// [`NoCycle`] with the reason.
pub fn steady<D: Driven>(
    driven: &D,
    angle: Angle,
    speed: f64,
    step: f64,
    resolution: Resolution,
) -> Result<Cycle, NoCycle> {
    let mut turns = Turns::new(driven, angle, speed, resolution)?;
    let first = turns.march.kinetic;
    let (low, high, approached) = turns.bracket(first, step)?;
    let mut failed = None;
    let kinetic = root::bracketed(
        |kinetic| {
            turns.gain(kinetic).unwrap_or_else(|unserved| {
                failed = Some(unserved);
                f64::NAN
            })
        },
        low,
        high,
    );
    let kinetic = kinetic.ok_or(failed.unwrap_or(Unserved::NotSmooth))?;
    let (slope, slope_error) = turns.slope(kinetic)?;
    let cycle = turns.turn(kinetic)?;
    let uncertain = cycle.uncertain / slope.abs().max(NOISE);
    Ok(Cycle {
        uncertain,
        // Motions do not cross: what is below zero is rounding.
        multiplier: (1.0 + slope).max(0.0),
        multiplier_error: slope_error,
        approached,
        ..cycle
    })
}

/// One turn from `angle` with `speed` (rad/s), whether it is periodic or not.
///
/// # Errors
/// [`Unserved`] where the crank does not complete it.
pub fn one_turn<D: Driven>(
    driven: &D,
    angle: Angle,
    speed: f64,
    resolution: Resolution,
) -> Result<Cycle, Unserved> {
    let mut turns = Turns::new(driven, angle, speed, resolution)?;
    turns.turn(turns.march.kinetic)
}

struct Turns<'a, D: Driven> {
    march: March<'a, D>,
    start: Angle,
    direction: f64,
    /// Inertia at the start, kg m²
    inertia: f64,
}

impl<'a, D: Driven> Turns<'a, D> {
    fn new(
        driven: &'a D,
        angle: Angle,
        speed: f64,
        resolution: Resolution,
    ) -> Result<Turns<'a, D>, Unserved> {
        let start = angle.reduced();
        let march = March::new(driven, start, speed, resolution)?;
        Ok(Turns {
            inertia: 2.0 * march.kinetic / (speed * speed),
            march,
            start,
            direction: speed.signum(),
        })
    }

    /// Energy that a turn gains, J.
    fn gain(&mut self, kinetic: f64) -> Result<f64, Unserved> {
        self.march.restart(kinetic);
        loop {
            self.march.panel()?;
            if self.march.at_turn() {
                return Ok(self.march.gain);
            }
        }
    }

    /// The same; none if the crank does not complete the turn.
    fn completed(&mut self, kinetic: f64) -> Result<Option<f64>, NoCycle> {
        match self.gain(kinetic) {
            Ok(gain) => Ok(Some(gain)),
            Err(Unserved::TooSlow | Unserved::NotSmooth) => Ok(None),
            Err(unserved) => Err(unserved.into()),
        }
    }

    /// An energy that gains, one above it that loses, and whether the motion from the first goes there.
    fn bracket(&mut self, first: f64, step: f64) -> Result<(f64, f64, bool), NoCycle> {
        let gain = self.completed(first)?;
        if gain == Some(0.0) {
            return Ok((first, first, true));
        }
        if gain.is_some_and(|gain| gain < 0.0)
            && let Some((low, high)) = self.below(first, step)?
        {
            return Ok((low, high, true));
        }
        let (low, high) = self.above(first, step)?;
        Ok((low, high, gain.is_some_and(|gain| gain > 0.0)))
    }

    /// The nearest such energies below one that loses.
    fn below(&mut self, first: f64, step: f64) -> Result<Option<(f64, f64)>, NoCycle> {
        let (mut high, mut step) = (first, step);
        while (first / high).ln() < FARTHEST {
            let kinetic = high * (-step).exp();
            match self.completed(kinetic)? {
                Some(gain) if gain >= 0.0 => return Ok(Some((kinetic, high))),
                Some(_) => high = kinetic,
                None => return self.near_stop(kinetic, high),
            }
            step = (2.0 * step).min(LONGEST);
        }
        Ok(None)
    }

    /// The nearest such energies above.
    fn above(&mut self, first: f64, step: f64) -> Result<(f64, f64), NoCycle> {
        let (mut kinetic, mut step) = (first, step);
        let (mut gains, mut stops, mut turned) = (None, None, false);
        while (kinetic / first).ln() < FARTHEST {
            match self.completed(kinetic)? {
                None => (gains, stops) = (None, Some(kinetic)),
                Some(gain) if gain >= 0.0 => (gains, turned) = (Some(kinetic), true),
                Some(_) => {
                    if let Some(low) = gains {
                        return Ok((low, kinetic));
                    }
                    if let Some(stops) = stops.take()
                        && let Some(found) = self.near_stop(stops, kinetic)?
                    {
                        return Ok(found);
                    }
                    turned = true;
                }
            }
            kinetic *= step.exp();
            step = (2.0 * step).min(LONGEST);
        }
        Err(match (gains, turned) {
            (Some(_), _) => NoCycle::Gains,
            (None, true) => NoCycle::Stops,
            // No energy at all was enough: then it is not for want of energy.
            (None, false) => Unserved::NotSmooth.into(),
        })
    }

    /// The same between an energy whose turn is not completed and one that loses.
    fn near_stop(&mut self, stops: f64, loses: f64) -> Result<Option<(f64, f64)>, NoCycle> {
        let (mut stops, mut loses) = (stops, loses);
        for _ in 0..HALVINGS {
            let kinetic = (stops * loses).sqrt();
            match self.completed(kinetic)? {
                None => stops = kinetic,
                Some(gain) if gain >= 0.0 => return Ok(Some((kinetic, loses))),
                Some(_) => loses = kinetic,
            }
        }
        Ok(None)
    }

    /// d gain/d energy, by differences over three distances, and its error.
    fn slope(&mut self, kinetic: f64) -> Result<(f64, f64), Unserved> {
        let mut slope = Err(Unserved::TooSlow);
        for part in [2.5e-3, 1e-5, 1e-7] {
            slope = self.slope_over(kinetic, part);
            if slope.is_ok() {
                break;
            }
        }
        slope
    }

    fn slope_over(&mut self, kinetic: f64, part: f64) -> Result<(f64, f64), Unserved> {
        let mut slopes = [0.0; 3];
        let mut largest = kinetic;
        for (slope, times) in slopes.iter_mut().zip([1.0, 2.0, 4.0]) {
            let way = times * part * kinetic;
            let ahead = self.gain(kinetic + way)?;
            *slope = (ahead - self.gain(kinetic - way)?) / (2.0 * way);
            largest = largest.max(self.march.fastest());
        }
        // Richardson: the errors go with the second and fourth power of the distance.
        let better = [0, 1].map(|i| (4.0 * slopes[i] - slopes[i + 1]) / 3.0);
        let best = (16.0 * better[0] - better[1]) / 15.0;
        let noise = NOISE * largest / (part * kinetic);
        Ok((best, (best - better[0]).abs() + noise))
    }

    fn turn(&mut self, kinetic: f64) -> Result<Cycle, Unserved> {
        let speed = self.direction * (2.0 * kinetic / self.inertia).sqrt();
        let mut leg = Leg::open();
        let mut least = kinetic;
        self.march.restart(kinetic);
        loop {
            leg.push(self.march.panel()?.panel);
            least = least.min(self.march.kinetic);
            if self.march.at_turn() {
                break;
            }
        }
        let largest = self.march.fastest();
        Ok(Cycle {
            period: leg.duration.0,
            orbit: Orbit::one_way(self.start, speed, leg),
            speed,
            gain: self.march.gain,
            largest,
            uncertain: NOISE * largest / least,
            multiplier: 1.0,
            multiplier_error: 0.0,
            approached: true,
            evaluations: self.march.evaluations,
        })
    }
}
