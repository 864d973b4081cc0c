//! Samples rounded to steps, so dense that many lie within each.
//!
//! Rounding errors of samples within one step are not independent: all that these tell is when the motion passes the
//! border to the next step, to the time between two samples. There the value is known, the middle of the two steps, and
//! with it the crank angle. Curves are fitted to these passages (as encoders are read by the times of their pulses;
//! Merry, van de Molengraft and Steinbuch, Mechatronics 20 (2010) 20). The time of a passage is uncertain as if rounded
//! to the times of samples, the crank angle there by that times the speed.

use super::rounding::{Rounding, of_step};
use super::sensor::Sensor;
use crate::numeric::fit::{Curve, Kind, Samples, Size};
use crate::numeric::median::median;
use crate::numeric::parallel;

/// Fewest samples for each passage, on average.
const DENSE: usize = 4;

/// Fewest passages that are fitted.
const FEWEST: usize = 64;

/// Part of the passages of which the motion may turn back at once: more of them are noise.
const BACK: f64 = 0.02;

/// Part of a step by which a change may differ from one.
const ALIKE: f64 = 1e-3;

/// Times the usual time between samples from which on it is a gap.
const GAP: f64 = 1.5;

/// Passages of a motion from one step to the next.
#[derive(Debug)]
pub(super) struct Passages {
    /// Middle between the two samples, s.
    t: Vec<f64>,
    /// Crank angle, rad, times the weight.
    target: Vec<f64>,
    /// Inverse to what the time between the samples makes uncertain.
    weight: Vec<f64>,
    /// What the median of the times between the samples is of the crank angle, rad.
    step: f64,
    /// Time from sample to sample if they are even, s.
    even: Option<f64>,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
struct Passage {
    t: f64,
    /// Time between the samples, s.
    between: f64,
    /// rad
    theta: f64,
}

impl Passages {
    /// Those of values rounded to steps, with crank angles (rad) that belong to them; none where there is nothing but steps
    /// to tell where they lie.
    pub fn of(
        sensor: &Sensor<'_>,
        times: &[f64],
        values: &[f64],
        theta: &[f64],
        step: f64,
    ) -> Option<Passages> {
        let found = found(sensor, [times, values, theta], step)?;
        if found.len() < FEWEST || are_noise(&found) {
            return None;
        }
        let speeds =
            (0..found.len()).map(|i| speed(&found[i.saturating_sub(1)..found.len().min(i + 2)]));
        let known: Vec<(Passage, f64)> = found.iter().copied().zip(speeds).collect();
        let known: Vec<(Passage, f64)> = known
            .into_iter()
            .map(|(passage, speed)| (passage, speed * passage.between))
            .filter(|(_, uncertain)| *uncertain > 0.0)
            .collect();
        let step = median(known.iter().map(|(_, uncertain)| *uncertain))?;
        let weight: Vec<f64> = known
            .iter()
            .map(|(_, uncertain)| step / uncertain)
            .collect();
        let pairs = known.iter().zip(&weight);
        Some(Passages {
            t: known.iter().map(|(passage, _)| passage.t).collect(),
            target: pairs
                .map(|((passage, _), weight)| weight * passage.theta)
                .collect(),
            weight,
            step,
            even: even(times),
        })
    }

    /// How many they are.
    pub fn len(&self) -> usize {
        self.t.len()
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
        let left = parallel::list(self.len(), |i| self.target[i] - self.weight[i] * values[i]);
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
        let Some(rounding) = Rounding::of(self.step, self.len(), left, parameters) else {
            return Ok(None);
        };
        let speeds: Vec<f64> = parallel::list(self.len(), |i| curve.state(self.t[i]).value[1]);
        curve.admit(&self.samples(), &|chosen, left| {
            let exact = parallel::list(chosen.len(), |k| {
                let i = chosen[k];
                let sign = speeds[i].signum();
                (self.step * (self.t[i] / period) + sign * left[k], sign)
            });
            rounding.errors(&exact)
        })?;
        Ok(Some(rounding))
    }
}

/// The passages of times, values and crank angles; none where samples are few, or values change by other than steps.
fn found(
    sensor: &Sensor<'_>,
    [times, values, theta]: [&[f64]; 3],
    step: f64,
) -> Option<Vec<Passage>> {
    let usual = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let mut found = Vec::new();
    for i in 1..times.len() {
        let change = (values[i] - values[i - 1]).abs();
        if change < (1.0 - ALIKE) * step {
            continue;
        }
        if change > (1.0 + ALIKE) * step {
            if times[i] - times[i - 1] > GAP * usual {
                continue;
            }
            return None;
        }
        let border = 0.5 * (values[i - 1] + values[i]);
        found.extend(
            sensor
                .between(border, [theta[i - 1], theta[i]])
                .map(|theta| Passage {
                    t: 0.5 * (times[i - 1] + times[i]),
                    between: times[i] - times[i - 1],
                    theta,
                }),
        );
        if DENSE * found.len() > values.len() {
            return None;
        }
    }
    Some(found)
}

/// Whether noise takes values over the same border back and forth: for a time short beside that for the next steps.
fn are_noise(passages: &[Passage]) -> bool {
    let back = passages.windows(4).filter(|list| {
        let time = |i: usize| list[i + 1].t - list[i].t;
        list[1].theta == list[2].theta && 2.0 * time(1) < time(0).min(time(2))
    });
    back.count() as f64 > BACK * passages.len() as f64
}

/// Speed at the middle one of neighbouring passages, rad/s.
fn speed(passages: &[Passage]) -> f64 {
    let way: f64 = passages
        .windows(2)
        .map(|pair| (pair[1].theta - pair[0].theta).abs())
        .sum();
    way / (passages[passages.len() - 1].t - passages[0].t)
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
