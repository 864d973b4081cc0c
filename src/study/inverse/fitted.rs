//! The fit of θ(t), in terms of what was measured.

use super::pattern::Pattern;
use super::rounding::{Rounding, common_step, of_step};
use super::sensor::Sensor;
use crate::numeric::fit::{Curve, Kind, Samples, Size};
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement};

/// A fitted motion.
#[derive(Debug)]
pub(super) struct Fitted {
    pub curve: Curve,
    /// Measured minus fitted, rad or m.
    pub residuals: Vec<f64>,
    pub pattern: Pattern,
    /// Whether the fit came to rest.
    pub settled: bool,
    /// A measured crank angle, continued over the turns, rad.
    continued: Option<Vec<f64>>,
    /// Standard deviation of a sample by noise alone: rounding that is not noise is in the curve's errors.
    noise: f64,
    /// Standard deviation of a sample that was computed.
    computed: f64,
}

/// Corrections after which a fit counts as not settling.
const MOST: usize = 30;

/// Samples that show how far a motion is from settled, and from which very many are begun.
const PART: usize = 20_000;
/// The correction before which the terms are chosen again, when the motion is about right.
const LAST_CHOICE: usize = 3;

/// Units of rounding to which samples without noise are right, that were computed: a computed motion goes on with its
/// errors.
const ROUNDED: f64 = 2.0;

/// A correction below this part of a standard error settles a fit.
const SETTLED: f64 = 1e-3;

impl Fitted {
    /// Fits the motion. `theta`, rad, are the unfolded samples.
    ///
    /// Where the crank angle itself was not measured, this is Gauss and Newton's method: each sample is worth
    /// what the crank angle can be read from it, nothing at the dead centres.
    pub fn new(
        sensor: &Sensor<'_>,
        measurement: &Measurement,
        theta: Vec<f64>,
        kind: Kind,
        size: Size,
    ) -> Result<Fitted, String> {
        let digits = measurement.resolution();
        if let Some(step) = common_step(measurement.values(), digits) {
            let fitted = Fitted::to(sensor, measurement, theta.clone(), (kind, size), step);
            // Values on an even motion may have a common step without being rounded to it.
            if let Ok(fitted) = fitted.and_then(|f| {
                (f.left() >= 0.5 * of_step(step))
                    .then_some(f)
                    .ok_or_else(String::new)
            }) {
                return Ok(fitted);
            }
        }
        Fitted::to(sensor, measurement, theta, (kind, size), digits)
    }

    /// Fits the motion to values rounded to steps.
    fn to(
        sensor: &Sensor<'_>,
        measurement: &Measurement,
        theta: Vec<f64>,
        (kind, size): (Kind, Size),
        step: f64,
    ) -> Result<Fitted, String> {
        let (times, values) = (measurement.times(), measurement.values());
        let largest = |list: &[f64]| list.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let floor = of_step(step.max(f64::EPSILON * largest(values)));
        if sensor.measured == Measured::Theta {
            let samples = Samples {
                t: times,
                target: &theta,
                weight: None,
                // Continued over the turns the angles have fewer digits.
                floor: floor.max(of_step(f64::EPSILON * largest(&theta))),
            };
            let curve = Curve::fit(&samples, kind, size)?;
            let residuals = parallel::list(theta.len(), |i| theta[i] - curve.value(times[i]));
            let exact = |i: usize| (values[i] - residuals[i], 1.0);
            let exact = parallel::list(theta.len(), exact);
            let computed = ROUNDED * f64::EPSILON * largest(&theta);
            let mut fitted = Fitted::of(curve, residuals, true, computed);
            fitted.round(&samples, step, &exact)?;
            fitted.continued = Some(theta);
            return Ok(fitted);
        }
        let seen = Seen {
            sensor,
            times,
            values,
            floor,
        };
        let (theta, last_choice) = seen.start(theta, kind, size);
        let (curve, theta, settled) = seen.settle(theta, kind, size, last_choice)?;
        let seen = parallel::list(times.len(), |i| sensor.residual(values[i], theta[i]));
        let (residuals, slopes): (Vec<f64>, Vec<f64>) = seen.into_iter().unzip();
        let exact = parallel::list(times.len(), |i| {
            let sign = sensor.sign(values[i], theta[i]);
            (values[i] - sign * residuals[i], sign)
        });
        let computed =
            ROUNDED * f64::EPSILON * largest(values).max(largest(&theta) * largest(&slopes));
        let target = parallel::list(times.len(), |i| residuals[i] + slopes[i] * theta[i]);
        let samples = Samples {
            t: times,
            target: &target,
            weight: Some(&slopes),
            floor,
        };
        let mut fitted = Fitted::of(curve, residuals, settled, computed);
        fitted.round(&samples, step, &exact)?;
        Ok(fitted)
    }

    fn of(curve: Curve, residuals: Vec<f64>, settled: bool, computed: f64) -> Fitted {
        let quality = curve.quality();
        let pattern = Pattern::of(&residuals, quality.parameters, quality.floor);
        Fitted {
            curve,
            residuals,
            pattern,
            settled,
            continued: None,
            noise: quality.sigma,
            computed,
        }
    }

    /// Counts rounding of the samples to steps that is not noise as an error of the curve, and not as noise. `exact` has the
    /// values before rounding, with the sign with which each counts.
    fn round(
        &mut self,
        samples: &Samples<'_>,
        step: f64,
        exact: &[(f64, f64)],
    ) -> Result<(), String> {
        if let Some(rounding) = Rounding::of(step, exact.len(), self.left()) {
            self.curve.admit(samples, &rounding.errors(exact))?;
            self.noise = rounding.noise(self.noise);
            self.pattern.widening = 1.0;
        }
        Ok(())
    }

    /// Standard deviation of what the fit leaves of the samples.
    fn left(&self) -> f64 {
        let quality = self.curve.quality();
        let free = self.residuals.len() as f64 - quality.parameters;
        (quality.squares / free.max(1.0)).sqrt()
    }

    /// What was measured; a crank angle continued over the turns.
    pub fn measured(&self, measurement: &Measurement) -> Vec<f64> {
        match &self.continued {
            Some(theta) => theta.clone(),
            None => measurement.values().to_vec(),
        }
    }

    /// Standard deviation of a measured value by noise, widened where the residuals are not independent.
    pub fn sigma(&self) -> f64 {
        (self.noise * self.pattern.widening).hypot(self.computed)
    }
}

/// Samples of something that the crank angle is read from.
#[derive(Clone, Copy, Debug)]
struct Seen<'a> {
    sensor: &'a Sensor<'a>,
    times: &'a [f64],
    values: &'a [f64],
    /// Standard deviation of a value that is due to its digits alone.
    floor: f64,
}

impl Seen<'_> {
    /// A first motion and the correction before which its terms are chosen for the last time. For very many samples it
    /// is fitted to a part of them; it is the given one where that fails.
    fn start(&self, theta: Vec<f64>, kind: Kind, size: Size) -> (Vec<f64>, usize) {
        let stride = theta.len() / PART;
        if stride < 2 {
            return (theta, LAST_CHOICE);
        }
        let part = |list: &[f64]| -> Vec<f64> { list.iter().step_by(stride).copied().collect() };
        let (times, values) = (part(self.times), part(self.values));
        let few = Seen {
            times: &times,
            values: &values,
            ..*self
        };
        match few.settle(part(&theta), kind, size, LAST_CHOICE) {
            Ok((curve, _, true)) => {
                let near = parallel::list(theta.len(), |i| curve.value(self.times[i]));
                (near, 0)
            }
            _ => (theta, LAST_CHOICE),
        }
    }

    /// Corrects a motion until it fits: the curve, its angles, and whether it came to rest.
    fn settle(
        &self,
        mut theta: Vec<f64>,
        kind: Kind,
        size: Size,
        last_choice: usize,
    ) -> Result<(Curve, Vec<f64>, bool), String> {
        let rows = theta.len();
        let mut chosen: Option<Curve> = None;
        let mut round = 0;
        loop {
            let lines = parallel::list(rows, |i| {
                let (residual, slope) = self.sensor.residual(self.values[i], theta[i]);
                (slope, residual + slope * theta[i])
            });
            let (weight, target): (Vec<f64>, Vec<f64>) = lines.into_iter().unzip();
            let samples = Samples {
                t: self.times,
                target: &target,
                weight: Some(&weight),
                floor: self.floor,
            };
            // Once the motion is about right the choice of terms stays, so that it cannot go on alternating.
            let curve = match chosen {
                Some(curve) if round != last_choice => curve.again(&samples)?,
                _ => Curve::fit(&samples, kind, size)?,
            };
            let sigma = curve.quality().sigma;
            let change = (0..rows).step_by(1 + rows / PART).map(|i| {
                let state = curve.state(self.times[i]);
                let error = sigma * state.covariance[0].sqrt() + state.rounding[0];
                (state.value[0] - theta[i]).abs() / error.max(f64::MIN_POSITIVE)
            });
            let change = change.fold(0.0, f64::max);
            let next = parallel::list(rows, |i| {
                let theta = curve.value(self.times[i]);
                (theta, self.sensor.linkage.pose(theta).exists())
            });
            let (next, exists): (Vec<f64>, Vec<bool>) = next.into_iter().unzip();
            theta = next;
            if exists.contains(&false) {
                return Err("the fit leaves the angles that the crank can take".to_owned());
            }
            round += 1;
            if change < SETTLED && round > last_choice || round == MOST {
                return Ok((curve, theta, change < 1.0));
            }
            chosen = Some(curve);
        }
    }
}
