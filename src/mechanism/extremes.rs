//! Extreme slider velocity and acceleration at constant crank speed, by roots of the next derivative, to rounding.

use std::convert::Infallible;
use std::f64::consts::{FRAC_PI_2, TAU};

use multiversion::multiversion;
use serde::Serialize;

use super::{Class, Linkage, Pose};
use crate::numeric::angle::{distinct, in_turn, in_turns};
use crate::numeric::root;
use crate::numeric::trigonometry::sin_cos;

/// Value and its crank angle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Located {
    /// Value, in SI units.
    pub value: f64,
    /// Crank angle, rad.
    pub theta_rad: f64,
}

/// Extremes of x' (m/rad) and x'' (m/rad²) over one turn of a crank that turns fully, at angles in [0, 2 pi); times
/// speed, or speed squared, they are velocity and acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremes {
    /// Largest x'.
    pub velocity_max: Located,
    /// Smallest x'.
    pub velocity_min: Located,
    /// Largest x''.
    pub acceleration_max: Located,
    /// Smallest x''.
    pub acceleration_min: Located,
}

impl Extremes {
    /// Locates the extremes; none where the crank cannot turn fully, as x' and x'' grow without bound.
    pub fn new(linkage: &Linkage) -> Option<Extremes> {
        if Class::of(linkage) != Class::RotatingCrank {
            return None;
        }
        let grid = linkage.turn_grid(true);
        let slopes = slopes(linkage, &grid);
        let derivative = |k: usize| {
            move |theta: f64| {
                let ([sin], [cos]) = sin_cos(&[theta]);
                derivatives(linkage, &linkage.pose_at(sin, cos))[k]
            }
        };
        let turns = |k: usize| range(&grid, |i| slopes[i][k], derivative(k + 1), derivative(k));
        let (velocity_min, velocity_max) = turns(0)?;
        let (acceleration_min, acceleration_max) = turns(1)?;
        Some(Extremes {
            velocity_max,
            velocity_min,
            acceleration_max,
            acceleration_min,
        })
    }
}

/// Returns the first three derivatives of x at a position.
fn derivatives(linkage: &Linkage, pose: &Pose) -> [f64; 3] {
    [pose.dx, pose.d2x, linkage.third_derivatives(pose).1]
}

/// Returns the second and third derivative of x at crank angles, rad, eight at a time.
#[multiversion(targets("x86_64+avx2"))]
fn slopes(linkage: &Linkage, grid: &[f64]) -> Vec<[f64; 2]> {
    let is_far = linkage.stays_far_from_limits();
    let mut slopes = Vec::with_capacity(grid.len());
    for some in grid.chunks(8) {
        let angles: [f64; 8] = std::array::from_fn(|i| some[i.min(some.len() - 1)]);
        let mut here = [[0.0; 2]; 8];
        let (sin, cos) = sin_cos(&angles);
        for i in 0..8 {
            let pose = match is_far {
                true => linkage.pose_far_from_limits(sin[i], cos[i]),
                false => linkage.pose_at(sin[i], cos[i]),
            };
            let [_, d2x, d3x] = derivatives(linkage, &pose);
            here[i] = [d2x, d3x];
        }
        slopes.extend(&here[..some.len()]);
    }
    slopes
}

/// Locates least and largest value over a turn: roots of the slope, bracketed by the angles of a grid of known slopes.
fn range(
    grid: &[f64],
    at: impl Fn(usize) -> f64,
    slope: impl Fn(f64) -> f64,
    value: impl Fn(f64) -> f64,
) -> Option<(Located, Located)> {
    let mut found: Option<(Located, Located)> = None;
    for i in 1..grid.len() {
        let (before, after) = (at(i - 1), at(i));
        if before.signum() == after.signum() && before != 0.0 && after != 0.0 {
            continue;
        }
        let known = |theta: f64| Ok::<f64, Infallible>(slope(theta));
        let ends = [(grid[i - 1], before), (grid[i], after)];
        let Ok(Some(theta)) = root::between(known, ends, 0.0) else {
            continue;
        };
        let here = Located {
            value: value(theta),
            theta_rad: in_turn(theta),
        };
        let (low, high) = found.get_or_insert((here, here));
        if here.value < low.value {
            *low = here;
        }
        if here.value >= high.value {
            *high = here;
        }
    }
    found
}

/// Angle at which a turn is cut, rad: symmetry makes no quantity extreme there.
pub const SEAM: f64 = -1.7;

/// Part of the distance from the nearest branch point at which samples show all that a function does.
const SHOWN_SHARE: f64 = 0.125;

/// Returns the distance (rad) from an angle at which the next sample of a function shows all that it does between them:
/// a part of the distance from the nearest of its branch points, each an angle and a height above the real axis.
pub(super) fn shown_distance<const N: usize>(angle: f64, points: [[f64; 2]; N]) -> f64 {
    let squared = points.map(|[at, height]| {
        let along = (angle - at).rem_euclid(TAU);
        let along = along.min(TAU - along);
        along * along + height * height
    });
    SHOWN_SHARE * squared.into_iter().fold(f64::INFINITY, f64::min).sqrt()
}

impl Linkage {
    /// Returns the branch points of x and φ, which are analytic in θ otherwise: ±90° ± i arcosh((l ∓ e)/r), where the
    /// rod would stand normal to the guide. Angle and distance from the real axis, rad.
    pub fn branch_points(&self) -> [[f64; 2]; 2] {
        // Rounding keeps the rod at least this far from the normal.
        let width = |height: f64| 2.0 * (0.5 * height / self.r).max(f64::EPSILON).sqrt().asinh();
        let (below, above) = (width(self.below[0]), width(self.above[0]));
        [[-FRAC_PI_2, below], [FRAC_PI_2, above]]
    }

    /// Returns the distance (rad) from a crank angle at which the next sample shows all of the geometry between them.
    pub fn shown_distance(&self, theta: f64) -> f64 {
        shown_distance(theta, self.branch_points())
    }

    /// Returns crank angles of one turn, rad, dense enough for all functions of the geometry, which vary on the scale
    /// of the distance from the branch points. They are at most 1° apart; for `smooth` functions, of geometry and mass
    /// alone, at most 0.0625 rad, less than the distance between extremes.
    pub fn turn_grid(&self, smooth: bool) -> Vec<f64> {
        let longest = if smooth { 0.0625 } else { 1f64.to_radians() };
        let points = self.branch_points();
        let end = SEAM + TAU;
        // A long rod keeps all branch points far off.
        let is_far = points
            .iter()
            .all(|[_, width]| SHOWN_SHARE * width >= longest);
        let next = |theta: &f64| {
            let step = match is_far {
                true => longest,
                false => longest.min(shown_distance(*theta, points)),
            };
            let next = theta + step;
            (*theta < end).then_some(next.min(end))
        };
        let mut grid = Vec::with_capacity((TAU / longest) as usize + 2);
        grid.extend(std::iter::successors(Some(SEAM), next));
        grid
    }

    /// Returns crank angles in rising order, rad, from at least one before `from` to at least one after `to`: those of
    /// [`Linkage::turn_grid`], not only for smooth functions, and the `corners` of loads.
    pub fn grid_between(&self, from: f64, to: f64, corners: &[f64]) -> Vec<f64> {
        let longest = 1f64.to_radians();
        let (from, to) = (from - longest, to + longest);
        let turns = (from / TAU).floor() as i64..=(to / TAU).ceil() as i64;
        let grid = self.turn_grid(false);
        let all = in_turns(&grid, turns).chain(corners.iter().copied());
        distinct(all.filter(|theta| (from..=to).contains(theta)).collect())
    }
}
