//! One turn: what it gains, how that changes with its energy, and its motion.

use super::march::March;
use super::{Driven, Resolution};
use crate::engine::energy::leg::Leg;
use crate::engine::energy::{Orbit, Unserved};
use crate::numeric::angle::Angle;

/// Relative error of a turn's gain by rounding, against its largest energy.
pub(super) const NOISE: f64 = 4e-15;

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

/// Turns of any energy.
pub(super) struct Turns<'a, D: Driven> {
    pub march: March<'a, D>,
    start: Angle,
    direction: f64,
    /// Inertia at the start, kg m²
    inertia: f64,
}

impl<'a, D: Driven> Turns<'a, D> {
    pub fn new(
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

    fn speed(&self, kinetic: f64) -> f64 {
        self.direction * (2.0 * kinetic / self.inertia).sqrt()
    }

    /// Energy that a turn gains, J.
    pub fn gain(&mut self, kinetic: f64) -> Result<f64, Unserved> {
        self.whole_turn(kinetic).map(|_| self.march.gain)
    }

    /// The panels of a turn, and the least energy at their points, J.
    fn whole_turn(&mut self, kinetic: f64) -> Result<(Leg, f64), Unserved> {
        let mut leg = Leg::open();
        let mut least = kinetic;
        self.march.restart(kinetic);
        loop {
            leg.push(self.march.panel()?.panel);
            least = least.min(self.march.least());
            if self.march.at_cycle() {
                return Ok((leg, least));
            }
        }
    }

    /// d gain/d energy, by differences over three distances, and its error.
    pub fn slope(&mut self, kinetic: f64) -> Result<(f64, f64), Unserved> {
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

    pub fn turn(&mut self, kinetic: f64) -> Result<Cycle, Unserved> {
        let (leg, least) = self.whole_turn(kinetic)?;
        let speed = self.speed(kinetic);
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
        })
    }
}
