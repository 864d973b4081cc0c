//! The collocation on one panel: K' = F(θ) + L(θ, ω, t), t' = 1/ω at the points of the panel.

use super::Driven;
use super::newton::correction;
use super::station::Station;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MOST, Series, Values};

/// The state at the start of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Start {
    /// s
    pub t: f64,
    /// J
    pub kinetic: f64,
    /// Whole turns beside the angles of the panel.
    pub turns: f64,
    /// Sign of the speed.
    pub direction: f64,
}

/// The motion on a panel.
pub(super) struct Swept {
    /// J, at the points.
    pub kinetic: Values,
    /// dt/dx at the points.
    pub slopes: Values,
    /// Its series.
    pub slope: Series,
    /// Force without a potential at the points, N m.
    pub spent: Values,
    /// Kinetic energy that is gained, J.
    pub gain: f64,
    /// Kinetic energy at the end, J.
    pub end: f64,
    /// Evaluations of the loads.
    pub evaluations: u64,
}

/// Most sweeps over a panel.
const MOST_SWEEPS: u32 = 40;
/// Sweeps that gain less than this factor give way to Newton's method.
const SLOW: f64 = 0.3;

/// Why a panel is not solved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unsolved {
    /// It is too long for its degree.
    TooLong,
    /// The crank seems to stop on it.
    Stops,
}

/// Solves a panel to a part `tail`.
pub(super) fn sweep<D: Driven>(
    driven: &D,
    station: &Station<D::Place>,
    start: Start,
    tail: f64,
) -> Result<Swept, Unsolved> {
    let half = station.half();
    let count = station.rule.degree() + 1;
    let mut kinetic = station.guess(start.kinetic);
    let mut newton = false;
    let mut before = f64::INFINITY;
    let mut evaluations = 0;
    for _ in 0..MOST_SWEEPS {
        let slopes = slopes(station, &kinetic).ok_or(Unsolved::TooLong)?;
        let forces = Forces::new(driven, station, start, &slopes);
        evaluations += count as u64;
        let gained = station.rule.integrals(&forces.total);
        let mut change: Values =
            std::array::from_fn(|j| start.kinetic + half * gained[j] - kinetic[j]);
        if newton {
            let rates = forces.rates(driven, station, start, &slopes);
            correction(station.rule, half, &rates, &mut change).ok_or(Unsolved::TooLong)?;
            keep_positive(&kinetic, &mut change);
        }
        let mut largest: f64 = 0.0;
        for j in 0..count {
            kinetic[j] += change[j];
            largest = largest.max((change[j] / kinetic[j]).abs());
            if kinetic[j].is_nan() {
                return Err(Unsolved::TooLong);
            }
            if kinetic[j] <= 0.0 {
                return Err(Unsolved::Stops);
            }
        }
        // What is left is smaller than the last change by the factor that was gained.
        let factor = if before.is_finite() {
            largest / before
        } else {
            SLOW
        };
        let left = largest * if newton { factor.min(SLOW) } else { factor };
        let at_rounding = largest < 1e-14 && largest >= 0.3 * before;
        if left <= tail || at_rounding {
            let mut swept = finish(driven, station, start, kinetic, tail, evaluations)
                .ok_or(Unsolved::TooLong)?;
            if !newton {
                // One sweep better than the last point; under steep loads it would be worse.
                swept.end = start.kinetic + swept.gain;
            }
            return Ok(swept);
        }
        newton |= before.is_finite() && largest > SLOW * before;
        before = largest;
    }
    Err(Unsolved::TooLong)
}

/// Shortens a change that would leave less than a tenth of the kinetic energy somewhere.
fn keep_positive(kinetic: &Values, change: &mut Values) {
    let share = |k: f64, c: f64| if c < -0.9 * k { -0.9 * k / c } else { 1.0 };
    let pairs = kinetic.iter().zip(change.iter());
    let least = pairs.fold(1.0f64, |least, (k, c)| least.min(share(*k, *c)));
    if least < 1.0 {
        for c in change {
            *c *= least;
        }
    }
}

fn finish<D: Driven>(
    driven: &D,
    station: &Station<D::Place>,
    start: Start,
    kinetic: Values,
    tail: f64,
    evaluations: u64,
) -> Option<Swept> {
    let half = station.half();
    let slopes = slopes(station, &kinetic)?;
    let slope = station.rule.series(&slopes);
    let noise = 8.0 * f64::EPSILON * (1.0 + station.piece.from.abs() / half.abs());
    let accepted = tail.max(noise);
    if slope.tail() > accepted {
        return None;
    }
    let forces = Forces::new(driven, station, start, &slopes);
    let series = station.rule.series(&forces.total);
    let share = series.largest() * half.abs() / start.kinetic;
    // Large forces that balance each other leave their rounding.
    let noise = 64.0 * f64::EPSILON * forces.largest_part(station) * half.abs() / start.kinetic;
    if series.tail() * share.min(1.0) > tail + noise && series.tail() > accepted {
        return None;
    }
    Some(Swept {
        end: kinetic[station.rule.degree()],
        kinetic,
        slope,
        slopes,
        spent: forces.spent,
        gain: half * station.rule.rounded_integral(&forces.total),
        evaluations: evaluations + station.rule.degree() as u64 + 1,
    })
}

/// dt/dx at the points; none where the kinetic energy is not positive.
fn slopes<P>(station: &Station<P>, kinetic: &Values) -> Option<Values> {
    let half = 0.5 * (station.piece.to - station.piece.from).abs();
    let mut slopes = [0.0; MOST + 1];
    let mut sum = 0.0;
    for j in 0..=station.rule.degree() {
        slopes[j] = half * (0.5 * station.table.inertia[j] / kinetic[j]).sqrt();
        sum += slopes[j];
    }
    // One value that is not finite makes the sum so.
    sum.is_finite().then_some(slopes)
}

/// Forces at the points of a panel, N m.
struct Forces {
    total: Values,
    spent: Values,
    times: Values,
}

impl Forces {
    fn new<D: Driven>(
        driven: &D,
        station: &Station<D::Place>,
        start: Start,
        slopes: &Values,
    ) -> Forces {
        let table = &station.table;
        let length = start.direction * station.half().abs();
        let mut forces = Forces {
            total: [0.0; MOST + 1],
            spent: [0.0; MOST + 1],
            times: [0.0; MOST + 1],
        };
        for (j, slope) in slopes.iter().enumerate().take(station.rule.degree() + 1) {
            forces.spent[j] = table.push[j] - table.damping[j] * (length / slope);
        }
        if let Some(switch) = &table.switch {
            for (j, slope) in slopes.iter().enumerate().take(station.rule.degree() + 1) {
                forces.spent[j] += switch.force[j] * (length / slope).powi(2);
            }
        }
        if driven.is_driven() {
            if driven.reads_time() {
                forces.times = station.rule.integrals(slopes);
            }
            for (j, x) in station.rule.points().iter().enumerate() {
                let speed = length / slopes[j];
                forces.spent[j] += forces.drive(driven, station, start, j, *x, speed);
            }
        }
        for j in 0..=station.rule.degree() {
            forces.total[j] = table.force[j] + forces.spent[j];
        }
        forces
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
        let angle = Angle {
            turns: start.turns,
            rest: station.piece.angle(x),
        };
        let place = &station.table.places[j];
        driven.drive(place, start.t + self.times[j], angle, speed)
    }

    /// The largest force that has a potential, N m: at balance the others are as large.
    fn largest_part<P>(&self, station: &Station<P>) -> f64 {
        let force = station.table.force.iter().take(station.rule.degree() + 1);
        force.fold(0.0f64, |largest, force| largest.max(force.abs()))
    }

    /// Derivatives of the forces with respect to the kinetic energy at the points, 1/rad.
    fn rates<D: Driven>(
        &self,
        driven: &D,
        station: &Station<D::Place>,
        start: Start,
        slopes: &Values,
    ) -> Values {
        const STEP: f64 = 1e-6;
        let table = &station.table;
        let length = start.direction * station.half().abs();
        let mut rates = [0.0; MOST + 1];
        for (j, x) in station.rule.points().iter().enumerate() {
            let speed = length / slopes[j];
            let mut rate = -table.damping[j];
            if driven.is_driven() {
                let at = |speed: f64| self.drive(driven, station, start, j, *x, speed);
                let (less, more) = (speed * (1.0 - STEP), speed * (1.0 + STEP));
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
