//! Many samples as few: each block of a record is replaced by the Gauss nodes of its samples.
//!
//! The nodes and weights that integrate all polynomials up to degree 2n − 1 over n nodes exactly are those of the
//! Jacobi matrix of the polynomials that are orthogonal over the samples (Golub and Welsch, Math. Comp. 23 (1969) 221).
//! For curves that are polynomials of degree n − 1 in each block the condensed problem is the same problem: same
//! solution, same covariance, and the squares that no such curve can take away are known.

mod nodes;
mod views;

use std::borrow::Cow;
use std::ops::Range;

use super::pieces::DEGREE;
use super::{COMPUTED, Samples};
use crate::numeric::leading::leading;
use crate::numeric::parallel;
use nodes::Part;

/// Nodes of a block.
const NODES: usize = DEGREE + 1;

/// Fewest samples that are condensed.
pub(super) const MANY: usize = 50_000;

/// Fewest samples of the smallest blocks, on average.
const OF_BLOCK: usize = 64;

/// Blocks that a thread takes at a time.
const TOGETHER: usize = 64;

/// Parts of the rows that are summed apart, and the most rows that are one part.
const PARTS: usize = 8;
const ONE_PART: usize = 8_192;

/// Fewest blocks.
const FEWEST: usize = 256;

/// Standard deviations of the digits within which what is left is theirs, whatever its order.
const OF_DIGITS: f64 = 1.5;

/// Standard deviations by which squares exceed those of noise if a block is too wide for the motion in it.
const CLEAR: f64 = 5.0;

/// Rows `weight`·y(t) = `target` as fits take them: the samples, or what stands for them.
#[derive(Clone, Debug)]
pub struct Rows<'a> {
    t: Cow<'a, [f64]>,
    target: Cow<'a, [f64]>,
    weight: Option<Cow<'a, [f64]>>,
    /// Standard deviation of a target that is due to its digits alone.
    pub(super) floor: f64,
    /// The same of one that was computed.
    pub(super) computed: f64,
    /// First and last argument of the samples.
    pub(super) span: [f64; 2],
    /// Number of samples.
    pub(super) count: usize,
    /// Squares that are in no row.
    pub(super) left: f64,
    /// Where the rows of each block end; none for samples as they are.
    ends: Vec<usize>,
}

impl<'a> From<&Samples<'a>> for Rows<'a> {
    fn from(samples: &Samples<'a>) -> Rows<'a> {
        Rows {
            t: samples.t.into(),
            target: samples.target.into(),
            weight: samples.weight.map(Cow::from),
            floor: samples.floor,
            computed: samples.computed(),
            span: [samples.t[0], samples.t[samples.t.len() - 1]],
            count: samples.t.len(),
            left: 0.0,
            ends: Vec::new(),
        }
    }
}

impl<'a> Rows<'a> {
    /// Very many samples condensed to narrow blocks, `unit` times a power of two of them; as they are where that would lose
    /// more of the motion than noise or the digits hide.
    ///
    /// Blocks half as wide as those that pass leave of the motion 2^-NODES of what they do. The samples may have been
    /// computed, with a standard deviation of `computed`.
    pub(super) fn new(samples: &Samples<'a>, unit: usize, computed: f64) -> Rows<'a> {
        let all = Rows::from(samples);
        let most = samples.t.len() / OF_BLOCK;
        if samples.t.len() < MANY || 2 * unit.max(FEWEST) > most {
            return all;
        }
        let mut blocks = unit;
        while 2 * blocks <= most {
            blocks *= 2;
        }
        let [first, last] = all.span;
        let width = (last - first) / blocks as f64;
        let mut end = 0;
        let ends = (1..=blocks).map(|block| {
            let limit = first + width * block as f64;
            end += leading(&samples.t[end..], |t| *t < limit);
            if block < blocks { end } else { samples.t.len() }
        });
        let narrow = all.condensed(&ends.collect::<Vec<usize>>());
        let wide = narrow.halved();
        if wide.is_some_and(|wide| {
            wide.is_noise_beside(&narrow) || wide.are_digits(wide.left, computed)
        }) {
            narrow
        } else {
            all
        }
    }

    /// The same rows in half as many blocks; none for an odd number of them.
    fn halved(&self) -> Option<Rows<'static>> {
        let pairs = self.ends.chunks_exact(2).map(|pair| pair[1]);
        let halves = !self.ends.is_empty() && self.ends.len().is_multiple_of(2);
        halves.then(|| self.condensed(&pairs.collect::<Vec<usize>>()))
    }

    fn borrowed(&self) -> Rows<'_> {
        Rows {
            t: Cow::Borrowed(&self.t),
            target: Cow::Borrowed(&self.target),
            weight: self.weight.as_deref().map(Cow::Borrowed),
            ends: self.ends.clone(),
            ..*self
        }
    }

    /// The problem of rows `weight`·f(y(t)) = `target`, linear in y: `line` gives slope and value at zero of f for the place of
    /// a row and what f is to be there.
    pub fn linear(&self, line: impl Fn(usize, f64) -> [f64; 2] + Sync) -> Rows<'_> {
        let (weight, target) = parallel::pairs(self.number(), |i| {
            let (_, weight, target) = self.row(i);
            // What has no weight has no value.
            let value = if weight == 0.0 { 0.0 } else { target / weight };
            let [slope, at_zero] = line(i, value);
            (weight * slope, weight * at_zero)
        });
        let lines = Rows {
            target: target.into(),
            weight: Some(weight.into()),
            ..self.borrowed()
        };
        let computed = COMPUTED * f64::EPSILON * self.reached(&lines);
        Rows {
            computed: self.computed.max(computed),
            ..lines
        }
    }

    /// The largest size of the values at zero of lines that stand for these rows.
    pub fn reached(&self, lines: &Rows<'_>) -> f64 {
        parallel::largest(self.number(), |i| lines.target[i] / self.row(i).1)
    }

    /// Number of blocks; none for samples as they are.
    pub(super) fn blocks(&self) -> Option<usize> {
        (!self.ends.is_empty()).then_some(self.ends.len())
    }

    /// Whether what these rows leave out beyond finer ones is noise like what those leave out.
    fn is_noise_beside(&self, fine: &Rows<'_>) -> bool {
        let free = (fine.count - fine.t.len()) as f64;
        let variance = (fine.left / free).max(fine.floor * fine.floor);
        let more = (fine.t.len() - self.t.len()) as f64;
        // Nodes have the weight of many samples, but are rounded like each.
        let rounding = |target: &f64| (ROUNDED * f64::EPSILON * target).powi(2);
        let rounded: f64 = fine.target.iter().map(rounding).sum();
        self.left - fine.left <= variance * (more + CLEAR * (2.0 * more).sqrt()) + rounded
    }

    /// Whether squares that are left of the samples are no more than those of the digits, or of how they were computed.
    pub(super) fn are_digits(&self, squares: f64, computed: f64) -> bool {
        squares <= self.count as f64 * (OF_DIGITS * self.floor.max(computed)).powi(2)
    }

    /// Blocks of these rows condensed to the nodes of each.
    fn condensed(&self, ends: &[usize]) -> Rows<'static> {
        let nodes = || Vec::with_capacity(NODES * ends.len());
        let mut rows = Rows {
            t: nodes().into(),
            target: nodes().into(),
            weight: Some(nodes().into()),
            floor: self.floor,
            computed: self.computed,
            span: self.span,
            count: self.count,
            left: self.left,
            ends: Vec::with_capacity(ends.len()),
        };
        let few = ends.chunks(TOGETHER).enumerate();
        let parts = parallel::map(few, |(number, few)| {
            let mut part = Part::default();
            let mut from = match number {
                0 => 0,
                _ => ends[TOGETHER * number - 1],
            };
            for end in few {
                let range = from..*end;
                part.take(&Samples {
                    t: &self.t[range.clone()],
                    target: &self.target[range.clone()],
                    weight: self.weight.as_ref().map(|weight| &weight[range]),
                    floor: self.floor,
                });
                part.ends.push(part.rows.len());
                from = *end;
            }
            part
        });
        for part in parts {
            rows.left += part.left;
            let before = rows.t.len();
            rows.ends.extend(part.ends.iter().map(|end| before + end));
            for [t, weight, target] in part.rows {
                rows.push(t, weight, target);
            }
        }
        rows
    }

    fn row(&self, i: usize) -> (f64, f64, f64) {
        let weight = self.weight.as_ref().map_or(1.0, |weight| weight[i]);
        (self.t[i], weight, self.target[i])
    }

    /// Whether they are fewer than the samples.
    pub fn is_condensed(&self) -> bool {
        !self.ends.is_empty()
    }

    /// Number of rows that have a weight.
    pub(super) fn counting(&self) -> usize {
        self.iter().filter(|(_, weight, _)| *weight != 0.0).count()
    }

    /// Number of rows.
    pub fn number(&self) -> usize {
        self.t.len()
    }

    /// Arguments of all rows.
    pub fn arguments(&self) -> &[f64] {
        &self.t
    }

    /// Argument, weight and target of all rows.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        (0..self.t.len()).map(|i| self.row(i))
    }

    /// Argument, weight and target of some rows.
    pub(super) fn some(&self, range: Range<usize>) -> impl Iterator<Item = (f64, f64, f64)> {
        range.map(|i| self.row(i))
    }

    /// Whether they stand for very many samples.
    pub fn is_very_many(&self) -> bool {
        self.count >= MANY
    }

    /// Arguments, weights if they are not all 1, and targets.
    pub(super) fn columns(&self) -> (&[f64], Option<&[f64]>, &[f64]) {
        (&self.t, self.weight.as_deref(), &self.target)
    }

    /// What is made of the rows part by part, on all cores; few rows are one part.
    pub(super) fn parts<T: Default + Send>(
        &self,
        make: impl Fn(Range<usize>) -> T + Sync,
    ) -> Vec<T> {
        let rows = self.t.len();
        let length = rows.div_ceil(PARTS).max(ONE_PART);
        let starts = (0..rows).step_by(length);
        parallel::map(starts, |start| make(start..(start + length).min(rows)))
    }

    fn push(&mut self, t: f64, weight: f64, target: f64) {
        self.t.to_mut().push(t);
        self.target.to_mut().push(target);
        if let Some(list) = &mut self.weight {
            list.to_mut().push(weight);
        }
    }
}

/// Units of rounding to which the target of a node is computed.
const ROUNDED: f64 = 2.0;

#[cfg(test)]
mod tests;
