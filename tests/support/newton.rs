//! Newton-Euler equations of crank, rod and slider with every joint force unknown.

use slider_crank::mechanism::Reactions;
use slider_crank::scene::Scene;

use super::exact::{Dd, Jet};
use super::{Exact, Point, Sizes, central_inertia};

type Vector = [Dd; 2];

/// Rigid body: mass, path of the centre of gravity, and the moment of inertia that rotates with ψ.
pub struct Part {
    mass: f64,
    cg: Point,
    inertia: Dd,
    dpsi: Jet,
    size: Size,
}

/// Sizes of the terms that make up p', p'', ψ' and ψ'', and of the inertia before subtraction.
struct Size {
    dp: f64,
    d2p: f64,
    dpsi: f64,
    d2psi: f64,
    inertia: f64,
}

impl Part {
    /// m |p'|² + I ψ'²
    pub fn inertia(&self) -> Jet {
        let (x, y) = (self.cg[0].derivative(), self.cg[1].derivative());
        Jet::from(self.mass) * (x * x + y * y) + Jet::from(self.inertia) * self.dpsi * self.dpsi
    }

    /// −m g·p
    pub fn potential(&self, gravity: [f64; 2]) -> Jet {
        let [gx, gy] = gravity.map(Jet::from);
        -Jet::from(self.mass) * (gx * self.cg[0] + gy * self.cg[1])
    }

    /// Returns the sizes of the terms of M, of ½ M' and of V'.
    fn sizes(&self, gravity: f64) -> [f64; 3] {
        let Size {
            dp,
            d2p,
            dpsi,
            d2psi,
            inertia,
        } = self.size;
        [
            self.mass * dp * dp + inertia * dpsi * dpsi,
            self.mass * dp * d2p + inertia * dpsi * d2psi,
            self.mass * gravity * dp,
        ]
    }

    /// Returns the size of the forces, and of the couple divided by `length`, that accelerate the body.
    fn force(&self, gravity: f64, omega: f64, alpha: f64, length: f64) -> f64 {
        let rate = |first: f64, second: f64| first * alpha.abs() + second * omega * omega;
        let Size {
            dp,
            d2p,
            dpsi,
            d2psi,
            inertia,
        } = self.size;
        self.mass * (rate(dp, d2p) + gravity) + inertia * rate(dpsi, d2psi) / length
    }

    fn place(&self) -> Vector {
        [self.cg[0].exactly(0), self.cg[1].exactly(0)]
    }

    /// Returns acceleration and angular acceleration: the factor of θ̈, and the remainder, proportional to θ̇².
    fn motion(&self, omega: Dd) -> ([Vector; 2], [Dd; 2]) {
        let squared = omega * omega;
        let order = |n: usize| [self.cg[0].exactly(n), self.cg[1].exactly(n)];
        (
            [order(1), order(2).map(|p| p * squared)],
            [self.dpsi.exactly(0), self.dpsi.exactly(1) * squared],
        )
    }
}

/// Crank, rod and slider of a scene; absent bodies have no mass.
pub struct Parts {
    pub all: [Part; 3],
    pub exact: Exact,
    pub gravity: [f64; 2],
}

impl Parts {
    pub fn new(scene: &Scene, theta: f64) -> Parts {
        let g = &scene.geometry;
        let exact = Exact::new(g, theta);
        let sizes = Sizes::new(g, &exact);
        let crank = scene.crank.unwrap_or_default();
        let [mass, along, left] = [crank.mass, crank.cg, crank.cg_lateral].map(Dd::from);
        let arm = crank.cg.hypot(crank.cg_lateral);
        let crank = Part {
            mass: crank.mass,
            cg: exact.on_crank(crank.cg, crank.cg_lateral),
            inertia: Dd::from(crank.inertia) - mass * (along * along + left * left),
            dpsi: Jet::from(1.0),
            size: Size {
                dp: arm,
                d2p: arm,
                dpsi: 1.0,
                d2psi: 0.0,
                inertia: crank.inertia,
            },
        };
        let rod = scene.rod.unwrap_or_default();
        let arm = rod.cg.hypot(rod.cg_lateral);
        let rod = Part {
            mass: rod.mass,
            cg: exact.on_rod(rod.cg, rod.cg_lateral),
            inertia: central_inertia(&rod),
            dpsi: exact.dpsi(),
            size: Size {
                dp: g.crank + arm * sizes.dphi,
                d2p: g.crank + arm * (sizes.d2phi + sizes.dphi * sizes.dphi),
                dpsi: sizes.dphi,
                d2psi: sizes.d2phi,
                inertia: rod.inertia,
            },
        };
        let slider = Part {
            mass: scene.slider.map_or(0.0, |s| s.mass),
            cg: exact.p,
            inertia: Dd::ZERO,
            dpsi: Jet::from(0.0),
            size: Size {
                dp: sizes.dx,
                d2p: sizes.d2x,
                dpsi: 0.0,
                d2psi: 0.0,
                inertia: 0.0,
            },
        };
        let gravity = scene.gravity.map_or([0.0; 2], |g| {
            [
                g.acceleration * g.direction.cos(),
                g.acceleration * g.direction.sin(),
            ]
        });
        Parts {
            all: [crank, rod, slider],
            exact,
            gravity,
        }
    }

    /// Returns the sizes of the terms of M, ½ M' and V'.
    pub fn sizes(&self) -> [f64; 3] {
        let gravity = self.gravity[0].hypot(self.gravity[1]);
        self.all.iter().fold([0.0; 3], |sum, part| {
            let size = part.sizes(gravity);
            std::array::from_fn(|i| sum[i] + size[i])
        })
    }

    /// Returns the size of the joint forces of a rod of this length.
    pub fn force_size(&self, omega: f64, alpha: f64, length: f64) -> f64 {
        let gravity = self.gravity[0].hypot(self.gravity[1]);
        let sum: f64 = self
            .all
            .iter()
            .map(|p| p.force(gravity, omega, alpha, length))
            .sum();
        sum / self.exact.cos_phi.value()
    }

    /// Returns the weight of all bodies.
    pub fn weight(&self) -> [f64; 2] {
        self.gravity
            .map(|g| g * self.all.iter().map(|part| part.mass).sum::<f64>())
    }

    /// Returns the moment of the weights about O.
    pub fn weight_moment(&self) -> f64 {
        let [gx, gy] = self.gravity;
        self.all
            .iter()
            .map(|p| p.mass * (p.cg[0].value() * gy - p.cg[1].value() * gx))
            .sum()
    }

    /// Returns the size of the potential energy of the weights.
    pub fn lift_size(&self, scene: &Scene) -> f64 {
        let [gx, gy] = self.weight();
        gx.hypot(gy) * 2.0 * (scene.geometry.crank + scene.geometry.rod)
    }

    /// Solves for θ̈ and all joint forces under a torque on the crank and a force on the slider.
    pub fn solve(&self, omega: f64, torque: f64, force: f64) -> (f64, Reactions) {
        const ALPHA: usize = 7;
        let [crank, rod, slider] = &self.all;
        let omega = Dd::from(omega);
        let gravity = self.gravity.map(Dd::from);
        let weight = |part: &Part| gravity.map(|g| Dd::from(part.mass) * g);
        let (one, zero) = (Dd::from(1.0), Dd::ZERO);
        // Unknowns: ground on crank (0, 1), crank on rod (2, 3), rod on slider (4, 5), guide (6), θ̈ (7).
        let mut rows = [[zero; 9]; 8];
        for (body, part) in self.all.iter().enumerate() {
            let (acceleration, _) = part.motion(omega);
            let mass = Dd::from(part.mass);
            for i in 0..2 {
                let row = &mut rows[2 * body + i];
                row[2 * body + i] = one;
                if body < 2 {
                    row[2 * body + 2 + i] = -one;
                } else if i == 1 {
                    row[6] = one;
                }
                row[ALPHA] = -mass * acceleration[0][i];
                row[8] = mass * acceleration[1][i] - weight(part)[i];
                if body == 2 && i == 0 {
                    row[8] = row[8] - Dd::from(force);
                }
            }
        }
        // Moments about the centre of gravity: a force f at p gives (p − c) × f.
        let pin = |point: &Point| [point[0].exactly(0), point[1].exactly(0)];
        let origin = [zero; 2];
        let (a, p) = (pin(&self.exact.a), pin(&self.exact.p));
        for (row, part, [from, to], column, torque) in
            [(6, crank, [origin, a], 0, torque), (7, rod, [a, p], 2, 0.0)]
        {
            let c = part.place();
            let (_, spin) = part.motion(omega);
            for (point, column, sign) in [(from, column, one), (to, column + 2, -one)] {
                rows[row][column] = -sign * (point[1] - c[1]);
                rows[row][column + 1] = sign * (point[0] - c[0]);
            }
            rows[row][ALPHA] = -part.inertia * spin[0];
            rows[row][8] = part.inertia * spin[1] - Dd::from(torque);
        }
        let f = eliminate(rows);
        let rate = |part: &Part| {
            let (acceleration, spin) = part.motion(omega);
            let a = [0, 1].map(|i| acceleration[0][i] * f[ALPHA] + acceleration[1][i]);
            (
                a.map(|a| Dd::from(part.mass) * a),
                part.inertia * (spin[0] * f[ALPHA] + spin[1]),
            )
        };
        let (mut linear, mut angular) = ([zero; 2], zero);
        for part in [crank, rod, slider] {
            let (momentum, spin) = rate(part);
            let c = part.place();
            linear = [linear[0] + momentum[0], linear[1] + momentum[1]];
            angular = angular + spin + c[0] * momentum[1] - c[1] * momentum[0];
        }
        let v = |i: usize| f[i].value();
        let reactions = Reactions {
            crank_bearing: [v(0), v(1)],
            crank_pin: [v(2), v(3)],
            wrist_pin: [v(4), v(5)],
            guide: v(6),
            shaking: [-linear[0].value(), -linear[1].value()],
            shaking_moment: -angular.value(),
        };
        (v(ALPHA), reactions)
    }
}

/// Solves the system by Gaussian elimination with pivoting.
fn eliminate(mut rows: [[Dd; 9]; 8]) -> [Dd; 8] {
    for k in 0..8 {
        let size = |row: &[Dd; 9]| row[k].value().abs();
        let best = (k..8)
            .max_by(|i, j| size(&rows[*i]).total_cmp(&size(&rows[*j])))
            .unwrap();
        rows.swap(k, best);
        for i in (0..8).filter(|i| *i != k) {
            let factor = rows[i][k] / rows[k][k];
            let pivot = rows[k];
            for (entry, above) in rows[i].iter_mut().zip(pivot).skip(k) {
                *entry = *entry - factor * above;
            }
        }
    }
    std::array::from_fn(|k| rows[k][8] / rows[k][k])
}
