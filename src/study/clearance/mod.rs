//! Motion with a loose joint.

mod motion;

use crate::engine::contact::{self, Phase, Settings};
use crate::error::Error;
use crate::mechanism::LooseMechanism;
use crate::scene::Scene;
use motion::*;

/// bench
pub fn bench(scene: &Scene, tolerance: f64, t_end: f64, verbose: bool, nudge: f64) -> Result<([f64; 7], u64, u64, u64), Error> {
    let scene = scene.reduced();
    let clearance = scene.clearance.unwrap();
    let mechanism = LooseMechanism::new(&scene, clearance)?;
    let start = mechanism.start(&scene)?;
    let mut start = start;
    start.v += nudge;
    let length = scene.geometry.crank.min(100.0 * clearance.radial);
    let model = Loose::<DRIVEN> {
        start: (start.theta, start.omega),
        mechanism: &mechanism,
        length,
        pace: scene.motion.speed.abs().max(1.0),
        angle: length / scene.geometry.crank,
        reach: scene.geometry.rod + scene.geometry.crank,
        corners: &|_| f64::INFINITY,
    };
    let mut impacts = 0;
    let mut last = Phase::Flight;
    let ended = contact::run(
        &model,
        model.numbers(&start, [0.0; 2]),
        clearance.law == crate::scene::ContactLaw::MasslessLink,
        Settings { tolerance, t_end, max_evaluations: 200_000_000 },
        &mut |stretch| {
            if verbose {
                println!("{:?} t={:.9} dt={:.3e} depth={:?}", stretch.phase, stretch.start[0], stretch.length(), mechanism.depth(&model.state(&stretch.end)));
            }
            if matches!((last, stretch.phase), (Phase::Flight, Phase::Contact { .. })) { impacts += 1 }
            last = stretch.phase;
            false
        },
    );
    let e0 = mechanism.energy(&start);
    let e1 = mechanism.energy(&model.state(&ended.last));
    if verbose { println!("{:?} residual {:e} of {:e}", ended, e1 - e0 - model.work(&ended.last)[0] + model.work(&ended.last)[1], e1); }
    Ok((ended.last, ended.evaluations, ended.steps, impacts))
}
