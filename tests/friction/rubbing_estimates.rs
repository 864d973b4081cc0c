//! Error estimates compared with true errors over random scenes with friction, limits and switching loads. The truth is
//! the reference of the comparison of methods: integration from event to event in double-double arithmetic, with the
//! guide force as an unknown.

use std::thread;

use crate::support::image::Image;
use crate::support::random::cases;
use crate::support::reference::precision;
use crate::support::rubbing::{Without, rubbing};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use slider_crank::precision::PrecisionOptions;
use slider_crank::scene::Scene;

/// Number of scenes; a longer test with 240 scenes also passes.
const SCENES: usize = 100;
const TOLERANCES: [f64; 3] = [1e-6, 1e-9, 1e-12];

/// Stated and true error.
#[derive(Clone, Debug)]
#[allow(dead_code, reason = "shown by failures")]
struct Judged {
    scene: usize,
    method: String,
    tolerance: f64,
    what: &'static str,
    error: f64,
    unsure: f64,
    stated: f64,
    /// Floor below which errors are not judged from above.
    floor: f64,
}

impl Judged {
    /// Whether the truth is accurate enough to judge an overestimate.
    fn is_sharp(&self) -> bool {
        self.unsure <= 0.1 * self.error.max(self.stated)
    }

    /// Returns the true error over the stated error.
    fn below(&self) -> f64 {
        let least = (self.error - self.unsure).max(0.0);
        if least == 0.0 {
            0.0
        } else {
            least / self.stated
        }
    }

    /// Returns the stated error over the true error, or over the floor.
    fn above(&self) -> f64 {
        self.stated / (self.error + self.unsure).max(self.floor)
    }
}

fn scenes() -> Vec<Scene> {
    let mut runner = TestRunner::new(cases(1));
    let strategy = (
        rubbing(Without {
            friction: false,
            loads: false,
            jumps: false,
        }),
        rubbing(Without {
            friction: true,
            loads: false,
            jumps: true,
        }),
        0..4u8,
    );
    let settings = (0..SCENES).map(|_| {
        let (rubs, slides, which) = strategy.new_tree(&mut runner).unwrap().current();
        if which == 0 { slides } else { rubs }
    });
    settings
        .map(|setting| setting.scene(&Image::SAME))
        .collect()
}

fn judge(index: usize, scene: &Scene) -> Vec<Judged> {
    let options = PrecisionOptions {
        tolerances: TOLERANCES.to_vec(),
        repeats: 1,
        most_s: 0.0,
        ..PrecisionOptions::default()
    };
    let result = precision(scene, &options).unwrap();
    // Another method is no reference for errors near rounding.
    if !result.reference.contains("double-double") {
        return Vec::new();
    }
    let unsure = [
        result.reference_error_theta_rad.unwrap(),
        result.reference_error_omega_rad_per_s.unwrap(),
    ];
    let mut judged = Vec::new();
    for row in result.rows {
        let served = ["time", "dop853", "dopri5"].contains(&row.method.as_str());
        if !served || row.failure.is_some() {
            continue;
        }
        let errors = [row.error_theta_rad, row.error_omega_rad_per_s].map(Option::unwrap);
        let stated = [row.estimate_theta_rad, row.estimate_omega_rad_per_s].map(Option::unwrap);
        for k in 0..2 {
            let speed = scene.motion.speed.abs().max(5.0 / result.t_s);
            judged.push(Judged {
                scene: index,
                method: row.method.clone(),
                tolerance: row.tolerance,
                what: ["theta", "omega"][k],
                error: errors[k],
                unsure: unsure[k],
                stated: stated[k],
                floor: [2e-14, 2e-14 * speed][k],
            });
        }
    }
    judged
}

#[test]
fn stated_errors_are_near_the_true_ones() {
    let scenes = scenes();
    let threads = thread::available_parallelism().map_or(2, usize::from);
    let judged: Vec<Judged> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|k| {
                let mine = scenes.iter().enumerate().skip(k).step_by(threads);
                scope.spawn(move || {
                    mine.flat_map(|(i, scene)| judge(i, scene))
                        .collect::<Vec<_>>()
                })
            })
            .collect();
        let found = workers.into_iter().map(|worker| worker.join().unwrap());
        found.flatten().collect()
    });
    let blurred = judged.iter().filter(|one| !one.is_sharp()).count();
    assert!(8 * blurred <= judged.len() && judged.len() > 16 * SCENES);
    for one in &judged {
        assert!(one.below() <= 2.0, "{one:?}");
        assert!(!one.is_sharp() || one.above() <= 10.0, "{one:?}");
    }
}
