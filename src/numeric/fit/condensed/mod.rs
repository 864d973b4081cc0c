//! Many samples as few: each block of a record is replaced by the Gauss nodes of its samples.
//!
//! The nodes and weights that integrate all polynomials up to degree 2n − 1 over n nodes exactly are those of the
//! Jacobi matrix of the polynomials that are orthogonal over the samples (Golub and Welsch, Math. Comp. 23 (1969) 221).
//! For curves that are polynomials of degree n − 1 in each block the condensed problem is the same problem: same
//! solution, same covariance, and the squares that no such curve can take away are known.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::{SMatrix, SymmetricEigen};

use super::Samples;
use super::pieces::DEGREE;
use crate::numeric::{orthogonal, parallel};

/// Nodes of a block.
const NODES: usize = DEGREE + 1;

/// Fewest samples that are condensed.
const MANY: usize = 50_000;

/// Fewest samples of the smallest blocks, on average.
const OF_BLOCK: usize = 64;

/// Blocks that a thread takes at a time.
const TOGETHER: usize = 64;

/// Most parts of the rows that are summed apart.
const PARTS: usize = 8;

/// Fewest blocks.
const FEWEST: usize = 256;

/// Standard deviations by which squares exceed those of noise if a block is too wide for the motion in it.
const CLEAR: f64 = 5.0;

/// Rows `weight`·y(t) = `target` as fits take them: the samples, or what stands for them.
#[derive(Clone, Debug)]
pub(super) struct Rows<'a> {
    t: Cow<'a, [f64]>,
    target: Cow<'a, [f64]>,
    weight: Option<Cow<'a, [f64]>>,
    /// Standard deviation of a target that is due to its digits alone.
    pub floor: f64,
    /// First and last argument of the samples.
    pub span: [f64; 2],
    /// Number of samples.
    pub count: usize,
    /// Squares that are in no row.
    pub left: f64,
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
            span: [samples.t[0], samples.t[samples.t.len() - 1]],
            count: samples.t.len(),
            left: 0.0,
            ends: Vec::new(),
        }
    }
}

impl<'a> Rows<'a> {
    /// The samples, condensed to as few blocks as serve; as they are if none do.
    pub fn new(samples: &Samples<'a>, unit: usize) -> Rows<'a> {
        let condensed = Rows::condense(samples, unit).pop();
        condensed.unwrap_or_else(|| Rows::from(samples))
    }

    /// The samples condensed to ever fewer blocks, if they are many and as long as noise outweighs what no polynomial
    /// follows. The number of blocks is `unit` times a power of two.
    pub fn condense(samples: &Samples<'a>, unit: usize) -> Vec<Rows<'a>> {
        let most = samples.t.len() / OF_BLOCK;
        if samples.t.len() < MANY || unit > most {
            return Vec::new();
        }
        let mut blocks = unit;
        while 2 * blocks <= most {
            blocks *= 2;
        }
        let all = Rows::from(samples);
        let [first, last] = all.span;
        let width = (last - first) / blocks as f64;
        let mut end = 0;
        let ends = (1..=blocks).map(|block| {
            let limit = first + width * block as f64;
            end += samples.t[end..].partition_point(|t| *t < limit);
            if block < blocks { end } else { samples.t.len() }
        });
        let mut now: Rows<'a> = all.condensed(&ends.collect::<Vec<usize>>());
        // Blocks half as wide as those that pass leave of the motion 2^-NODES of what they do.
        let mut list = Vec::new();
        while now.ends.len().is_multiple_of(2) && now.ends.len() / 2 >= FEWEST.max(unit) {
            let pairs: Vec<usize> = now.ends.chunks(2).map(|pair| pair[1]).collect();
            let wide = now.condensed(&pairs);
            if !wide.is_noise_beside(&now) {
                break;
            }
            list.push(std::mem::replace(&mut now, wide));
        }
        list
    }

    /// Number of blocks; none for samples as they are.
    pub fn blocks(&self) -> Option<usize> {
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

    /// Blocks of these rows condensed to the nodes of each.
    fn condensed(&self, ends: &[usize]) -> Rows<'static> {
        let nodes = || Vec::with_capacity(NODES * ends.len());
        let mut rows = Rows {
            t: nodes().into(),
            target: nodes().into(),
            weight: Some(nodes().into()),
            floor: self.floor,
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

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Argument, weight and target of all rows.
    pub fn iter(&self) -> impl Iterator<Item = (f64, f64, f64)> {
        (0..self.t.len()).map(|i| self.row(i))
    }

    /// Argument, weight and target of some rows.
    pub fn some(&self, range: Range<usize>) -> impl Iterator<Item = (f64, f64, f64)> {
        range.map(|i| self.row(i))
    }

    /// What is made of the rows part by part, on all cores; few rows are one part.
    pub fn parts<T: Default + Send>(&self, make: impl Fn(Range<usize>) -> T + Sync) -> Vec<T> {
        let rows = self.t.len();
        let length = rows.div_ceil(PARTS).max(MANY);
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

/// What stands for some blocks.
#[derive(Debug, Default)]
struct Part {
    /// Argument, weight and target.
    rows: Vec<[f64; 3]>,
    /// Where the rows of each block end.
    ends: Vec<usize>,
    /// Squares that are in no row.
    left: f64,
}

impl Part {
    /// Adds what stands for the samples of a block.
    fn take(&mut self, block: &Samples<'_>) {
        let weight = |i: usize| block.weight.map_or(1.0, |weight| weight[i]);
        let counting = || (0..block.t.len()).filter(|i| weight(*i) != 0.0);
        let found = (counting().count() > NODES).then(|| {
            let enough = |squares: &[f64]| squares.len() < NODES;
            orthogonal::fit::<f64>(block.t, block.target, block.weight, enough)
        });
        let Some(found) = found.filter(|found| found.coefficients.len() == NODES) else {
            let nothing = (0..block.t.len()).filter(|i| weight(*i) == 0.0);
            self.left += nothing.map(|i| block.target[i].powi(2)).sum::<f64>();
            for i in counting() {
                self.rows.push([block.t[i], weight(i), block.target[i]]);
            }
            return;
        };
        self.left += found.squares[NODES - 1];
        let jacobi = SMatrix::<f64, NODES, NODES>::from_fn(|i, j| match i.abs_diff(j) {
            0 => found.centres[i],
            1 => found.norms[i.max(j)],
            _ => 0.0,
        });
        let SymmetricEigen {
            eigenvalues,
            eigenvectors,
        } = jacobi.symmetric_eigen();
        let mut order: [usize; NODES] = std::array::from_fn(|i| i);
        order.sort_by(|a, b| eigenvalues[*a].total_cmp(&eigenvalues[*b]));
        for node in order {
            let vector = eigenvectors.column(node);
            let values = found.coefficients.iter().zip(vector.iter());
            self.rows.push([
                found.middle + found.half * eigenvalues[node],
                found.norms[0] * vector[0],
                values.map(|(c, v)| c * v).sum(),
            ]);
        }
    }
}

#[cfg(test)]
mod tests;
