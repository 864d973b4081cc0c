//! Samples so far apart that motion outweighs noise; the others follow from them.

use std::f64::consts::TAU;

use super::spacing::{Spacing, window};
use crate::mechanism::Candidates;
use crate::scene::Measurement;

/// A part of the samples.
#[derive(Debug)]
pub(super) struct Anchors {
    /// Their numbers.
    pub index: Vec<usize>,
    /// s
    pub t: Vec<f64>,
    pub candidates: Vec<Candidates>,
}

/// Part of their span by which samples are uneven about an anchor.
const UNEVEN: f64 = 0.1;

/// The middle of the parabola through an odd number of evenly spaced values (Savitzky and Golay, Anal. Chem. 36 (1964)
/// 1627).
fn smoothed(values: &[f64]) -> f64 {
    let k = (values.len() / 2) as f64;
    let weight = |i: usize| 3.0 * k * (k + 1.0) - 1.0 - 5.0 * (i as f64 - k).powi(2);
    let sum: f64 = values.iter().enumerate().map(|(i, v)| weight(i) * v).sum();
    3.0 * sum / ((2.0 * k - 1.0) * (2.0 * k + 1.0) * (2.0 * k + 3.0))
}

impl Anchors {
    /// Chooses the samples; `angles` are those of a measured value.
    ///
    /// The samples around an anchor are taken together, so that dense samples are not worse than few.
    pub fn choose(
        measurement: &Measurement,
        candidates: &[Candidates],
        spacing: &Spacing<'_>,
        angles: impl Fn(f64) -> Candidates,
    ) -> Anchors {
        let times = measurement.times();
        let index = spacing.walk();
        let gap = |k: usize| index[k] - index[k - 1];
        let at_anchor = |k: usize| {
            let i = index[k];
            let nearest = gap(k.max(1)).min(gap((k + 1).min(index.len() - 1)));
            let around = window(nearest).min(i).min(times.len() - 1 - i);
            let (from, to) = (i - around, i + around);
            let (before, after) = (times[i] - times[from], times[to] - times[i]);
            if around == 0 || (after - before).abs() > UNEVEN * (after + before) {
                return candidates[i];
            }
            let found = angles(smoothed(&measurement.values()[from..=to]));
            if found.angles().is_empty() {
                candidates[i]
            } else {
                found
            }
        };
        Anchors {
            t: index.iter().map(|i| times[*i]).collect(),
            candidates: (0..index.len()).map(at_anchor).collect(),
            index,
        }
    }

    /// The angle of the first sample that is nearest to the motion through the anchors.
    pub fn first(&self, times: &[f64], candidates: &[Candidates], theta: &[f64]) -> f64 {
        self.spread(&times[..1], &candidates[..1], theta)[0]
    }

    /// The angle of each sample that is nearest to the motion through the anchors.
    pub fn spread(&self, times: &[f64], candidates: &[Candidates], theta: &[f64]) -> Vec<f64> {
        let last = self.t.len() - 1;
        let mut right = 0;
        let mut near = Near::of(&self.t[..3], &theta[..3]);
        let mut angles = Vec::with_capacity(times.len());
        for (sample, t) in times.iter().enumerate() {
            while right <= last && self.index[right] <= sample {
                right += 1;
                let inside = 0 < right && right <= last;
                // Before the first and after the last anchor, where noise would grow most, through fewer.
                let from = right.saturating_sub(2).min(last - 2);
                let to = if inside {
                    (right + 2).min(last + 1)
                } else {
                    from + 3
                };
                near = Near::of(&self.t[from..to], &theta[from..to]);
            }
            let expected = near.at(*t);
            angles.push(nearest(&candidates[sample], expected).unwrap_or(expected));
        }
        angles
    }
}

/// The polynomial through up to four anchors, by divided differences.
#[derive(Clone, Copy, Debug)]
struct Near {
    t: [f64; 4],
    differences: [f64; 4],
}

impl Near {
    fn of(t: &[f64], theta: &[f64]) -> Near {
        let mut near = Near {
            t: [0.0; 4],
            differences: [0.0; 4],
        };
        near.t[..t.len()].copy_from_slice(t);
        near.differences[..t.len()].copy_from_slice(theta);
        for order in 1..t.len() {
            for k in (order..t.len()).rev() {
                let step = near.differences[k] - near.differences[k - 1];
                near.differences[k] = step / (t[k] - t[k - order]);
            }
        }
        near
    }

    fn at(&self, t: f64) -> f64 {
        let [a, b, c, d] = self.differences;
        a + (t - self.t[0]) * (b + (t - self.t[1]) * (c + (t - self.t[2]) * d))
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
