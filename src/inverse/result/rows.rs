//! Output rows of a motion: force and torque at each sample, doubtful forces left empty.

use super::super::fitted::Fitted;
use super::super::row::InverseRow;
use super::bands::{AT_REST, BandRule, DeadCentreBand};
use super::inverse_dynamics::InverseDynamics;
use super::shared_errors::SharedErrors;
use crate::numeric::parallel;
use crate::scene::Measurement;

/// Rows of a motion, and the bands without force.
#[derive(Debug)]
pub(in crate::inverse) struct Rows {
    pub rows: Vec<InverseRow>,
    pub bands: Vec<DeadCentreBand>,
    pub rule: BandRule,
}

impl Rows {
    /// Computes the rows; half of a 95 % band is `factor` standard errors.
    pub fn new(
        backwards: &InverseDynamics<'_>,
        fitted: &Fitted,
        measurement: &Measurement,
        shared: &SharedErrors,
        factor: f64,
    ) -> Rows {
        let times = measurement.times();
        let (mut rows, leverages) = parallel::pairs(times.len(), |i| {
            let state = fitted.motion[i].stretched(measurement.period_uncertainty());
            backwards.demand(times[i], &state, |noise| shared.with(i, noise))
        });
        let rule = BandRule::new(backwards.equation.linkage(), &rows, factor);
        let pairs = rows.iter().zip(&leverages);
        let reasons = pairs.map(|(row, leverage)| rule.reason(row, leverage, factor));
        let reasons: Vec<_> = reasons.collect();
        // Rest is one cause, dead centres and limits are another.
        let goes_on = |a: &Option<&str>, b: &Option<&str>| {
            let both = a.zip(*b);
            both.is_some_and(|(a, b)| (a == AT_REST) == (b == AT_REST))
        };
        let (mut bands, mut rest) = (Vec::new(), &mut rows[..]);
        for alike in reasons.chunk_by(goes_on) {
            let band;
            (band, rest) = rest.split_at_mut(alike.len());
            let Some(reason) = alike[0] else { continue };
            for row in band.iter_mut() {
                (row.slider_force, row.slider_force_se) = (None, None);
                row.near_dead_centre = true;
            }
            let (first, last) = (&band[0], &band[band.len() - 1]);
            bands.push(DeadCentreBand {
                from_s: first.t,
                to_s: last.t,
                from_theta_rad: first.theta,
                to_theta_rad: last.theta,
                rows: band.len(),
                reason,
            });
        }
        Rows { rows, bands, rule }
    }
}
