//! Hypothesis of a tracker: a path up to a sample, extended by the next one, kept or dropped. Their ways through the samples are
//! lists of links that share their begins.

use std::f64::consts::TAU;

use super::super::model::kalman::{Gaussian, Sample};

/// Standard deviations beyond which a sample shows another motion.
pub(in crate::inverse) const FAR: f64 = 5.0;

/// Maximum number of hypotheses, mirror images among them, and ln of the likelihood ratio to the best beyond which one is dropped.
const MOST_HYPOTHESES: usize = 12;
pub(in crate::inverse) const DROPPED_LOG_RATIO: f64 = 50.0;

/// Hypothesis: a path up to the current sample.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Hypothesis {
    pub state: Gaussian<3>,
    pub score: f64,
    /// Whether the sensor holds the value of the current sample.
    pub held: bool,
    /// Index of the last link in the list of all links.
    pub last: usize,
}

/// Crank angle, rad, that a sample may stand for.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Sight {
    pub theta: f64,
    pub variance: f64,
    /// ln of the density of the measured value, per angle.
    pub score: f64,
}

impl Hypothesis {
    /// Goes on by a sample that the sensor holds, at the cost of a ln of odds.
    pub fn held(&self, cost: f64, links: &mut Vec<Link>, list: &mut Vec<Hypothesis>) {
        let held = Hypothesis {
            score: self.score - cost,
            held: true,
            ..*self
        };
        held.push(Some(self.last), links, list);
    }

    /// Extends the predicted path by a sample, in each turn of the crank that is possible. A value that repeats adds no density.
    pub fn extend(
        &self,
        sight: &Sight,
        repeats: bool,
        links: &mut Vec<Link>,
        list: &mut Vec<Hypothesis>,
    ) {
        let nearest = ((self.state.mean[0] - sight.theta) / TAU).round();
        let spread = self.state.covariance[0][0] + sight.variance;
        let reach = if spread.sqrt() > 0.1 * TAU { 1 } else { 0 };
        for turn in -reach..=reach {
            let theta = sight.theta + (nearest + f64::from(turn)) * TAU;
            let mut found = Hypothesis {
                held: false,
                ..*self
            };
            let seen = found.state.update(&Sample {
                value: theta,
                is_second: false,
                slope: 1.0,
                is_correlated: false,
                variance: sight.variance,
            });
            // Outliers are scored by the tails of Student's distribution with four degrees of freedom.
            let spread = seen.variance;
            let off = seen.error * seen.error / spread;
            let tails = if off < 4.0 {
                0.5 * off
            } else {
                2.0 + 2.5 * (1.0 + (off - 4.0) / 4.0).ln()
            };
            found.score -= tails;
            if !repeats {
                found.score += sight.score - 0.5 * spread.ln();
            }
            if off > FAR * FAR {
                // An outlier moves the path no further than a sample at this distance.
                let (before, there) = (self.state, found.state.mean);
                let part = FAR / off.sqrt();
                let between = |k: usize| before.mean[k] + part * (there[k] - before.mean[k]);
                found.state = Gaussian {
                    mean: std::array::from_fn(between),
                    ..before
                };
            }
            found.push(Some(self.last), links, list);
        }
    }

    /// Adds this hypothesis with its link to the one before, if there is one.
    pub fn push(
        mut self,
        before: Option<usize>,
        links: &mut Vec<Link>,
        list: &mut Vec<Hypothesis>,
    ) {
        links.push(Link {
            theta: self.state.mean[0],
            before,
            rival: None,
        });
        self.last = links.len() - 1;
        list.push(self);
    }
}

/// Keeps the likeliest hypotheses, and only the likeliest of those that agree, with its rival.
pub(in crate::inverse) fn prune(list: &mut Vec<Hypothesis>, links: &mut [Link]) {
    list.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: usize = 0;
    for k in 0..list.len() {
        let now = list[k];
        let agrees = |other: &&Hypothesis| {
            let off = |i: usize| other.state.mean[i] - now.state.mean[i];
            now.held == other.held && (0..2).all(|i| off(i).powi(2) < now.state.covariance[i][i])
        };
        if let Some(other) = list[..kept].iter().find(agrees) {
            links[other.last].rival.get_or_insert(Rival {
                last: now.last,
                loss: other.score - now.score,
            });
            continue;
        }
        let keep = now.score >= list[0].score - DROPPED_LOG_RATIO && kept < MOST_HYPOTHESES;
        if keep && now.score.is_finite() {
            list[kept] = now;
            kept += 1;
        }
    }
    list.truncate(kept);
}

/// Crank angle of a path, rad, with the index of the preceding link.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Link {
    pub theta: f64,
    pub before: Option<usize>,
    pub rival: Option<Rival>,
}

/// The likeliest other way to the state of a link.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Rival {
    /// Index of its last link.
    pub last: usize,
    /// ln of the likelihood ratio of the way that was taken to this one.
    pub loss: f64,
}

/// Path through all samples: a way that was taken, after a rival way to one of its states.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Track {
    pub score: f64,
    /// Whether the rival way is far from the way that was taken, or there is none.
    pub is_far: bool,
    /// Index of the last link.
    pub last: usize,
    /// Number of links of the way that was taken.
    pub after: usize,
    /// Index of the link before these.
    pub before: usize,
}

/// Returns the indices of the links of a way, the last first.
pub(in crate::inverse) fn way(links: &[Link], last: usize) -> impl Iterator<Item = usize> {
    std::iter::successors(Some(last), |link| links[*link].before)
}

impl Track {
    /// Returns the crank angles of all samples, rad.
    pub fn angles(&self, links: &[Link]) -> Vec<f64> {
        let after = way(links, self.last).take(self.after);
        let mut list: Vec<usize> = after.chain(way(links, self.before)).collect();
        list.reverse();
        list.into_iter().map(|link| links[link].theta).collect()
    }
}

/// True if a crank turns less than half a turn from sample to sample in the mean: a faster motion has the samples of a
/// slower one (sampling theorem).
pub(in crate::inverse) fn is_resolved(theta: &[f64]) -> bool {
    let way: f64 = theta.windows(2).map(|w| (w[1] - w[0]).abs()).sum();
    way < 0.5 * TAU * (theta.len() - 1) as f64
}
