//! The fit of θ(t), in terms of what was measured.

use super::pattern::Pattern;
use super::sensor::Sensor;
use crate::numeric::fit::{Curve, Kind, Samples, Size, State};
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
}

/// Corrections after which a fit counts as not settling.
const MOST: usize = 30;

/// Corrections before which the terms are chosen: at first, and when the motion is about right.
const CHOICES: [usize; 2] = [0, LAST_CHOICE];
const LAST_CHOICE: usize = 3;

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
        let (times, values) = (measurement.times(), measurement.values());
        let largest = |list: &[f64]| list.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let digits = measurement.resolution().max(f64::EPSILON * largest(values));
        let floor = digits / 12f64.sqrt();
        if sensor.measured == Measured::Theta {
            let samples = Samples {
                t: times,
                target: &theta,
                weight: None,
                // Continued over the turns the angles have fewer digits.
                floor: floor.max(f64::EPSILON * largest(&theta) / 12f64.sqrt()),
            };
            let curve = Curve::fit(&samples, kind, size)?;
            let states = states(&curve, times);
            let residuals: Vec<f64> = theta
                .iter()
                .zip(&states)
                .map(|(y, s)| y - s.value[0])
                .collect();
            return Ok(Fitted::of(curve, residuals, true, Some(theta)));
        }
        let mut now = theta;
        let (mut weight, mut target) = (vec![0.0; times.len()], vec![0.0; times.len()]);
        let mut chosen: Option<Curve> = None;
        let mut round = 0;
        loop {
            for (i, (value, theta)) in values.iter().zip(&now).enumerate() {
                let (residual, slope) = sensor.residual(*value, *theta);
                weight[i] = slope;
                target[i] = residual + slope * theta;
            }
            let samples = Samples {
                t: times,
                target: &target,
                weight: Some(&weight),
                floor,
            };
            // Once the motion is about right the choice of terms stays, so that it cannot go on alternating.
            let curve = match chosen {
                Some(curve) if !CHOICES.contains(&round) => curve.again(&samples)?,
                _ => Curve::fit(&samples, kind, size)?,
            };
            let sigma = curve.quality().sigma;
            let mut change = 0.0f64;
            for (t, theta) in times.iter().zip(&mut now) {
                let state = curve.state(*t);
                let error = sigma * state.covariance[0].sqrt() + state.rounding[0];
                change = change.max((state.value[0] - *theta).abs() / error.max(f64::MIN_POSITIVE));
                *theta = state.value[0];
            }
            if now
                .iter()
                .any(|theta| !theta.is_finite() || !sensor.linkage.pose(*theta).exists())
            {
                return Err("the fit leaves the angles that the crank can take".to_owned());
            }
            round += 1;
            if change < SETTLED && round > LAST_CHOICE || round == MOST {
                let residual = |(value, theta): (&f64, &f64)| sensor.residual(*value, *theta).0;
                let residuals = values.iter().zip(&now).map(residual).collect();
                return Ok(Fitted::of(curve, residuals, change < 1.0, None));
            }
            chosen = Some(curve);
        }
    }

    fn of(curve: Curve, residuals: Vec<f64>, settled: bool, continued: Option<Vec<f64>>) -> Fitted {
        let quality = curve.quality();
        let pattern = Pattern::of(&residuals, quality.parameters, quality.floor);
        Fitted {
            curve,
            residuals,
            pattern,
            settled,
            continued,
        }
    }

    /// What was measured; a crank angle continued over the turns.
    pub fn measured(&self, measurement: &Measurement) -> Vec<f64> {
        match &self.continued {
            Some(theta) => theta.clone(),
            None => measurement.values().to_vec(),
        }
    }

    /// Standard deviation of a measured value, widened where the residuals are not independent.
    pub fn sigma(&self) -> f64 {
        self.curve.quality().sigma * self.pattern.widening
    }
}

/// The curve at each time.
pub(super) fn states(curve: &Curve, times: &[f64]) -> Vec<State> {
    times.iter().map(|t| curve.state(*t)).collect()
}
