//! One output row for each sample.

use super::bands::{BandRule, DeadCentreBand};
use super::fitted::Fitted;
use super::force::{Backwards, Demand};
use crate::numeric::fit::{Curve, State};
use crate::numeric::parallel;
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
    /// The first sample whose crank angle the mechanism cannot take.
    pub unreachable: Option<usize>,
}

/// A row before it is decided whether it has a force, with the lever arm x' of the force and its standard error.
#[derive(Debug)]
pub(super) struct Draft {
    pub row: InverseRow,
    pub arm: f64,
    pub arm_se: f64,
    /// Whether the rod is nearly normal to the guide.
    pub near_limit: bool,
    /// Whether the friction of the guide is known.
    pub friction_known: bool,
}

impl Draft {
    fn new(t: f64, state: &State, demand: &Demand) -> Draft {
        let [theta, omega, alpha] = state.value;
        Draft {
            row: InverseRow {
                t,
                theta,
                omega,
                alpha,
                slider_force: Some(demand.force),
                slider_force_se: Some(demand.force_se),
                crank_torque: demand.torque,
                crank_torque_se: demand.torque_se,
                near_dead_centre: false,
            },
            arm: demand.arm,
            arm_se: demand.arm_se,
            near_limit: demand.near_limit,
            friction_known: demand.friction_known,
        }
    }
}

impl Rows {
    /// The rows; half of a 95 % band is `factor` standard errors.
    pub fn new(backwards: &Backwards<'_>, curve: &Curve, times: &[f64], factor: f64) -> Rows {
        let drafts = parallel::list(times.len(), |i| {
            let state = curve.state(times[i]);
            Draft::new(times[i], &state, &backwards.demand(times[i], &state))
        });
        let linkage = backwards.equation.linkage();
        let rocks = !linkage.limit_angles().is_empty();
        let torques = drafts.iter().map(|d| {
            // The lever arm grows without bound towards a limit, and the torque with it.
            let longer = if rocks {
                (d.arm.abs() / linkage.r).max(1.0)
            } else {
                1.0
            };
            (d.row.crank_torque / longer, d.row.crank_torque_se / longer)
        });
        let mut found = Rows {
            rows: Vec::new(),
            bands: Vec::new(),
            rule: BandRule::new(linkage.r, torques, factor),
            unreachable: drafts.iter().position(|draft| !draft.arm.is_finite()),
        };
        let mut before = false;
        let rows = drafts.into_iter().map(|mut draft| {
            let reason = found.rule.reason(&draft, factor);
            if let Some(reason) = reason {
                let row = &mut draft.row;
                (row.slider_force, row.slider_force_se) = (None, None);
                row.near_dead_centre = true;
                found.extend_band(row.t, row.theta, reason, before);
            }
            before = reason.is_some();
            draft.row
        });
        let rows = rows.collect();
        Rows { rows, ..found }
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
