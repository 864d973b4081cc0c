//! Which way the quantities that are watched have their signs as a piece of the motion begins.

use super::super::guide_friction::BESIDE;
use super::follow::Run;
use super::stick_slip::{CRANK, DEAD_CENTRE, NORMAL, Phase, SPEED, Signs, against, signs};
use crate::engine::Motion;
use crate::engine::event_functions::EventFunction;
use crate::engine::time::Start;

impl Run<'_, '_> {
    /// The signs with which motion in `direction` (±1 of the coordinate) begins.
    pub fn signs_for(&self, direction: f64) -> Signs {
        let equation = self.follow.equation;
        if equation.loads().are_dry() {
            // The sign of N follows from those of the speeds.
            let seen = self.seen(direction);
            self.quantities.against.set(against(equation, &seen));
        }
        self.seen(direction)
    }

    fn seen(&self, direction: f64) -> Signs {
        let Start { t, angle, speed } = self.now;
        let values = self.quantities.values(t, angle, speed);
        let ahead = self
            .quantities
            .values(t, angle.plus(direction * BESIDE), speed);
        let mut signs = signs(values, ahead, direction);
        // A start without speed says nothing about its direction.
        if speed == 0.0 && !self.follow.may_stick() {
            let motion = self.in_phase(Phase::FREE);
            if motion.acceleration(t, angle, speed) < 0.0 {
                signs[SPEED] = -1.0;
            }
        }
        signs
    }

    /// Where dry loads turn round, the normal force jumps.
    pub fn oppose(&mut self, index: usize) {
        let equation = self.follow.equation;
        if equation.loads().are_dry() && matches!(index, DEAD_CENTRE | CRANK) {
            self.quantities.against.set(against(equation, &self.signs));
            self.signs[NORMAL] = self.seen(self.signs[SPEED])[NORMAL];
        }
    }
}
