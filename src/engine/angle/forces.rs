//! The forces at the points of a panel.

use super::Driven;
use super::panel::Station;
use super::sweep::Start;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MAX_DEGREE, Values};
use crate::numeric::enclosure::Interval;

/// Forces at the points of a panel, N m.
#[derive(Clone)]
pub(super) struct Forces {
    pub total: Values,
    /// Forces without a potential.
    pub spent: Values,
    /// rad/s
    speeds: Values,
    /// s after the start of the panel
    times: Values,
}

impl Forces {
    pub fn new() -> Forces {
        let zero = [0.0; MAX_DEGREE + 1];
        Forces {
            total: zero,
            spent: zero,
            speeds: zero,
            times: zero,
        }
    }

    /// From the kinetic energy there, J. None where they are not known.
    pub fn evaluate<D: Driven>(
        &mut self,
        driven: &D,
        station: &Station<D::Place>,
        start: Start,
        kinetic: &Values,
    ) -> Option<()> {
        let count = station.rule.degree() + 1;
        self.clear_from(count);
        self.take_speeds(station, start, kinetic);
        let (push, damping) = (
            &station.table.push[..count],
            &station.table.damping[..count],
        );
        let (speeds, spent) = (&self.speeds[..count], &mut self.spent[..count]);
        for j in 0..count {
            spent[j] = push[j] - damping[j] * speeds[j];
        }
        if let Some(switch) = &station.table.switch {
            for j in 0..count {
                spent[j] += switch.force[j] * (speeds[j] * speeds[j]);
            }
        }
        if driven.is_driven() {
            if driven.reads_time() {
                let mut slopes = [0.0; MAX_DEGREE + 1];
                self.fill_slopes(station, &mut slopes)?;
                self.times = station.rule.integrals(&slopes);
            }
            for (j, x) in station.rule.points().iter().enumerate() {
                self.spent[j] += self.drive(driven, station, start, j, *x, self.speeds[j]);
            }
        }
        let (force, spent) = (&station.table.force[..count], &self.spent[..count]);
        let total = &mut self.total[..count];
        for j in 0..count {
            total[j] = force[j] + spent[j];
        }
        is_finite(total).then_some(())
    }

    /// Takes the speeds at the points from the kinetic energy there, J.
    pub fn take_speeds<P: Copy>(&mut self, station: &Station<P>, start: Start, all: &Values) {
        let count = station.rule.degree() + 1;
        let (kinetic, mobility) = (&all[..count], &station.mobility[..count]);
        let speeds = &mut self.speeds[..count];
        for j in 0..count {
            speeds[j] = start.direction * (kinetic[j] * mobility[j]).sqrt();
        }
    }

    /// Least and largest speed at the first points, rad/s.
    pub fn speed_range(&self, count: usize) -> Interval {
        let points = self.speeds[..count].iter().copied().map(Interval::point);
        points.reduce(Interval::hull).unwrap_or_default()
    }

    /// |dt/dx| at the points.
    pub fn fill_slopes<P: Copy>(&self, station: &Station<P>, slopes: &mut Values) -> Option<()> {
        let half = station.half();
        let (filled, rest) = slopes.split_at_mut(station.rule.degree() + 1);
        rest.fill(0.0);
        for (slope, speed) in filled.iter_mut().zip(&self.speeds) {
            *slope = half / speed;
        }
        is_finite(filled).then_some(())
    }

    /// What is beyond the points is zero.
    fn clear_from(&mut self, count: usize) {
        for values in [&mut self.total, &mut self.spent, &mut self.speeds] {
            values[count..].fill(0.0);
        }
    }

    fn drive<D: Driven>(
        &self,
        driven: &D,
        station: &Station<D::Place>,
        start: Start,
        j: usize,
        x: f64,
        speed: f64,
    ) -> f64 {
        let angle = Angle::new(start.turns, station.piece.angle(x));
        let place = &station.table.places[j];
        driven.drive(place, start.t + self.times[j], angle, speed)
    }

    /// Derivatives of the forces with respect to the kinetic energy at the points, 1/rad.
    pub fn rates<D: Driven>(
        &self,
        driven: &D,
        station: &Station<D::Place>,
        start: Start,
    ) -> Values {
        // The error of a central difference is least for this step.
        let step = f64::EPSILON.cbrt();
        let table = &station.table;
        let mut rates = [0.0; MAX_DEGREE + 1];
        for (j, x) in station.rule.points().iter().enumerate() {
            let speed = self.speeds[j];
            let mut rate = -table.damping[j];
            if driven.is_driven() {
                let at = |speed: f64| self.drive(driven, station, start, j, *x, speed);
                let (less, more) = (speed * (1.0 - step), speed * (1.0 + step));
                rate += (at(more) - at(less)) / (more - less);
            }
            if let Some(switch) = &table.switch {
                rate += 2.0 * switch.force[j] * speed;
            }
            rates[j] = rate / (table.inertia[j] * speed);
        }
        rates
    }
}

/// Whether all values are: one that is not makes their sum so.
fn is_finite(values: &[f64]) -> bool {
    values.iter().sum::<f64>().is_finite()
}
