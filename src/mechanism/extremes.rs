//! Extreme slider velocity and acceleration at constant crank speed, located to rounding.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Class, Linkage, Pose};
use crate::numeric::root;

/// An extreme value and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extreme {
    /// x' (m/rad) or x'' (m/rad²); times speed, or speed squared, it is the velocity or acceleration.
    pub value: f64,
    /// Crank angle in [0, 2 pi), rad.
    pub theta: f64,
}

/// Extremes over one turn of a crank that turns fully.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest x'.
    pub velocity_max: Extreme,
    /// Smallest x'.
    pub velocity_min: Extreme,
    /// Largest x''.
    pub acceleration_max: Extreme,
    /// Smallest x''.
    pub acceleration_min: Extreme,
}

impl Extremes {
    /// The extremes, or none where the crank cannot turn fully: there x' and x'' grow without bound.
    pub fn new(linkage: &Linkage) -> Option<Extremes> {
        if Class::of(linkage) != Class::RotatingCrank {
            return None;
        }
        let grid = grid(linkage);
        let poses: Vec<_> = grid
            .iter()
            .map(|theta| (*theta, linkage.pose(*theta)))
            .collect();
        let (velocity_min, velocity_max) = pair(linkage, &poses, |p| p.dx, |_, p| p.d2x)?;
        let (acceleration_min, acceleration_max) = pair(
            linkage,
            &poses,
            |p| p.d2x,
            |linkage, p| linkage.third_derivatives(p).1,
        )?;
        Some(Extremes {
            velocity_max,
            velocity_min,
            acceleration_max,
            acceleration_min,
        })
    }
}

/// Smallest and largest `value` over a turn, from the roots of its derivative between these poses.
fn pair(
    linkage: &Linkage,
    poses: &[(f64, Pose)],
    value: impl Fn(&Pose) -> f64,
    derivative: impl Fn(&Linkage, &Pose) -> f64,
) -> Option<(Extreme, Extreme)> {
    let slope = |theta: f64| derivative(linkage, &linkage.pose(theta));
    let slopes: Vec<f64> = poses.iter().map(|(_, p)| derivative(linkage, p)).collect();
    let between = poses.windows(2).zip(slopes.windows(2));
    let mut found: Vec<Extreme> = between
        .filter(|(_, slopes)| slopes[0].signum() != slopes[1].signum() || slopes.contains(&0.0))
        .filter_map(|(poses, _)| root::bracketed(slope, poses[0].0, poses[1].0))
        .map(|theta| Extreme {
            value: value(&linkage.pose(theta)),
            theta: theta.rem_euclid(TAU) % TAU,
        })
        .collect();
    found.sort_by(|a, b| a.value.total_cmp(&b.value));
    Some((*found.first()?, *found.last()?))
}

impl Linkage {
    /// Crank angles of one turn, rad: every degree, and ever finer towards ±90°, where a rod that is
    /// hardly long enough makes narrow peaks of width sqrt((l − |e| − r)/r).
    pub fn turn_grid(&self) -> Vec<f64> {
        grid(self)
    }
}

/// Where the turn is cut, rad: an angle at which nothing is extreme for a reason of symmetry.
const SEAM: f64 = -1.7;

fn grid(linkage: &Linkage) -> Vec<f64> {
    let mut angles: Vec<f64> = (0..=360)
        .map(|i| SEAM + PI * f64::from(i) / 180.0)
        .collect();
    let narrow = (linkage.margin() / linkage.r).max(1e-16).sqrt();
    let mut distance = PI / 180.0;
    while distance > 1e-3 * narrow.min(1.0) {
        for centre in [-FRAC_PI_2, FRAC_PI_2] {
            angles.extend([centre - distance, centre + distance]);
        }
        distance *= 0.7;
    }
    angles.sort_by(f64::total_cmp);
    angles.dedup();
    angles
}
