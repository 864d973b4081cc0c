//! What a curve misses of a motion that it cannot follow: a spline through its residuals, where these are a smooth curve.

use super::pattern::Pattern;
use crate::numeric::fit::{Curve, Kind, Samples, Size, State};

/// Correlation of each residual with the next from which residuals are taken for a curve and not for noise.
const SMOOTH: f64 = 0.7;

/// Part of the squares of residuals that a spline may leave: noise hides derivatives of what it does not follow.
const NOISY: f64 = 1e-3;

/// Part of what is missed of angle, speed and acceleration that is left where these make up for each other; where much of
/// the angle (rad) is missed the equation bends, and more is left.
const LEFT: f64 = 0.1;

/// Most residuals that are looked at.
const MOST: usize = 4000;

/// Most places at which errors are compared.
const PLACES: usize = 500;

/// Residuals of a fit as a curve.
#[derive(Debug)]
pub(super) struct Missed {
    curve: Curve,
    /// Standard deviation of a sample by noise beside that curve.
    pub noise: f64,
}

impl Missed {
    /// The curve that residuals with a pattern show; none where the fit, for samples of the standard deviation `sigma`,
    /// already tells more of its errors.
    pub fn of(
        curve: &Curve,
        samples: &Samples<'_>,
        residuals: &[f64],
        pattern: &Pattern,
        sigma: f64,
    ) -> Option<Missed> {
        if !pattern.clear || pattern.lag_one < SMOOTH || curve.kind() == Kind::Spline {
            return None;
        }
        let stride = residuals.len().div_ceil(MOST);
        let part = |list: &[f64]| -> Vec<f64> { list.iter().step_by(stride).copied().collect() };
        let (t, target) = (part(samples.t), part(residuals));
        let weight = samples.weight.map(part);
        let left = Samples {
            t: &t,
            target: &target,
            weight: weight.as_deref(),
            floor: samples.floor,
        };
        let mut found = Curve::fit(&left, Kind::Spline, Size::Auto).ok()?;
        let squares: f64 = target.iter().map(|r| r * r).sum();
        if found.quality().squares > NOISY * squares {
            return None;
        }
        found.compare(&left);
        let noise = found.quality().sigma;
        let missed = Missed {
            curve: found,
            noise,
        };
        let acceleration = [0.0, 0.0, 1.0];
        let square = |state: &State, sigma: f64| {
            sigma * sigma * state.variance(&acceleration) + state.bias_of(&acceleration)
        };
        let (mut before, mut after) = (0.0, 0.0);
        for t in t.iter().step_by(t.len().div_ceil(PLACES)) {
            let state = curve.state(*t);
            before += square(&state, sigma);
            after += square(&missed.beside(state, *t), noise);
        }
        (after < before).then_some(missed)
    }

    /// The state of the fit with what it misses as what may be wrong.
    pub fn beside(&self, state: State, t: f64) -> State {
        let missed = self.curve.state(t);
        let left = LEFT + missed.value[0].abs();
        state.wrong_by(&missed, self.noise, left)
    }
}
