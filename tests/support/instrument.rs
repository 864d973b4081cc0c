//! Readings of instruments on a mechanism.

use slider_crank::mechanism::Linkage;
use slider_crank::scene::{Measured, Scene};

/// Returns the reading at a crank angle, rad; gamma is the angle between the directions from crank pin to pivot and to
/// wrist pin.
pub fn shown(scene: &Scene, measured: Measured, theta: f64) -> f64 {
    let pose = Linkage::new(&scene.geometry).pose(theta);
    let (r, e) = (scene.geometry.crank, scene.geometry.offset);
    let (ax, ay) = (r * theta.cos(), r * theta.sin());
    let (px, py) = (pose.x - ax, -e - ay);
    match measured {
        Measured::Theta => theta,
        Measured::X => pose.x,
        Measured::Omega => panic!("an angle alone has no speed"),
        Measured::Gamma => (px * ay - py * ax).abs().atan2(-ax * px - ay * py),
    }
}
