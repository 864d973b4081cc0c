//! Samples rounded to steps, so dense that many lie within each.
//!
//! Rounding errors of samples within one step are not independent: all that these tell is when the motion passes the
//! border to the next step, to the time between two samples. There the value is known, the middle of the two steps, and
//! with it the crank angle. Curves are fitted to these passages (as encoders are read by the times of their pulses;
//! Merry, van de Molengraft and Steinbuch, Mechatronics 20 (2010) 20). The time of a passage is uncertain as if rounded
//! to the times of samples, the crank angle there by that times the speed. Slight noise takes values over a border and
//! back: the time of the passage is then the one before which as many samples are beyond the border as are short of it after
//! it.

mod crossings;

use std::f64::consts::PI;

use super::rounding::{Rounding, of_step};
use super::sensor::Sensor;
use crate::numeric::chebyshev::largest;
use crate::numeric::fit::{Curve, Dependent, Kind, Samples, Size};
use crate::numeric::median::median;
use crate::numeric::{parallel, root};
use crossings::{Passage, speeds};

/// Fewest passages that are fitted.
const FEWEST: usize = 64;

/// Part of the passages that may have more than one change of steps before that tells noise.
const FEW: f64 = 0.02;

/// Distance of crank angles whose difference tells how the slope changes, rad.
const NEAR: f64 = 1e-3;

/// Part of the time from sample to sample by which even times may be off. Half or twice as much changes no fit of 54 records.
const ALIKE: f64 = 1e-3;

/// Passages of a motion from one step to the next.
#[derive(Debug)]
pub(super) struct Passages {
    /// Times, s: those of passages, and of a few samples where these are far apart and at the ends.
    t: Vec<f64>,
    /// Crank angle, rad, times the weight.
    target: Vec<f64>,
    /// Inverse to what the time between the samples makes uncertain.
    weight: Vec<f64>,
    /// What the median of the times between the samples is of the crank angle, rad.
    step: f64,
    /// How many are passages.
    number: usize,
    /// Time from sample to sample if they are even, s.
    even: Option<f64>,
}

impl Passages {
    /// Those of values rounded to steps of a width, rad or m, with crank angles (rad) that belong to them; none where samples
    /// are too few for each step or too noisy.
    pub fn of(
        sensor: &Sensor<'_>,
        times: &[f64],
        values: &[f64],
        theta: &[f64],
        width: f64,
    ) -> Option<Passages> {
        if width <= 0.0 {
            return None;
        }
        let found = crossings::passages(sensor, [times, values, theta], width)?;
        if found.len() < FEWEST {
            return None;
        }
        let growth = |(passage, speed): &(Passage, f64)| {
            (sensor.shown(passage.theta).1 * speed * passage.between).abs()
        };
        let mut known: Vec<(Passage, f64)> = found.iter().copied().zip(speeds(&found)).collect();
        known.retain(|passage| growth(passage) > 0.0 && passage.1.is_finite());
        let growths: Vec<f64> = known.iter().map(growth).collect();
        let changes = known
            .iter()
            .map(|(passage, _)| passage.changes as f64)
            .sum();
        let noise = noise(changes, &growths);
        let clean = |(passage, speed): &(Passage, f64)| passage.between * speed;
        let unit = median(known.iter().map(clean))?;
        let weight = known
            .iter()
            .zip(&growths)
            .map(|(passage, growth)| unit / clean(passage) / widened(noise / growth).sqrt());
        let passages = known.iter().map(|(passage, _)| [passage.t, passage.theta]);
        let mut rows: Vec<[f64; 3]> = passages
            .zip(weight)
            .map(|([t, theta], w)| [t, theta, w])
            .collect();
        let number = rows.len();
        let between = crossings::far_between(times, &rows)?;
        rows.extend(between.into_iter().map(|i| {
            let weight = unit / within(sensor, theta[i], width);
            let weight = if weight.is_finite() { weight } else { 0.0 };
            [times[i], theta[i], weight]
        }));
        rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Some(Passages {
            t: rows.iter().map(|[t, ..]| *t).collect(),
            target: rows
                .iter()
                .map(|[_, theta, weight]| weight * theta)
                .collect(),
            weight: rows.iter().map(|[.., weight]| *weight).collect(),
            step: unit,
            number,
            // Noise spreads passages over the times of samples.
            even: even(times).filter(|_| noise == 0.0),
        })
    }

    /// How many passages they are.
    pub fn number(&self) -> usize {
        self.number
    }

    /// As samples of the crank angle.
    pub fn samples(&self) -> Samples<'_> {
        Samples {
            t: &self.t,
            target: &self.target,
            weight: Some(&self.weight),
            floor: of_step(self.step),
        }
    }

    /// The curve that fits them, and what it leaves.
    pub fn fit(&self, kind: Kind, size: Size) -> Result<(Curve, Vec<f64>), String> {
        let curve = Curve::fit(&self.samples(), kind, size)?;
        let values = curve.values(&self.t);
        let left = parallel::list(self.t.len(), |i| {
            self.target[i] - self.weight[i] * values[i]
        });
        Ok((curve, left))
    }

    /// What a curve with so much more of the crank angle, rad, leaves of one of them, and by how much that falls with it.
    pub fn line(&self, curve: &Curve, i: usize, more: f64) -> (f64, f64) {
        let weight = self.weight[i];
        (
            self.target[i] - weight * (curve.value(self.t[i]) + more),
            weight,
        )
    }

    /// Counts what is not noise of the rounding of even times as an error of a curve: where the motion takes
    /// about a whole number of samples for a step, passages beside each other are off by about the same.
    pub fn round(&self, curve: &mut Curve, left: f64) -> Result<Option<Rounding>, String> {
        let Some(period) = self.even else {
            return Ok(None);
        };
        let parameters = curve.quality().parameters;
        let Some(rounding) = Rounding::of(self.step, self.t.len(), left, parameters) else {
            return Ok(None);
        };
        let speeds: Vec<f64> = parallel::list(self.t.len(), |i| curve.state(self.t[i]).value[1]);
        let error = |place: usize, chosen: &[usize], left: &[f64]| {
            let exact = parallel::list(chosen.len(), |k| {
                let i = chosen[k];
                let sign = speeds[i].signum();
                // A time that is too late counts as an angle that is too small.
                (self.step * (self.t[i] / period) + sign * left[k], -sign)
            });
            rounding.error(place, &exact)
        };
        let errors = Dependent {
            number: rounding.places(),
            error: &error,
        };
        curve.admit(&self.samples(), errors)?;
        Ok(Some(rounding))
    }
}

/// Standard deviation of noise in the measured values, if they go back and forth over borders, for so many changes of
/// steps and for how much the value grows from sample to sample at each passage.
///
/// Noise of s times that growth makes about √(1 + (2s/√π)²) changes of a passage.
fn noise(changes: f64, growths: &[f64]) -> f64 {
    if changes <= (1.0 + FEW) * growths.len() as f64 {
        return 0.0;
    }
    let rate = 2.0 / PI.sqrt();
    let expected = |noise: f64| -> f64 {
        growths
            .iter()
            .map(|growth| 1.0f64.hypot(rate * noise / growth))
            .sum()
    };
    let most = changes * largest(growths);
    root::bracketed(|noise| expected(noise) - changes, 0.0, most).unwrap_or(most)
}

/// Variance of the time of a passage beside that by times of samples alone, for noise of so many times what the value grows
/// from sample to sample: 1/12 of a sample's time squared without noise, s/√π of it with much.
fn widened(s: f64) -> f64 {
    1.0f64.hypot(12.0 / PI.sqrt() * s)
}

/// How far a crank angle, rad, may be off that was read from a value rounded to steps of a width: at a fold a small change of
/// the value is a large one of the angle.
fn within(sensor: &Sensor<'_>, theta: f64, width: f64) -> f64 {
    let slope = |theta: f64| sensor.shown(theta).1;
    let bend = (slope(theta + NEAR) - slope(theta - NEAR)).abs() / (2.0 * NEAR);
    let slope = slope(theta).abs();
    2.0 * width / (slope + (slope * slope + 2.0 * bend * width).sqrt())
}

/// The time from sample to sample, s, if it is the same throughout.
fn even(times: &[f64]) -> Option<f64> {
    let last = times.len() - 1;
    let period = (times[last] - times[0]) / last as f64;
    let off = |i: usize| (times[i] - times[0] - period * i as f64).abs();
    (0..=last)
        .all(|i| off(i) < ALIKE * period)
        .then_some(period)
}
