//! One output row for each sample.

use super::bands::{BandRule, DeadCentreBand, LONG_ARM, alike};
use super::fitted::Fitted;
use super::inverse_dynamics::{Backwards, Demand};
use super::motion_estimate::MotionEstimate;
use super::shared_errors::SharedErrors;
use crate::mechanism::Linkage;
use crate::numeric::parallel;
use crate::scene::Measurement;

/// Motion, force and torque at one sample, SI and radians.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
    /// Standard error of the force, N.
    pub slider_force_se: Option<f64>,
    /// Torque on the crank that does the same as the slider force, N m; none where the guide locks itself against any.
    pub crank_torque: Option<f64>,
    /// Standard error of the torque, N m.
    pub crank_torque_se: Option<f64>,
    /// Whether the force is left empty.
    pub near_dead_centre: bool,
}

/// What was measured at one sample and what the fit gives, rad or m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
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
        let times = measurement.times();
        parallel::list(times.len(), |i| Residual {
            t: times[i],
            measured: fitted.measured[i],
            residual: fitted.residuals[i],
        })
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

/// What decides whether a row has a force.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Doubt {
    /// Whether the mechanism can take the crank angle.
    pub exists: bool,
    /// Whether the lever arm x' of the force is at least half a crank.
    pub long_arm: bool,
    /// Whether the sign of the lever arm is certain.
    pub certain: bool,
    /// Whether the rod is nearly normal to the guide.
    pub near_limit: bool,
    /// Whether friction of the guide and dry loads are known.
    pub friction_known: bool,
}

impl Doubt {
    fn new(demand: &Demand, r: f64) -> Doubt {
        let arm = demand.arm.abs();
        Doubt {
            exists: arm.is_finite(),
            long_arm: arm >= LONG_ARM * r,
            // Not-a-number counts as uncertain.
            certain: arm > 5.0 * demand.arm_se,
            near_limit: demand.near_limit,
            friction_known: demand.friction_known,
        }
    }
}

impl InverseRow {
    /// A row before it is decided whether it has a force.
    fn new(t: f64, state: &MotionEstimate, demand: &Demand) -> InverseRow {
        let [theta, omega, alpha] = state.value;
        let is_known = demand.torque.is_finite() && demand.torque_se.is_finite();
        InverseRow {
            t,
            theta,
            omega,
            alpha,
            slider_force: Some(demand.force),
            slider_force_se: Some(demand.force_se),
            crank_torque: is_known.then_some(demand.torque),
            crank_torque_se: is_known.then_some(demand.torque_se),
            near_dead_centre: false,
        }
    }
}

/// All rows with their forces, and what is in doubt of each.
fn demanded(
    backwards: &Backwards<'_>,
    fitted: &Fitted,
    measurement: &Measurement,
    shared: &SharedErrors,
) -> (Vec<InverseRow>, Vec<Doubt>) {
    let times = measurement.times();
    let r = backwards.equation.linkage().r;
    parallel::pairs(times.len(), |i| {
        let state = fitted.motion[i].stretched(measurement.time_uncertainty());
        let mut demand = backwards.demand(times[i], &state);
        [demand.force_se, demand.torque_se] = shared.with(i, [demand.force_se, demand.torque_se]);
        let row = InverseRow::new(times[i], &state, &demand);
        (row, Doubt::new(&demand, r))
    })
}

/// Crank torques and their standard errors, N m, of a rocker over its lever arm where that is
/// longer than the crank: it grows without bound towards a limit, and the torque with it.
fn torques<'a>(
    linkage: &'a Linkage,
    rows: &'a [InverseRow],
) -> impl Iterator<Item = (f64, f64)> + Clone + 'a {
    let rocks = !linkage.limit_angles().is_empty();
    rows.iter().filter_map(move |row| {
        let longer = if rocks {
            (linkage.pose(row.theta).dx.abs() / linkage.r).max(1.0)
        } else {
            1.0
        };
        Some((row.crank_torque? / longer, row.crank_torque_se? / longer))
    })
}

impl Rows {
    /// The rows; half of a 95 % band is `factor` standard errors.
    pub fn new(
        backwards: &Backwards<'_>,
        fitted: &Fitted,
        measurement: &Measurement,
        shared: &SharedErrors,
        factor: f64,
    ) -> Rows {
        let linkage = backwards.equation.linkage();
        let (rows, doubts) = demanded(backwards, fitted, measurement, shared);
        let rule = BandRule::new(linkage.r, torques(linkage, &rows), factor);
        let mut found = Rows {
            rows,
            bands: Vec::new(),
            rule,
            unreachable: doubts.iter().position(|doubt| !doubt.exists),
        };
        found.leave_out_doubtful(&doubts, factor);
        found
    }

    /// Leaves out the forces that are in doubt.
    fn leave_out_doubtful(&mut self, doubts: &[Doubt], factor: f64) {
        let mut before: Option<&str> = None;
        for (i, doubt) in doubts.iter().enumerate() {
            let row = &mut self.rows[i];
            let reason = self.rule.reason(row, doubt, factor);
            if let Some(reason) = reason {
                (row.slider_force, row.slider_force_se) = (None, None);
                row.near_dead_centre = true;
                let (t, theta) = (row.t, row.theta);
                let goes_on = before.is_some_and(|before| alike(before, reason));
                self.extend_band(t, theta, reason, goes_on);
            }
            before = reason;
        }
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
