//! How a rotation with harmonics is found: the number of harmonics, and Gauss and Newton's method.

use super::Size;
use super::choice::{best, undecided};
use super::condensed::Rows;
use super::decay::Decay;
use super::design::{UNTOLD, rounding, solve, squares, told};

/// Most harmonics that are chosen from the samples.
const MOST: usize = 64;

/// Harmonics beyond the last one whose part in the error is estimated.
const TAIL: usize = 6;

/// The second derivative of a harmonic grows with this power of its number, squared.
const GROWTH: i32 = 4;

/// Blocks for each period of the last harmonic, at which polynomials in them are harmonics but for rounding.
const NARROW: f64 = 6.0;

/// Corrections of the rotation after which a fit is given up.
const ROUNDS: usize = 40;

/// A step that gains less than this part of what noise gives a parameter settles a fit.
const SETTLED: f64 = 1e-8;

/// Part of all squares that is not worth a step, and part of what a step should gain that it gains at least, if that is not
/// rounding.
const NOTHING: f64 = 1e-6;
const HARDLY: f64 = 0.5;

/// The least part of a step that is tried.
const LEAST_PART: f64 = 1e-3;

const UNSETTLED: &str =
    "the fit by rotation and harmonics, which is for steady speeds, does not settle";

/// Turns in a span at a speed.
pub(super) fn turns(speed: f64, [first, last]: [f64; 2]) -> f64 {
    speed.abs() * (last - first) / std::f64::consts::TAU
}

/// The fewest rows that see so many harmonics.
fn serving<'r>(levels: &'r [Rows<'r>], parameters: &[f64], count: usize) -> &'r Rows<'r> {
    let periods = turns(parameters[1], levels[0].span) * count.max(1) as f64;
    let serves = |level: &&Rows<'_>| {
        level
            .blocks()
            .is_none_or(|blocks| NARROW * periods <= blocks as f64)
    };
    levels.iter().rev().find(serves).unwrap_or(&levels[0])
}

pub(super) fn most_harmonics(samples: &Rows<'_>) -> usize {
    MOST.min((samples.count / 2).saturating_sub(2) / 2)
}

/// The number of harmonics that the samples support at about this rotation, if it is not given, and the variances of
/// the coefficients of those that follow.
pub(super) fn supported(
    levels: &[Rows<'_>],
    middle: f64,
    parameters: &[f64],
    size: Size,
) -> Result<(usize, Vec<f64>), String> {
    let rows = levels[0].count;
    let least = rows as f64 * levels[0].floor.powi(2);
    let mut most = most_harmonics(&levels[0]);
    let mut tried = match size {
        Size::Fixed(count) => (count + 2).min(most.max(count)),
        Size::Auto => 4.min(most),
    };
    loop {
        let samples = serving(levels, parameters, tried);
        // About the motion so far, not to lose small harmonics in the rounding of large ones.
        let known = &parameters[..parameters.len().min(2 + 2 * tried)];
        let triangle = told(samples, middle, known, tried);
        let Some(columns) = triangle.size().checked_sub(2) else {
            return Err(UNTOLD.to_owned());
        };
        if columns < 2 * tried {
            (most, tried) = (columns / 2, columns / 2);
        }
        if let Size::Fixed(count) = size
            && count > tried
        {
            return Err(format!(
                "the samples are at so few angles of a turn that they tell no more than {tried} harmonics"
            ));
        }
        let mut harmonics = known.to_vec();
        harmonics.truncate(2 + 2 * tried);
        harmonics[..2].fill(0.0);
        let squares = triangle
            .squares(&harmonics)
            .into_iter()
            .skip(2)
            .take(2 * tried + 1)
            .map(|s| samples.left + s);
        let squares: Vec<f64> = squares.collect();
        // Both parameters of a harmonic come together.
        let pairs: Vec<f64> = squares.iter().step_by(2).copied().collect();
        let found = best(rows, 2, 2, &pairs, least);
        if tried < most && size == Size::Auto && undecided(rows, 2, 2, &pairs, least) {
            tried = (2 * tried).min(most);
            continue;
        }
        let free = rows.saturating_sub(2 + 2 * tried).max(1) as f64;
        let noise = (pairs[tried] / free).max(least / rows as f64);
        let mut terms = vec![0.0];
        terms.extend(pairs.windows(2).map(|pair| (pair[0] - pair[1]).max(0.0)));
        let decay = Decay::of(&terms, 2.0, noise, found.max(1));
        let count = match size {
            Size::Fixed(count) => count,
            Size::Auto => decay.enough(found, most, GROWTH).unwrap_or(most),
        };
        let weights: f64 = samples.iter().map(|(_, weight, _)| weight * weight).sum();
        let beyond = count + 1..count + 1 + TAIL;
        let tail = decay.beyond(beyond, GROWTH).into_iter();
        return Ok((count, tail.map(|v| 2.0 * v / weights).collect()));
    }
}

/// Gauss and Newton's method for all parameters; a step that does not lessen the squares is halved.
pub(super) fn settle(
    levels: &[Rows<'_>],
    middle: f64,
    parameters: &mut Vec<f64>,
) -> Result<(), String> {
    let count = parameters.len() / 2 - 1;
    let samples = serving(levels, parameters, count);
    let free = (samples.count - parameters.len()).max(1) as f64;
    let rounding = rounding(samples, middle, parameters);
    let mut before = squares(samples, middle, parameters);
    for _ in 0..ROUNDS {
        let (triangle, step) = solve(samples, middle, parameters, count)?;
        let sums = triangle.squares(&[]);
        let gain = sums[0] - sums[sums.len() - 1];
        let noise = (before / free).max(samples.floor * samples.floor);
        // What the step should gain, in units of what one parameter gains from noise.
        if gain <= SETTLED * noise {
            return Ok(());
        }
        let is_rounding = gain < (NOTHING * before).max(rounding);
        let mut part = 1.0;
        loop {
            let moved = parameters.iter().zip(&step).map(|(p, s)| p + part * s);
            let moved: Vec<f64> = moved.collect();
            let after = squares(samples, middle, &moved);
            let gained = before - after;
            if gained > 0.0 {
                (*parameters, before) = (moved, after);
                if is_rounding && gained < HARDLY * gain {
                    return Ok(());
                }
                break;
            }
            if is_rounding {
                return Ok(());
            }
            if part < LEAST_PART {
                return Err(UNSETTLED.to_owned());
            }
            part *= 0.5;
        }
    }
    Err(UNSETTLED.to_owned())
}
