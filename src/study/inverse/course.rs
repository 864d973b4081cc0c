//! How a motion changes from one correction to the next.
//!
//! Corrections of samples near dead centres shrink by about the same factor each time. The motion about which the samples
//! are taken as lines is then the one to which this and the last correction point together (Anderson, J. ACM 12 (1965)
//! 547).

use crate::numeric::fit::{Curve, Rows};
use crate::numeric::parallel;

/// Rows at which a change is measured.
const PART: usize = 20_000;

/// Way of a fit from the crank angles that the samples were unfolded to, rad, beyond which it fits other ones.
const ASTRAY: f64 = 0.5 * std::f64::consts::PI;

/// Parts of the way from the fit before to the present one by which the next motion goes on, at least and at most.
const ON: [f64; 2] = [-0.5, 8.0];

/// A motion at the rows, on its way to the one that fits.
#[derive(Debug)]
pub(super) struct Course<'a> {
    times: &'a [f64],
    /// The crank angles about which the samples are lines, rad.
    pub about: Vec<f64>,
    stride: usize,
    /// Crank angles of the samples at some rows, rad.
    read: Vec<f64>,
    /// Standard deviation there for samples of unit variance, and rounding.
    errors: Vec<[f64; 2]>,
    /// The fit before, and what it changed at some rows.
    before: Option<(Vec<f64>, Vec<f64>)>,
}

impl<'a> Course<'a> {
    /// From crank angles at the rows, rad.
    pub fn new(rows: &'a Rows<'_>, about: Vec<f64>) -> Course<'a> {
        let stride = 1 + about.len() / PART;
        Course {
            times: rows.arguments(),
            read: about.iter().step_by(stride).copied().collect(),
            about,
            stride,
            errors: Vec::new(),
            before: None,
        }
    }

    /// Takes the errors of a curve for those of the ones to come.
    pub fn look(&mut self, curve: &Curve) {
        self.errors = parallel::list(self.read.len(), |i| {
            let state = curve.state(self.times[i * self.stride]);
            [state.covariance[0].sqrt(), state.rounding[0]]
        });
    }

    /// What a fit changes at some rows, rad.
    fn moved(&self, found: &[f64]) -> Vec<f64> {
        let pairs = found.iter().zip(&self.about).step_by(self.stride);
        pairs.map(|(found, about)| found - about).collect()
    }

    /// The largest change by a fit, in standard errors for samples with these standard deviations.
    pub fn change<const N: usize>(&self, found: &[f64], sigmas: [f64; N]) -> [f64; N] {
        let mut most = [0.0f64; N];
        for (moved, [deviation, rounding]) in self.moved(found).iter().zip(&self.errors) {
            for (most, sigma) in most.iter_mut().zip(sigmas) {
                let error = sigma * deviation + rounding + f64::MIN_POSITIVE;
                *most = most.max(moved.abs() / error);
            }
        }
        most
    }

    /// Whether a fit is far off what the samples were unfolded to.
    pub fn is_astray(&self, found: &[f64]) -> bool {
        let mut pairs = found.iter().step_by(self.stride).zip(&self.read);
        pairs.any(|(found, read)| (found - read).abs() > ASTRAY)
    }

    /// Goes on from a fit, if it is `slow` to where it points together with the one before.
    pub fn go_on(&mut self, found: Vec<f64>, slow: bool) {
        let moved = self.moved(&found);
        let on = match &self.before {
            Some((_, before)) if slow => self.on(&moved, before),
            _ => 0.0,
        };
        match &self.before {
            Some((before, _)) if on != 0.0 => {
                let next = |i: usize| found[i] + on * (found[i] - before[i]);
                self.about = parallel::list(found.len(), next);
            }
            _ => self.about.clone_from(&found),
        }
        self.before = Some((found, moved));
    }

    /// The part of the way between two fits that makes least of what is left to change, in standard errors.
    fn on(&self, moved: &[f64], before: &[f64]) -> f64 {
        let (mut product, mut square) = (0.0, 0.0);
        for ((moved, before), [deviation, _]) in moved.iter().zip(before).zip(&self.errors) {
            let weight = 1.0 / (deviation * deviation + f64::MIN_POSITIVE);
            let less = before - moved;
            product += weight * moved * less;
            square += weight * less * less;
        }
        let on = product / square;
        if on.is_finite() {
            on.clamp(ON[0], ON[1])
        } else {
            0.0
        }
    }
}
