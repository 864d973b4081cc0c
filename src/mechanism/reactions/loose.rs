//! Joint and guide forces of a mechanism with a loose joint.

use super::{Known, Path, Reactions, Reactor, Ways};
use crate::mechanism::{LooseRates, LooseState};
use crate::scene::Joint;

impl Reactor {
    /// The forces at a state of a mechanism whose joint is loose. The force in that joint is known, and from it
    /// those in the others follow, body by body. Time is the coordinate of the paths.
    pub fn loose(&self, joint: Joint, s: &LooseState, rates: &LooseRates) -> Reactions {
        let linkage = &self.linkage;
        let direction = |angle: f64| [angle.cos(), angle.sin()];
        let (crank, axis) = (direction(s.theta), direction(s.psi));
        let (crank_turn, rod_turn) = ([s.omega, rates.alpha], [s.spin, rates.spin_rate]);
        let slider = Path {
            dp: [s.v, 0.0],
            d2p: [rates.a, 0.0],
            ..Path::default()
        };
        let pin = crank.map(|part| linkage.r * part);
        let arm = self.rod.arm(axis);
        let [fx, fy] = rates.on_rod;
        // The rod moves with the body that it is pinned to; its end at the crank, and the force that is known.
        let (rod, end, known) = match joint {
            Joint::CrankPin => {
                let from_slider = [0, 1].map(|i| arm[i] - linkage.l * axis[i]);
                let end = [s.x - linkage.l * axis[0], -linkage.e - linkage.l * axis[1]];
                let rod = slider.carrying(&Path::turning(from_slider, rod_turn));
                (rod, end, Known::CrankPin([fx, fy]))
            }
            Joint::WristPin => {
                let carrier = Path::turning(pin, crank_turn);
                let rod = carrier.carrying(&Path::turning(arm, rod_turn));
                (rod, pin, Known::WristPin([-fx, -fy]))
            }
        };
        let ways = Ways {
            crank: Path::turning(self.crank.arm(crank), crank_turn),
            rod,
            slider,
            pin: end,
            axis,
            turn: crank_turn,
        };
        self.forces(&ways, 1.0, 0.0, &known)
    }
}
