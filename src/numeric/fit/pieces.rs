//! B-splines of degree 7 over evenly spaced knots.

use std::ops::Range;

use super::condensed::Rows;
use crate::numeric::banded::DIAGONALS;

/// Degree of the pieces.
pub(super) const DEGREE: usize = 7;

/// Evenly spaced knots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub start: f64,
    /// Width of a piece.
    pub width: f64,
    pub pieces: usize,
}

impl Grid {
    pub fn new(samples: &Rows<'_>, pieces: usize) -> Grid {
        let [first, last] = samples.span;
        Grid {
            start: first,
            width: (last - first) / pieces as f64,
            pieces,
        }
    }

    /// Number of coefficients.
    pub fn size(&self) -> usize {
        self.pieces + DEGREE
    }

    /// The piece at `t` and the place in it, from 0 to 1.
    pub fn place(&self, t: f64) -> (usize, f64) {
        let at = (t - self.start) / self.width;
        let piece = (at.max(0.0) as usize).min(self.pieces - 1);
        (piece, at - piece as f64)
    }

    /// The coefficients that rows have to do with.
    pub fn touched(&self, rows: &Rows<'_>, range: &Range<usize>) -> Range<usize> {
        let t = &rows.arguments()[range.clone()];
        let [first, last] = [t[0], t[t.len() - 1]].map(|t| self.place(t).0);
        first..last + DIAGONALS
    }

    /// The argument at a place, from 0 to 1, in a piece.
    pub fn argument(&self, piece: usize, u: f64) -> f64 {
        self.start + self.width * (piece as f64 + u)
    }

    /// The piece at `t`, and its B-splines and their derivatives there.
    pub fn bases(&self, t: f64) -> (usize, [[f64; DIAGONALS]; 3]) {
        let (piece, u) = self.place(t);
        let per = 1.0 / self.width;
        let [lowest, lower, value] = last_bases(u);
        let at = |list: &[f64; DIAGONALS], i: usize, back: usize| {
            if i >= back { list[i - back] } else { 0.0 }
        };
        let bases: [[f64; DIAGONALS]; 3] = [
            value,
            std::array::from_fn(|i| per * (at(&lower, i, 1) - lower[i])),
            std::array::from_fn(|i| {
                per * per * (at(&lowest, i, 2) - 2.0 * at(&lowest, i, 1) + lowest[i])
            }),
        ];
        (piece, bases)
    }

    /// How many of rising arguments, from the first on, are in one piece.
    pub fn in_one_piece(&self, t: &[f64]) -> usize {
        let (piece, _) = self.place(t[0]);
        t.partition_point(|t| self.place(*t).0 == piece)
    }
}

/// The cardinal B-splines of a degree at place u of a piece (de Boor's recurrence on even knots).
#[inline(always)]
pub(super) fn basis(degree: usize, u: f64) -> [f64; DIAGONALS] {
    let mut b = [0.0; DIAGONALS];
    b[0] = 1.0;
    for d in 1..=degree {
        b = raised(b, d, u);
    }
    b
}

/// The same of the last three degrees up to [`DEGREE`].
fn last_bases(u: f64) -> [[f64; DIAGONALS]; 3] {
    let lowest = basis(DEGREE - 2, u);
    let lower = raised(lowest, DEGREE - 1, u);
    [lowest, lower, raised(lower, DEGREE, u)]
}

/// The B-splines of degree d from those of the degree below.
#[inline(always)]
fn raised(mut b: [f64; DIAGONALS], d: usize, u: f64) -> [f64; DIAGONALS] {
    let per = 1.0 / d as f64;
    let mut saved = 0.0;
    for (r, value) in b.iter_mut().enumerate().take(d) {
        let part = *value * per;
        *value = saved + ((r + 1) as f64 - u) * part;
        saved = (u + (d - 1 - r) as f64) * part;
    }
    b[d] = saved;
    b
}

/// A spline over such knots.
#[derive(Clone, Debug)]
pub(super) struct Piecewise {
    pub grid: Grid,
    /// Coefficients of the B-splines.
    pub coefficients: Vec<f64>,
}

impl Piecewise {
    /// The spline at `t`.
    pub fn value(&self, t: f64) -> f64 {
        let (piece, u) = self.grid.place(t);
        let basis = basis(DEGREE, u);
        let terms = basis.iter().zip(&self.coefficients[piece..]);
        terms.fold(0.0, |sum, (b, c)| sum + b * c)
    }

    /// The spline and its derivatives at `t`.
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        let (piece, bases) = self.grid.bases(t);
        let part = &self.coefficients[piece..piece + DIAGONALS];
        bases.map(|basis| basis.iter().zip(part).map(|(b, c)| b * c).sum())
    }
}
