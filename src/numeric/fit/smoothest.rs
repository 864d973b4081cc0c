//! The smoothest spline from which another one does not stand out beside errors of samples that depend on each other.

use super::dependent::{Dependent, Follows, Scattered};
use super::penalized::Normal;
use super::pieces::{Grid, Piecewise, basis};
use super::spline::FAILED;
use super::{Kind, Samples, Size, Spline};
use crate::numeric::banded::Factors;
use crate::numeric::parallel;

/// Standard deviations from which on a spline stands out.
const OUT: f64 = 2.0;

/// Halvings in the search for a penalty.
const HALVINGS: usize = 7;

/// A spline under another penalty.
struct Smoothed {
    curve: Piecewise,
    factor: Factors,
}

impl Spline {
    /// Counts what errors of the samples make of the spline as what may be wrong with it.
    pub(super) fn admit(
        &mut self,
        samples: &Samples<'_>,
        errors: Dependent<'_>,
    ) -> Result<(), String> {
        let size = Size::Fixed(self.curve.grid.pieces);
        let rows = Kind::Spline.rows(samples, size, samples.computed());
        let normal = Normal::new(&rows, self.curve.grid.pieces);
        let factor = normal.factor(self.strength).ok_or(FAILED)?;
        let smoothest = self.smoothest(&normal, &factor, samples, errors);
        let smoothest = smoothest.ok_or(FAILED)?;
        let errors = errors.beside_motions(&smoothest, samples);
        let grid = &self.curve.grid;
        let right = samples.products(grid.size(), &errors, terms(grid));
        self.errors
            .extend(right.iter().map(|right| factor.solve(right)));
        Ok(())
    }

    /// The spline under the strongest penalty from which this one does not stand out by more than noise and such errors do,
    /// as they are beside it.
    fn smoothest(
        &self,
        normal: &Normal<'_>,
        factor: &Factors,
        samples: &Samples<'_>,
        errors: Dependent<'_>,
    ) -> Option<Smoothed> {
        let some = Scattered::of(samples);
        let grid = self.curve.grid;
        let under = |strength: f64| {
            let factor = normal.factor(strength)?;
            let near = self.curve.coefficients.clone();
            let coefficients = normal.solve_from(strength, &factor, near);
            let curve = Piecewise { grid, coefficients };
            Some(Smoothed { curve, factor })
        };
        let stands_out = |smoothed: &Smoothed| {
            let left = smoothed.left(&some.samples(), &vec![0.0; grid.size()]);
            let errors = errors.beside(&some.chosen, &left);
            let products = some.samples().products(grid.size(), &errors, terms(&grid));
            let products = products.into_iter().map(|p| some.weighted(p));
            let mut errors: Vec<Vec<f64>> = products.map(|p| factor.solve(&p)).collect();
            let smooth = &smoothed.curve.coefficients;
            let of_both = self.curve.coefficients.iter().zip(smooth);
            errors.push(of_both.map(|(a, b)| a - b).collect());
            (0..grid.pieces).any(|piece| self.is_beyond(piece, &errors))
        };
        let mut weak = self.strength.ln();
        let mut strong = normal.strongest().ln().max(weak);
        let mut smoothest = None;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (weak + strong);
            match under(middle.exp()).filter(|smoothed| !stands_out(smoothed)) {
                Some(found) => (weak, smoothest) = (middle, Some(found)),
                None => strong = middle,
            }
        }
        smoothest.or_else(|| under(self.strength))
    }

    /// Whether the last of splines is beyond what noise and the others make likely, in the middle of a piece.
    fn is_beyond(&self, piece: usize, splines: &[Vec<f64>]) -> bool {
        let basis = basis(0.5);
        let times = |part: &[f64]| -> f64 { basis.iter().zip(part).map(|(b, c)| b * c).sum() };
        let square = |spline: &Vec<f64>| times(&spline[piece..]).powi(2);
        let noise = times(&self.covariance.times_part(piece, &basis));
        let (differs, errors) = splines.split_last().map_or((0.0, 0.0), |(last, others)| {
            (square(last), others.iter().map(square).sum())
        });
        differs > OUT * OUT * (noise * self.quality.sigma.powi(2) + errors)
    }
}

impl Follows for Smoothed {
    fn size(&self) -> usize {
        self.curve.grid.size()
    }

    fn left(&self, samples: &Samples<'_>, less: &[f64]) -> Vec<f64> {
        let coefficients = self.curve.coefficients.iter().zip(less);
        let motion = Piecewise {
            grid: self.curve.grid,
            coefficients: coefficients.map(|(c, l)| c - l).collect(),
        };
        let value = |i: usize| motion.value(samples.t[i]);
        samples.left(&parallel::list(samples.t.len(), value))
    }

    fn followed(&self, samples: &Samples<'_>, errors: &[f64]) -> Vec<f64> {
        let grid = &self.curve.grid;
        let products = samples.products(grid.size(), &[errors.to_vec()], terms(grid));
        self.factor.solve(&products.concat())
    }
}

/// The B-splines of a grid, one after the other.
fn terms(grid: &Grid) -> impl Fn(f64, &mut dyn FnMut(usize, f64)) + Sync {
    |t, take| {
        let (piece, u) = grid.place(t);
        let values = basis(u).into_iter().zip(piece..);
        values.for_each(|(value, term)| take(term, value));
    }
}
