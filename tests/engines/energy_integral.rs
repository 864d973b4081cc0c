//! Reference for motion without loads by quadrature: t = ∫ dθ sqrt(M/(2 (E − V))), with M and V from the positions and
//! velocities of the bodies.

use slider_crank::scene::Scene;

pub struct EnergyIntegral {
    scene: Scene,
    energy: f64,
    nodes: Vec<(f64, f64)>,
}

/// Number of panels in a turn.
const PANELS: f64 = 240.0;

impl EnergyIntegral {
    pub fn new(scene: &Scene) -> EnergyIntegral {
        assert!(scene.torques.is_empty() && scene.forces.is_empty());
        let mut integral = EnergyIntegral {
            scene: scene.clone(),
            energy: 0.0,
            nodes: fejer(24),
        };
        let (m, v) = integral.m_and_v(scene.motion.angle);
        integral.energy = 0.5 * m * scene.motion.speed.powi(2) + v;
        integral
    }

    /// Returns M and V at a crank angle.
    pub fn m_and_v(&self, theta: f64) -> (f64, f64) {
        let geometry = &self.scene.geometry;
        let (r, l, e, s) = (
            geometry.crank,
            geometry.rod,
            geometry.offset,
            geometry.branch.sign(),
        );
        let (sin, cos) = theta.sin_cos();
        let sin_phi = (e + r * sin) / l;
        let cos_phi = (1.0 - sin_phi * sin_phi).sqrt();
        let phi_rate = r * cos / (l * cos_phi);
        let x = r * cos + s * l * cos_phi;
        let x_rate = -r * sin - s * l * sin_phi * phi_rate;
        let gravity = self.scene.gravity.map_or([0.0; 2], |gravity| {
            let (sin, cos) = gravity.direction.sin_cos();
            [gravity.acceleration * cos, gravity.acceleration * sin]
        });
        let (mut m, mut v) = (0.0, 0.0);
        let mut lift = |mass: f64, x: f64, y: f64| v -= mass * (gravity[0] * x + gravity[1] * y);
        if let Some(crank) = &self.scene.crank {
            m += crank.inertia;
            let (a, b) = (crank.cg, crank.cg_lateral);
            lift(crank.mass, a * cos - b * sin, a * sin + b * cos);
        }
        if let Some(rod) = &self.scene.rod {
            let (a, b) = (rod.cg, rod.cg_lateral);
            let (ux, uy) = (s * cos_phi, -sin_phi);
            let (gx, gy) = (a * ux - b * uy, a * uy + b * ux);
            let spin = -s * phi_rate;
            let (vx, vy) = (-r * sin - spin * gy, r * cos + spin * gx);
            m += rod.mass * (vx * vx + vy * vy) + rod.central_inertia() * spin * spin;
            lift(rod.mass, r * cos + gx, r * sin + gy);
        }
        if let Some(slider) = &self.scene.slider {
            m += slider.mass * x_rate * x_rate;
            lift(slider.mass, x, -e);
        }
        (m, v)
    }

    /// Returns the speed at a crank angle, rad/s, with the sign of the start.
    pub fn speed(&self, theta: f64) -> f64 {
        let (m, v) = self.m_and_v(theta);
        (2.0 * (self.energy - v) / m)
            .sqrt()
            .copysign(self.scene.motion.speed)
    }

    /// Returns the time from `from` to `to` within one panel.
    fn time(&self, from: f64, to: f64) -> f64 {
        let half = 0.5 * (to - from);
        let middle = 0.5 * (to + from);
        let node = |&(x, w): &(f64, f64)| w / self.speed(middle + half * x);
        half * self.nodes.iter().map(node).sum::<f64>()
    }

    /// Returns the times from the start of a turn to the end of each of its panels.
    fn times(&self) -> Vec<f64> {
        let panel = self.panel();
        let (mut sum, mut lost) = (0.0, 0.0);
        (0..PANELS as u32)
            .map(|i| {
                let from = self.scene.motion.angle + f64::from(i) * panel;
                // Kahan summation.
                let corrected = self.time(from, from + panel) - lost;
                let next: f64 = sum + corrected;
                lost = (next - sum) - corrected;
                sum = next;
                sum
            })
            .collect()
    }

    fn panel(&self) -> f64 {
        std::f64::consts::TAU / PANELS * self.scene.motion.speed.signum()
    }

    /// Returns angle and speed at time t: whole turns, and a remainder inside the first turn, where angles are small.
    pub fn state(&self, t: f64) -> (f64, f64) {
        let times = self.times();
        let turn = times[times.len() - 1];
        let turns = (t / turn).floor();
        let rest = t - turns * turn;
        let index = times.partition_point(|end| *end <= rest);
        let begin = if index == 0 { 0.0 } else { times[index - 1] };
        let from = self.scene.motion.angle + index as f64 * self.panel();
        let (theta, speed) = self.inside(from, self.panel(), rest - begin);
        let whole = turns * std::f64::consts::TAU * self.scene.motion.speed.signum();
        (whole + theta, speed)
    }

    /// Solves by Newton's method for the angle that is reached a time `left` after `from`.
    fn inside(&self, from: f64, panel: f64, left: f64) -> (f64, f64) {
        let mut theta = from + (left * self.speed(from)).clamp(-panel.abs(), panel.abs());
        for _ in 0..50 {
            let change = (left - self.time(from, theta)) * self.speed(theta);
            theta += change;
            if change.abs() <= 2e-16 * theta.abs() {
                break;
            }
        }
        (theta, self.speed(theta))
    }
}

/// Returns nodes and weights of Fejér's first rule on [−1, 1], interpolatory on the zeros of T_n (Davis and Rabinowitz,
/// Methods of Numerical Integration, 2.5.5): exact for polynomials of degree less than n.
pub fn fejer(n: u32) -> Vec<(f64, f64)> {
    let count = f64::from(n);
    (0..n)
        .map(|i| {
            let angle = std::f64::consts::PI * (f64::from(i) + 0.5) / count;
            let term = |j: u32| {
                let j = f64::from(j);
                (2.0 * j * angle).cos() / (4.0 * j * j - 1.0)
            };
            let sum: f64 = (1..=n / 2).map(term).sum();
            (angle.cos(), 2.0 / count * (1.0 - 2.0 * sum))
        })
        .collect()
}
