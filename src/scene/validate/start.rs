//! Crank angles at which the mechanism has a position.

use super::check::Check;
use crate::scene::number::{computed, show};
use crate::scene::{Geometry, Motion};

/// What decides whether the mechanism can be assembled.
pub(super) const LENGTHS: [&str; 3] = ["geometry.crank", "geometry.rod", "geometry.offset"];

/// The limits themselves are reached, also when rounding puts them outside by this part of the lengths.
const LIMIT_ROUNDING: f64 = 1e-12;

/// Larger angles, rad, are rounded by more than a hundredth of a degree.
const LARGEST: f64 = 1e12;

/// The crank angle at the start: its place in the turn is to be known.
pub(super) fn angle(list: &mut Check, angle: f64) {
    if list.finite("motion.angle", angle) && angle.abs() > LARGEST {
        list.add(
            "motion.angle",
            format!("{angle:e} rad is so many turns that rounding hides the place in the last one"),
            "give an angle below 1e12 rad",
        );
    }
}

/// The start must be an angle at which the rod reaches the guide. A scene that says nothing of its motion
/// has no start: its kinematics can be asked for all the same.
pub(super) fn reached(list: &mut Check, geometry: &Geometry, motion: &Motion) {
    let Geometry {
        crank, rod, offset, ..
    } = *geometry;
    let distance = (offset + crank * motion.angle.sin()).abs();
    let outside = distance > rod + LIMIT_ROUNDING * (crank + rod);
    if !outside || *motion == Motion::default() {
        return;
    }
    if !list.sound(LENGTHS) || !list.sound(["motion.angle"]) {
        return;
    }
    let ranges: Vec<String> = ranges(geometry)
        .iter()
        .map(|[from, to]| format!("from {} to {} deg", computed(*from), computed(*to)))
        .collect();
    list.add(
        "motion.angle",
        format!(
            "the mechanism has no position at a crank angle of {} deg: the crank pin is {} m from the guide, the rod {} m long",
            show(motion.angle.to_degrees()),
            computed(distance),
            show(rod)
        ),
        &format!("give an angle {}", ranges.join(" or ")),
    );
}

/// The angles with |e + r sin θ| ≤ l, in degrees.
fn ranges(geometry: &Geometry) -> Vec<[f64; 2]> {
    let Geometry {
        crank, rod, offset, ..
    } = *geometry;
    let angle = |sine: f64| sine.asin().to_degrees();
    let (low, high) = ((-rod - offset) / crank, (rod - offset) / crank);
    match (low > -1.0, high < 1.0) {
        (true, true) => vec![
            [angle(low), angle(high)],
            [180.0 - angle(high), 180.0 - angle(low)],
        ],
        (true, false) => vec![[angle(low), 180.0 - angle(low)]],
        (false, true) => vec![[180.0 - angle(high), 360.0 + angle(high)]],
        (false, false) => Vec::new(),
    }
}
