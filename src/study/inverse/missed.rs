//! What a curve misses of a motion that it cannot follow: a spline through its residuals, where these are a smooth curve.

use super::errors::turns;
use super::pattern::Pattern;
use crate::numeric::fit::{Curve, Kind, Rows, Samples, Size, State};

/// Correlation of each residual with the next from which residuals are taken for a curve and not for noise.
const SMOOTH: f64 = 0.7;

/// Part of the squares of residuals that a spline may leave: noise hides derivatives of what it does not follow.
const NOISY: f64 = 0.01;

/// Part of what is missed of angle, speed and acceleration that is left where these make up for each other; where much of
/// the angle (rad) is missed the equation bends, and more is left.
const LEFT: f64 = 0.1;

/// Samples of a wave of the last harmonic below which waves beyond it look slower than they are, and below which some do.
const OF_WAVE: [f64; 2] = [2.0, 8.0];

/// Part of the variance of the acceleration from which on waves are taken for noise where some look slower than they are.
const UNSEEN: f64 = 0.1;

/// Part of an error of one sample that a curve follows, beyond which its residual hardly shows what is missed.
const FOLLOWED: f64 = 0.5;

/// Most residuals that are looked at.
const MOST: usize = 2000;

/// Corrections of what is missed of a crank angle that was not measured itself.
const ROUNDS: usize = 3;

/// Most places at which errors are compared.
const PLACES: usize = 500;

/// Residuals of a fit as a curve.
#[derive(Debug)]
pub(super) struct Missed {
    curve: Curve,
    /// Times between which residuals show what is missed: at the ends of the samples a polynomial follows each of them.
    shown: [f64; 2],
    /// Standard deviation of a sample by noise beside that curve.
    pub noise: f64,
}

impl Missed {
    /// The curve that residuals with a pattern show; none where the fit, for samples of the standard deviation `sigma`,
    /// tells more of its errors, and errors as large.
    ///
    /// `line` gives what a sample leaves beside the fit with so much more of the crank angle, rad, and by how much the
    /// measured value grows with the latter.
    pub fn of(
        curve: &Curve,
        samples: &Samples<'_>,
        line: &dyn Fn(usize, f64) -> (f64, f64),
        pattern: &Pattern,
        sigma: f64,
    ) -> Option<Missed> {
        if !pattern.clear || pattern.lag_one < SMOOTH || curve.kind() == Kind::Spline {
            return None;
        }
        let of_wave = of_wave(curve, samples.t);
        if of_wave < OF_WAVE[0] {
            return None;
        }
        let last = samples.t.len() - 1;
        let steps = last.min(MOST);
        let chosen: Vec<usize> = (0..=steps).map(|i| i * last / steps).collect();
        let t: Vec<f64> = chosen.iter().map(|i| samples.t[*i]).collect();
        let part = |list: &[f64]| -> Vec<f64> { chosen.iter().map(|i| list[*i]).collect() };
        let (target, weight) = (part(samples.target), samples.weight.map(part));
        let motion = Samples {
            t: &t,
            target: &target,
            weight: weight.as_deref(),
            floor: samples.floor,
        };
        let motion = Curve::fit(&motion, Kind::Spline, Size::Auto).ok()?;
        let rounds = if samples.weight.is_some() { ROUNDS } else { 1 };
        let (mut found, mut follows) = (None, false);
        for _ in 0..rounds {
            let more = |t: f64| found.as_ref().map_or(0.0, |found: &Curve| found.value(t));
            let lines = chosen.iter().zip(&t).map(|(i, t)| {
                let more = more(*t);
                let (residual, slope) = line(*i, more);
                (slope, residual + slope * more)
            });
            let (weight, target): (Vec<f64>, Vec<f64>) = lines.unzip();
            let left = Samples {
                t: &t,
                target: &target,
                weight: Some(&weight),
                floor: samples.floor,
            };
            let mut spline = freer(&motion, &left)?;
            let squares: f64 = target.iter().map(|r| r * r).sum();
            follows = spline.quality().squares <= NOISY * squares;
            if follows {
                spline.compare(&left);
            }
            found = Some(spline);
        }
        let spline = found.filter(|_| follows)?;
        let noise = spline.quality().sigma;
        let follows = |i: &usize| {
            let weight = samples.weight.map_or(1.0, |weight| weight[*i]);
            weight * weight * curve.state(samples.t[*i]).covariance[0] > FOLLOWED
        };
        let missed = Missed {
            curve: spline,
            shown: inner(&chosen, follows).map(|i| samples.t[i]),
            noise,
        };
        let acceleration = [0.0, 0.0, 1.0];
        let square = |state: &State, sigma: f64| {
            sigma * sigma * state.variance(&acceleration) + state.bias_of(&acceleration)
        };
        let (mut before, mut after, mut seen, mut noisy) = (0.0, 0.0, 0.0, 0.0);
        let places = t.iter().step_by(t.len().div_ceil(PLACES));
        for t in places.filter(|t| missed.shows(**t)) {
            let state = curve.state(*t);
            before += square(&state, sigma);
            let more = missed.curve.state(*t);
            seen += more.value[2] * more.value[2];
            after += square(&missed.beside(*t, state, &more), noise);
            noisy += noise * noise * state.variance(&acceleration);
        }
        if of_wave < OF_WAVE[1] && noisy > UNSEEN * after {
            return None;
        }
        (after < before || seen > before).then_some(missed)
    }

    /// The states of the fit at rising times with what it misses as what may be wrong.
    pub fn all_beside(&self, mut states: Vec<State>, t: &[f64]) -> Vec<State> {
        for ((state, missed), t) in states.iter_mut().zip(self.curve.states(t)).zip(t) {
            *state = self.beside(*t, *state, &missed);
        }
        states
    }

    fn shows(&self, t: f64) -> bool {
        let [first, last] = self.shown;
        first < t && t < last
    }

    fn beside(&self, t: f64, state: State, missed: &State) -> State {
        let left = LEFT + missed.value[0].abs();
        let mut found = state.wrong_by(missed, self.noise, left);
        if !self.shows(t) {
            let pairs = found.bias.iter_mut().zip(state.bias);
            pairs.for_each(|(found, own)| *found += own);
        }
        found
    }
}

/// The first and the last of these samples between which no sample of either half is followed.
fn inner(samples: &[usize], follows: impl Fn(&usize) -> bool) -> [usize; 2] {
    let (before, after) = samples.split_at(samples.len() / 2);
    let first = before.iter().rev().find(|i| follows(i));
    let last = after.iter().find(|i| follows(i));
    [first.or(samples.first()), last.or(samples.last())].map(|i| i.copied().unwrap_or(0))
}

/// Samples at these times for each wave of the last harmonic; a polynomial is followed closer by any number of samples.
fn of_wave(curve: &Curve, t: &[f64]) -> f64 {
    match curve.kind() {
        Kind::Fourier => t.len() as f64 / (curve.size().max(1) as f64 * turns(curve, t)),
        Kind::Polynomial | Kind::Spline => f64::INFINITY,
    }
}

/// The spline through what is left of samples, as free as one through all of the motion (`motion`) at least: of waves that
/// noise hides in the residuals these tell nothing.
fn freer(motion: &Curve, left: &Samples<'_>) -> Option<Curve> {
    let alike = motion.again(&Rows::from(left)).ok()?;
    let own = Curve::fit(left, Kind::Spline, Size::Auto).ok()?;
    let parameters = |curve: &Curve| curve.quality().parameters;
    Some(if parameters(&alike) > parameters(&own) {
        alike
    } else {
        own
    })
}
