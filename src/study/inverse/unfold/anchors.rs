//! Samples far enough apart that motion outweighs noise; the others follow from them.

use std::f64::consts::TAU;

use super::noise;
use crate::mechanism::Candidates;
use crate::scene::Measurement;

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

/// So many samples on either side that are taken together, and more, are dense: the crank is to turn between their means
/// by so many times what blurs these. Of few samples the means would be those over a fold.
const DENSE: usize = 16;
const FARTHER: f64 = 4.0;

/// Part of their span by which samples are uneven about an anchor.
const UNEVEN: f64 = 0.1;

/// Samples on either side of an anchor that are taken together with it.
fn window(stride: usize) -> usize {
    stride / 3
}

/// The middle of the parabola through an odd number of evenly spaced values (Savitzky and Golay, Anal. Chem. 36 (1964)
/// 1627).
fn smoothed(values: &[f64]) -> f64 {
    let k = (values.len() / 2) as f64;
    let weight = |i: usize| 3.0 * k * (k + 1.0) - 1.0 - 5.0 * (i as f64 - k).powi(2);
    let sum: f64 = values.iter().enumerate().map(|(i, v)| weight(i) * v).sum();
    3.0 * sum / ((2.0 * k - 1.0) * (2.0 * k + 1.0) * (2.0 * k + 3.0))
}

/// Fewest anchors.
const FEWEST: usize = 16;

impl Anchors {
    /// Chooses anchors between which the crank turns by at least `blur`, rad, or a little more; `angles` are those of a
    /// measured value.
    ///
    /// The samples around an anchor are taken together, so that dense samples are not worse than few.
    pub fn choose(
        measurement: &Measurement,
        candidates: &[Candidates],
        blur: f64,
        angles: impl Fn(f64) -> Candidates,
    ) -> Anchors {
        let times = measurement.times();
        // On either stroke the motion looks alike.
        let one: Vec<f64> = candidates
            .iter()
            .map(|c| c.angles().iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b)))
            .collect();
        let noise = 8.0 * noise(&one);
        let wanted = |stride: usize| {
            let together = (window(stride) as f64).max(1.0);
            let farther = if window(stride) < DENSE { 1.0 } else { FARTHER };
            let blur = farther * blur / together.powf(0.25);
            (noise / together.sqrt()).max(blur).clamp(LEAST, ENOUGH)
        };
        let motion = |stride: usize| {
            let picked: Vec<f64> = one.iter().step_by(stride).copied().collect();
            let mut steps: Vec<f64> = picked.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
            let part = steps.len() / 3;
            *steps.select_nth_unstable_by(part, f64::total_cmp).1
        };
        let mut stride = 1;
        while times.len() / (2 * stride) >= FEWEST && motion(stride) < wanted(stride) {
            stride *= 2;
        }
        let around = window(stride);
        let index: Vec<usize> = (around..times.len() - around).step_by(stride).collect();
        let at_anchor = |i: &usize| {
            let (from, to) = (i - around, i + around);
            let (before, after) = (times[*i] - times[from], times[to] - times[*i]);
            if around == 0 || (after - before).abs() > UNEVEN * (after + before) {
                return candidates[*i];
            }
            let found = angles(smoothed(&measurement.values()[from..=to]));
            if found.angles().is_empty() {
                candidates[*i]
            } else {
                found
            }
        };
        Anchors {
            t: index.iter().map(|i| times[*i]).collect(),
            candidates: index.iter().map(at_anchor).collect(),
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
