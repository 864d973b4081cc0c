//! Smoothing splines: pieces of degree 7 with a penalty on the sixth differences of their coefficients (Eilers and
//! Marx, Statist. Sci. 11 (1996) 89).
//!
//! Number of pieces and penalty are those of the largest restricted likelihood. That penalty is for the curve itself; for
//! its second derivative it is too strong wherever the motion is less even than the random curves that it stands for.
//! The fit therefore has a weaker one, that cuts off at a frequency √2 times as high, and one that is weaker yet where it
//! would foretell further samples as well. Its error is that of the Bayesian
//! view (Wahba, J. R. Statist. Soc. B 45 (1983) 133; Nychka, J. Amer. Statist. Assoc. 83 (1988) 1134): noise, and what
//! the penalty bends away of a curve that is as rough as is likely. What it bends away of this one is added.

use super::condensed::Rows;
use super::covariance::Spread;
use super::enough::{Enough, FEWEST, goes_through};
use super::penalized::Normal;
use super::pieces::{Grid, Piecewise};
use super::support::supported;
use super::told::Told;
use super::{DIAGONAL, Kind, Quality, Samples, Size, State, add_products, differences, refinement};
use crate::numeric::banded::{Banded, DIAGONALS};
use crate::numeric::parallel;

/// Cut-off frequency of the fit for one of the most likely penalty.
const CUT_OFF: f64 = std::f64::consts::SQRT_2;

pub(super) const FAILED: &str = "the samples do not determine a spline";

/// A fitted smoothing spline.
#[derive(Clone, Debug)]
pub struct Spline {
    pub(super) curve: Piecewise,
    /// Strength of the most likely penalty.
    likely: f64,
    /// Strength of the penalty of the fit.
    pub(super) strength: f64,
    /// Band of the covariance of the coefficients, for samples of unit variance.
    pub(super) covariance: Banded,
    /// Coefficients of what may be wrong beside noise: of what the penalty has bent away, and of errors of the samples.
    pub(super) errors: Vec<Vec<f64>>,
    /// Whether its penalty is so weak that it goes through the samples.
    through: bool,
    /// Whether the samples ask for more pieces than blocks of them allowed.
    wants_more: bool,
    /// What it and its derivatives may be off between such samples, for each piece.
    between: Vec<[f64; 3]>,
    pub(super) quality: Quality,
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
        let enough = match size {
            Size::Fixed(pieces) => Enough::just(pieces),
            Size::Auto => Enough::of(rows).ok_or_else(failed)?,
        };
        let (normal, choice) = enough.choose(rows).ok_or_else(failed)?;
        let strength = supported(&normal, normal.weaker(choice.strength, CUT_OFF));
        let likely = Told::likely(normal, choice, strength);
        let told = match size {
            Size::Fixed(_) => likely,
            Size::Auto => Told::by(rows, likely),
        };
        let spline =
            Spline::new(told.normal, told.strengths, Some(told.near)).ok_or_else(failed)?;
        Ok(Spline {
            wants_more: enough.more,
            ..spline
        })
    }

    /// The spline under the weakest penalty alone.
    pub(super) fn through(rows: &Rows<'_>, pieces: usize) -> Option<Piecewise> {
        let normal = Normal::new(rows, pieces);
        let weakest = normal.weakest();
        Some(Piecewise {
            grid: normal.grid,
            coefficients: normal.solve(weakest, &normal.factor(weakest)?),
        })
    }

    /// A spline with as many pieces under the same penalty.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn again(&self, rows: &Rows<'_>) -> Result<Spline, String> {
        let near = self.curve.coefficients.clone();
        let normal = Normal::next_to(rows, self.curve.grid.pieces, near);
        let strengths = [self.likely, self.strength];
        let spline = Spline::new(normal, strengths, None);
        let spline = spline.ok_or_else(|| FAILED.to_owned())?;
        Ok(Spline {
            wants_more: self.wants_more,
            ..spline
        })
    }

    /// The same but for its errors, which stay those of this one.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn moved(mut self, rows: &Rows<'_>) -> Result<Spline, String> {
        let near = self.curve.coefficients.clone();
        let normal = Normal::next_to(rows, self.curve.grid.pieces, near);
        let Some((moved, squares)) = normal.step(self.strength) else {
            return self.again(rows);
        };
        self.curve.coefficients = moved;
        let quality = &mut self.quality;
        if quality.squares > 0.0 {
            quality.sigma *= (squares / quality.squares).sqrt();
            quality.sigma = quality.sigma.max(quality.floor);
        }
        quality.squares = squares;
        Ok(self)
    }

    /// A spline under the last of two penalties, the first of which is the likely one, from coefficients that are nearer
    /// than those that the sums are about.
    fn new(
        normal: Normal<'_>,
        [likely, strength]: [f64; 2],
        nearer: Option<Vec<f64>>,
    ) -> Option<Spline> {
        // Samples that hardly tell the angle may need the likely penalty.
        let (strength, factor) = match normal.factor(strength) {
            Some(factor) => (strength, factor),
            None => (likely, normal.factor(likely)?),
        };
        let solution = match nearer {
            Some(nearer) => normal.solve_from(strength, &factor, nearer),
            None => normal.solve(strength, &factor),
        };
        let about = normal.about(solution);
        let (variance, spread) = parallel::both(
            || about.variance(likely),
            || Spread::of(&normal, [likely, strength], &factor),
        );
        let variance = variance?;
        let (squares, coefficients) = (about.squares, about.near);
        Some(Spline {
            quality: Quality {
                squares,
                parameters: spread.parameters,
                sigma: variance.sqrt(),
                floor: normal.floor(),
            },
            condition: factor.diagonal_ratio(),
            through: goes_through(&normal, strength),
            wants_more: false,
            between: Vec::new(),
            errors: vec![normal.bent_away(strength, &factor, &coefficients)],
            covariance: spread.covariance,
            likely,
            strength,
            curve: Piecewise {
                grid: normal.grid,
                coefficients,
            },
        })
    }

    /// Estimates the error of a spline that goes through its samples, if it does, from splines through fewer of them, and
    /// their noise from their differences; whether it has done so.
    pub(super) fn compare(&mut self, samples: &Samples<'_>) -> bool {
        let judged = self.through.then(|| {
            let few = refinement::Few::of(samples, self.curve.grid.pieces);
            let rows = Rows::from(&few.samples());
            let normal = Normal::new(&rows, self.curve.grid.pieces);
            let factor = normal.factor(self.strength)?;
            let noise = differences::noise(samples)?;
            let between = refinement::errors(&self.curve, &few)?;
            // Not as rough as a likely curve: by noise alone.
            let spread = Spread::of(&normal, [f64::INFINITY, self.strength], &factor);
            Some((spread.covariance, noise, between))
        });
        let Some((covariance, noise, between)) = judged.flatten() else {
            return false;
        };
        (self.covariance, self.between) = (covariance, between);
        self.quality.sigma = noise.max(samples.floor);
        true
    }

    pub(super) fn grid(&self) -> &Grid {
        &self.curve.grid
    }

    pub(super) fn into_curve(self) -> Piecewise {
        self.curve
    }

    /// Number of its pieces.
    pub fn pieces(&self) -> usize {
        self.curve.grid.pieces
    }

    /// Whether the samples ask for more pieces than blocks of them allowed.
    pub(super) fn wants_more(&self) -> bool {
        self.wants_more
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        self.quality
    }

    /// Coefficients of the B-splines, their standard errors for samples of unit variance, and the ratio of the largest
    /// to the smallest pivot of their equations.
    pub fn coefficients(&self) -> (Vec<f64>, Vec<f64>, f64) {
        let error = |i| self.covariance.get(i, i).sqrt();
        let errors = (0..self.curve.coefficients.len()).map(error).collect();
        (self.curve.coefficients.clone(), errors, self.condition)
    }

    /// The spline at `t`.
    pub fn value(&self, t: f64) -> f64 {
        self.curve.value(t)
    }

    /// The spline and its derivatives at `t`, without their errors.
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        self.curve.derivatives(t)
    }

    /// The spline and its derivatives at `t`.
    pub fn state(&self, t: f64) -> State {
        let (piece, bases) = self.curve.grid.bases(t);
        let mut state = State::default();
        for (k, basis) in bases.iter().enumerate() {
            for (b, c) in basis.iter().zip(&self.curve.coefficients[piece..]) {
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
