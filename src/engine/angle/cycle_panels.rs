//! Panels of a cycle, with the parts into which one of them is cut in the present turn.

use super::AngleDynamics;
use super::panel::{Fineness, PanelTable};
use crate::engine::energy::NotApplicable;

/// Panels of a cycle in the order of motion, and the position of a run among them.
pub(super) struct CyclePanels<P> {
    pub panels: Vec<PanelTable<P>>,
    /// Parts of a panel that was too long in this turn, the next one last.
    parts: Vec<PanelTable<P>>,
    /// Index of the next panel, or of the one in parts.
    index: usize,
}

impl<P: Copy> CyclePanels<P> {
    /// Begins with the first of some panels.
    pub fn new(panels: Vec<PanelTable<P>>) -> CyclePanels<P> {
        CyclePanels {
            panels,
            parts: Vec::new(),
            index: 0,
        }
    }

    /// Begins again with the first panel.
    pub fn restart(&mut self) {
        self.parts.clear();
        self.index = 0;
    }

    /// True if the next panel begins a cycle.
    pub fn at_cycle(&self) -> bool {
        self.index == 0 && !self.has_parts()
    }

    /// True if the next panel is part of another one, in this turn alone.
    pub fn has_parts(&self) -> bool {
        !self.parts.is_empty()
    }

    /// Returns the next panel or part of a panel.
    pub fn next(&self) -> &PanelTable<P> {
        self.parts.last().unwrap_or(&self.panels[self.index])
    }

    /// Returns the next panel or part of a panel, to be changed.
    pub fn next_mut(&mut self) -> &mut PanelTable<P> {
        let whole = &mut self.panels[self.index];
        self.parts.last_mut().unwrap_or(whole)
    }

    /// Moves on to the rest of the next panel, or beyond it; true at the end of a turn.
    pub fn advance(&mut self, rest: Option<PanelTable<P>>) -> bool {
        self.parts.pop();
        self.parts.extend(rest);
        if self.has_parts() {
            return false;
        }
        let turns = self.panels[self.index].turns;
        self.index += 1;
        let next = self.panels.get(self.index);
        let ends_turn = next.is_none_or(|next| next.turns != turns);
        self.index %= self.panels.len();
        ends_turn
    }

    /// Replaces the next panel by two parts, in this turn.
    pub fn cut_in_turn(&mut self, [first, second]: [PanelTable<P>; 2]) {
        self.parts.pop();
        self.parts.extend([second, first]);
    }

    /// Replaces the next panel by two parts, in all turns.
    pub fn cut(&mut self, parts: [PanelTable<P>; 2]) {
        self.panels.splice(self.index..=self.index, parts);
    }

    /// Cuts every panel that failed, in all turns.
    pub fn cut_failed<D: AngleDynamics<Place = P>>(
        &mut self,
        dynamics: &D,
        fine: Fineness,
    ) -> Result<(), NotApplicable> {
        let mut all = Vec::with_capacity(2 * self.panels.len());
        for panel in std::mem::take(&mut self.panels) {
            let parts = panel.failed.then(|| panel.parts(dynamics, 0.5, fine));
            match parts.transpose()?.flatten() {
                Some(parts) => all.extend(parts),
                None => all.push(panel),
            }
        }
        self.panels = all;
        Ok(())
    }

    /// Makes the rest of the next panel from an angle (rad) on.
    pub fn rest<D: AngleDynamics<Place = P>>(
        &self,
        dynamics: &D,
        from: f64,
        fine: Fineness,
    ) -> Result<PanelTable<P>, NotApplicable> {
        let panel = self.next();
        let index = panel.is_rest.map_or(0, |index| index + 1);
        let known = self.panels[self.index].rests.get(index);
        panel.rest(dynamics, from, index, known, fine)
    }

    /// Stores the solution on a rest as the guess for the next turn.
    pub fn remember_rest(&mut self) {
        if let Some((index, rest)) = self.parts.last().and_then(PanelTable::as_rest) {
            let rests = &mut self.panels[self.index].rests;
            if index < rests.len() {
                rests[index] = rest;
            } else {
                rests.push(rest);
            }
        }
    }
}
