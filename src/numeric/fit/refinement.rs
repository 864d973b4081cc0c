//! What a spline through samples without visible noise is off, from splines through a half and a quarter of them or, where
//! there are very many, from splines of a half and a quarter of its pieces.
//!
//! Where refining makes differences smaller by a factor, it goes on doing so, and by 64 for the second derivative of a
//! resolved motion (the error of splines of degree 7 is of order 8, two orders less for that derivative).

use std::borrow::Cow;

use super::condensed::{MANY, Rows};
use super::pieces::{DEGREE, Piecewise};
use super::{Samples, Size, Spline};
use crate::numeric::parallel;

/// Least factor by which the error is taken to be smaller than the difference that was made by doubling the samples.
const LEAST: f64 = 1.0 / 64.0;

/// The same for the two pieces at each end, where the penalty and not the motion gives the last derivatives: the error is of
/// lower order.
const LEAST_AT_END: f64 = 1.0 / 8.0;

/// Places in a piece at which splines are compared.
const PLACES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// Every so many of them are enough where there are very many samples.
const STRIDE: usize = 2;

/// Pieces on each side that count with each for the finer and the coarser difference.
const BESIDE: [usize; 2] = [2, 4];

/// Samples of a piece that tell its error where there are very many.
const OF_PIECE: usize = 16;

/// Samples by which a spline is judged: as they are or, of very many, some of them, each for those between.
#[derive(Debug)]
pub(super) struct Few<'a> {
    t: Cow<'a, [f64]>,
    target: Cow<'a, [f64]>,
    weight: Option<Cow<'a, [f64]>>,
    floor: f64,
    /// Whether the pieces and not the samples are what resolves the motion.
    many: bool,
}

impl<'a> Few<'a> {
    /// Of the samples of a spline of so many pieces.
    pub fn of(samples: &Samples<'a>, pieces: usize) -> Few<'a> {
        let many = samples.t.len() >= MANY;
        let stride = if many {
            samples.t.len() / (OF_PIECE * pieces)
        } else {
            1
        };
        if stride < 2 {
            return Few {
                t: samples.t.into(),
                target: samples.target.into(),
                weight: samples.weight.map(Cow::from),
                floor: samples.floor,
                many,
            };
        }
        let more = (stride as f64).sqrt();
        let weight = |i: usize| more * samples.weight.map_or(1.0, |weight| weight[i]);
        let places = || (0..samples.t.len()).step_by(stride);
        Few {
            t: places().map(|i| samples.t[i]).collect(),
            target: places().map(|i| more * samples.target[i]).collect(),
            weight: Some(places().map(weight).collect()),
            floor: samples.floor,
            many,
        }
    }

    pub fn samples(&self) -> Samples<'_> {
        Samples {
            t: &self.t,
            target: &self.target,
            weight: self.weight.as_deref(),
            floor: self.floor,
        }
    }
}

/// Differences of splines in a piece, for the curve and each derivative.
#[derive(Clone, Copy, Debug, Default)]
struct Differences {
    /// Sums of squares, of the finer two splines and of the coarser two.
    squares: [[f64; 3]; 2],
    /// Size of the largest of the finer two.
    largest: [f64; 3],
}

/// Errors of angle, speed and acceleration for each piece of a spline; none for too few samples.
pub(super) fn errors(spline: &Piecewise, few: &Few<'_>) -> Option<Vec<[f64; 3]>> {
    let samples = few.samples();
    let coarser = |by: usize| match few.many {
        true => interpolating(&samples, spline.grid.pieces.div_ceil(by)),
        false => through_fewer(&samples, spline.grid.pieces, by),
    };
    let (half, quarter) = (coarser(2)?, coarser(4)?);
    let places = PLACES
        .into_iter()
        .step_by(if few.many { STRIDE } else { 1 });
    let differences = parallel::list(spline.grid.pieces, |piece| {
        let mut found = Differences::default();
        for u in places.clone() {
            let t = spline.grid.argument(piece, u);
            let [fine, middle, coarse] =
                [spline, &half, &quarter].map(|spline| spline.derivatives(t));
            for k in 0..3 {
                let [last, before] = [middle[k] - fine[k], coarse[k] - middle[k]];
                found.squares[0][k] += last * last;
                found.squares[1][k] += before * before;
                found.largest[k] = found.largest[k].max(last.abs());
            }
        }
        found
    });
    let mean = |piece: usize, level: usize, k: usize| {
        let from = piece.saturating_sub(BESIDE[level]);
        let to = (piece + BESIDE[level] + 1).min(differences.len());
        let around = differences[from..to].iter();
        let squares: f64 = around.map(|d| d.squares[level][k]).sum();
        (squares / (places.len() * (to - from)) as f64).sqrt()
    };
    let error = |piece: usize| -> [f64; 3] {
        std::array::from_fn(|k| {
            let [last, before] = [0, 1].map(|level| mean(piece, level, k));
            // Towards the ends errors grow fast.
            let last = last.max(differences[piece].largest[k]);
            let factor = if before > 0.0 { last / before } else { 1.0 };
            let from_end = piece.min(differences.len() - 1 - piece);
            let least = if from_end < 2 { LEAST_AT_END } else { LEAST };
            last * factor.clamp(least, 1.0)
        })
    };
    Some(parallel::list(spline.grid.pieces, error))
}

/// A spline through each sample of a stride, the first and the last one among them.
fn through_fewer(samples: &Samples<'_>, pieces: usize, stride: usize) -> Option<Piecewise> {
    let part = |list: &[f64]| -> Vec<f64> {
        let last = list.len() - 1;
        let steps = last.div_ceil(stride);
        (0..=steps)
            .map(|i| list[(i * last + steps / 2) / steps])
            .collect()
    };
    let (t, target) = (part(samples.t), part(samples.target));
    let weight = samples.weight.map(part);
    let most = t.len().checked_sub(DEGREE + 1).filter(|most| *most > 1)?;
    let part = Samples {
        t: &t,
        target: &target,
        weight: weight.as_deref(),
        floor: samples.floor,
    };
    interpolating(&part, most.min(pieces.div_ceil(stride)))
}

/// A spline of so many pieces that is as free as any; if samples do not determine that, with the penalty that they ask for,
/// which bends it away where it is smooth for what it does not follow elsewhere.
fn interpolating(samples: &Samples<'_>, pieces: usize) -> Option<Piecewise> {
    let rows = Rows::from(samples);
    let chosen = || Spline::to(&rows, Size::Fixed(pieces)).ok();
    Spline::through(&rows, pieces).or_else(|| chosen().map(Spline::into_curve))
}
