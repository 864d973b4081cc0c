//! Zeros and other least magnitudes of the balancing force or torque over a turn.

use std::f64::consts::TAU;

use super::StaticAnalysis;
use crate::kinematics::Located;
use crate::mechanism::{Equilibrium, Limits, SEAM};
use crate::numeric::{angle, maximum, root};

impl StaticAnalysis {
    /// Locates the least magnitudes over the turn from 0 to 360 degrees, without friction and with it; loads may differ
    /// in the next turn. A zero that lasts counts where it begins.
    pub(super) fn least(&self) -> [Vec<Located>; 2] {
        let linkage = self.statics.equation().linkage();
        let of = |balance: Equilibrium| balance.band.map_or(f64::NAN, |band| band.value);
        let value = |theta: f64| of(self.balance(theta.rem_euclid(TAU)));
        let mut corners = self.statics.equation().loads().corners_between(0.0, TAU);
        let centres = Limits::new(linkage, 0.0).dead_centres.into_iter();
        corners.extend(centres.map(|centre| centre.theta).chain([0.0]));
        let corners: Vec<f64> = angle::in_turns(&corners, -1..=1).collect();
        // A value may be constant through the end of the turn.
        let mut grid = linkage.grid_between(SEAM, SEAM + 2.0 * TAU, &corners);
        // V' − τ − F x': the crank torque, and the slider force times x', which has no poles at the dead centres.
        let torque = |theta: f64| of(self.statics.crank_torque(theta.rem_euclid(TAU)));
        let sizes = grid.iter().map(|theta| torque(*theta).abs());
        let rounding = 16.0 * f64::EPSILON * sizes.fold(0.0, f64::max);
        let torque = |theta: f64| {
            let torque = torque(theta);
            if torque.abs() <= rounding {
                0.0
            } else {
                torque
            }
        };
        for sign in [1.0, -1.0] {
            let extremes = maximum::peaks(|theta| sign * torque(theta), &grid);
            grid.extend(extremes.iter().map(|(theta, _)| theta));
            grid.sort_by(f64::total_cmp);
        }
        let zero = |ends: &[f64]| {
            let [before, after] = [ends[0], ends[1]].map(torque);
            let zero = root::bracketed(torque, ends[0], ends[1])?;
            // Between the end of the turn and its beginning a value may jump over zero.
            let small = 1e-6 * before.abs().max(after.abs());
            let is_between = before != 0.0 && after != 0.0 && torque(zero).abs() <= small;
            is_between.then_some(zero)
        };
        let zeros: Vec<f64> = grid.windows(2).filter_map(zero).collect();
        grid.extend(&zeros);
        grid.sort_by(f64::total_cmp);
        // Where torque and x' vanish together the force is finite.
        grid.retain(|theta| !self.is_pole(*theta) || torque(*theta) != 0.0);
        let is_zero = |theta: f64| torque(theta) == 0.0 || zeros.contains(&theta);
        let without = |theta: f64| if is_zero(theta) { 0.0 } else { value(theta) };
        let nearer_edge =
            |theta: f64| nearer_edge(&self.balance(theta.rem_euclid(TAU))).unwrap_or(f64::NAN);
        [
            self.minima(&grid, without),
            match self.friction > 0.0 {
                true => self.minima(&grid, nearer_edge),
                false => Vec::new(),
            },
        ]
    }

    /// Locates the minima of the magnitude of a value that these angles resolve, rad.
    fn minima(&self, grid: &[f64], value: impl Fn(f64) -> f64) -> Vec<Located> {
        let height = |theta: f64| match self.is_pole(theta) {
            true => f64::NEG_INFINITY,
            false => -value(theta).abs(),
        };
        let least = maximum::peaks(height, grid).into_iter();
        let least = least.filter(|(theta, _)| (SEAM..SEAM + TAU).contains(theta));
        let located = |(theta, _)| Located {
            value: value(theta),
            theta_rad: angle::in_turn(theta),
        };
        let mut found: Vec<Located> = least.map(located).collect();
        found.sort_by(|a, b| a.theta_rad.total_cmp(&b.theta_rad));
        found
    }

    /// True at the dead centres, where a slider force has no value.
    fn is_pole(&self, theta: f64) -> bool {
        let theta = theta.rem_euclid(TAU);
        self.balance(theta).band.is_none() && self.statics.crank_torque(theta).band.is_some()
    }
}

/// Returns the edge of the band nearer to zero; none if zero lies in the band, where friction alone holds.
fn nearer_edge(balance: &Equilibrium) -> Option<f64> {
    let band = balance.band?;
    let (min, max) = (band.min?, band.max?);
    match (min > 0.0, max < 0.0) {
        (true, _) => Some(min),
        (_, true) => Some(max),
        _ => None,
    }
}
