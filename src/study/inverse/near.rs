//! A motion from which corrections set out.

use crate::numeric::fit::{Curve, Rows};
use crate::numeric::parallel;

/// The correction before which the terms are chosen again, when the motion is about right.
const LAST_CHOICE: usize = 3;

/// A motion from which another is begun.
#[derive(Debug)]
pub(super) enum Near {
    /// Crank angles of the samples, rad.
    Samples(Vec<f64>),
    /// A motion that is about right.
    Motion(Curve),
    /// One whose terms are to stay, and the factor by which corrections shrink.
    Curve(Curve, f64),
}

impl Near {
    /// Crank angles, rad, from those of samples.
    pub fn values(&self, times: &[f64], rows: &Rows<'_>) -> Vec<f64> {
        let t = rows.arguments();
        match self {
            Near::Samples(theta) if !rows.is_condensed() => theta.clone(),
            Near::Samples(theta) => parallel::list(t.len(), |i| {
                let at = times.partition_point(|time| *time < t[i]);
                theta[at.min(theta.len() - 1)]
            }),
            Near::Motion(curve) | Near::Curve(curve, _) => curve.values(t),
        }
    }

    /// The correction before which the terms are chosen for the last time: in blocks of samples the motion is about right
    /// at once.
    pub fn last_choice(&self, rows: &Rows<'_>, folds: bool) -> Option<usize> {
        match self {
            // The signs of folded values come anew after that, and the terms with them.
            Near::Samples(_) if rows.is_condensed() => Some(usize::from(!folds)),
            Near::Samples(_) => Some(LAST_CHOICE),
            Near::Motion(_) => Some(0),
            Near::Curve(..) => None,
        }
    }
}
