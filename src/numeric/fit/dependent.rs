//! Errors of samples that depend on each other and on the motion, as those of rounding to steps do.
//!
//! Where they change slowly a curve follows them in part. Beside such a curve the samples lie at other places of their steps
//! than beside the motion, and errors about it look less than they are: the curve has taken up what it could. The motions
//! that may be behind a curve are the curve less what it follows of the errors about them, for each of the errors that
//! are as likely.

use super::Samples;

/// Samples that are looked at, about; of more, terms that do not stand out move them by a slight part of their errors.
const MOST: usize = 20_000;

/// Times that the errors about a motion are taken anew: with half as many stated errors of even motions in steps are up to 20 %
/// less, with twice as many they change by a few per cent.
const ROUNDS: usize = 8;

/// One of several errors, for the samples of these numbers of which a motion leaves so much.
type OneError<'a> = &'a dyn Fn(usize, &[usize], &[f64]) -> Vec<f64>;

/// Errors that are as likely as each other.
#[derive(Clone, Copy)]
pub struct Dependent<'a> {
    /// How many they are.
    pub number: usize,
    /// One of them.
    pub error: OneError<'a>,
}

/// A curve whose parameters go with the samples almost as lines.
pub(super) trait Follows {
    /// How many parameters it has.
    fn size(&self) -> usize;

    /// What it leaves of samples with its parameters less these.
    fn left(&self, samples: &Samples<'_>, less: &[f64]) -> Vec<f64>;

    /// What of its parameters comes from errors of samples.
    fn followed(&self, samples: &Samples<'_>, errors: &[f64]) -> Vec<f64>;
}

impl Dependent<'_> {
    /// Those of some samples of which a curve leaves so much, so that the sum of their squares is the variance.
    pub(super) fn beside(&self, chosen: &[usize], left: &[f64]) -> Vec<Vec<f64>> {
        let all = 0..self.number;
        all.map(|k| self.part((self.error)(k, chosen, left)))
            .collect()
    }

    /// The same of all samples, beside the motions that may be behind a curve.
    pub(super) fn beside_motions(
        &self,
        curve: &impl Follows,
        samples: &Samples<'_>,
    ) -> Vec<Vec<f64>> {
        let some = Scattered::of(samples);
        let all: Vec<usize> = (0..samples.t.len()).collect();
        let error = |k: usize| {
            let mut less = vec![0.0; curve.size()];
            for _ in 0..ROUNDS {
                let left = curve.left(&some.samples(), &less);
                let error = some.weighted((self.error)(k, &some.chosen, &left));
                less = curve.followed(&some.samples(), &error);
            }
            let left = curve.left(samples, &less);
            self.part((self.error)(k, &all, &left))
        };
        (0..self.number).map(error).collect()
    }

    fn part(&self, mut error: Vec<f64>) -> Vec<f64> {
        let part = (self.number as f64).sqrt().recip();
        error.iter_mut().for_each(|error| *error *= part);
        error
    }
}

/// Some of the samples, that stand for all of them.
pub(super) struct Scattered {
    pub chosen: Vec<usize>,
    /// Samples for each of these.
    stride: usize,
    t: Vec<f64>,
    target: Vec<f64>,
    weight: Option<Vec<f64>>,
    floor: f64,
}

impl Scattered {
    pub fn of(samples: &Samples<'_>) -> Scattered {
        let stride = samples.t.len().div_ceil(MOST);
        // Even strides would see fast errors as slow ones.
        let scattered = |i: usize| {
            let part = (i as f64 * 0.618_033_988_749_895).fract();
            i * stride + (part * stride as f64) as usize
        };
        let chosen: Vec<usize> = (0..samples.t.len() / stride).map(scattered).collect();
        let of = |list: &[f64]| -> Vec<f64> { chosen.iter().map(|i| list[*i]).collect() };
        Scattered {
            t: of(samples.t),
            target: of(samples.target),
            weight: samples.weight.map(of),
            floor: samples.floor,
            chosen,
            stride,
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

    /// Errors or their products, as those of all samples.
    pub fn weighted(&self, mut errors: Vec<f64>) -> Vec<f64> {
        let all = errors.iter_mut();
        all.for_each(|error| *error *= self.stride as f64);
        errors
    }
}
