//! Equations of crank, rod and slider with the guide force as an unknown.

use super::super::extended::value;
use super::super::extrapolation::State;
use super::{Guided, NUMBERS};
use crate::support::exact::SinCos;
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::scene::Instant;

type Pair = [DoubleDouble; 2];

/// Linear equations at a state.
pub(super) struct Equations {
    m: [Pair; 2],
    q: Pair,
    jx: Pair,
    jy: Pair,
    bend: DoubleDouble,
    /// Velocity of the slider, m/s.
    pub v: DoubleDouble,
}

impl Guided<'_> {
    pub(super) fn equations(&self, y: &State<NUMBERS>) -> Equations {
        let zero = DoubleDouble::ZERO;
        let (r, l, _) = self.extended.lengths();
        let ((sin, cos), (rod_sin, rod_cos)) = (y[1].sin_cos(), y[2].sin_cos());
        let (omega, spin) = (y[3], y[4]);
        let (turn2, spin2) = (omega * omega, spin * spin);
        let a = [cos * r, sin * r];
        let d = [rod_cos, -rod_sin];
        // Position, Jacobian and acceleration at θ̈ = Φ̈ = 0 of a point of the rod.
        let point = |along: f64, left: f64| {
            let arm = [d[0] * along - d[1] * left, d[1] * along + d[0] * left];
            let jacobian = [[-a[1], arm[1]], [a[0], -arm[0]]];
            let bend = [0, 1].map(|k| -a[k] * turn2 - arm[k] * spin2);
            (arm, jacobian, bend)
        };
        let (arm, [jx, jy], bend) = point(l, 0.0);
        let mut equations = Equations {
            m: [[self.extended.crank_inertia, zero], [zero; 2]],
            q: [zero; 2],
            jx,
            jy,
            bend: bend[1],
            v: jx[0] * omega + jx[1] * spin,
        };
        let [gx, gy] = self.extended.gravity;
        let mut add = |mass: DoubleDouble, jacobian: [Pair; 2], bend: Pair| {
            for i in 0..2 {
                for j in 0..2 {
                    let products =
                        jacobian[0][i] * jacobian[0][j] + jacobian[1][i] * jacobian[1][j];
                    equations.m[i][j] += mass * products;
                }
                let pulled = jacobian[0][i] * (-bend[0] + gx) + jacobian[1][i] * (-bend[1] + gy);
                equations.q[i] += mass * pulled;
            }
        };
        add(self.extended.slider_mass, [jx, jy], bend);
        if let Some(rod) = &self.extended.rod {
            let (_, jacobian, bend) = point(rod.along, rod.left);
            add(rod.mass, jacobian, bend);
            equations.m[1][1] += rod.inertia;
        }
        for &(mass, along, left) in &self.extended.on_crank {
            let rate = [-(sin * along) - cos * left, cos * along - sin * left];
            equations.q[0] += mass * (rate[0] * gx + rate[1] * gy);
        }
        let x = a[0] + arm[0];
        let between = self.between.get();
        let now = Instant {
            t: y[0].value().max(between.low).min(between.high),
            theta: y[1].value(),
            omega: omega.value(),
            x: x.value(),
            v: equations.v.value(),
        };
        for load in self.extended.torques() {
            equations.q[0] += value(load, false, omega, x, &now);
        }
        for load in self.extended.forces() {
            let force = value(load, true, equations.v, x, &now);
            equations.q[0] += force * jx[0];
            equations.q[1] += force * jx[1];
        }
        equations
    }
}

impl Equations {
    /// Solves for (θ̈, Φ̈) and N: along the free direction τ of the guide and across it.
    pub fn solve(&self, c: f64) -> (Pair, DoubleDouble) {
        let pushed = [0, 1].map(|i| self.jy[i] + self.jx[i] * c);
        let squared = self.jy[0] * self.jy[0] + self.jy[1] * self.jy[1];
        let across = [0, 1].map(|i| -(self.bend * self.jy[i]) / squared);
        let held = self.times(across);
        let rest = [0, 1].map(|i| self.q[i] - held[i]);
        let (open, slow) = (self.open(), self.times(self.open()));
        let determinant = cross(slow, pushed);
        let along = cross(rest, pushed) / determinant;
        let normal = cross(rest, slow) / determinant;
        ([0, 1].map(|i| across[i] + open[i] * along), normal)
    }

    fn open(&self) -> Pair {
        [self.jy[1], -self.jy[0]]
    }

    /// Returns the product of M and a pair.
    fn times(&self, by: Pair) -> Pair {
        [0, 1].map(|i| self.m[i][0] * by[0] + self.m[i][1] * by[1])
    }

    /// Returns the normal force N and the friction that keep the mechanism at rest.
    pub fn hold(&self) -> (DoubleDouble, DoubleDouble) {
        let determinant = self.jy[0] * self.jx[1] - self.jx[0] * self.jy[1];
        (
            (self.jx[0] * self.q[1] - self.q[0] * self.jx[1]) / determinant,
            (self.q[0] * self.jy[1] - self.jy[0] * self.q[1]) / determinant,
        )
    }

    /// Returns a number that is positive while exactly one acceleration exists.
    pub fn clear(&self, mu: f64) -> DoubleDouble {
        let slow = self.times(self.open());
        let ratio = cross(slow, self.jx) / cross(slow, self.jy) * mu;
        let size = if ratio.value() < 0.0 { -ratio } else { ratio };
        DoubleDouble::ONE - size
    }
}

fn cross(a: Pair, b: Pair) -> DoubleDouble {
    a[0] * b[1] - a[1] * b[0]
}
