//! Zeros and other least magnitudes of the balancing force or torque over the cycle.

use super::StaticAnalysis;
use crate::kinematics::Located;
use crate::mechanism::{Equilibrium, Limits};
use crate::numeric::{angle, maximum, root};

impl StaticAnalysis {
    /// Locates the least magnitudes over the cycle, without friction and with it; loads that do not repeat may
    /// differ in the next turn. A zero that lasts counts where it begins.
    pub(super) fn least(&self) -> [Vec<Located>; 2] {
        let (equation, whole) = (&self.statics.equation, self.whole());
        let of = |balance: Equilibrium| balance.band.map_or(f64::NAN, |band| band.value);
        // V' − τ − F x': the crank torque, and the slider force times x', which has no poles at the dead centres.
        let torque = |theta: f64| of(self.statics.crank_torque(theta.rem_euclid(whole)));
        let turn = equation.linkage().turn_grid(false);
        let turn: Vec<f64> = angle::in_turns(&turn, 0..i64::from(self.cycle_turns)).collect();
        let torques = turn.iter().map(|theta| torque(*theta).abs());
        let rounding = 16.0 * f64::EPSILON * torques.fold(0.0, f64::max);
        let torque = |theta: f64| match torque(theta) {
            torque if torque.abs() <= rounding => 0.0,
            torque => torque,
        };
        // The cycle is cut where the value is largest: nothing least lasts through there.
        let larger = |most: (f64, f64), theta: &f64| {
            let size = of(self.balance(theta.rem_euclid(whole))).abs();
            if size > most.0 { (size, *theta) } else { most }
        };
        let (_, cut) = turn.iter().fold((0.0, turn[0]), larger);
        let mut corners = equation.loads().corners_between(0.0, whole);
        let centres = Limits::new(equation.linkage(), 0.0).dead_centres;
        corners.extend(centres.iter().map(|centre| centre.theta).chain([0.0]));
        let turns = i64::from(self.cycle_turns);
        let corners: Vec<f64> = angle::in_turns(&corners, -turns..=turns).collect();
        let mut grid = equation.linkage().grid_between(cut, cut + whole, &corners);
        for sign in [1.0, -1.0] {
            let extremes = maximum::peaks(|theta| sign * torque(theta), &grid);
            grid.extend(extremes.iter().map(|(theta, _)| theta));
            grid.sort_by(f64::total_cmp);
        }
        let known: Vec<(f64, f64)> = grid.iter().map(|theta| (*theta, torque(*theta))).collect();
        let zero = |ends: &[(f64, f64)]| {
            let [(from, before), (to, after)] = [ends[0], ends[1]];
            let changes = before.min(after) < 0.0 && before.max(after) > 0.0;
            let zero = changes
                .then(|| root::bracketed(torque, from, to))
                .flatten()?;
            // Between the end of the turn and its beginning a value may jump over zero.
            let small = 1e-6 * before.abs().max(after.abs());
            (torque(zero).abs() <= small).then_some(zero)
        };
        let zeros: Vec<f64> = known.windows(2).filter_map(zero).collect();
        grid.extend(&zeros);
        grid.sort_by(f64::total_cmp);
        // Where torque and x' vanish together the force is finite.
        grid.retain(|theta| !self.is_pole(*theta) || torque(*theta) != 0.0);
        let is_zero = |theta: f64| torque(theta) == 0.0 || zeros.contains(&theta);
        let without = |theta: f64, balance| if is_zero(theta) { 0.0 } else { of(balance) };
        let with = |_, balance| nearer_edge(&balance).unwrap_or(f64::NAN);
        [
            self.minima(cut, &grid, without),
            match self.friction > 0.0 {
                true => self.minima(cut, &grid, with),
                false => Vec::new(),
            },
        ]
    }

    /// Locates the minima of the magnitude of a value of the balance, over a cycle from an angle on that a grid resolves,
    /// rad.
    fn minima(
        &self,
        from: f64,
        grid: &[f64],
        value: impl Fn(f64, Equilibrium) -> f64,
    ) -> Vec<Located> {
        let value = |theta: f64| value(theta, self.balance(theta.rem_euclid(self.whole())));
        let height = |theta: f64| match self.is_pole(theta) {
            true => f64::NEG_INFINITY,
            false => -value(theta).abs(),
        };
        let least = maximum::peaks(height, grid).into_iter();
        let least = least.filter(|(theta, _)| (from..from + self.whole()).contains(theta));
        let located = |(theta, _)| Located {
            value: value(theta),
            theta_rad: theta.rem_euclid(self.whole()),
        };
        let mut found: Vec<Located> = least.map(located).collect();
        found.sort_by(|a, b| a.theta_rad.total_cmp(&b.theta_rad));
        found
    }

    /// True at the dead centres, where a slider force has no value.
    fn is_pole(&self, theta: f64) -> bool {
        let theta = theta.rem_euclid(self.whole());
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
