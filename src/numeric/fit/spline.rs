//! Smoothing splines: pieces of degree 7 with a penalty on the sixth differences of their coefficients (Eilers and
//! Marx, Statist. Sci. 11 (1996) 89).
//!
//! Number of pieces and penalty are those of the largest restricted likelihood. That penalty is for the curve itself; for
//! its second derivative it is too strong wherever the motion is less even than the random curves that it stands for.
//! The fit therefore has a weaker one, that cuts off at a frequency √2 times as high. Its error is that of the Bayesian
//! view (Wahba, J. R. Statist. Soc. B 45 (1983) 133; Nychka, J. Amer. Statist. Assoc. 83 (1988) 1134): noise, and what
//! the penalty bends away of a curve that is as rough as is likely. What it bends away of this one is added.

use super::condensed::Rows;
use super::penalized::Normal;
use super::pieces::{DEGREE, Grid, basis, last_bases};
use super::support::supported;
use super::{DIAGONAL, Kind, Quality, Samples, Size, State, add_products, differences, refinement};
use crate::numeric::banded::{Banded, DIAGONALS};

/// Pieces for each one that the samples ask for, so that the penalty and not the pieces decide how smooth it is.
const FINER: usize = 4;

/// Cut-off frequency of the fit for one of the most likely penalty.
const CUT_OFF: f64 = std::f64::consts::SQRT_2;

/// Penalties up to this many times the weakest one let a spline go through the samples.
const THROUGH: f64 = 64.0;

/// Step in the logarithm of the penalty for derivatives by it.
const STEP: f64 = 0.05;

/// Fewest pieces that are tried.
const FEWEST: usize = 4;

const FAILED: &str = "the samples do not determine a spline";

/// A fitted smoothing spline.
#[derive(Clone, Debug)]
pub struct Spline {
    grid: Grid,
    /// Strength of the most likely penalty.
    likely: f64,
    /// Strength of the penalty of the fit.
    strength: f64,
    coefficients: Vec<f64>,
    /// Band of the covariance of the coefficients, for samples of unit variance.
    covariance: Banded,
    /// Coefficients of what may be wrong beside noise: of what the penalty has bent away, and of errors of the samples.
    errors: Vec<Vec<f64>>,
    /// Whether its penalty is so weak that it goes through the samples.
    through: bool,
    /// What it and its derivatives may be off between such samples, for each piece.
    between: Vec<[f64; 3]>,
    quality: Quality,
    condition: f64,
}

impl Spline {
    /// Fits a smoothing spline of this many pieces, or of as many as the samples ask for.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, size: Size) -> Result<Spline, String> {
        Spline::to(&Kind::Spline.rows(samples, size, samples.computed()), size)
    }

    /// The number of pieces in twice, four times... as many of which all numbers of pieces that are tried fit.
    pub(super) fn unit(size: Size) -> usize {
        match size {
            Size::Fixed(pieces) => pieces.max(1),
            Size::Auto => FEWEST,
        }
    }

    /// Fits a smoothing spline to rows.
    pub(super) fn to(rows: &Rows<'_>, size: Size) -> Result<Spline, String> {
        let failed = || FAILED.to_owned();
        let pieces = match size {
            Size::Fixed(pieces) => pieces,
            Size::Auto => enough_pieces(rows).ok_or_else(failed)?,
        };
        let normal = Normal::new(rows, pieces);
        let choice = normal.choose().ok_or_else(failed)?;
        let strength = supported(&normal, normal.weaker(choice.strength, CUT_OFF));
        Spline::new(normal, [choice.strength, strength], choice.coefficients).ok_or_else(failed)
    }

    /// A spline with as many pieces under the same penalty.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn again(&self, rows: &Rows<'_>) -> Result<Spline, String> {
        let normal = Normal::new(rows, self.grid.pieces);
        let strengths = [self.likely, self.strength];
        let spline = Spline::new(normal, strengths, self.coefficients.clone());
        spline.ok_or_else(|| FAILED.to_owned())
    }

    /// A spline under the last of two penalties, the first of which is the likely one, from coefficients that are near.
    fn new(normal: Normal<'_>, [likely, strength]: [f64; 2], near: Vec<f64>) -> Option<Spline> {
        // Samples that hardly tell the angle may need the likely penalty.
        let (strength, factor) = match normal.factor(strength) {
            Some(factor) => (strength, factor),
            None => (likely, normal.factor(likely)?),
        };
        let coefficients = normal.solve(strength, &factor, near);
        let inverse = factor.inverse_band();
        let (squares, _) = normal.residuals(&coefficients);
        Some(Spline {
            quality: Quality {
                squares,
                parameters: inverse.trace_of_product(&normal.matrix),
                sigma: normal.variance(likely, &coefficients)?.sqrt(),
                floor: normal.floor(),
            },
            condition: factor.diagonal_ratio(),
            through: strength <= THROUGH * normal.weakest(),
            between: Vec::new(),
            errors: vec![normal.bent_away(strength, &factor, &coefficients)],
            covariance: covariance(&normal, [likely, strength], inverse),
            grid: normal.grid,
            likely,
            strength,
            coefficients,
        })
    }

    /// Counts what errors of the samples make of the spline as what may be wrong with it.
    pub(super) fn admit(
        &mut self,
        samples: &Samples<'_>,
        errors: &[Vec<f64>],
    ) -> Result<(), String> {
        let size = Size::Fixed(self.grid.pieces);
        let rows = Kind::Spline.rows(samples, size, samples.computed());
        let normal = Normal::new(&rows, self.grid.pieces);
        let factor = normal.factor(self.strength).ok_or(FAILED)?;
        let right = samples.products(self.grid.size(), errors, |t, take| {
            let (piece, u) = self.grid.place(t);
            let basis = basis(DEGREE, u).into_iter();
            basis
                .zip(piece..)
                .for_each(|(value, term)| take(term, value));
        });
        self.errors
            .extend(right.iter().map(|right| factor.solve(right)));
        Ok(())
    }

    /// Estimates the error of a spline that goes through its samples, if it does, from splines through fewer of them, and
    /// their noise from their differences; whether it has done so.
    pub(super) fn compare(&mut self, samples: &Samples<'_>) -> bool {
        let judged = self.through.then(|| {
            let few = refinement::Few::of(samples, self.grid.pieces);
            let rows = Rows::from(&few.samples());
            let normal = Normal::new(&rows, self.grid.pieces);
            let inverse = normal.factor(self.strength)?.inverse_band();
            let noise = differences::noise(samples)?;
            let between = refinement::errors(self, &few)?;
            // Not as rough as a likely curve: by noise alone.
            let covariance = covariance(&normal, [f64::INFINITY, self.strength], inverse);
            Some((covariance, noise, between))
        });
        let Some((covariance, noise, between)) = judged.flatten() else {
            return false;
        };
        (self.covariance, self.between) = (covariance, between);
        self.quality.sigma = noise.max(samples.floor);
        true
    }

    /// The argument at a place, from 0 to 1, in a piece.
    pub(super) fn argument(&self, piece: usize, u: f64) -> f64 {
        self.grid.start + self.grid.width * (piece as f64 + u)
    }

    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Number of its pieces.
    pub fn pieces(&self) -> usize {
        self.grid.pieces
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Coefficients of the B-splines, their standard errors for samples of unit variance, and the ratio of the largest
    /// to the smallest pivot of their equations.
    pub fn coefficients(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let error = |i| self.covariance.get(i, i).sqrt();
        let errors = (0..self.coefficients.len()).map(error).collect();
        (self.coefficients.clone(), errors, self.condition)
    }

    /// The spline at `t`.
    pub fn value(&self, t: f64) -> f64 {
        let (piece, u) = self.grid.place(t);
        let basis = basis(DEGREE, u);
        let terms = basis.iter().zip(&self.coefficients[piece..]);
        terms.fold(0.0, |sum, (b, c)| sum + b * c)
    }

    /// The B-splines and their derivatives at `t`, and its piece.
    fn bases(&self, t: f64) -> (usize, [[f64; DIAGONALS]; 3]) {
        let (piece, u) = self.grid.place(t);
        let per = 1.0 / self.grid.width;
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

    /// The spline and its derivatives at `t`, alone.
    pub(super) fn derivatives(&self, t: f64) -> [f64; 3] {
        let (piece, bases) = self.bases(t);
        let part = &self.coefficients[piece..piece + DIAGONALS];
        bases.map(|basis| basis.iter().zip(part).map(|(b, c)| b * c).sum())
    }

    /// The spline and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let (piece, bases) = self.bases(t);
        let mut state = State::default();
        for (k, basis) in bases.iter().enumerate() {
            for (b, c) in basis.iter().zip(&self.coefficients[piece..]) {
                state.value[k] += b * c;
                state.rounding[k] += 2.0 * f64::EPSILON * (b * c).abs();
            }
        }
        for error in &self.errors {
            let part = &error[piece..piece + DIAGONALS];
            let error = bases.map(|basis| basis.iter().zip(part).map(|(b, c)| b * c).sum());
            add_products(&mut state.bias, &error, 1.0);
        }
        if let Some(between) = self.between.get(piece) {
            for (entry, error) in DIAGONAL.into_iter().zip(between) {
                state.bias[entry] += error * error;
            }
        }
        let spread = bases.map(|basis| self.covariance.times_part(piece, &basis));
        let mut entry = 0;
        for basis in 0..3 {
            for spread in &spread[..=basis] {
                let products = bases[basis].iter().zip(spread);
                state.covariance[entry] = products.map(|(b, s)| b * s).sum();
                entry += 1;
            }
        }
        state
    }
}

/// Number of pieces that the samples ask for, none if they determine no spline.
fn enough_pieces(rows: &Rows<'_>) -> Option<usize> {
    let most = rows.count.saturating_sub(DEGREE + 1).max(1);
    // Knots inside a block would be lost; what narrow blocks leave is noise.
    let most = rows.blocks().map_or(most, |blocks| blocks.min(most));
    let levels = rows.levels(FEWEST);
    let (mut pieces, mut worse) = (FEWEST.min(most), 0);
    let mut best: Option<(f64, usize, bool)> = None;
    while pieces <= most && (worse < 2 || best.is_some_and(|best| !best.2)) {
        let serves = |level: &&Rows<'_>| level.blocks().is_none_or(|blocks| blocks >= pieces);
        let level = levels.iter().rev().find(serves).unwrap_or(rows);
        let choice = Normal::new(level, pieces).choose()?;
        if best.is_none_or(|best| choice.cost < best.0) {
            let follows = choice.follows(rows);
            best = Some((choice.cost, pieces, follows));
            worse = 0;
        } else {
            worse += 1;
        }
        pieces *= 2;
    }
    let enough = best?.1;
    Some((FINER * enough).min(most).max(enough))
}

/// Mean products of the errors of the coefficients, for samples of unit variance and curves as rough as the likely
/// penalty has them.
///
/// With N the normal matrix and P the penalty of strength s, A = N + sP, noise gives A⁻¹ N A⁻¹, and the roughness
/// s² A⁻¹ P A⁻¹ over the likely strength. The two matrices come from A⁻¹ and its derivative by ln s, −s A⁻¹ P A⁻¹.
fn covariance(normal: &Normal<'_>, [likely, strength]: [f64; 2], inverse: Banded) -> Banded {
    let beside = |step: f64| Some(normal.factor(strength * step.exp())?.inverse_band());
    let (Some(weaker), Some(stronger)) = (beside(-STEP), beside(STEP)) else {
        // As if the fit had the likely penalty.
        return inverse;
    };
    let part = (1.0 - strength / likely) * 0.5 / STEP;
    inverse.plus(part, &stronger).plus(-part, &weaker)
}
