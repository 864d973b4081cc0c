//! How far apart anchors are to be.

use std::f64::consts::TAU;

use super::anchors::in_turn;
use super::noise;
use crate::mechanism::Candidates;

/// Fewest anchors.
const FEWEST: usize = 16;

/// What noise and blur count for.
const NOISE: f64 = 8.0;

/// The least and the largest size of what is to be outweighed, rad.
const LEAST: f64 = 0.01;
const MOST: f64 = 0.2;

/// The crank is to turn between anchors by so many times that. The angle after a dead centre is foretold from three
/// before it, which makes five times their noise of it.
const OUTWEIGHED: f64 = 4.0;

/// Anchors are so many times the blur away from a dead centre, where it is largest.
const CLEAR: f64 = 4.0;

/// Smaller motions than that have so many anchors on the way.
const PARTS: f64 = 20.0;

/// The motion that anchors are to have between them.
pub(super) struct Spacing<'a> {
    candidates: &'a [Candidates],
    /// Sums of all crank angles before each, on one stroke: on either the motion looks alike.
    sums: Vec<f64>,
    /// Of a single sample, rad.
    noise: f64,
    /// Of a single sample at a dead centre, rad.
    blur: f64,
    /// A part of the whole motion, rad.
    part: f64,
    rotates: bool,
}

/// Samples on either side of an anchor that are taken together with it.
pub(super) fn window(stride: usize) -> usize {
    stride / 3
}

impl<'a> Spacing<'a> {
    /// `blur` is that of a sample's angle at a dead centre, rad; `rotates` is whether the crank turns fully.
    pub fn new(candidates: &'a [Candidates], blur: f64, rotates: bool) -> Spacing<'a> {
        let largest = |c: &Candidates| c.angles().iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let one: Vec<f64> = candidates.iter().map(largest).collect();
        let least = one.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        let most = one.iter().fold(f64::NEG_INFINITY, |a, b| a.max(*b));
        let mut sums = Vec::with_capacity(one.len() + 1);
        sums.push(0.0);
        let mut sum = 0.0;
        sums.extend(one.iter().map(|angle| {
            sum += angle;
            sum
        }));
        Spacing {
            candidates,
            sums,
            noise: NOISE * noise(&one),
            blur,
            part: (most - least) / PARTS,
            rotates,
        }
    }

    /// Samples that are far enough from one to the next: the crank may be fast at one time and slow at another.
    pub fn walk(&self) -> Vec<usize> {
        let samples = self.candidates.len();
        let mut stride = self.next(0, 0);
        let around = window(stride);
        // At a dead centre the motion would begin in one way only.
        let first = (around..=around + stride.min(samples / 4)).find(|at| self.clear(*at, stride));
        let mut at = first.unwrap_or(around);
        let mut index = vec![at];
        let end = samples - 1 - around;
        loop {
            stride = self.next(at, stride);
            if at + stride >= end {
                break;
            }
            at += stride;
            index.push(at);
        }
        index.push(end.max(at + 1));
        index
    }

    /// The stride from a sample on, after one of `before`.
    fn next(&self, from: usize, before: usize) -> usize {
        let most = (self.candidates.len() / FEWEST).max(1);
        let mut stride = (before / 2).clamp(1, most);
        while stride < most && !self.is_enough(from, stride) {
            stride = (stride + 1 + stride / 4).min(most);
        }
        stride
    }

    fn is_enough(&self, from: usize, stride: usize) -> bool {
        let wanted = (OUTWEIGHED * self.uncertain(stride)).min(self.part);
        self.motion(from, stride) >= wanted && self.clear(from + stride, stride)
    }

    /// What is to be outweighed where samples are taken together, rad.
    fn uncertain(&self, stride: usize) -> f64 {
        let together = (window(stride) as f64).max(1.0);
        (self.noise / together.sqrt())
            .max(self.blur / together.powf(0.25))
            .clamp(LEAST, MOST)
    }

    /// Whether the crank angles of a sample are plainly two: at a dead centre they meet in one.
    fn clear(&self, at: usize, stride: usize) -> bool {
        let apart = match self.candidates[at.min(self.candidates.len() - 1)].angles() {
            [one, other] => (in_turn(*one, *other) - other).abs(),
            [_] if self.rotates => 0.0,
            _ => TAU,
        };
        let together = (window(stride) as f64).max(1.0);
        apart >= (CLEAR * self.blur / together.powf(0.25)).max(self.uncertain(stride))
    }

    /// How far the angles get from each other over a stride, rad, each as the mean of those around it.
    fn motion(&self, from: usize, stride: usize) -> f64 {
        let (around, samples) = (window(stride), self.candidates.len());
        let parts = 4.min(stride);
        let means = (0..=parts).map(|part| {
            let at = (from + part * stride / parts).min(samples - 1);
            let (a, b) = (at.saturating_sub(around), (at + around + 1).min(samples));
            (self.sums[b] - self.sums[a]) / (b - a) as f64
        });
        let (least, most) = means.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), mean| {
            (a.min(mean), b.max(mean))
        });
        most - least
    }
}
