//! What instruments show of a mechanism.

use slider_crank::mechanism::Linkage;
use slider_crank::scene::{Measured, Scene};

/// What is measured at a crank angle, rad; the angle at the crank pin from the directions to pivot and wrist pin.
pub fn shown(scene: &Scene, measured: Measured, theta: f64) -> f64 {
    let pose = Linkage::new(&scene.geometry).pose(theta);
    let (r, e) = (scene.geometry.crank, scene.geometry.offset);
    let (ax, ay) = (r * theta.cos(), r * theta.sin());
    let (px, py) = (pose.x - ax, -e - ay);
    match measured {
        Measured::Theta => theta,
        Measured::X => pose.x,
        Measured::Gamma => (px * ay - py * ax).abs().atan2(-ax * px - ay * py),
    }
}
