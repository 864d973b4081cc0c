//! Record: samples of one or several sensors, combined at the nodes of a path.

use std::borrow::Cow;
use std::ops::Range;

use super::grid::Course;
use super::measurement_model::{Scale, Sensor, Shown, Turning};
use super::model::state_space::Observed;
use super::model::tone::Tone;
use super::quantised::{Codes, Interval};
use super::residual_tests::{self, FAR};
use crate::mechanism::Linkage;
use crate::numeric::ROUNDING_DEVIATION;
use crate::scene::Measured;

/// Least noise of an instrument, rad: none resolves the root of double rounding.
const INSTRUMENT_NOISE: f64 = 1.5e-8;

/// Samples of a sensor with their weights, and of the sensors beside it.
#[derive(Clone, Debug)]
pub(super) struct Record<'a> {
    pub sensor: Sensor<'a>,
    /// Sample times, s, rising.
    pub times: Cow<'a, [f64]>,
    /// Measured values less tones of the sensor, rad or m; a crank angle continued over the turns.
    pub values: Vec<f64>,
    /// Tones: those of the sensor are not in the values.
    pub tones: Vec<Tone>,
    /// Weight of each sample: precision over that of a full one; 0 for none.
    pub weights: Vec<f64>,
    /// Whether each sample, as it was measured, repeats the value before it.
    pub repeated: Vec<bool>,
    /// Step of the values, rad or m, if they are counted or rounded; else 0.
    pub step: f64,
    /// Whether the sensor holds values: those that repeat the one before do not count.
    pub holds: bool,
    /// Quantisation of the samples, if wider than the noise.
    pub codes: Option<Codes>,
    /// Intervals in the place of quantised samples, represented by normal distributions at `values`.
    pub intervals: Vec<Interval>,
    /// Standard deviations, s, of the times of the samples whose means these are; none of single ones.
    pub spreads: Vec<f64>,
    /// Times, s, and values, rad, of the samples that the intervals stand for.
    pub shown: Vec<[f64; 2]>,
    /// Other sensors of the motion.
    pub beside: Vec<SensorBeside<'a>>,
    /// Lower bound of the standard deviation of a sample, rad or m.
    pub floor: f64,
    /// Time of the scene at time 0 of the record, s.
    pub origin: f64,
}

/// Sensor beside that of the record, with values at times of the record.
#[derive(Clone, Debug)]
pub(super) struct SensorBeside<'a> {
    pub sensor: Sensor<'a>,
    /// Measured values, rad or m; NaN for none.
    pub values: Cow<'a, [f64]>,
    /// Standard deviation of a sample, rad or m; infinite while unknown.
    pub sigma: f64,
    /// Mean of the residuals, rad or m.
    pub mean: f64,
}

impl<'a> Record<'a> {
    /// Leaves out all but a range of samples.
    pub fn keep(&mut self, range: Range<usize>) {
        self.times = self.times[range.clone()].to_vec().into();
        self.values = self.values[range.clone()].to_vec();
        self.weights = self.weights[range.clone()].to_vec();
        self.spreads = self.spreads.get(range.clone()).unwrap_or_default().to_vec();
        self.repeated = self.repeated[range.clone()].to_vec();
        if let Some(first) = self.repeated.first_mut() {
            *first = false;
        }
        for sensor in &mut self.beside {
            sensor.values = sensor.values[range.clone()].to_vec().into();
        }
    }

    /// Returns the samples less their codes for another linkage and scale of the sensor, shifted by a zero, rad.
    pub fn moved<'b>(&self, linkage: &'b Linkage, scale: Scale, zero: f64) -> Record<'b>
    where
        'a: 'b,
    {
        let mut moved: Record<'b> = Record {
            codes: None,
            intervals: Vec::new(),
            shown: Vec::new(),
            ..self.clone()
        };
        moved.sensor = Sensor {
            linkage,
            scale,
            ..self.sensor
        };
        for value in &mut moved.values {
            *value += zero;
        }
        for other in &mut moved.beside {
            other.sensor.linkage = linkage;
        }
        moved
    }

    /// Returns this record with the intervals of its codes in the place of the samples.
    pub fn coded(&self, codes: Codes) -> Self {
        let intervals = codes.intervals(&self.times, &self.values);
        let shown = self.times.iter().zip(&self.values);
        Record {
            times: intervals.iter().map(|i| i.t).collect(),
            values: intervals.iter().map(|i| i.middle).collect(),
            tones: self.tones.clone(),
            weights: vec![1.0; intervals.len()],
            repeated: vec![false; intervals.len()],
            spreads: Vec::new(),
            intervals,
            shown: shown.map(|(t, value)| [*t, *value]).collect(),
            beside: Vec::new(),
            ..*self
        }
    }

    /// Returns the number of samples that count.
    pub fn counted(&self) -> f64 {
        self.weights.iter().filter(|weight| **weight > 0.0).count() as f64
    }

    /// Returns the number of samples whose means these are, but for outliers; none of single ones.
    pub fn stands_for(&self) -> Option<usize> {
        let all = self.weights.iter().sum::<f64>().round();
        (!self.spreads.is_empty()).then_some(all as usize)
    }

    /// Returns the indices of the samples with little weight because they are far off.
    pub fn outliers(&self) -> impl Iterator<Item = usize> {
        let far = (0..self.weights.len()).filter(|i| match self.intervals.get(*i) {
            Some(interval) => interval.middle.is_nan(),
            None => self.weights[*i] < 0.5,
        });
        far.map(|i| self.intervals.get(i).map_or(i, |interval| interval.sample))
    }

    /// Returns the weights of samples that are not far off: 1, or 0 for those that the sensor held.
    pub fn full_weights(&self) -> Vec<f64> {
        let weight = |repeats: &bool| f64::from(u8::from(!(self.holds && *repeats)));
        self.repeated.iter().map(weight).collect()
    }

    /// True if values repeat more often than their noise lets them, which has a density below 1/σ: by the deviance of their number as
    /// that of rare events. A value of 0 is not counted: at rest a speed repeats it.
    pub fn repeats_more_than_noise(&self) -> bool {
        let again = self.repeated.iter().zip(&self.values);
        let again = again.filter(|(repeats, value)| **repeats && **value != 0.0);
        let again = again.count() as f64;
        if again == 0.0 || self.is_computed() {
            return false;
        }
        // Two values may both be off by a step.
        let step = f64::max(2.0 * self.step, self.floor);
        let sigma = residual_tests::noise(&self.times, &self.values);
        let expected = self.values.len() as f64 * step / sigma;
        let deviance = 2.0 * (again * (again / expected).ln() - (again - expected));
        again > expected && deviance > FAR * FAR
    }

    /// True if the crank angle itself was measured, and nothing else.
    pub fn is_linear(&self) -> bool {
        self.sensor.measured == Measured::Theta && self.beside.is_empty()
    }

    /// Returns the noise, rad or m, below which samples were computed.
    pub fn instrument_noise(&self) -> f64 {
        INSTRUMENT_NOISE * self.sensor.size()
    }

    /// True if the samples were computed: their noise, that of their codes included, is below that of any instrument.
    pub fn is_computed(&self) -> bool {
        let noise = residual_tests::noise(&self.times, &self.values).max(self.floor);
        let widths = self.intervals.iter().map(|interval| interval.width);
        let of_codes = ROUNDING_DEVIATION * widths.fold(0.0, f64::max);
        self.codes.is_none() && noise.max(of_codes) < self.instrument_noise()
    }

    /// Returns two times that have the mean and the variance of those of the samples whose mean a sample is.
    pub fn times_of(&self, sample: usize) -> [f64; 2] {
        let (t, spread) = (self.times[sample], self.spreads.get(sample).unwrap_or(&0.0));
        [t - spread, t + spread]
    }

    /// Returns the mean deviation of the samples of a node from the nominal path; of several sensors, that of the angle by
    /// their information Σ w h′² and Σ w h′ r.
    pub fn observed(&self, path: &Course<'_>, node: usize, sigma: f64) -> Observed {
        let [theta, omega, _] = path.motion[node - path.first];
        let mut sums = [0.0; 5];
        for i in path.grid.first[node]..path.grid.first[node + 1] {
            let beside = self.beside.iter();
            let beside = beside.map(|other| {
                (
                    &other.sensor,
                    other.values[i],
                    (sigma / other.sigma).powi(2),
                )
            });
            let own = (&self.sensor, self.values[i], self.weights[i]);
            for (sensor, value, weight) in std::iter::once(own).chain(beside) {
                let off = |turning: Turning| {
                    let (residual, Shown { slope, .. }) = sensor.residual(value, turning);
                    [residual, slope]
                };
                let [residual, slope] = match self.spreads.is_empty() {
                    true => off([theta, omega]),
                    false => {
                        let [a, b] = self.times_of(i).map(|t| off(path.at(t)));
                        [0, 1].map(|k| 0.5 * (a[k] + b[k]))
                    }
                };
                if weight > 0.0 && residual.is_finite() && slope.is_finite() {
                    let parts = [1.0, residual, slope, slope * residual, slope * slope];
                    (0..5).for_each(|k| sums[k] += weight * parts[k]);
                }
            }
        }
        let [weight, residual, slope, both, square] = sums;
        let (weight, sum, slope) = match self.beside.is_empty() {
            true => (weight, residual, slope / weight),
            false => (square, both, 1.0),
        };
        Observed {
            residual: sum / weight,
            slope,
            variance: 1.0 / weight,
            is_speed: self.sensor.is_of_speed(),
        }
    }

    /// Replaces samples by the middles of their intervals, weighted by 1/width²: the information of passages from step
    /// to step, for any motion between them.
    pub fn take_middles(&mut self, codes: Codes) {
        self.codes = None;
        for (i, interval) in std::mem::take(&mut self.intervals).iter().enumerate() {
            self.weights[i] = 0.0;
            if interval.middle.is_finite() {
                self.values[i] = interval.middle;
                self.weights[i] = (codes.step / interval.width).powi(2);
            }
        }
    }
}
