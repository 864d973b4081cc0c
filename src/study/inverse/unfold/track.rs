//! A motion along the strokes.

use std::f64::consts::TAU;

use super::beginning::Beginning;
use super::strokes::{Fold, Stroke};
use super::visit::{Motion, Visit};
use crate::numeric::parallel;

/// A motion that begins on one of the strokes.
#[derive(Clone, Debug, Default)]
pub(super) struct Track {
    /// Crank angle at each sample, rad.
    pub theta: Vec<f64>,
    /// Samples where it is not certain whether the motion passes a fold.
    pub doubts: Vec<usize>,
    /// How often the motion comes to a fold.
    pub visits: usize,
    /// How it begins, if that is known.
    pub beginning: Option<Beginning>,
}

/// Part of a time between samples by which the next one is to be farther off, at an end of the record.
const EVEN: f64 = 0.6;

/// Parts of two motions that are compared, how far apart the same ones are at most, rad, and part of them that may be farther.
const PARTS: usize = 200;
const SAME: f64 = 1e-6;
const FEW: usize = 10;

impl Track {
    /// The motion from a stroke on; at the turning points that it is known to have `passed` it is not looked at again.
    pub fn new(motion: &Motion<'_>, passed: &[bool], first: Stroke) -> Track {
        let count = motion.turnings.len();
        let mut along = vec![first];
        let mut visits: Vec<Option<Visit>> = Vec::with_capacity(count);
        for k in 0..count {
            let visit = motion.fold(k).map(|fold| match passed[k] {
                true => Visit::passage(fold),
                false => motion.look(k, fold, along[k]),
            });
            along.push(visit.map_or(along[k], |visit| visit.next(along[k])));
            visits.push(visit);
        }
        // What another verdict changes of the strokes after it.
        let mut changed = 0;
        for k in 0..count {
            if let Some(visit) = visits[k].filter(|visit| !visit.certain) {
                let stroke = |part: usize| along[part] ^ if part > k { changed } else { 0 };
                let again = motion.look_again(k, visit, stroke);
                visits[k] = Some(again);
                if again.passes != visit.passes {
                    changed ^= visit.fold.change;
                }
            }
            along[k + 1] ^= changed;
        }
        let doubtful = |k: &usize| visits[*k].is_some_and(|visit| !visit.certain);
        let doubts = (0..count).filter(doubtful);
        let (theta, before) = motion.angles(&along);
        let beginning = motion.beginning(first, before);
        let unseen = beginning.filter(|beginning| beginning.turns_unseen);
        let doubts = doubts.map(|k| motion.turnings[k].at);
        Track {
            theta,
            doubts: unseen.map(|_| 0).into_iter().chain(doubts).collect(),
            visits: visits.iter().flatten().count(),
            beginning,
        }
    }
}

impl Track {
    /// Whether another one is the same motion, but for few samples: both may begin on either stroke next to a fold.
    pub fn is_like(&self, other: &Track) -> bool {
        let step = (self.theta.len() / PARTS).max(1);
        let pairs = || self.theta.iter().zip(&other.theta).step_by(step);
        let differs = |pair: &(&f64, &f64)| (in_turn(*pair.1, *pair.0) - pair.0).abs() > SAME;
        FEW * pairs().filter(differs).count() < pairs().count()
    }
}

impl Motion<'_> {
    /// The crank angle of each sample, with its turns, on the strokes between turning points, and how many of the first ones
    /// are on another stroke, before a fold that is between samples.
    fn angles(&self, along: &[Stroke]) -> (Vec<f64>, usize) {
        let values = self.record.values;
        let changes: Vec<usize> = (0..self.turnings.len())
            .map(|k| self.change(self.turnings[k].at, [along[k], along[k + 1]]))
            .collect();
        let mut theta = parallel::list(values.len(), |i| {
            let stroke = along[changes.partition_point(|change| *change <= i)];
            self.strokes.angles(values[i])[stroke]
        });
        for i in 0..theta.len() {
            let expected = match i {
                0 => 0.0,
                1 => theta[0],
                _ => 2.0 * theta[i - 1] - theta[i - 2],
            };
            theta[i] = in_turn(theta[i], expected);
        }
        let mut before = 0;
        if let [.., last] = along
            && theta.len() > 5
        {
            let end = theta.len() - 1;
            self.mend(&mut theta, end - 1, (0..end - 1).rev(), *last);
            self.mend(&mut theta, end, (0..end).rev(), *last);
            let second = self.mend(&mut theta, 1, 2..=end, along[0]);
            let first = self.mend(&mut theta, 0, 1..=end, along[0]);
            before = usize::from(first) + usize::from(first && second);
        }
        (theta, before)
    }

    /// The first sample on the stroke after a turning point, which itself may be on either.
    fn change(&self, at: usize, [from, to]: [Stroke; 2]) -> usize {
        if from == to || at == 0 || at == self.record.last() {
            return at;
        }
        let angle = |i: usize, stroke: Stroke| self.strokes.angles(self.record.values[i])[stroke];
        let start = angle(at - 1, from);
        let around = (at.saturating_sub(2)..=(at + 2).min(self.record.last())).filter(|i| *i != at);
        let others: Vec<(usize, f64)> = around
            .map(|i| (i, in_turn(angle(i, if i < at { from } else { to }), start)))
            .collect();
        let expected = self.foretold(at, &others);
        let off = |stroke: Stroke| (in_turn(angle(at, stroke), expected) - expected).abs();
        if off(from) <= off(to) { at + 1 } else { at }
    }

    /// Lets the first or last sample be where three of the others, from the next one on, lead: past a fold that is between
    /// samples. Whether it is there.
    fn mend(
        &self,
        theta: &mut [f64],
        at: usize,
        others: impl Iterator<Item = usize>,
        stroke: Stroke,
    ) -> bool {
        let values = self.record.values;
        let step = self.record.nearby(at);
        let folds = [true, false].map(|above| self.strokes.fold(values[at], above));
        let is_near = |fold: &Fold| (values[at] - fold.value).abs() <= step;
        let Some(fold) = folds.into_iter().flatten().find(is_near) else {
            return false;
        };
        let others = self.apart(at, others);
        let known: Vec<(usize, f64)> = others.iter().map(|i| (*i, theta[*i])).collect();
        let expected = self.foretold(at, &known);
        let weights = self.weights(at, &others);
        let error = others
            .iter()
            .zip(weights)
            .map(|(i, weight)| weight * self.blur(values[*i], stroke, 1.0))
            .fold(0.0, f64::hypot);
        let angles = self.strokes.angles(values[at]);
        let [one, other] =
            [stroke, stroke ^ fold.change].map(|stroke| in_turn(angles[stroke], expected));
        let is_past = (one - expected).abs() > (other - expected).abs() + error;
        if is_past {
            theta[at] = other;
        }
        is_past
    }

    /// Three samples whose times lead evenly to that of another one, of those from the next one on.
    fn apart(&self, at: usize, others: impl Iterator<Item = usize>) -> Vec<usize> {
        let far = |i: usize| (self.record.times[i] - self.record.times[at]).abs();
        let mut list: Vec<usize> = Vec::new();
        for i in others {
            let is_even = |next: &usize| far(i) >= EVEN * (list.len() + 1) as f64 * far(*next);
            if list.first().is_none_or(is_even) {
                list.push(i);
            }
            if list.len() == 3 {
                break;
            }
        }
        list
    }

    /// The polynomial through the angles of some samples at another one.
    fn foretold(&self, at: usize, others: &[(usize, f64)]) -> f64 {
        let samples: Vec<usize> = others.iter().map(|(i, _)| *i).collect();
        let weights = self.weights(at, &samples);
        others
            .iter()
            .zip(weights)
            .map(|((_, angle), weight)| angle * weight)
            .sum()
    }

    /// The weights of some samples in the polynomial through them at another one.
    fn weights(&self, at: usize, samples: &[usize]) -> Vec<f64> {
        let t = |i: usize| self.record.times[i];
        let weight = |i: &usize| {
            let others = samples.iter().filter(|j| *j != i);
            others.map(|j| (t(at) - t(*j)) / (t(*i) - t(*j))).product()
        };
        samples.iter().map(weight).collect()
    }
}

/// The angle in the turn that brings it nearest to another.
pub(super) fn in_turn(angle: f64, expected: f64) -> f64 {
    angle + ((expected - angle) / TAU).round() * TAU
}
