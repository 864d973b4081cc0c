//! Places where another motion is about as smooth as the one taken.

use super::anchors::{Anchors, in_turn};
use super::search::{Path, error, predict};

/// The other motion counts as possible if its differences from prediction are below this many times the usual ones...
const USUAL: f64 = 4.0;

/// ... or below this many times those of the motion taken at the same place.
const SAME_PLACE: f64 = 1.5;

/// Anchors from which the motion could have gone on along the other stroke: first one of each place.
pub(super) fn doubts(anchors: &Anchors, path: &Path) -> Vec<usize> {
    let mut found: Vec<usize> = Vec::new();
    let mut last = None;
    for at in 3..path.theta.len().saturating_sub(2) {
        let Some(other) = other_way(anchors, path, at) else {
            continue;
        };
        let taken = (at..at + 3)
            .map(|i| error(anchors, &path.theta, i))
            .fold(0.0, f64::max);
        if other < (USUAL * path.scale).max(SAME_PLACE * taken) {
            if last.is_none_or(|last| at > last + 3) {
                found.push(at);
            }
            last = Some(at);
        }
    }
    found
}

/// The largest difference from prediction over three anchors of the motion that changes stroke where the path does
/// not, or does not where the path does.
fn other_way(anchors: &Anchors, path: &Path, at: usize) -> Option<f64> {
    let mut theta = path.theta[at - 3..at].to_vec();
    let mut largest = 0.0f64;
    for i in at..at + 3 {
        let n = theta.len();
        let last = [theta[n - 1], theta[n - 2], theta[n - 3]];
        let (expected, spread) = predict(&anchors.t, i, &last);
        let others = anchors.candidates[i].angles().iter().enumerate();
        let best = others
            .filter(|(choice, _)| *choice != path.choice[i])
            .map(|(_, angle)| in_turn(*angle, expected))
            .min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))?;
        largest = largest.max((best - expected).abs() / spread);
        theta.push(best);
    }
    Some(largest)
}
