//! The fit of θ(t), in terms of what was measured.

use super::errors::Errors;
use super::missed::Missed;
use super::passages::Passages;
use super::rounding::{Rounding, common_step, of_step};
use super::seen::Seen;
use super::sensor::Sensor;
use crate::numeric::chebyshev::largest;
use crate::numeric::fit::{Curve, Dependent, Kind, Samples, Size, State};
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
    /// Standard deviation of a measured value that is due to its digits alone, rad or m.
    pub floor: f64,
    /// Passages from step to step that were fitted instead of the samples, if so.
    pub passages: Option<usize>,
    /// What samples of an even motion go on by, rad or m: they may be exact, or rounded to steps of which this is a multiple.
    pub even_step: Option<f64>,
}

/// Units of rounding to which samples without noise are right, that were computed: a computed motion goes on with its
/// errors.
pub(super) const ROUNDED: f64 = 2.0;

/// Part of a step beyond which a motion is off a sample that was rounded to it, and part of the samples that may be.
const OUTSIDE: f64 = 0.75;
const FEW: f64 = 0.01;

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
        let common = common_step(measurement.values(), digits);
        if let Some(step) = common {
            let fitted = Fitted::to(sensor, measurement, theta.clone(), (kind, size), step);
            // Values on an even motion may have a common step without being rounded to it.
            if let Ok(fitted) = fitted
                && fitted.left() >= 0.5 * of_step(step)
            {
                return Ok(fitted);
            }
        }
        let fitted = Fitted::to(sensor, measurement, theta, (kind, size), digits)?;
        Ok(Fitted {
            even_step: common.filter(|_| sensor.measured == Measured::Theta),
            ..fitted
        })
    }

    /// Fits the motion to values rounded to steps.
    fn to(
        sensor: &Sensor<'_>,
        measurement: &Measurement,
        theta: Vec<f64>,
        (kind, size): (Kind, Size),
        step: f64,
    ) -> Result<Fitted, String> {
        let (times, values) = (measurement.elapsed(), measurement.values());
        let floor = of_step(step.max(f64::EPSILON * largest(values)));
        let by_passages = Passages::of(sensor, times, values, &theta, step)
            .and_then(|passages| Fitted::of_passages(&passages, kind, size).ok())
            .map(|fitted| fitted.beside(sensor, times, [values, &theta], floor))
            .filter(|fitted| kind == Kind::Polynomial || fitted.stays_in_steps(step));
        if let Some(mut fitted) = by_passages {
            fitted.continued = (sensor.measured == Measured::Theta).then_some(theta);
            return Ok(fitted);
        }
        if sensor.measured == Measured::Theta {
            let samples = Samples {
                t: times,
                target: &theta,
                weight: None,
                // Continued over the turns the angles have fewer digits.
                floor: floor.max(of_step(f64::EPSILON * largest(&theta))),
            };
            let curve = Curve::fit(&samples, kind, size)?;
            let mut residuals = curve.values(times);
            let pairs = residuals.iter_mut().zip(&theta);
            pairs.for_each(|(residual, theta)| *residual = theta - *residual);
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
        let (curve, settled) = seen.fit(theta, kind, size)?;
        let [slopes, target, residuals] = seen.lines(&curve.values(times));
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
            floor: samples.floor,
            passages: None,
            even_step: None,
        }
    }

    /// With the residuals of samples, for crank angles that belong to them.
    fn beside(
        self,
        sensor: &Sensor<'_>,
        times: &[f64],
        [values, theta]: [&[f64]; 2],
        floor: f64,
    ) -> Fitted {
        let found = self.curve.values(times);
        let residuals = parallel::list(times.len(), |i| match sensor.measured {
            Measured::Theta => theta[i] - found[i],
            _ => sensor.residual(values[i], found[i]).0,
        });
        Fitted {
            residuals,
            floor,
            ..self
        }
    }

    /// Whether hardly any sample is outside its step: passages that lie at the same angles in each turn may not tell
    /// harmonics, which then leave the steps.
    fn stays_in_steps(&self, step: f64) -> bool {
        let outside = self.residuals.iter().filter(|r| r.abs() > OUTSIDE * step);
        outside.count() as f64 <= FEW * self.residuals.len() as f64
    }

    /// Fits the motion to passages from step to step; what it leaves are residuals of these.
    fn of_passages(passages: &Passages, kind: Kind, size: Size) -> Result<Fitted, String> {
        let (curve, left) = passages.fit(kind, size)?;
        let samples = passages.samples();
        let computed = ROUNDED * f64::EPSILON * largest(samples.target);
        let line = |curve: &Curve, i: usize, more: f64| passages.line(curve, i, more);
        let mut fitted = Fitted::of(curve, left, &samples, computed, line);
        let left = fitted.left();
        if let Some(rounding) = passages.round(&mut fitted.curve, left)? {
            fitted.errors.without(&rounding);
        }
        fitted.passages = Some(passages.number());
        Ok(fitted)
    }

    /// The motion at rising times, rad and s.
    pub fn states(&self, t: &[f64]) -> Vec<State> {
        self.errors.states(&self.curve, t)
    }

    /// Whether the fit is known to follow the motion at a time, at which this is its state, at least as to the size of the
    /// acceleration.
    pub fn follows(&self, state: &State, t: f64) -> bool {
        let missed = self.errors.missed.as_ref();
        let is_lost = |missed: &Missed| missed.is_most(state, t);
        !(self.curve.is_cut_short() && missed.is_some_and(is_lost))
    }

    /// Counts rounding of the measured values to steps that is not noise as an error of the curve, and not as noise.
    fn round(
        &mut self,
        sensor: &Sensor<'_>,
        values: &[f64],
        samples: &Samples<'_>,
        step: f64,
    ) -> Result<(), String> {
        if self.curve.is_cut_short() && self.errors.missed.is_some() {
            // The places of the values in the steps are not known by a fit that misses the motion.
            return Ok(());
        }
        let parameters = self.curve.quality().parameters;
        let Some(rounding) = Rounding::of(step, values.len(), self.left(), parameters) else {
            return Ok(());
        };
        let theta = self.curve.values(samples.t);
        let error = |place: usize, chosen: &[usize], left: &[f64]| {
            // Values before rounding, with the sign with which each counts.
            let exact = parallel::list(chosen.len(), |k| {
                let i = chosen[k];
                let sign = sensor.sign(values[i], || theta[i]);
                (values[i] - sign * left[k], sign)
            });
            rounding.error(place, &exact)
        };
        let errors = Dependent {
            number: rounding.places(),
            error: &error,
        };
        self.curve.admit(samples, errors)?;
        self.errors.without(&rounding);
        Ok(())
    }

    /// Standard deviation of what the fit leaves of the samples.
    pub fn left(&self) -> f64 {
        let squares: f64 = self.residuals.iter().map(|r| r * r).sum();
        let free = self.residuals.len() as f64 - self.curve.quality().parameters;
        (squares / free.max(1.0)).sqrt()
    }

    /// What was measured; a crank angle continued over the turns.
    pub fn measured<'a>(&'a self, measurement: &'a Measurement) -> &'a [f64] {
        match &self.continued {
            Some(theta) => theta,
            None => measurement.values(),
        }
    }
}
