//! B-splines of degree 7 over evenly spaced knots.

use std::array;
use std::ops::Range;

use super::condensed::Rows;
use crate::numeric::banded::DIAGONALS;
use crate::numeric::leading::leading;

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
        let scales = [1.0, per, per * per];
        let bases = array::from_fn(|order| at(&BASIS[order], u).map(|b| scales[order] * b));
        (piece, bases)
    }

    /// How many of rising arguments, from the first on, are in one piece.
    pub fn in_one_piece(&self, t: &[f64]) -> usize {
        let (piece, _) = self.place(t[0]);
        leading(t, |t| self.place(*t).0 == piece)
    }
}

/// The cardinal B-splines at place u of a piece.
#[inline(always)]
pub(super) fn basis(u: f64) -> [f64; DIAGONALS] {
    at(&BASIS[0], u)
}

/// Factors of powers of u − ½, from the lowest one on, one for each B-spline of a piece.
type Powers = [[f64; DIAGONALS]; DEGREE + 1];

/// Those of the cardinal B-splines and of their first two derivatives.
const BASIS: [Powers; 3] = {
    let values = cardinal();
    let first = derivative(&values);
    [values, first, derivative(&first)]
};

/// Polynomials at place u of a piece (Horner).
#[inline(always)]
fn at(powers: &Powers, u: f64) -> [f64; DIAGONALS] {
    let from_middle = u - 0.5;
    let mut values = powers[DEGREE];
    for factors in powers[..DEGREE].iter().rev() {
        for (value, factor) in values.iter_mut().zip(factors) {
            *value = *value * from_middle + factor;
        }
    }
    values
}

/// The cardinal B-splines as polynomials (de Boor's recurrence on even knots); exact up to the division by 7!.
const fn cardinal() -> Powers {
    let mut powers = [[0.0; DIAGONALS]; DEGREE + 1];
    powers[0][0] = 1.0;
    let (mut degree, mut factorial) = (1, 1.0);
    while degree <= DEGREE {
        factorial *= degree as f64;
        // From the highest power down: each is made of itself and the one below.
        let mut power = degree + 1;
        while power > 0 {
            power -= 1;
            let mut spline = degree + 1;
            while spline > 0 {
                spline -= 1;
                // Of the spline before, which rises here, and of this one, which falls.
                let (mut rising, mut falling) = (0.0, 0.0);
                if spline > 0 {
                    rising = ((degree - spline) as f64 + 0.5) * powers[power][spline - 1];
                }
                if spline < degree {
                    falling = (spline as f64 + 0.5) * powers[power][spline];
                }
                if power > 0 {
                    if spline > 0 {
                        rising += powers[power - 1][spline - 1];
                    }
                    falling -= powers[power - 1][spline];
                }
                powers[power][spline] = rising + falling;
            }
        }
        degree += 1;
    }
    let mut power = 0;
    while power <= DEGREE {
        let mut spline = 0;
        while spline < DIAGONALS {
            powers[power][spline] /= factorial;
            spline += 1;
        }
        power += 1;
    }
    powers
}

/// The derivatives of polynomials.
const fn derivative(powers: &Powers) -> Powers {
    let mut derivative = [[0.0; DIAGONALS]; DEGREE + 1];
    let mut power = 1;
    while power <= DEGREE {
        let mut spline = 0;
        while spline < DIAGONALS {
            derivative[power - 1][spline] = power as f64 * powers[power][spline];
            spline += 1;
        }
        power += 1;
    }
    derivative
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
        let basis = basis(u);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// At the knots they are Eulerian numbers over 7!, and at all places their sum is 1 and that of their places the place.
    #[test]
    fn they_are_cardinal() {
        let eulerian = [1.0, 120.0, 1191.0, 2416.0, 1191.0, 120.0, 1.0, 0.0];
        for (b, wanted) in basis(0.0).into_iter().zip(eulerian) {
            assert!((b - wanted / 5040.0).abs() < 1e-16);
        }
        for u in [0.0, 0.1, 0.37, 0.5, 0.92, 1.0] {
            let moment = |b: [f64; DIAGONALS], power: i32| -> f64 {
                let terms = b.iter().zip(0..).map(|(b, i)| b * f64::from(i).powi(power));
                terms.sum()
            };
            let [value, slope, bend] = BASIS.map(|powers| at(&powers, u));
            // A spline with coefficients i, i² is the place from the first knot less 4, and its square and 2/3.
            let place = u + 3.0;
            assert!((moment(value, 0) - 1.0).abs() < 4e-16);
            assert!((moment(value, 1) - place).abs() < 4e-15);
            assert!((moment(value, 2) - (place * place + 2.0 / 3.0)).abs() < 2e-14);
            assert!(moment(slope, 0).abs() < 1e-15 && moment(bend, 0).abs() < 4e-15);
            assert!((moment(slope, 1) - 1.0).abs() < 1e-14);
            assert!((moment(slope, 2) - 2.0 * place).abs() < 1e-13);
            assert!(moment(bend, 1).abs() < 1e-13 && (moment(bend, 2) - 2.0).abs() < 1e-13);
        }
    }
}
