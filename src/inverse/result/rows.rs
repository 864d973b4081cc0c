//! Output rows of a motion: force and torque at each sample, doubtful forces left empty.

use super::super::fitted::Fitted;
use super::super::row::InverseRow;
use super::bands::{BandRule, DeadCentreBand, alike};
use super::inverse_dynamics::{InverseDynamics, Leverage};
use super::shared_errors::SharedErrors;
use crate::mechanism::Linkage;
use crate::numeric::parallel;
use crate::scene::Measurement;

/// Rows of a motion, and the bands without force.
#[derive(Debug)]
pub(in crate::inverse) struct Rows {
    pub rows: Vec<InverseRow>,
    pub bands: Vec<DeadCentreBand>,
    pub rule: BandRule,
}

/// Returns crank torques and standard errors, N m; those of a rocker over |x'| in crank lengths where it exceeds 1, for
/// lever arm and torque grow without bound towards a limit.
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
    /// Computes the rows; half of a 95 % band is `factor` standard errors.
    pub fn new(
        backwards: &InverseDynamics<'_>,
        fitted: &Fitted,
        measurement: &Measurement,
        shared: &SharedErrors,
        factor: f64,
    ) -> Rows {
        let linkage = backwards.equation.linkage();
        let times = measurement.times();
        let (rows, leverages) = parallel::pairs(times.len(), |i| {
            let state = fitted.motion[i].stretched(measurement.period_uncertainty());
            backwards.demand(times[i], &state, |noise| shared.with(i, noise))
        });
        let rule = BandRule::new(linkage.r, torques(linkage, &rows), factor);
        let mut found = Rows {
            rows,
            bands: Vec::new(),
            rule,
        };
        found.leave_out_doubtful(&leverages, factor);
        found
    }

    /// Empties the forces that are in doubt, and lists the bands.
    fn leave_out_doubtful(&mut self, leverages: &[Leverage], factor: f64) {
        let rows = self.rows.iter().zip(leverages);
        let reasons: Vec<_> = rows
            .map(|(row, leverage)| self.rule.reason(row, leverage, factor))
            .collect();
        let goes_on =
            |a: &Option<&str>, b: &Option<&str>| a.zip(*b).is_some_and(|(a, b)| alike(a, b));
        let mut rest = &mut self.rows[..];
        for band in reasons.chunk_by(goes_on) {
            let rows;
            (rows, rest) = rest.split_at_mut(band.len());
            let Some(reason) = band[0] else { continue };
            for row in rows.iter_mut() {
                (row.slider_force, row.slider_force_se) = (None, None);
                row.near_dead_centre = true;
            }
            let (first, last) = (&rows[0], &rows[rows.len() - 1]);
            self.bands.push(DeadCentreBand {
                from_s: first.t,
                to_s: last.t,
                from_theta_rad: first.theta,
                to_theta_rad: last.theta,
                rows: rows.len(),
                reason,
            });
        }
    }
}
