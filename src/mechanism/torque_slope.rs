//! Derivatives of the driving torque at constant speed with respect to the lengths, in closed form.

use super::{Bodies, Body, Length, Link, Linkage, Path, Pose, PoseSlope, single};
use crate::error::Error;
use crate::scene::{Load, RodModel, Scene, Variables};

/// Bodies and loads whose torque changes with the lengths; masses, moments of inertia and centres of gravity stay
/// constant, measured from the crank pivot and the crank pin.
#[derive(Clone, Debug)]
pub struct TorqueSlope {
    linkage: Linkage,
    inertias: Vec<Body>,
    weights: Vec<Body>,
    gravity: [f64; 2],
    force: f64,
    stiffness: f64,
    damping: f64,
    /// Forces on the slider that depend on neither its position nor its velocity.
    others: Vec<Load>,
    /// Two-mass rod: mass, kg, distance of its centre of gravity, m, and mass at the crank pin, kg.
    two_mass: Option<[f64; 3]>,
    /// Mass of a spin-only rod, kg, whose weight acts on the crank's line beyond its end.
    spin_only: Option<f64>,
}

impl TorqueSlope {
    /// Collects the bodies and loads of a scene.
    ///
    /// # Errors
    /// [`Error::Refused`] for slider forces of position or velocity other than springs and dampers: their slope is not
    /// known.
    pub fn new(scene: &Scene) -> Result<TorqueSlope, Error> {
        let scene = scene.reduced();
        let bodies = Bodies::new(&scene);
        let mut found = TorqueSlope {
            linkage: Linkage::new(&scene.geometry),
            inertias: bodies.inertias,
            weights: bodies.weights,
            gravity: scene.gravity.map_or([0.0; 2], |gravity| gravity.vector()),
            force: 0.0,
            stiffness: 0.0,
            damping: 0.0,
            others: Vec::new(),
            two_mass: None,
            spin_only: None,
        };
        match &scene.rod {
            Some(rod) if rod.model == RodModel::TwoMass => {
                // The rod's mass at the crank pin moves with the pin and is not fixed to the crank.
                let on_crank = |body: &Body| body.on == Link::Crank;
                if let Some(last) = found.weights.iter().rposition(on_crank) {
                    let at_crank_pin = found.weights.remove(last).mass;
                    found.two_mass = Some([rod.mass, rod.cg, at_crank_pin]);
                }
            }
            Some(rod) if rod.model == RodModel::SpinOnly => found.spin_only = Some(rod.mass),
            _ => {}
        }
        for load in &scene.forces {
            match load {
                Load::Viscous(coefficient) => found.damping += coefficient,
                Load::Spring { stiffness, rest } => {
                    found.stiffness += stiffness;
                    found.force += stiffness * rest;
                }
                other if other.reads(true).disjoint(Variables::X.or(Variables::V)) => {
                    found.others.push(other.clone());
                }
                other => {
                    let what = format!(
                        "the slope of a slider force of kind \"{}\" over position or velocity is not known, so neither is the torque's sensitivity to the lengths",
                        other.kind()
                    );
                    return Err(Error::refused(what, "compare two scenes"));
                }
            }
        }
        Ok(found)
    }

    /// Returns d τ/d length, N, of the torque τ = ½ M' ω² + V' − F x' that drives the crank at constant speed ω (rad/s)
    /// at a crank angle (rad); time counts from θ = 0.
    pub fn driving_torque(&self, theta: f64, omega: f64, length: Length) -> f64 {
        let pose = &self.linkage.pose(theta);
        let slope = self.linkage.slope(pose, length);
        let squared = omega * omega;
        let inertias = self.inertias.iter().map(|body| {
            let (mass, inertia) = (body.mass, body.inertia);
            let [path, change] = self.paths(body, pose, &slope);
            let bilinear = |a: &Path, b: &Path| {
                mass * (a.dp[0] * b.d2p[0] + a.dp[1] * b.d2p[1]) + inertia * a.dpsi * b.d2psi
            };
            squared * (bilinear(&change, &path) + bilinear(&path, &change))
        });
        let weights = self.weights.iter().map(|body| {
            let [_, change] = self.paths(body, pose, &slope);
            -body.mass * (self.gravity[0] * change.dp[0] + self.gravity[1] * change.dp[1])
        });
        let inertia: f64 = inertias.chain(weights).sum();
        let now = pose.instant(theta / omega, theta, omega);
        let others: f64 = self
            .others
            .iter()
            .map(|load| single(load, true, &now))
            .sum();
        let force = others + self.force - self.stiffness * pose.x - self.damping * pose.dx * omega;
        let force_slope = -self.stiffness * slope.x - self.damping * slope.dx * omega;
        inertia - force * slope.dx - force_slope * pose.dx + self.moved_mass(pose, squared, length)
    }

    /// Returns the path of a body, and its derivative with respect to the length.
    fn paths(&self, body: &Body, pose: &Pose, slope: &PoseSlope) -> [Path; 2] {
        let (along, lateral) = (body.along, body.lateral);
        match body.on {
            Link::Crank => [Path::on_crank(pose, along, lateral), Path::default()],
            Link::Rod => {
                let path = Path::on_rod(&self.linkage, pose, along, lateral);
                let pin = Path::on_crank(pose, slope.crank, 0.0);
                let part = |pin: [f64; 2], [x, y]: [f64; 2]| {
                    [
                        pin[0] + along * x - lateral * y,
                        pin[1] + along * y + lateral * x,
                    ]
                };
                let s = self.linkage.s;
                let change = Path {
                    dp: part(pin.dp, slope.axis[1]),
                    d2p: part(pin.d2p, slope.axis[2]),
                    dpsi: -s * slope.dphi,
                    d2psi: -s * slope.d2phi,
                };
                [path, change]
            }
            Link::Slider => {
                let sliding = |first: f64, second: f64| Path {
                    dp: [first, 0.0],
                    d2p: [second, 0.0],
                    ..Path::default()
                };
                [sliding(pose.dx, pose.d2x), sliding(slope.dx, slope.d2x)]
            }
        }
    }

    /// Returns the effect of the lengths beside the motion of the bodies, N: masses and places of two point masses, and
    /// the place of a weight that is measured from the crank's end.
    fn moved_mass(&self, pose: &Pose, squared: f64, length: Length) -> f64 {
        let [gx, gy] = self.gravity;
        let crank = Path::on_crank(pose, 1.0, 0.0);
        // V' of a unit mass on the crank, per length along it.
        let lift = -(gx * crank.dp[0] + gy * crank.dp[1]);
        match (length, self.two_mass, self.spin_only) {
            (Length::Crank, Some([_, _, at_crank_pin]), _) => at_crank_pin * lift,
            (Length::Rod, Some([mass, cg, _]), _) => {
                // The mass m c/l at the wrist pin falls, and the rest at the crank pin grows.
                let to_crank_pin = mass * cg / (self.linkage.l * self.linkage.l);
                let at_wrist_pin = squared * pose.dx * pose.d2x - gx * pose.dx;
                to_crank_pin * (self.linkage.r * lift - at_wrist_pin)
            }
            (Length::Rod, _, Some(mass)) => mass * lift,
            _ => 0.0,
        }
    }
}
