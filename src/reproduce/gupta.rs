//! Gupta: offset slider-crank in a multibody program and by Newton-Raphson, equations (1)-(11). This module computes
//! the values without formula: loop closure by the paper's script, and inertias of bodies.

use std::f64::consts::{PI, TAU};

use super::formulas::{PaperFormulas, files};
use super::gupta_clearance::LooseTurns;
use super::paper::Paper;
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::mechanism::{Linkage, Shape};
use crate::scene::Scene;

/// Names of the six quantities, prefixed by `script_` (by the script) or `closed_` (closed form). The rod angle theta3
/// is that of the direction from slider to crank pin.
const QUANTITIES: [&str; 6] = ["theta3", "r4", "omega3", "v4", "alpha3", "a4"];

/// Position, velocity and acceleration by the script and in closed form, in SI units.
#[derive(Clone, Copy)]
struct Script {
    linkage: Linkage,
    speed: f64,
}

impl Script {
    fn computed(&self, theta: f64) -> [f64; 6] {
        let Linkage { r, l, .. } = self.linkage;
        let speed = self.speed;
        // Initial guess of the script: rod angle 180 degrees, slider position 40 mm; tolerance 1e-6 mm.
        let Some(found) = self.linkage.close_loop(theta, (PI, 0.04), 1e-9) else {
            return [f64::NAN; 6];
        };
        let (sin3, cos3) = found.theta3.sin_cos();
        let omega3 = r * theta.cos() * speed / (l * cos3);
        let velocity = l * sin3 * omega3 - r * theta.sin() * speed;
        let alpha3 = (l * sin3 * omega3 * omega3 - r * theta.sin() * speed * speed) / (l * cos3);
        let acceleration =
            l * cos3 * omega3 * omega3 + l * sin3 * alpha3 - r * theta.cos() * speed * speed;
        [
            found.theta3,
            found.x,
            omega3,
            velocity,
            alpha3,
            acceleration,
        ]
    }

    fn closed(&self, theta: f64) -> [f64; 6] {
        let (pose, speed) = (self.linkage.pose(theta), self.speed);
        [
            PI - pose.phi(),
            pose.x,
            -pose.dphi * speed,
            pose.dx * speed,
            -pose.d2phi * speed * speed,
            pose.d2x * speed * speed,
        ]
    }

    fn value(&self, name: &str, theta: f64) -> Option<f64> {
        let (way, quantity) = name.split_once('_')?;
        let i = QUANTITIES.iter().position(|known| *known == quantity)?;
        match way {
            "script" => Some(self.computed(theta)[i]),
            "closed" => Some(self.closed(theta)[i]),
            _ => None,
        }
    }

    /// Returns the largest relative difference between script and closed form in 200 positions.
    fn worst(&self) -> f64 {
        let at = |i: u32| {
            let theta = TAU * f64::from(i) / 199.0;
            let pairs = self.computed(theta).into_iter().zip(self.closed(theta));
            pairs.map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max)
        };
        (0..200).map(at).fold(0.0, f64::max)
    }
}

/// Returns mass (kg) or moment of inertia (kg mm2) of a body of the paper, by the name BODY_QUANTITY_DENSITY.
fn plate(name: &str) -> Option<f64> {
    let mut parts = name.split('_');
    let (shape, depth) = match parts.next()? {
        "bar1" => (Shape::rectangle(0.14, 0.03), 0.02),
        "bar2" => (Shape::rectangle(0.31, 0.03), 0.02),
        "drawn1" => (Shape::polygon_ended(0.14, 0.03, 20), 0.02),
        "drawn2" => (Shape::polygon_ended(0.31, 0.03, 20), 0.02),
        "block" => (Shape::rectangle(0.1, 0.05), 0.05),
        _ => return None,
    };
    let quantity = parts.next()?;
    let plate = shape.plate(depth, parts.next()?.parse().ok()?);
    match quantity {
        "mass" => Some(plate.mass),
        "mxx" => Some(plate.normal * 1e6),
        "myy" => Some(plate.across * 1e6),
        "mzz" => Some(plate.along * 1e6),
        _ => None,
    }
}

pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(Paper::Gupta, files!("gupta"))?;
    let [r, l, e, speed] = symbols.numbers(["r2", "r3", "e", "w"])?;
    let scene = |crank: f64, rod: f64| Scene::new(crank, rod).offset(e);
    let mechanisms = vec![
        ("original", MechanismQuantities::new(scene(r, l))),
        ("longcrank", MechanismQuantities::new(scene(0.15, l))),
        ("longrod", MechanismQuantities::new(scene(r, 0.32))),
    ];
    let linkage = Linkage::new(&scene(r, l).geometry);
    let script = Script { linkage, speed };
    let (worst, loose) = (script.worst(), LooseTurns::new()?);
    let other = move |name: &str, theta: f64| match name {
        "worst" => Some(worst),
        _ => (script.value(name, theta))
            .or_else(|| plate(name))
            .or_else(|| loose.value(name, theta)),
    };
    Ok(symbols.with(quantities::of(mechanisms, other)))
}
