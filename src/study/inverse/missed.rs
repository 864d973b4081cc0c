//! What a curve misses of a motion that it cannot follow: a spline through its residuals.
//!
//! Smoothing the residuals as a spline through all of the motion smooths that has the errors of such a spline, whatever
//! part of the residuals is noise: these are added, so that nothing has to tell the one from the other.

use super::pattern::Pattern;
use crate::numeric::fit::{Curve, Kind, Rows, Samples, Size, State};

/// Correlation of each residual with the next from which residuals are taken for a curve of their own: that of waves of
/// eight samples. From 0.5 to 0.85 no band of 49 misfits changes.
const SMOOTH: f64 = 0.7;

/// Part of what is missed of angle, speed and acceleration that is left where these make up for each other; where much of
/// the angle (rad) is missed the equation bends, and more is left. Half or twice as much moves the coverage of 49 misfits by
/// less than 0.001.
const LEFT: f64 = 0.1;

/// Part of the squares of residuals that is much where a spline leaves it of them in a pattern: a tenth of their size.
const MUCH: f64 = 0.01;

/// Most residuals that are looked at where they have a pattern.
const MOST: usize = 2000;

/// Most where noise or rounding hides it: the time grows with them.
const HIDDEN: usize = 100_000;

/// Corrections of what is missed of a crank angle that was not measured itself.
const ROUNDS: usize = 3;

/// Most places at which errors are compared.
const PLACES: usize = 500;

/// Standard errors beyond which a difference is certain.
const CERTAIN: f64 = 5.0;

/// The acceleration, as a combination of angle, speed and acceleration.
const ACCELERATION: [f64; 3] = [0.0, 0.0, 1.0];

/// Residuals of a fit as a curve.
#[derive(Debug)]
pub(super) struct Missed {
    curve: Curve,
    /// The spline through all of the motion, if that through the residuals is no freer than it.
    whole: Option<Curve>,
    /// Standard deviation of a sample by noise beside that curve.
    pub noise: f64,
    /// Whether that curve leaves little of the residuals, or nothing but noise.
    follows: bool,
    /// Root mean square of the acceleration, rad/s².
    acceleration: f64,
}

impl Missed {
    /// The curve that residuals show which have a pattern, or are those of a fit that was to have more terms; none where the
    /// fit, for samples of the standard deviation `sigma`, tells more of its errors, and errors as large.
    pub fn of(
        curve: &Curve,
        samples: &Samples<'_>,
        line: &Line<'_>,
        pattern: &Pattern,
        sigma: f64,
    ) -> Option<Missed> {
        let last = samples.t.len() - 1;
        let asked = pattern.clear || curve.is_cut_short() && last < HIDDEN;
        if curve.kind() == Kind::Spline || !asked {
            return None;
        }
        // What noise or rounding hides is told by all samples only.
        let steps = if pattern.clear { last.min(MOST) } else { last };
        let looked = Looked::at(curve, samples, line, steps);
        let rounds = if samples.weight.is_some() { ROUNDS } else { 1 };
        let (motion, mut missed) = looked.settled(pattern, rounds)?;
        let every = looked.t.len().div_ceil(PLACES);
        let places: Vec<f64> = looked.t.iter().step_by(every).copied().collect();
        let squares = places.iter().map(|t| motion.derivatives(*t)[2].powi(2));
        missed.acceleration = (squares.sum::<f64>() / places.len() as f64).sqrt();
        missed.says_more(curve, sigma, &places).then_some(missed)
    }

    /// Whether, by the squares of the acceleration at these times, its stated errors are smaller with what is missed than without,
    /// or more is missed than is stated without; or at one of them it is certainly wrong.
    fn says_more(&self, curve: &Curve, sigma: f64, places: &[f64]) -> bool {
        let square = |state: &State, sigma: f64| {
            sigma * sigma * state.variance(&ACCELERATION) + state.bias_of(&ACCELERATION)
        };
        let [mut before, mut after, mut seen] = [0.0; 3];
        for t in places {
            let state = curve.state(*t);
            before += square(&state, sigma);
            let more = self.curve.state(*t);
            let off = match &self.whole {
                Some(whole) => whole.derivatives(*t)[2] - state.value[2],
                None => more.value[2],
            };
            seen += off.powi(2);
            after += square(&self.beside(state, &more, *t), self.noise);
        }
        let is_lost = || places.iter().any(|t| self.is_most(&curve.state(*t), *t));
        after < before || seen > before || is_lost()
    }

    /// The spline through what is left of samples, as free as one through all of the motion at least: of waves that noise
    /// hides in the residuals these tell nothing. Residuals that are a curve may ask for a freer one.
    fn beside_motion(motion: &Curve, left: &Samples<'_>, pattern: &Pattern) -> Option<Missed> {
        let alike = motion.again(&Rows::from(left)).ok()?;
        let freer = |own: &Curve| own.quality().parameters >= alike.quality().parameters;
        let own = (pattern.lag_one > SMOOTH).then(|| Curve::fit(left, Kind::Spline, Size::Auto));
        let own = own.transpose().ok()?.filter(freer);
        let whole = own.is_none().then(|| motion.clone());
        let mut curve = own.unwrap_or(alike);
        let (noise, follows) = noise_beside(&mut curve, left);
        Some(Missed {
            curve,
            whole,
            noise,
            follows,
            acceleration: 0.0,
        })
    }

    /// Whether this is about the same as what was found before, as it is once it has settled.
    fn is_alike(&self, before: Option<&Missed>, t: &[f64]) -> bool {
        let squares = t.iter().fold([0.0; 2], |[all, changed], t| {
            let value = self.curve.value(*t);
            let change = value - before.map_or(0.0, |before| before.curve.value(*t));
            [all + value * value, changed + change * change]
        });
        squares[1] <= LEFT * LEFT * squares[0]
    }

    /// Whether certainly more is missed of the acceleration of a state of the fit than there usually is.
    pub fn is_most(&self, state: &State, t: f64) -> bool {
        let off = match &self.whole {
            Some(whole) => whole.derivatives(t)[2] - state.value[2],
            None => self.curve.derivatives(t)[2],
        };
        let by_noise = CERTAIN * self.noise * state.variance(&ACCELERATION).sqrt();
        off.abs() > self.acceleration.max(by_noise)
    }

    /// The states of the fit at rising times with what it misses as what may be wrong.
    pub fn all_beside(&self, mut states: Vec<State>, t: &[f64]) -> Vec<State> {
        for ((state, missed), t) in states.iter_mut().zip(self.curve.states(t)).zip(t) {
            *state = self.beside(*state, &missed, *t);
        }
        states
    }

    /// With what is missed at a time. A fit that goes up and down between its samples hides that from the residuals, not from
    /// a spline through all of the motion.
    fn beside(&self, state: State, missed: &State, t: f64) -> State {
        let left = LEFT + missed.value[0].abs();
        let hidden = self.whole.as_ref().map(|whole| {
            let whole = whole.derivatives(t);
            std::array::from_fn(|k| whole[k] - state.value[k] - missed.value[k])
        });
        let state = state.wrong_by(missed, self.noise, left);
        hidden.map_or(state, |hidden| state.off_by(&hidden))
    }
}

/// What a sample leaves beside the fit with so much more of the crank angle, rad, and by how much the measured value grows
/// with the latter.
type Line<'a> = dyn Fn(usize, f64) -> (f64, f64) + 'a;

/// The samples of a fit that are looked at.
struct Looked<'a> {
    curve: &'a Curve,
    line: &'a Line<'a>,
    chosen: Vec<usize>,
    /// Their times, s.
    t: Vec<f64>,
    floor: f64,
}

impl<'a> Looked<'a> {
    /// The first one and so many more, evenly among all.
    fn at(curve: &'a Curve, samples: &Samples<'_>, line: &'a Line<'a>, steps: usize) -> Looked<'a> {
        let last = samples.t.len() - 1;
        let chosen: Vec<usize> = (0..=steps).map(|i| i * last / steps).collect();
        Looked {
            curve,
            line,
            t: chosen.iter().map(|i| samples.t[*i]).collect(),
            chosen,
            floor: samples.floor,
        }
    }

    /// The spline through all of the motion, and what the fit misses, once that has settled.
    fn settled(&self, pattern: &Pattern, rounds: usize) -> Option<(Curve, Missed)> {
        let mut found: Option<(Curve, Missed)> = None;
        let mut settled = true;
        for _ in 0..rounds {
            let before = found.as_ref().map(|(_, missed)| missed);
            let (motion, missed) = self.corrected(before, pattern)?;
            settled = rounds == 1 || missed.is_alike(before, &self.t);
            found = Some((motion, missed));
        }
        found.filter(|(_, missed)| settled && missed.follows)
    }

    /// The same, with samples that are linear about what was found before.
    fn corrected(&self, before: Option<&Missed>, pattern: &Pattern) -> Option<(Curve, Missed)> {
        let lines = self.chosen.iter().zip(&self.t).map(|(i, t)| {
            let more = before.map_or(0.0, |before| before.curve.value(*t));
            let (residual, slope) = (self.line)(*i, more);
            [slope, residual + slope * more, slope * self.curve.value(*t)]
        });
        let lines: Vec<[f64; 3]> = lines.collect();
        let each = |of: fn(&[f64; 3]) -> f64| -> Vec<f64> { lines.iter().map(of).collect() };
        let weight = each(|line| line[0]);
        let (left, whole) = (each(|line| line[1]), each(|line| line[1] + line[2]));
        let rows = |target| Samples {
            t: &self.t,
            target,
            weight: Some(&weight),
            floor: self.floor,
        };
        let motion = Curve::fit(&rows(&whole), Kind::Spline, Size::Auto).ok()?;
        let missed = Missed::beside_motion(&motion, &rows(&left), pattern)?;
        Some((motion, missed))
    }
}

/// Standard deviation of a sample beside a spline, widened where what that leaves has a pattern; and whether it follows the
/// samples, other than one that leaves much of them as well.
fn noise_beside(spline: &mut Curve, samples: &Samples<'_>) -> (f64, bool) {
    let through = spline.compare(samples);
    let quality = spline.quality();
    if through {
        return (quality.sigma, true);
    }
    let residuals = samples.left(&spline.values(samples.t));
    let pattern = Pattern::of(&residuals, spline, samples.t, quality.floor);
    let squares: f64 = samples.target.iter().map(|target| target * target).sum();
    let follows = !pattern.clear || quality.squares <= MUCH * squares;
    (quality.sigma * pattern.widening, follows)
}
