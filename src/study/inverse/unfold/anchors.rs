//! Samples far enough apart that motion outweighs noise; the others follow from them.

use std::f64::consts::TAU;

use super::noise;
use crate::mechanism::Candidates;

/// A part of the samples, evenly taken.
#[derive(Debug)]
pub(super) struct Anchors {
    /// Their numbers.
    pub index: Vec<usize>,
    /// s
    pub t: Vec<f64>,
    pub candidates: Vec<Candidates>,
}

/// The motion between anchors, rad, that is enough however loud the noise.
const ENOUGH: f64 = 0.2;

/// The motion between anchors, rad, that is wanted however still the noise.
const LEAST: f64 = 0.01;

/// Fewest anchors.
const FEWEST: usize = 16;

impl Anchors {
    /// Chooses anchors between which the crank turns by at least `blur`, rad, or a little more.
    pub fn choose(times: &[f64], candidates: &[Candidates], blur: f64) -> Anchors {
        // On either stroke the motion looks alike.
        let one: Vec<f64> = candidates
            .iter()
            .map(|c| c.angles().iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)))
            .collect();
        let wanted = (8.0 * noise(&one)).max(blur).clamp(LEAST, ENOUGH);
        let motion = |stride: usize| {
            let picked: Vec<f64> = one.iter().step_by(stride).copied().collect();
            let mut steps: Vec<f64> = picked.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
            let part = steps.len() / 3;
            *steps.select_nth_unstable_by(part, f64::total_cmp).1
        };
        let mut stride = 1;
        while times.len() / (2 * stride) >= FEWEST && motion(stride) < wanted {
            stride *= 2;
        }
        let index: Vec<usize> = (0..times.len()).step_by(stride).collect();
        Anchors {
            t: index.iter().map(|i| times[*i]).collect(),
            candidates: index.iter().map(|i| candidates[*i]).collect(),
            index,
        }
    }

    /// The angle of each sample that is nearest to the motion through the anchors.
    pub fn spread(&self, times: &[f64], candidates: &[Candidates], theta: &[f64]) -> Vec<f64> {
        let last = self.t.len() - 1;
        let slope = |i: usize| {
            let (a, b) = (i.saturating_sub(1), (i + 1).min(last));
            (theta[b] - theta[a]) / (self.t[b] - self.t[a])
        };
        let mut right = 1;
        let mut angles = Vec::with_capacity(times.len());
        for (sample, t) in times.iter().enumerate() {
            while right < last && self.index[right] < sample {
                right += 1;
            }
            let left = right - 1;
            let width = self.t[right] - self.t[left];
            let u = (t - self.t[left]) / width;
            let expected = if u > 1.0 {
                theta[right] + slope(right) * (t - self.t[right])
            } else {
                let (a, b) = (theta[left], theta[right]);
                let (va, vb) = (slope(left) * width, slope(right) * width);
                a + u * (va + u * (3.0 * (b - a) - 2.0 * va - vb + u * (2.0 * (a - b) + va + vb)))
            };
            angles.push(nearest(&candidates[sample], expected).unwrap_or(expected));
        }
        angles
    }
}

/// The candidate, in whatever turn, that is nearest to an angle.
pub(super) fn nearest(candidates: &Candidates, expected: f64) -> Option<f64> {
    let angles = candidates.angles().iter().map(|c| in_turn(*c, expected));
    angles.min_by(|a, b| (a - expected).abs().total_cmp(&(b - expected).abs()))
}

/// The angle in the turn that brings it nearest to another.
pub(super) fn in_turn(angle: f64, expected: f64) -> f64 {
    angle + ((expected - angle) / TAU).round() * TAU
}
