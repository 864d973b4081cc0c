//! What a fit, its residuals and rounding tell of the errors of a motion.

use super::missed::Missed;
use super::pattern::{Pattern, in_waves};
use super::rounding::Rounding;
use super::waves::Waves;
use crate::numeric::fit::{Curve, Kind, Samples, State};
use std::f64::consts::{PI, TAU};

/// Part of the terms of the equation to which a computed motion is right, as a standard deviation: it obeys an equation that
/// was approximated, and to a tolerance of 1e-10 for each step.
const EXACT: f64 = 1.5e-12;

/// Part of what samples may be off that were computed which no residuals show.
const PART: f64 = 0.2;

/// What is known of the errors of a fitted motion, beside what the curve knows of its own.
#[derive(Debug)]
pub(super) struct Errors {
    pub pattern: Pattern,
    /// Whether the curve goes through its samples, and curves through fewer of them tell its error.
    pub through: bool,
    /// Standard deviation of a sample by noise alone: rounding that is not noise is in the curve's errors.
    noise: f64,
    /// Standard deviation of a sample that was computed.
    computed: f64,
    /// Part of the terms of the equation to which the motion that samples show is known, if they were computed.
    pub exact: f64,
    /// Degrees of freedom of the noise.
    pub free: f64,
    /// What the curve misses of the motion, if its residuals show it.
    pub missed: Option<Missed>,
    /// Waves in the residuals that the curve does not follow, in terms of the motion.
    pub waves: Option<Waves>,
}

impl Errors {
    /// Those of a curve that leaves these residuals, for samples that may be off by `computed` even without noise. `line` is
    /// that of [`Missed::of`].
    pub fn of(
        curve: &mut Curve,
        samples: &Samples<'_>,
        residuals: &[f64],
        computed: f64,
        line: impl Fn(&Curve, usize, f64) -> (f64, f64),
    ) -> Errors {
        let quality = curve.quality();
        let known = quality.floor.max(computed);
        let mut pattern = Pattern::of(residuals, curve, samples.t, known);
        // Nothing but rounding is left of samples that no file or instrument has rounded.
        let is_exact = !pattern.shown && quality.floor <= computed;
        if is_exact {
            pattern.widening = in_waves(residuals, quality.parameters);
        }
        let rows = residuals.len() as f64;
        let through = curve.compare(samples);
        let repeated = match curve.kind() {
            Kind::Fourier => turns(curve, samples.t).max(1.0).sqrt(),
            Kind::Polynomial | Kind::Spline => 1.0,
        };
        let mut errors = Errors {
            pattern,
            through,
            noise: curve.quality().sigma,
            computed: PART * computed * repeated,
            exact: if is_exact { EXACT } else { 0.0 },
            free: (rows - quality.parameters).max(1.0),
            missed: None,
            waves: None,
        };
        if through {
            // The residuals tell nothing; the noise is seen in differences that overlap.
            errors.pattern.widening = 1.0;
            errors.free = 0.5 * rows;
            return errors;
        }
        let line = |i: usize, more: f64| line(curve, i, more);
        errors.missed = Missed::of(curve, samples, &line, &errors.pattern, errors.sigma());
        if let Some(missed) = &errors.missed {
            errors.noise = missed.noise;
            errors.pattern.widening = 1.0;
        }
        // A spline through a pattern that is clear has its waves in it.
        if errors.pattern.shown && (errors.missed.is_none() || !errors.pattern.clear) {
            let followed = quality.parameters / rows * part_in_waves(curve.kind());
            errors.waves = Waves::of(residuals, samples, followed);
        }
        errors
    }

    /// Leaves to the curve what of the errors of the samples is rounding and not noise.
    pub fn without(&mut self, rounding: &Rounding) {
        self.noise = rounding.noise(self.noise);
        self.pattern.widening = 1.0;
        self.missed = None;
    }

    /// Standard deviation of a measured value by noise, widened where the residuals are not independent.
    pub fn sigma(&self) -> f64 {
        (self.noise * self.pattern.widening).hypot(self.computed)
    }

    /// The motion at rising times, rad and s.
    pub fn states(&self, curve: &Curve, t: &[f64]) -> Vec<State> {
        let mut states = curve.states(t);
        if let Some(missed) = &self.missed {
            states = missed.all_beside(states, t);
        }
        if let Some(waves) = &self.waves {
            let all = states.iter_mut();
            all.for_each(|state| *state = waves.beside(*state));
        }
        states
    }
}

/// The waves that a curve follows all along, as a part of those of half as many as parameters. A polynomial has fewer in its
/// middle than at its ends.
fn part_in_waves(kind: Kind) -> f64 {
    match kind {
        Kind::Polynomial => 2.0 / PI,
        Kind::Spline | Kind::Fourier => 1.0,
    }
}

/// Turns from the first to the last of these times.
pub(super) fn turns(curve: &Curve, t: &[f64]) -> f64 {
    let [first, last] = [t[0], t[t.len() - 1]].map(|t| curve.value(t));
    (last - first).abs() / TAU
}
