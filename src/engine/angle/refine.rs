//! Refinement of panels that were not solved: higher degree or cut; and the rest of a panel after a switching.

use super::Driven;
use super::panel::{Fineness, PanelTable};
use super::stepper::PanelStepper;
use super::sweep::Unsolved;
use crate::engine::energy::NotApplicable;

impl<D: Driven> PanelStepper<'_, D> {
    /// Raises the degree of the next panel, or cuts it: for this turn, or for all turns if the failure recurs or will.
    pub(super) fn refine(&mut self, why: Unsolved) -> Result<(), NotApplicable> {
        self.progress.refined = true;
        let fastest = self.progress.fastest;
        let for_now = !self.parts.is_empty();
        let panel = self.parts.last_mut().unwrap_or(&mut self.panels[self.next]);
        if panel.raise(self.driven)? {
            return Ok(());
        }
        let kinetic = self.progress.kinetic;
        // Below this fraction of the largest kinetic energy, and of this half length, rad, a crank that seems to stop on
        // the panel is not followed further: the panels would shrink geometrically, and a step in time passes.
        let (slow_share, short_half) = (0.1, 0.25);
        let slows = kinetic < slow_share * fastest && panel.half().abs() < short_half;
        if self.gives_up && why == Unsolved::Stops && slows {
            return Err(NotApplicable::TooSlow);
        }
        let Some([first, second]) = panel.parts(self.driven, 0.5, self.fine)? else {
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
        if for_now {
            self.parts.pop();
            self.parts.extend([second, first]);
        } else if panel.failed || panel.is_new() && panel.largest_work() < small_work * kinetic {
            self.panels.splice(self.next..=self.next, [first, second]);
        } else {
            panel.failed = true;
            self.parts.extend([second, first]);
        }
        Ok(())
    }

    /// Cuts every panel that failed, for all turns.
    pub fn settle(&mut self) -> Result<(), NotApplicable> {
        let panels = std::mem::take(&mut self.panels);
        self.panels = cut(self.driven, panels, 0.5, self.fine, |of| of.failed)?;
        Ok(())
    }
}

/// Cuts the selected panels at the fraction `share`, if they are long enough.
fn cut<D: Driven>(
    driven: &D,
    panels: Vec<PanelTable<D::Place>>,
    share: f64,
    fine: Fineness,
    which: impl Fn(&PanelTable<D::Place>) -> bool,
) -> Result<Vec<PanelTable<D::Place>>, NotApplicable> {
    let mut all = Vec::with_capacity(2 * panels.len());
    for panel in panels {
        let parts = which(&panel).then(|| panel.parts(driven, share, fine));
        match parts.transpose()?.flatten() {
            Some(parts) => all.extend(parts),
            None => all.push(panel),
        }
    }
    Ok(all)
}

impl<D: Driven> PanelStepper<'_, D> {
    /// Makes the rest of the next panel from an angle (rad) on.
    pub(super) fn rest(&self, from: f64) -> Result<PanelTable<D::Place>, NotApplicable> {
        let whole = &self.panels[self.next];
        let panel = self.parts.last().unwrap_or(whole);
        let index = panel.is_rest.map_or(0, |index| index + 1);
        panel.rest(self.driven, from, index, whole.rests.get(index), self.fine)
    }

    /// Stores the solution on a rest as the guess for the next turn.
    pub(super) fn remember_rest(&mut self) {
        if let Some((index, rest)) = self.parts.last().and_then(PanelTable::as_rest) {
            let rests = &mut self.panels[self.next].rests;
            if index < rests.len() {
                rests[index] = rest;
            } else {
                rests.push(rest);
            }
        }
    }
}
