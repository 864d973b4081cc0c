//! Equations of crank, rod and slider with a loose joint.

use super::super::extended::value;
use super::super::extrapolation::State;
use super::{Loose, Mode, NUMBERS};
use crate::support::exact::SinCos;
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::scene::{Instant, Joint};

type Vector = [DoubleDouble; 2];
/// Triple of numbers, one each for θ, ψ and x.
type Triple = [DoubleDouble; 3];

/// Relative position and velocity of journal and bearing at a state.
pub(super) struct Meeting {
    pub distance: DoubleDouble,
    /// Jacobian of the distance for θ, ψ and x.
    closing: Triple,
    pub closing_rate: DoubleDouble,
    /// Jacobian of the sliding displacement at the point of contact for θ, ψ and x.
    sliding: Triple,
    pub sliding_rate: DoubleDouble,
}

impl Loose<'_> {
    /// Returns the ends of crank and rod.
    fn frame(&self, y: &State<NUMBERS>) -> (Vector, Vector) {
        let (r, ..) = self.extended.lengths();
        let ((sin, cos), (dy, dx)) = (y[1].sin_cos(), y[2].sin_cos());
        ([cos * r, sin * r], [dx, dy])
    }

    pub(super) fn meeting(&self, y: &State<NUMBERS>) -> Meeting {
        let (_, l, e) = self.extended.lengths();
        let (a, d) = self.frame(y);
        let at_crank = self.clearance.joint == Joint::CrankPin;
        let side = if at_crank { 1.0 } else { -1.0 };
        // Vector from the slider to the end of the rod, and its Jacobian.
        let offset = [
            (a[0] + d[0] * l - y[3]) * side,
            (a[1] + d[1] * l + e) * side,
        ];
        let zero = DoubleDouble::ZERO;
        let one = DoubleDouble::ONE;
        let jacobian = [
            [-a[1] * side, -(d[1] * l) * side, -one * side],
            [a[0] * side, d[0] * l * side, zero],
        ];
        let distance = dot(offset, offset).sqrt();
        let along = offset.map(|part| part / distance);
        let by = |direction: Vector| -> Triple {
            std::array::from_fn(|i| dot(direction, [jacobian[0][i], jacobian[1][i]]))
        };
        let rates = [y[4], y[5], y[6]];
        let closing = by(along);
        let mut sliding = by([-along[1], along[0]]);
        // Surfaces at the point of contact: the bearing rotates with the rod, the crank pin with the crank.
        let bearing = self.clearance.bearing_radius.unwrap_or(0.0);
        sliding[1] += -DoubleDouble::from(bearing);
        if at_crank {
            sliding[0] += DoubleDouble::from(bearing) - distance;
        }
        Meeting {
            distance,
            closing_rate: product(closing, rates),
            closing,
            sliding_rate: product(sliding, rates),
            sliding,
        }
    }

    /// Returns the virtual work of the contact force for each of θ, ψ and x.
    fn contact(&self, mode: Mode, meeting: &Meeting) -> Triple {
        let zero = DoubleDouble::ZERO;
        let depth = meeting.distance - self.clearance.radial;
        let Mode::Touch {
            approach,
            presses: true,
            slides,
        } = mode
        else {
            return [zero; 3];
        };
        if depth.value() <= 0.0 {
            return [zero; 3];
        }
        let factor = meeting.closing_rate / approach * self.force.damping + 1.0;
        let normal = depth * depth.sqrt() * self.force.stiffness * factor;
        let share = if slides == 0.0 {
            meeting.sliding_rate / self.clearance.friction_threshold
        } else {
            DoubleDouble::from(slides)
        };
        let drag = normal * share * self.clearance.friction.unwrap_or(0.0);
        std::array::from_fn(|i| -(normal * meeting.closing[i]) - drag * meeting.sliding[i])
    }

    /// Returns the inertia matrix and the forces for θ, ψ and x.
    pub(super) fn equations(&self, mode: Mode, y: &State<NUMBERS>) -> ([Triple; 3], Triple) {
        let zero = DoubleDouble::ZERO;
        let (a, d) = self.frame(y);
        let (turn2, spin2) = (y[4] * y[4], y[5] * y[5]);
        let [gx, gy] = self.extended.gravity;
        let mut m = [[zero; 3]; 3];
        m[0][0] = self.extended.crank_inertia;
        m[2][2] = self.extended.slider_mass;
        let mut q = self.contact(mode, &self.meeting(y));
        q[2] += self.extended.slider_mass * gx;
        let (sin, cos) = y[1].sin_cos();
        for &(mass, along, left) in &self.extended.on_crank {
            let rate = [-(sin * along) - cos * left, cos * along - sin * left];
            q[0] += mass * (rate[0] * gx + rate[1] * gy);
        }
        if let Some(rod) = &self.extended.rod {
            let (_, l, _) = self.extended.lengths();
            let at_crank = self.clearance.joint == Joint::CrankPin;
            let along = DoubleDouble::from(rod.along) - if at_crank { l } else { 0.0 };
            let arm = [
                d[0] * along - d[1] * rod.left,
                d[1] * along + d[0] * rod.left,
            ];
            // The rod is pinned at the slider if the crank pin is loose, and at the crank otherwise.
            let (jacobian, bend) = if at_crank {
                (
                    [[zero, -arm[1], DoubleDouble::ONE], [zero, arm[0], zero]],
                    [0, 1].map(|k| -(arm[k] * spin2)),
                )
            } else {
                (
                    [[-a[1], -arm[1], zero], [a[0], arm[0], zero]],
                    [0, 1].map(|k| -(a[k] * turn2) - arm[k] * spin2),
                )
            };
            for i in 0..3 {
                for j in 0..3 {
                    m[i][j] += rod.mass
                        * (jacobian[0][i] * jacobian[0][j] + jacobian[1][i] * jacobian[1][j]);
                }
                q[i] += rod.mass
                    * (jacobian[0][i] * (-bend[0] + gx) + jacobian[1][i] * (-bend[1] + gy));
            }
            m[1][1] += rod.inertia;
        }
        let now = Instant {
            t: y[0].value(),
            theta: y[1].value(),
            omega: y[4].value(),
            x: y[3].value(),
            v: y[6].value(),
        };
        for load in self.extended.torques() {
            q[0] += value(load, false, y[4], y[3], &now);
        }
        for load in self.extended.forces() {
            q[2] += value(load, true, y[6], y[3], &now);
        }
        (m, q)
    }
}

fn dot(a: Vector, b: Vector) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1]
}

fn product(a: Triple, b: Triple) -> DoubleDouble {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Solves three linear equations with a symmetric matrix, by elimination.
pub(super) fn solved(mut m: [Triple; 3], mut q: Triple) -> Triple {
    for i in 0..3 {
        let (pivot, right) = (m[i], q[i]);
        for j in i + 1..3 {
            let factor = m[j][i] / pivot[i];
            for (entry, above) in m[j].iter_mut().zip(pivot).skip(i) {
                *entry = *entry - factor * above;
            }
            q[j] = q[j] - factor * right;
        }
    }
    for i in (0..3).rev() {
        for k in i + 1..3 {
            q[i] = q[i] - m[i][k] * q[k];
        }
        q[i] = q[i] / m[i][i];
    }
    q
}
