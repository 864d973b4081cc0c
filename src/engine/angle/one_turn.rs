//! One cycle: what it gains, and its motion.

use super::super::energy::segment::Segment;
use super::fixed_point::CycleMap;
use super::stepper::PanelStepper;
use super::{Driven, Resolution};
use crate::engine::energy::{NotApplicable, Orbit};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::ROUNDING;

/// A cycle of some turns.
pub struct Cycle {
    /// Motion of the turn.
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
}

/// Cycles of any energy over the crank angle.
pub struct Turns<'a, D: Driven> {
    march: PanelStepper<'a, D>,
    start: Angle,
    direction: f64,
    /// Kinetic energy at the first speed, J.
    first: f64,
    /// Inertia at the start, kg m²
    inertia: f64,
}

impl<'a, D: Driven> Turns<'a, D> {
    /// From `angle` in the direction of `speed` (rad/s).
    ///
    /// # Errors
    /// [`NotApplicable`] where the angle cannot be the independent variable.
    pub fn new(
        driven: &'a D,
        angle: Angle,
        speed: f64,
        resolution: Resolution<'a>,
    ) -> Result<Turns<'a, D>, NotApplicable> {
        let start = angle.reduced();
        let march = PanelStepper::new(driven, start, speed, resolution)?;
        Ok(Turns {
            first: march.kinetic,
            inertia: 2.0 * march.kinetic / (speed * speed),
            march,
            start,
            direction: speed.signum(),
        })
    }

    fn speed(&self, kinetic: f64) -> f64 {
        self.direction * (2.0 * kinetic / self.inertia).sqrt()
    }

    /// The panels of a cycle, and the least energy at their points, J.
    fn whole_turn(&mut self, kinetic: f64) -> Result<(Segment, f64), NotApplicable> {
        let mut least = kinetic;
        let leg = self.march.cycle(kinetic, |march| {
            least = least.min(march.least());
            Ok(())
        })?;
        Ok((leg, least))
    }

    /// The cycle that begins with a kinetic energy, J.
    ///
    /// # Errors
    /// [`NotApplicable`] where the crank does not complete it.
    pub fn turn(&mut self, kinetic: f64) -> Result<Cycle, NotApplicable> {
        let (leg, least) = self.whole_turn(kinetic)?;
        let speed = self.speed(kinetic);
        let largest = self.march.fastest;
        Ok(Cycle {
            period: leg.duration.0,
            orbit: Orbit::one_way(self.start, speed, leg),
            speed,
            gain: self.march.gain,
            largest,
            uncertain: ROUNDING * largest / least,
        })
    }
}

impl<D: Driven> CycleMap for Turns<'_, D> {
    fn first(&self) -> f64 {
        self.first
    }

    fn gain(&mut self, kinetic: f64) -> Result<f64, NotApplicable> {
        self.whole_turn(kinetic).map(|_| self.march.gain)
    }

    fn largest(&self) -> f64 {
        self.march.fastest
    }

    fn noise(&self) -> f64 {
        ROUNDING
    }
}
