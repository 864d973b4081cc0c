//! One output row for each sample.

use super::bands::{BandRule, DeadCentreBand};
use super::fitted::Fitted;
use super::force::{Backwards, Demand};
use crate::numeric::fit::State;
use crate::scene::Measurement;

/// Motion, force and torque at one sample, SI and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InverseRow {
    /// s
    pub t: f64,
    /// Fitted crank angle, rad, unwrapped.
    pub theta: f64,
    /// rad/s
    pub omega: f64,
    /// rad/s²
    pub alpha: f64,
    /// Force on the slider along +x, N; none where the motion does not determine it.
    pub slider_force: Option<f64>,
    /// Its standard error, N.
    pub slider_force_se: Option<f64>,
    /// Torque on the crank that does the same as the slider force, N m.
    pub crank_torque: f64,
    /// Its standard error, N m.
    pub crank_torque_se: f64,
    /// Whether the force is left empty.
    pub near_dead_centre: bool,
}

/// What was measured at one sample and what the fit gives, rad or m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// s
    pub t: f64,
    /// As measured; a crank angle continued over the turns.
    pub measured: f64,
    /// Measured minus fitted.
    pub residual: f64,
}

impl Residual {
    pub(super) fn list(fitted: &Fitted, measurement: &Measurement) -> Vec<Residual> {
        let measured = fitted.measured(measurement);
        let samples = measurement.times().iter().zip(measured);
        samples
            .zip(&fitted.residuals)
            .map(|((t, measured), residual)| Residual {
                t: *t,
                measured,
                residual: *residual,
            })
            .collect()
    }
}

/// All rows of a motion and the bands without force.
#[derive(Debug)]
pub(super) struct Rows {
    pub rows: Vec<InverseRow>,
    pub bands: Vec<DeadCentreBand>,
    pub rule: BandRule,
}

impl Rows {
    /// The rows; half of a 95 % band is `factor` standard errors.
    pub fn new(backwards: &Backwards<'_>, times: &[f64], states: &[State], factor: f64) -> Rows {
        let demands = demands(backwards, times, states);
        let torques: Vec<(f64, f64)> = demands.iter().map(|d| (d.torque, d.torque_se)).collect();
        let rule = BandRule::new(backwards.equation.linkage().r, &torques, factor);
        let mut found = Rows {
            rows: Vec::with_capacity(times.len()),
            bands: Vec::new(),
            rule,
        };
        let mut before = None;
        for ((t, state), demand) in times.iter().zip(states).zip(&demands) {
            let reason = rule.reason(demand, factor);
            let [theta, omega, alpha] = state.value;
            found.rows.push(InverseRow {
                t: *t,
                theta,
                omega,
                alpha,
                slider_force: reason.is_none().then_some(demand.force),
                slider_force_se: reason.is_none().then_some(demand.force_se),
                crank_torque: demand.torque,
                crank_torque_se: demand.torque_se,
                near_dead_centre: reason.is_some(),
            });
            if let Some(reason) = reason {
                found.extend_band(*t, theta, reason, before.is_some());
            }
            before = reason;
        }
        found
    }

    fn extend_band(&mut self, t: f64, theta: f64, reason: &'static str, goes_on: bool) {
        match self.bands.last_mut() {
            Some(band) if goes_on => {
                band.to_s = t;
                band.to_theta_rad = theta;
                band.rows += 1;
            }
            _ => self.bands.push(DeadCentreBand {
                from_s: t,
                to_s: t,
                from_theta_rad: theta,
                to_theta_rad: theta,
                rows: 1,
                reason,
            }),
        }
    }
}

fn demands(backwards: &Backwards<'_>, times: &[f64], states: &[State]) -> Vec<Demand> {
    let samples = times.iter().zip(states);
    samples
        .map(|(t, state)| backwards.demand(*t, state))
        .collect()
}
