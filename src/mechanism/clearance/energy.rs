//! Energy of the mechanism with a loose joint, and projection of a state onto a massless link.

use super::LooseMechanism;
use crate::mechanism::LooseState;
use crate::mechanism::plane::dot;
use crate::scene::Joint;

impl LooseMechanism {
    /// Returns the sum of kinetic energy, potential energy of gravity and energy stored in the contact, J. The crank's
    /// kinetic energy counts only where its motion is free.
    pub fn energy(&self, s: &LooseState) -> f64 {
        self.kinetic(s) + self.gravity_energy(s) + self.stored(s)
    }

    /// Returns the kinetic energy, J, without that of a crank of prescribed speed, which is constant.
    pub fn kinetic(&self, s: &LooseState) -> f64 {
        let f = self.frame(s);
        let pin = match self.clearance.joint {
            Joint::CrankPin => [s.v, 0.0],
            Joint::WristPin => [-s.omega * f.crank_pin[1], s.omega * f.crank_pin[0]],
        };
        // `rod_inertia` is about the pinned end and contains the part of the centre of gravity.
        let across = [-f.centre[1], f.centre[0]];
        let rod = 0.5 * self.rod_mass * dot(pin, pin)
            + self.rod_mass * s.spin * dot(pin, across)
            + 0.5 * self.rod_inertia * s.spin * s.spin;
        let crank = match self.driven {
            true => 0.0,
            false => 0.5 * self.crank_inertia * s.omega * s.omega,
        };
        crank + rod + 0.5 * self.slider_mass * s.v * s.v
    }

    fn gravity_energy(&self, s: &LooseState) -> f64 {
        let f = self.frame(s);
        let pinned = match self.clearance.joint {
            Joint::CrankPin => [s.x, -self.e],
            Joint::WristPin => f.crank_pin,
        };
        let centre = [pinned[0] + f.centre[0], pinned[1] + f.centre[1]];
        let crank = self.crank_weight[0] * f.crank_pin[1] + self.crank_weight[1] * f.crank_pin[0];
        let slider = self.slider_mass * dot(self.gravity, [s.x, -self.e]);
        -crank - self.rod_mass * dot(self.gravity, centre) - slider
    }

    /// Returns the energy stored in the contact, J.
    pub fn stored(&self, s: &LooseState) -> f64 {
        if self.is_linked() {
            return 0.0;
        }
        self.force.stored(self.depth(s).0.max(0.0))
    }

    /// Projects a state onto a massless link, length and rate of length corrected: rod and slider give way.
    pub fn relinked(&self, s: &LooseState) -> LooseState {
        let mut s = *s;
        for _ in 0..2 {
            let f = self.frame(&s);
            let c = self.clearance.radial;
            let excess = dot(f.offset, f.offset) - c * c;
            // Least change of (ψ, x), with ψ weighted by the length of the rod.
            let turn = [
                -self.side * self.l * f.axis[1],
                self.side * self.l * f.axis[0],
            ];
            let slope = [
                2.0 * dot(f.offset, turn) / self.l,
                -2.0 * self.side * f.offset[0],
            ];
            let squared = slope[0] * slope[0] + slope[1] * slope[1];
            if squared == 0.0 {
                break;
            }
            s.psi -= excess * slope[0] / squared / self.l;
            s.x -= excess * slope[1] / squared;
            let f = self.frame(&s);
            let rate = 2.0 * dot(f.offset, f.rate);
            s.spin -= rate * slope[0] / squared / self.l;
            s.v -= rate * slope[1] / squared;
        }
        s
    }
}
