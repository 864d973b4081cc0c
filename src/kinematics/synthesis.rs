//! Synthesis: crank, rod and offset for a wanted stroke and time ratio, in closed form.

use std::f64::consts::PI;

use serde::Serialize;

use super::{Kinematics, kinematics};
use crate::error::Error;
use crate::scene::Scene;

/// Choice between the mechanisms of one stroke and time ratio. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Choice {
    /// Mechanism with the largest least transmission angle.
    BestTransmission,
    /// Given crank length.
    Crank(f64),
    /// Given rod length.
    Rod(f64),
    /// Given size of the offset.
    Offset(f64),
    /// Given ratio of rod to crank.
    RodRatio(f64),
}

/// Mechanism of the branch `right` with a wanted stroke and time ratio.
#[derive(Clone, Debug, Serialize)]
pub struct Synthesis {
    /// Crank length, m.
    pub crank_m: f64,
    /// Rod length, m.
    pub rod_m: f64,
    /// Offset, m, negative for time ratios below 1.
    pub offset_m: f64,
    /// Kinematics of one turn.
    pub turn: Kinematics,
}

/// Solves for crank, rod and offset from a stroke (m, positive) and a time ratio (1/3 to 3 if the crank turns fully).
///
/// At the dead centres the slider pin is l + r and l - r from O, under an angle of a = pi (K - 1)/(K + 1) for the time
/// ratio K. With the stroke H the law of cosines is an ellipse, l = (H/2) sin u / sin(a/2) and r = (H/2)
/// cos u / cos(a/2), and the area of the triangle gives e = (l^2 - r^2) sin(a)/H. The crank turns fully where
/// a/2 < u < pi/2 - a/2. The transmission angle, cos mu = (r + e)/l, is best where cos u = (sqrt(4 + S^2) - S)/2 with
/// S = sin(a/2), the root of (c - S)(c^2 + S c - 1) = 0 within. (For the graphical method see VDI 2126.)
///
/// # Errors
/// [`Error::Refused`] if no mechanism fits, with the range in which some do.
///
/// ```
/// use slider_crank::kinematics::{Choice, synthesis};
/// let press = synthesis(0.1, 1.25, Choice::BestTransmission)?;
/// assert!((press.turn.stroke_m - 0.1).abs() < 1e-15);
/// assert!((press.turn.time_ratio.unwrap() - 1.25).abs() < 1e-14);
/// assert!(synthesis(0.1, 3.5, Choice::BestTransmission).is_err());
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
pub fn synthesis(stroke: f64, time_ratio: f64, choice: Choice) -> Result<Synthesis, Error> {
    let is_slower = time_ratio >= 1.0;
    let ratio = match is_slower {
        true => time_ratio,
        false => 1.0 / time_ratio,
    };
    if !(stroke > 0.0 && stroke.is_finite() && ratio < 3.0 && time_ratio > 0.0) {
        return Err(Error::refused(
            format!(
                "no slider-crank whose crank turns fully has a stroke of {stroke} m and a time ratio of {time_ratio}"
            ),
            "give a positive stroke, and a time ratio between 1/3 and 3",
        ));
    }
    let [crank, rod, offset] = lengths(0.5 * stroke, ratio, choice)?;
    let offset = if is_slower { offset } else { -offset };
    let scene = Scene::new(crank, rod).offset(offset);
    Ok(Synthesis {
        crank_m: crank,
        rod_m: rod,
        offset_m: offset,
        turn: kinematics(&scene)?,
    })
}

/// Solves for crank, rod and offset from half the stroke and a time ratio of 1 or more.
fn lengths(half: f64, ratio: f64, choice: Choice) -> Result<[f64; 3], Error> {
    if ratio == 1.0 {
        return in_line(half, choice);
    }
    let (sin, cos) = (0.5 * PI * (ratio - 1.0) / (ratio + 1.0)).sin_cos();
    let tan = sin / cos;
    let check = |name, value: f64, low: f64, high: f64| match low < value && value < high {
        true => Ok(()),
        false => Err(out_of_range(name, value, low, high)),
    };
    // Sine and cosine of u.
    let other = |one: f64| ((1.0 - one) * (1.0 + one)).sqrt();
    let [s, c] = match choice {
        Choice::BestTransmission => {
            let c = 2.0 / ((4.0 + sin * sin).sqrt() + sin);
            [(sin * c).sqrt(), c]
        }
        Choice::Rod(rod) => {
            check("rod", rod, half, half / tan)?;
            let s = rod * sin / half;
            [s, other(s)]
        }
        Choice::Crank(crank) => {
            check("crank", crank, half * tan, half)?;
            let c = crank * cos / half;
            [other(c), c]
        }
        Choice::Offset(offset) => {
            check("offset", offset, 0.0, half * (1.0 / tan - tan))?;
            let s = (sin * sin + offset * sin * cos / half).sqrt();
            [s, other(s)]
        }
        Choice::RodRatio(ratio) => {
            check(RATIO, ratio, 1.0, 1.0 / (tan * tan))?;
            let hypotenuse = (ratio * sin).hypot(cos);
            [ratio * sin / hypotenuse, cos / hypotenuse]
        }
    };
    let (crank, rod) = (half * c / cos, half * s / sin);
    let offset = half * (s - sin) * (s + sin) / (sin * cos);
    let mut lengths = [crank, rod, offset];
    // The given length stays exact to the last digit.
    match choice {
        Choice::Crank(crank) => lengths[0] = crank,
        Choice::Rod(rod) => lengths[1] = rod,
        Choice::Offset(offset) => lengths[2] = offset,
        Choice::BestTransmission | Choice::RodRatio(_) => {}
    }
    Ok(lengths)
}

/// Returns the lengths without offset: the crank is half the stroke, and any longer rod will do.
fn in_line(half: f64, choice: Choice) -> Result<[f64; 3], Error> {
    let rod = match choice {
        Choice::Rod(rod) => rod,
        Choice::RodRatio(ratio) => half * ratio,
        _ => {
            return Err(Error::refused(
                format!(
                    "with a time ratio of 1 the crank is {half} m and the offset 0, whatever the rod"
                ),
                "say which rod, like --rod-ratio 3.5",
            ));
        }
    };
    match half < rod && rod.is_finite() {
        true => Ok([half, rod, 0.0]),
        false => Err(out_of_range("rod", rod, half, f64::INFINITY)),
    }
}

/// Name of the only choice that is no length.
const RATIO: &str = "rod ratio";

fn out_of_range(name: &str, value: f64, low: f64, high: f64) -> Error {
    let unit = if name == RATIO { "" } else { " m" };
    Error::refused(
        format!(
            "no slider-crank of this stroke and time ratio whose crank turns fully has the {name} {value}{unit}"
        ),
        format!("give one above {low}{unit} and below {high}{unit}"),
    )
}
