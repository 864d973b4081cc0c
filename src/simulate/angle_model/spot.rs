//! What the loads need to know of a crank angle.

use super::super::guide_friction::Grip;
use crate::engine::angle::State;
use crate::scene::Instant;

/// A position as the loads see it.
#[derive(Clone, Copy, Debug)]
pub(in crate::simulate) struct Spot {
    /// x (m) and x' (m/rad).
    pub(super) at: [f64; 2],
    /// Zero without friction.
    pub grip: Grip,
}

impl Spot {
    /// States as loads see them.
    #[inline]
    pub(super) fn instants<const N: usize>(at: &[State<'_, Spot>; N]) -> [Instant; N] {
        let mut instants = [Instant::default(); N];
        for (instant, at) in instants.iter_mut().zip(at) {
            let [x, dx] = at.place.at;
            *instant = Instant {
                t: at.t,
                theta: at.angle.radians(),
                omega: at.speed,
                x,
                v: dx * at.speed,
            };
        }
        instants
    }
}
