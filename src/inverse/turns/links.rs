//! Ways of a tracker through samples: lists of links that share their begins.

use std::f64::consts::TAU;

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
