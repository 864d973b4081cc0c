//! Refinement of panels that were not solved: higher degree or cut.

use super::Dynamics;
use super::stepper::PanelStepper;
use super::sweep::Unsolved;
use crate::engine::energy::NotApplicable;

impl<D: Dynamics> PanelStepper<'_, D> {
    /// Raises the degree of the next panel, or cuts it: for this turn, or for all turns if the failure recurs or will.
    pub(super) fn refine(&mut self, why: Unsolved) -> Result<(), NotApplicable> {
        self.progress.refined = true;
        let (kinetic, fastest) = (self.progress.kinetic, self.progress.fastest);
        let has_parts = self.panels.has_parts();
        let panel = self.panels.next_mut();
        let attempt = self.solution.attempt(panel.rule);
        let attempt = attempt.as_ref();
        if why == Unsolved::TooLong
            && let Some(degree) = self.solution.degree_needed(panel, self.fine.tail)
        {
            return panel.raise(self.dynamics, degree, attempt);
        }
        // Below this fraction of the largest kinetic energy, and this half length, rad, a crank that seems to stop on
        // the panel is not followed further: the panels would shrink geometrically, and a step in time passes.
        let (slow_share, short_half) = (0.1, 0.25);
        let slows = kinetic < slow_share * fastest && panel.half().abs() < short_half;
        if self.gives_up && why == Unsolved::Stops && slows {
            return Err(NotApplicable::TooSlow);
        }
        let Some(parts) = panel.parts(self.dynamics, self.fine.cut, self.fine, attempt)? else {
            // The crank is near rest below this fraction of the largest kinetic energy, and where the forces may have
            // produced its energy within so many radians.
            let small = 1e-2;
            let force = panel.table.force[0] + panel.table.push[0];
            return Err(
                if kinetic < small * fastest || kinetic < small * force.abs() {
                    NotApplicable::TooSlow
                } else {
                    NotApplicable::NotSmooth
                },
            );
        };
        // Where the position-dependent forces do less work than this fraction of the kinetic energy, they are not the
        // reason for the panel being too long: it will be too long in the next turn, too.
        let small_work = 0.1;
        let recurs = panel.failed || panel.is_new() && panel.largest_work() < small_work * kinetic;
        if recurs && !has_parts {
            self.panels.cut(parts);
        } else {
            panel.failed = true;
            self.panels.cut_in_turn(parts);
        }
        Ok(())
    }
}
