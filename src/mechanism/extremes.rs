//! Extreme slider velocity and acceleration at constant crank speed, located to rounding.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::{Class, Linkage, Pose};
use crate::numeric::root;
use crate::numeric::trigonometry::sin_cos;

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
        let poses = poses(linkage, &linkage.turn_grid(true));
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

/// Poses at crank angles, rad: sines and cosines of some angles at a time.
fn poses(linkage: &Linkage, grid: &[f64]) -> Vec<(f64, Pose)> {
    let some = grid.chunks(8).flat_map(|some| {
        let angles: [f64; 8] = std::array::from_fn(|i| some[i.min(some.len() - 1)]);
        let (sin, cos) = sin_cos(&angles);
        (0..some.len()).map(move |i| (angles[i], linkage.pose_at(sin[i], cos[i])))
    });
    some.collect()
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
    /// Where x and φ, analytic in θ otherwise, have branch points, for the rod would stand normal to the guide: ±90° ±
    /// i arcosh((l ∓ e)/r). Angle and distance from it, rad.
    pub fn branch_points(&self) -> [[f64; 2]; 2] {
        // The rod misses the normal by rounding at least.
        let width = |height: f64| 2.0 * (0.5 * height / self.r).max(f64::EPSILON).sqrt().asinh();
        let (below, above) = (width(self.below[0]), width(self.above[0]));
        [[-FRAC_PI_2, below], [FRAC_PI_2, above]]
    }

    /// Crank angles of one turn, rad, close enough to show all that the geometry makes: it varies on the scale of the distance
    /// from the branch points. At most a degree apart, or what is between the extremes of what is `smooth`, which geometry and
    /// mass alone make.
    pub fn turn_grid(&self, smooth: bool) -> Vec<f64> {
        let step = if smooth { 0.0625 } else { 1f64.to_radians() };
        let [[_, below], [_, above]] = self.branch_points();
        let widths = [below, above, below];
        let distance = |theta: f64| {
            let squared = |k: usize| {
                let along = theta - FRAC_PI_2 * (2.0 * k as f64 - 1.0);
                along * along + widths[k] * widths[k]
            };
            squared(0).min(squared(1)).min(squared(2)).sqrt()
        };
        let end = SEAM + TAU;
        // A long rod keeps them all far off.
        let is_far = STEP_BY_DISTANCE * widths[0].min(widths[1]) >= step;
        let next = |theta: &f64| {
            let step = match is_far {
                true => step,
                false => step.min(STEP_BY_DISTANCE * distance(*theta)),
            };
            let next = theta + step;
            (*theta < end).then_some(next.min(end))
        };
        std::iter::successors(Some(SEAM), next).collect()
    }
}

/// Where the turn is cut, rad: an angle at which nothing is extreme for a reason of symmetry.
const SEAM: f64 = -1.7;
/// Step as a part of the distance from the nearest branch point.
const STEP_BY_DISTANCE: f64 = 0.125;
