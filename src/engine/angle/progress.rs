//! Sums over the panels of a run: time, energy, work and errors.

use super::super::energy::panel::Panel;
use super::super::energy::piece::Piece;
use super::Errors;
use super::panel::PanelTable;
use super::solution::PanelSolution;
use crate::numeric::exact::two_sum;

/// Sums over the panels since the start of a run or of a turn.
pub(super) struct Progress {
    /// Time, s: rounded value and remainder.
    pub t: (f64, f64),
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Rounding remainder of the kinetic energy, J.
    pub kinetic_low: f64,
    /// Propagated rounding errors, of a second run.
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

    /// Moves on over a piece of a panel and returns the motion on it.
    pub fn pass<P: Copy>(
        &mut self,
        table: &PanelTable<P>,
        piece: Piece,
        solution: &PanelSolution,
    ) -> Panel {
        let rule = table.rule;
        let work = solution.work(rule, piece.span, 1.0);
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
        let (slopes, slope) = (&solution.slopes, solution.slope);
        let mut panel = Panel::from_slopes(piece, rule, slopes, slope, 0.0, self.kinetic);
        panel.turns = self.turns;
        let (sum, lost) = two_sum(self.t.0, panel.duration.0);
        self.t = two_sum(sum, lost + self.t.1 + panel.duration.1);
        panel
    }
}
