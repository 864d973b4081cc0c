//! The fit of θ(t), in terms of what was measured.

use super::errors::Errors;
use super::rounding::{Rounding, common_step, of_step};
use super::sensor::Sensor;
use crate::numeric::fit::{Curve, Kind, Samples, Size, State};
use crate::numeric::parallel;
use crate::scene::{Measured, Measurement};

/// A fitted motion.
#[derive(Debug)]
pub(super) struct Fitted {
    pub curve: Curve,
    /// Measured minus fitted, rad or m.
    pub residuals: Vec<f64>,
    pub errors: Errors,
    /// Whether the fit came to rest.
    pub settled: bool,
    /// A measured crank angle, continued over the turns, rad.
    continued: Option<Vec<f64>>,
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

/// A fit is settled where further corrections would change it by less than this part of a standard error.
const SETTLED: f64 = 1e-3;

/// Way of a fit from the crank angles that the samples were unfolded to, rad, beyond which it fits other ones.
const ASTRAY: f64 = 0.5 * std::f64::consts::PI;

/// Units of rounding below which corrections do not shrink any more.
const NOTHING: f64 = 4.0;

/// A correction below this part of the one before it tells that the next one will be as much smaller again.
const FAST: f64 = 0.01;

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
            if let Ok(fitted) = fitted
                && fitted.left() >= 0.5 * of_step(step)
            {
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
            let computed = ROUNDED * f64::EPSILON * largest(&theta);
            let line =
                |curve: &Curve, i: usize, more: f64| (theta[i] - curve.value(times[i]) - more, 1.0);
            let mut fitted = Fitted::of(curve, residuals, &samples, computed, line);
            fitted.round(sensor, values, &samples, step)?;
            fitted.continued = Some(theta);
            return Ok(fitted);
        }
        let seen = Seen {
            sensor,
            times,
            values,
            floor,
        };
        let (curve, [slopes, target, residuals], settled) = match seen.start(&theta, kind, size) {
            Some(near) => {
                drop(theta);
                seen.settle(|i| near.value(times[i]), kind, size, 0)?
            }
            None => seen.settle(|i| theta[i], kind, size, LAST_CHOICE)?,
        };
        let reached =
            (0..times.len()).fold(0.0f64, |most, i| most.max((target[i] - residuals[i]).abs()));
        let computed = ROUNDED * f64::EPSILON * largest(values).max(reached);
        let samples = Samples {
            t: times,
            target: &target,
            weight: Some(&slopes),
            floor,
        };
        let line = |curve: &Curve, i: usize, more: f64| {
            sensor.residual(values[i], curve.value(times[i]) + more)
        };
        let mut fitted = Fitted::of(curve, residuals, &samples, computed, line);
        fitted.settled = settled;
        fitted.round(sensor, values, &samples, step)?;
        Ok(fitted)
    }

    fn of(
        mut curve: Curve,
        residuals: Vec<f64>,
        samples: &Samples<'_>,
        computed: f64,
        line: impl Fn(&Curve, usize, f64) -> (f64, f64),
    ) -> Fitted {
        Fitted {
            errors: Errors::of(&mut curve, samples, &residuals, computed, line),
            curve,
            residuals,
            settled: true,
            continued: None,
        }
    }

    /// The motion at a time, rad and s.
    pub fn state(&self, t: f64) -> State {
        self.errors.state(&self.curve, t)
    }

    /// Counts rounding of the measured values to steps that is not noise as an error of the curve, and not as noise.
    fn round(
        &mut self,
        sensor: &Sensor<'_>,
        values: &[f64],
        samples: &Samples<'_>,
        step: f64,
    ) -> Result<(), String> {
        let parameters = self.curve.quality().parameters;
        let Some(rounding) = Rounding::of(step, values.len(), self.left(), parameters) else {
            return Ok(());
        };
        let (curve, residuals) = (&self.curve, &self.residuals);
        // Values before rounding, with the sign with which each counts.
        let exact = parallel::list(values.len(), |i| {
            let sign = sensor.sign(values[i], || curve.value(samples.t[i]));
            (values[i] - sign * residuals[i], sign)
        });
        let errors = rounding.errors(&exact);
        self.curve.admit(samples, &errors)?;
        self.errors.without(&rounding);
        Ok(())
    }

    /// Standard deviation of what the fit leaves of the samples.
    pub fn left(&self) -> f64 {
        let quality = self.curve.quality();
        let free = self.residuals.len() as f64 - quality.parameters;
        (quality.squares / free.max(1.0)).sqrt()
    }

    /// What was measured; a crank angle continued over the turns.
    pub fn measured<'a>(&'a self, measurement: &'a Measurement) -> &'a [f64] {
        match &self.continued {
            Some(theta) => theta,
            None => measurement.values(),
        }
    }
}

fn largest(list: &[f64]) -> f64 {
    list.iter().fold(0.0, |most, value| most.max(value.abs()))
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
    /// A motion near the one of very many samples, fitted to a part of them; none where that fails.
    fn start(&self, theta: &[f64], kind: Kind, size: Size) -> Option<Curve> {
        let stride = theta.len() / PART;
        if stride < 2 {
            return None;
        }
        let part = |list: &[f64]| -> Vec<f64> { list.iter().step_by(stride).copied().collect() };
        let (times, values) = (part(self.times), part(self.values));
        let few = Seen {
            times: &times,
            values: &values,
            ..*self
        };
        let theta = part(theta);
        match few.settle(|i| theta[i], kind, size, 0) {
            Ok((curve, _, true)) => Some(curve),
            _ => None,
        }
    }

    /// Corrects a motion until it fits: the curve, the samples about it, and whether it came to rest. The terms are chosen
    /// for the last time before correction `last_choice`.
    fn settle(
        &self,
        theta: impl Fn(usize) -> f64 + Sync,
        kind: Kind,
        size: Size,
        last_choice: usize,
    ) -> Result<(Curve, [Vec<f64>; 3], bool), String> {
        let rows = self.times.len();
        let stride = 1 + rows / PART;
        let few = rows.div_ceil(stride);
        let mut before = parallel::list(few, |i| theta(i * stride));
        let read = before.clone();
        let mut lines = self.lines(theta);
        // Each correction evaluates the samples' lines anew, with other roundings.
        let computed = ROUNDED * f64::EPSILON * largest(self.values).max(largest(&lines[1]));
        let mut chosen: Option<Curve> = None;
        let (mut round, mut change_before) = (0, 0.0);
        loop {
            let [weight, target, _] = &lines;
            let samples = Samples {
                t: self.times,
                target,
                weight: Some(weight),
                floor: self.floor,
            };
            // Once the motion is about right the choice of terms stays, so that it cannot go on alternating.
            let curve = match chosen {
                Some(curve) if round != last_choice => curve.again(&samples)?,
                _ => Curve::fit(&samples, kind, size)?,
            };
            // Two motions are not held at a time.
            drop(lines);
            let sigma = curve.quality().sigma;
            let moved = parallel::list(few, |i| {
                let state = curve.state(self.times[i * stride]);
                let change = (state.value[0] - before[i]).abs();
                let deviation = state.covariance[0].sqrt();
                let error = sigma * deviation + state.rounding[0] + f64::MIN_POSITIVE;
                let rounding = computed * deviation + state.rounding[0] + f64::MIN_POSITIVE;
                (state.value[0], change / error, change / rounding)
            });
            let change = moved.iter().fold(0.0, |most, moved| moved.1.max(most));
            let in_rounding = moved.iter().fold(0.0, |most, moved| moved.2.max(most));
            lines = self.lines(|i| curve.value(self.times[i]));
            if lines[0].iter().any(|slope| !slope.is_finite()) {
                return Err("the fit leaves the angles that the crank can take".to_owned());
            }
            let far = |(moved, read): (&(f64, _, _), &f64)| (moved.0 - read).abs() > ASTRAY;
            if moved.iter().zip(&read).any(far) {
                return Err("the fit goes astray, far off the crank angles of the samples: they hardly tell them, or it is not the fit for this motion".to_owned());
            }
            round += 1;
            // Corrections shrink by about the same factor, or ever faster.
            let factor = change / change_before;
            let more = change * if factor < FAST { factor } else { 1.0 };
            let settled = more < SETTLED || in_rounding < NOTHING;
            if settled && round > last_choice || round == MOST {
                return Ok((curve, lines, settled || change < 1.0));
            }
            change_before = change;
            before = moved.into_iter().map(|moved| moved.0).collect();
            chosen = Some(curve);
        }
    }

    /// The samples about a motion, each a line in the crank angle: slope and value at zero, with what they leave of the
    /// samples.
    fn lines(&self, theta: impl Fn(usize) -> f64 + Sync) -> [Vec<f64>; 3] {
        parallel::columns(self.times.len(), |i| {
            let theta = theta(i);
            let (residual, slope) = self.sensor.residual(self.values[i], theta);
            [slope, residual + slope * theta, residual]
        })
    }
}
