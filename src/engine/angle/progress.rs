//! Sums over the panels of a run: time, energy, work and errors.

use super::super::energy::panel::Panel;
use super::super::energy::piece::Piece;
use super::Errors;
use super::panel::PanelTable;
use super::solution::PanelSolution;
use crate::numeric::exact::two_sum;
use crate::numeric::median::range;

/// Sums over the panels since the start of a run or of a turn.
pub(super) struct Progress {
    /// Time, s: rounded value and remainder.
    pub t: (f64, f64),
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Rounding remainder of the kinetic energy, J.
    pub kinetic_low: f64,
    /// Propagated rounding errors.
    pub errors: Errors,
    /// Whole turns, with sign.
    pub turns: f64,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// Work of the non-conservative loads, J.
    pub work: f64,
    /// Largest kinetic energy at the ends of panels, J.
    pub fastest: f64,
    /// True if a panel was cut or its degree raised.
    pub refined: bool,
    /// True if the points of a panel missed a load.
    pub missed_load: bool,
}

impl Progress {
    /// Starts with a kinetic energy, J, with an error `off` beyond its rounding, J.
    pub fn at(kinetic: f64, off: f64) -> Progress {
        Progress {
            t: (0.0, 0.0),
            kinetic,
            kinetic_low: 0.0,
            errors: Errors::at(kinetic, off),
            turns: 0.0,
            gain: 0.0,
            work: 0.0,
            fastest: kinetic,
            refined: false,
            missed_load: false,
        }
    }

    /// Moves on over a piece of a panel and returns the motion on it; `mistimed`: work of rounded times over epsilon,
    /// J.
    pub fn pass<P: Copy>(
        &mut self,
        table: &PanelTable<P>,
        piece: Piece,
        solution: &PanelSolution,
        mistimed: f64,
    ) -> Panel {
        let rule = table.rule;
        let work = solution.work(rule, piece.span(), 1.0);
        // Under steep loads the end energy is not the sum of start and gain.
        let summed = solution.end == self.kinetic + solution.gain;
        (self.kinetic, self.kinetic_low) = if summed {
            two_sum(self.kinetic, solution.gain + self.kinetic_low)
        } else {
            (solution.end, 0.0)
        };
        self.gain += solution.gain;
        self.fastest = self.fastest.max(self.kinetic);
        self.work += work;
        let retained = (0.5 * work.min(0.0) / self.kinetic).exp();
        let count = rule.degree() + 1;
        // Error of the work due to rounded angles, over machine epsilon, J.
        let misplaced = [&table.table.force, &table.table.push].map(|forces| {
            let (low, high) = range(&forces[..count]);
            0.5 * piece.from.abs().max(piece.to.abs()) * (high - low)
        });
        let noise = f64::EPSILON * (solution.gain.abs() + misplaced[0] + misplaced[1] + mistimed);
        let (slopes, slope) = (&solution.slopes, solution.slope);
        let mut panel = Panel::from_slopes(piece, rule, slopes, slope, 0.0, self.kinetic);
        panel.turns = self.turns;
        // The noise arises mainly where the energy is large.
        let largest = solution.kinetic[0].max(solution.kinetic[rule.degree()]);
        let advance_of_noise = 0.5 * panel.duration.0 / largest;
        let advance = solution.advance(rule);
        self.errors.pass(retained, noise, advance, advance_of_noise);
        let (sum, lost) = two_sum(self.t.0, panel.duration.0);
        self.t = two_sum(sum, lost + self.t.1 + panel.duration.1);
        panel
    }
}
