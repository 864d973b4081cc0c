//! Whether loads over the crank angle repeat with each turn.

use std::f64::consts::TAU;

use crate::mechanism::{Linkage, single};
use crate::scene::{Instant, Load, Scene, Variable};

/// Places of a turn that are looked at, at two speeds.
const PLACES: u32 = 90;

/// Whether every load that reads the crank angle has the same value one turn further, forwards and back: a table with
/// the period of two turns has not.
pub(crate) fn repeats_with_each_turn(scene: &Scene) -> bool {
    let linkage = Linkage::new(&scene.geometry);
    let torques = scene.torques.iter().map(|load| (load, false));
    let forces = scene.forces.iter().map(|load| (load, true));
    torques
        .chain(forces)
        .filter(|(load, on_slider)| load.reads(*on_slider).has(Variable::Theta))
        .all(|(load, on_slider)| repeats(load, on_slider, &linkage, scene.motion.speed))
}

fn repeats(load: &Load, on_slider: bool, linkage: &Linkage, speed: f64) -> bool {
    let values = |turn: f64| {
        (0..PLACES).map(move |i| {
            let theta = 0.37 + TAU * f64::from(i) / f64::from(PLACES);
            let pose = linkage.pose(theta);
            let omega = if i % 2 == 0 { speed } else { 0.3 * speed };
            let now = Instant {
                t: 0.0,
                theta: theta + turn * TAU,
                omega,
                x: pose.x,
                v: pose.dx * omega,
            };
            single(load, on_slider, &now)
        })
    };
    let largest = values(0.0).fold(0.0, |largest: f64, value| largest.max(value.abs()));
    [-1.0, 1.0, 2.0].into_iter().all(|turn| {
        values(0.0)
            .zip(values(turn))
            .all(|(a, b)| (a - b).abs() <= 1e-9 * largest)
    })
}
