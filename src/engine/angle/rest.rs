//! What is left of a panel after a change of the switch.

use super::Driven;
use super::panel::Station;
use super::stepper::PanelStepper;
use crate::engine::energy::NotApplicable;

impl<D: Driven> PanelStepper<'_, D> {
    /// What is left of the next panel from an angle on.
    pub(super) fn rest(&self, from: f64) -> Result<Station<D::Place>, NotApplicable> {
        let whole = &self.stations[self.next];
        let station = self.parts.last().unwrap_or(whole);
        let index = station.is_rest.map_or(0, |index| index + 1);
        station.rest(self.driven, from, index, whole.rests.get(index), self.fine)
    }

    /// Keeps what was found on a rest for the next turn.
    pub(super) fn remember_rest(&mut self) {
        if let Some((index, rest)) = self.parts.last().and_then(Station::as_rest) {
            let rests = &mut self.stations[self.next].rests;
            if index < rests.len() {
                rests[index] = rest;
            } else {
                rests.push(rest);
            }
        }
    }
}
