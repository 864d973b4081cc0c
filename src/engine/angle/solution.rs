//! Motion on a solved panel.

use super::forces::Forces;
use super::panel::PanelTable;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Series, Values};

/// Motion on a panel.
pub(super) struct PanelSolution {
    /// Kinetic energy at the points, J.
    pub kinetic: Values,
    /// Magnitude of dt/dx at the points, s.
    pub slopes: Values,
    /// Series of |dt/dx|.
    pub slope: Series,
    pub(super) forces: Forces,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// Kinetic energy at the end, J.
    pub end: f64,
    /// Fraction of the panel at which the motion on it ends.
    pub share: f64,
    /// Evaluations of the loads.
    pub evaluations: u64,
    /// Largest change of the kinetic energy by the first sweep, relative to it.
    pub first_change: f64,
    /// Largest change by the last sweep.
    pub last_change: f64,
}

impl PanelSolution {
    /// Makes an empty motion.
    pub fn new() -> PanelSolution {
        let zero = [0.0; MAX_DEGREE + 1];
        PanelSolution {
            kinetic: zero,
            slopes: zero,
            slope: Series::new(0, zero),
            forces: Forces::new(),
            gain: 0.0,
            end: 0.0,
            share: 1.0,
            evaluations: 0,
            first_change: 0.0,
            last_change: 0.0,
        }
    }

    /// Returns the work of the non-conservative force, J, to x in [−1, 1] on the part of the panel on which the motion
    /// lies, of signed length `span` (rad).
    pub fn work(&self, rule: &Rule, span: f64, x: f64) -> f64 {
        let (force, half) = (&self.forces.non_conservative, 0.5 * span / self.share);
        if x * self.share == 1.0 {
            return half * rule.rounded_integral(force);
        }
        let work = rule.series(force).integral();
        half * work.value(self.share * (1.0 + x) - 1.0)
    }

    /// Returns the series of the kinetic energy of an unsolved panel, J; none if the sweeps did not converge.
    pub fn attempt(&self, rule: &Rule) -> Option<Series> {
        (self.last_change <= self.first_change).then(|| rule.series(&self.kinetic))
    }

    /// Returns the next degree at which the forces on an unsolved panel are likely to decay to a tail, if any.
    pub fn degree_needed<P: Copy>(&self, panel: &PanelTable<P>, tail: f64) -> Option<usize> {
        let next = Rule::next_degree(panel.rule.degree())?;
        let mut slopes = [0.0; MAX_DEGREE + 1];
        self.forces.fill_slopes(panel, &mut slopes)?;
        let series = [&slopes, &self.forces.total].map(|values| panel.rule.series(values));
        let needed = series.map(|series| series.degree_of_tail(tail));
        let needed = needed[0].max(needed[1]);
        Rule::DEGREES
            .into_iter()
            .find(|degree| *degree >= next && *degree as f64 >= needed)
    }
}
