//! The speed with which a motion begins.
//!
//! Next to a fold the crank angle of a sample is blurred, and the motion may turn or pass the fold unseen. What is measured
//! depends smoothly on the angle, so a polynomial through the first way of the crank tells the speed all the same, or that it
//! is not known.

use super::super::sensor::Sensor;
use super::evidence::{MOST, Misfit, fitted, over};
use super::refined::{Solved, solved};
use super::strokes::{Fold, Stroke};
use super::visit::{Motion, search};
use super::window::{Window, turned_back};
use crate::numeric::orthogonal::Expansion;

/// First way of the crank, rad, and fewest blocks of samples on it.
const WAY: f64 = 1.2;
const FEWEST: usize = 5;

/// Way beyond a fold, rad, that is more than a fit in terms of what was measured mends.
const UNSEEN: f64 = 0.1;

/// Standard errors that a speed is to have for its sense to be known.
const KNOWN: f64 = 3.0;

/// Standard deviations of noise that may take a size over its fold.
const FOLDED: f64 = 4.0;

/// Part of half the time over which a derivative is taken.
const STEP: f64 = 1e-5;

/// The speed of the first sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beginning {
    /// rad/s
    pub speed: f64,
    /// Its standard error, rad/s.
    pub error: f64,
    /// Whether the motion may be at a fold.
    pub at_fold: bool,
    /// Whether it turns beyond the fold, too near to it for a turning point to be seen.
    pub turns_unseen: bool,
}

impl Beginning {
    /// Whether the sense of the motion is known.
    pub fn is_known(&self) -> bool {
        self.speed.abs() > KNOWN * self.error
    }

    /// Whether a motion that begins with some speed, rad/s, may begin like this or the other way round: the samples do not
    /// tell less than their error from its opposite. Away from a fold one at rest is known by where it goes.
    pub fn is_either_way(&self, speed: f64) -> bool {
        let slow = self.hides(speed);
        if self.is_known() {
            slow
        } else {
            self.at_fold || !slow
        }
    }

    /// Whether a speed, rad/s, is less than the error.
    pub fn hides(&self, speed: f64) -> bool {
        speed.abs() < self.error
    }
}

const UNKNOWN: Beginning = Beginning {
    speed: 0.0,
    error: f64::INFINITY,
    at_fold: true,
    turns_unseen: false,
};

impl Motion<'_> {
    /// How the motion begins on a stroke, or past a fold on the way to it, if its samples are not too few to tell. So many of the
    /// first ones are before the fold.
    pub fn beginning(&self, stroke: Stroke, before: usize) -> Option<Beginning> {
        let Motion {
            record, strokes, ..
        } = self;
        let folds = [true, false].map(|above| strokes.fold(record.values[0], above));
        let off = |fold: &Fold| (record.values[0] - fold.value).abs();
        let folds = folds.into_iter().flatten();
        let fold = folds.min_by(|a, b| off(a).total_cmp(&off(b)))?;
        let at_fold = strokes.angles(fold.value)[stroke];
        let off = |i: usize| turned_back(strokes.angles(record.values[i])[stroke] - at_fold).abs();
        let end = self
            .turnings
            .first()
            .map_or(record.last(), |turning| turning.at);
        let to = search(0, end, |i| off(i) <= WAY);
        if to < FEWEST {
            return None;
        }
        let to = self.before_noise_folds(to);
        if to < FEWEST {
            return Some(UNKNOWN);
        }
        let linkage = strokes.linkage_at(fold, at_fold);
        let sensor = Sensor {
            linkage: &linkage,
            ..*strokes.sensor
        };
        let along = |i: usize| {
            if i < before {
                stroke ^ fold.change
            } else {
                stroke
            }
        };
        let window = Window::new(self, (0, fold), along, [0, to]);
        let half = 0.5 * (record.times[to] - record.times[0]);
        let (degree, solved) = simplest(&window, &sensor)?;
        let (speed, error) = speed(&window.t, degree, &solved, half);
        let side = window.back.iter().sum::<f64>().signum();
        let beyond = solved.angles.iter().skip(before).map(|angle| -side * angle);
        let at_fold = record.is_at(0, fold.value);
        Some(Beginning {
            speed,
            error,
            at_fold,
            turns_unseen: at_fold && beyond.fold(0.0, f64::max) > UNSEEN,
        })
    }
}

impl Motion<'_> {
    /// The last sample, up to one, before those that are so near to a fold of a size that noise may have turned them back.
    fn before_noise_folds(&self, to: usize) -> usize {
        let Motion {
            record, strokes, ..
        } = self;
        let is_folded = |i: usize| {
            let value = record.values[i];
            let folds = [true, false].map(|above| strokes.fold(value, above));
            let off = |fold: Fold| (value - fold.value).abs();
            folds
                .into_iter()
                .flatten()
                .any(|fold| off(fold) < FOLDED * record.noise)
        };
        match strokes.sensor.folds() {
            true => (1..=to).rev().find(|i| !is_folded(*i)).unwrap_or(0),
            false => to,
        }
    }
}

/// The simplest polynomial that explains a window, in terms of what was measured, and its degree.
fn simplest(window: &Window, sensor: &Sensor<'_>) -> Option<(usize, Solved)> {
    let weights: Vec<f64> = window.error.iter().map(|error| 1.0 / error).collect();
    let most = MOST.min(window.t.len() / 2);
    let fit = fitted(&window.t, &over(&window.back, &weights), &weights, most);
    let solved =
        (1..fit.squares.len()).map(|degree| (degree, solved(window, sensor, &fit, degree)));
    let cost = |(degree, solved): &(usize, Solved)| {
        let (degree, squares) = (*degree, solved.squares);
        Misfit { degree, squares }.cost()
    };
    solved.min_by(|a, b| cost(a).total_cmp(&cost(b)))
}

/// The speed at the first of some times from −1 to 1, `half` in s, and its standard error.
fn speed(t: &[f64], degree: usize, solved: &Solved, half: f64) -> (f64, f64) {
    let ones = vec![1.0; t.len()];
    let slope = |fit: &Expansion<f64>| {
        (fit.value(degree, t[0] + STEP) - fit.value(degree, t[0])) / (STEP * half)
    };
    let speed = slope(&fitted(t, &solved.angles, &ones, degree));
    // Each of the orthonormal polynomials has a coefficient of variance 1.
    let mut one = fitted(t, &solved.slopes, &solved.slopes, degree);
    let mut variance = 0.0;
    for j in 0..one.coefficients.len() {
        one.coefficients.fill(0.0);
        one.coefficients[j] = 1.0;
        variance += slope(&one).powi(2);
    }
    let free = t.len().saturating_sub(degree + 1).max(1) as f64;
    let misfit = (solved.squares / free).max(1.0);
    (speed, (variance * misfit).sqrt())
}
