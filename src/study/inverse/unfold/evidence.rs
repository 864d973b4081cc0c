//! Which of two motions the samples tell: one that goes back from a fold, or one that passes it.
//!
//! Both are told by polynomials of rising degree. The motion whose crank angle is smooth needs a low degree to leave
//! nothing but noise; the other one has a bend at the fold, and needs a high degree if it gets there at all.

use super::super::sensor::Sensor;
use super::refined::refined;
use super::touching::stays_off;
use super::window::Window;
use crate::numeric::orthogonal::{self, Expansion};

/// Largest degree.
pub(super) const MOST: usize = 12;

/// Squared standard errors that a degree d is to bring, over ln(1 + d).
const DEGREE: f64 = 16.0;

/// Evidence that decides.
pub(super) const ENOUGH: f64 = 25.0;

/// Ratio of the sums of squares that is as much, where neither motion leaves noise alone.
const RATIO: f64 = 1e4;

/// Standard deviations by which a sum of squares that is noise may be large.
const NOISE: f64 = 4.0;

/// Fewest blocks away from the fold on either side, and fewest in all.
const CLEAR: usize = 1;
const FEWEST: usize = 5;

/// Parts of all degrees within which a motion is simple.
const PARTS: usize = 4;
const HALF: usize = 2;
const MOST_PARTS: usize = 3;

/// What counts as far less, of a sum of squares.
const FAR_LESS: f64 = 100.0;

/// Evidence so many times as much as decides is plain if a motion is explained, and if none is.
const PLAIN: f64 = 50.0;
const PLAIN_UNEXPLAINED: f64 = 1.5;

/// For or against a passage.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Evidence {
    /// By how much the motion that goes back is worse, in squared standard errors; it is better if this is negative.
    pub passes: f64,
    /// Whether the better one leaves nothing but noise.
    pub explained: bool,
    /// Whether a motion that goes back does so before the fold: one that comes to rest just there may as well pass it.
    pub stays_off: bool,
}

impl Evidence {
    /// What the samples of a window tell.
    pub fn of(window: &Window, sensor: &Sensor<'_>) -> Evidence {
        let Some((rough, fits)) = Evidence::at_first_sight(window) else {
            return Evidence::default();
        };
        let evidence = if rough.is_plain() {
            rough
        } else {
            let [back, past] = fits.each_ref().map(|fit| refined(window, sensor, fit));
            Evidence::between(&back, &past, window.t.len())
        };
        Evidence {
            stays_off: evidence.passes < 0.0 && stays_off(window, sensor, &fits[0]),
            ..evidence
        }
    }

    /// What the crank angles of a window tell by themselves, and the polynomials through those that go back and that pass.
    pub fn at_first_sight(window: &Window) -> Option<(Evidence, [Expansion<f64>; 2])> {
        let count = window.t.len();
        if window.clear.iter().any(|clear| *clear < CLEAR) || count < FEWEST {
            return None;
        }
        let most = MOST.min(count / 2 + 1);
        let weights: Vec<f64> = window.error.iter().map(|error| 1.0 / error).collect();
        let fit = |angles: &Vec<f64>| fitted(&window.t, &over(angles, &weights), &weights, most);
        let back = fit(&window.back);
        let last = |fit: &Expansion<f64>| fit.squares.last().copied().unwrap_or(f64::INFINITY);
        let past = window.past.iter().map(fit);
        let past = past.min_by(|a, b| last(a).total_cmp(&last(b)))?;
        let evidence = Evidence::between(&misfits(&back), &misfits(&past), count);
        Some((evidence, [back, past]))
    }

    /// Whether a motion plainly passes, and leaves nothing but noise.
    pub fn tells_a_passage(&self) -> bool {
        self.explained && self.passes > 0.0 && self.is_plain()
    }

    /// Whether there is no need to look closer.
    fn is_plain(&self) -> bool {
        let plain = if self.explained {
            PLAIN
        } else {
            PLAIN_UNEXPLAINED
        };
        self.passes.abs() > plain * ENOUGH
    }

    /// Whether there is no need to look elsewhere.
    pub fn is_clear(&self) -> bool {
        self.is_plain() || self.explained && self.passes.abs() > 4.0 * ENOUGH
    }

    /// Whether a motion clearly passes, and leaves nothing but noise.
    pub fn is_clear_passage(&self) -> bool {
        self.explained && self.passes > 0.0 && self.is_clear()
    }

    pub fn between(back: &[Misfit], past: &[Misfit], count: usize) -> Evidence {
        let samples = count as f64;
        let free = |misfit: &Misfit| samples - misfit.degree as f64 - 1.0;
        let most = back.iter().chain(past).map(|m| m.degree).max().unwrap_or(0);
        let noise = most_noise(samples);
        let explains = |m: &&Misfit| m.squares < noise * free(m);
        let simplest = back
            .iter()
            .chain(past)
            .filter(explains)
            .map(|m| m.degree)
            .min();
        if let Some(degree) = simplest {
            let cost = |list: &[Misfit]| least(list, Misfit::cost);
            let explained = Evidence {
                passes: cost(back) - cost(past),
                explained: true,
                stays_off: false,
            };
            // Only what leaves half of the degrees to the other motion shows that it needs more, or what leaves it some that
            // by far are not enough.
            let leaves = |part: usize| PARTS * degree <= part * most + 1;
            if leaves(HALF) || leaves(MOST_PARTS) && explained.is_plain() {
                return explained;
            }
        }
        let left = |list: &[Misfit]| least(list, |m| m.squares / free(m));
        Evidence {
            passes: ENOUGH * (left(back) / left(past)).ln() / RATIO.ln(),
            ..Evidence::default()
        }
    }
}

/// Whether one motion leaves far less than another one that has more degrees, and that noise does not explain.
pub(super) fn is_simpler(one: &Expansion<f64>, other: &Expansion<f64>) -> bool {
    let most = one.squares.len().min(other.squares.len()).saturating_sub(1);
    let (left, others) = (
        one.squares.get(most * MOST_PARTS / PARTS),
        other.squares.get(most),
    );
    match (left, others) {
        (Some(left), Some(others)) => *others > (FAR_LESS * left).max(PLAIN * ENOUGH),
        _ => false,
    }
}

/// Whether a polynomial through a window leaves nothing but noise, with all of its degrees.
pub(super) fn leaves_noise(fit: &Expansion<f64>, window: &Window) -> bool {
    let samples = window.t.len() as f64;
    let left = fit.squares.last();
    left.is_some_and(|left| *left < most_noise(samples) * (samples - fit.squares.len() as f64))
}

/// The most that noise leaves of so many samples, for each degree of freedom.
fn most_noise(samples: f64) -> f64 {
    1.0 + NOISE * (2.0 / samples).sqrt()
}

/// What a polynomial leaves.
#[derive(Clone, Copy, Debug)]
pub(super) struct Misfit {
    pub degree: usize,
    /// Sum of squares in squared standard errors.
    pub squares: f64,
}

impl Misfit {
    pub fn cost(&self) -> f64 {
        self.squares + DEGREE * (self.degree as f64).ln_1p()
    }
}

/// The least of what polynomials leave, in some measure.
pub(super) fn least(list: &[Misfit], of: impl Fn(&Misfit) -> f64) -> f64 {
    list.iter().map(of).fold(f64::INFINITY, f64::min)
}

pub(super) fn over(values: &[f64], weights: &[f64]) -> Vec<f64> {
    values.iter().zip(weights).map(|(v, w)| v * w).collect()
}

pub(super) fn fitted(t: &[f64], target: &[f64], weights: &[f64], most: usize) -> Expansion<f64> {
    orthogonal::fit(t, target, Some(weights), |squares| squares.len() <= most)
}

/// What the polynomials of each degree leave.
pub(super) fn misfits(fit: &Expansion<f64>) -> Vec<Misfit> {
    let list = fit.squares.iter().enumerate();
    list.map(|(degree, squares)| Misfit {
        degree,
        squares: *squares,
    })
    .collect()
}
