//! Stated errors of scenes compared with true errors.
//!
//! The truth is the reference of the comparison of methods: collocation in double-double arithmetic of independently
//! written equations. Where this reference is not sharp (non-smooth loads where the crank turns back), the truth is
//! another method at a tight tolerance.

use std::f64::consts::TAU;
use std::thread;

use super::reference::precision;
use slider_crank::plan::Method;
use slider_crank::precision::{PrecisionOptions, PrecisionRow};
use slider_crank::scene::{Extent, Scene};
use slider_crank::simulate::{Options, simulate};

/// True and stated error of angle or speed.
#[derive(Clone, Debug)]
#[allow(dead_code, reason = "shown by failures")]
pub struct Judged {
    pub scene: usize,
    pub method: String,
    pub tolerance: f64,
    pub what: &'static str,
    /// Distance from the truth.
    pub distance: f64,
    /// Error of the truth itself.
    pub unsure: f64,
    pub stated: f64,
    pub floor: f64,
}

impl Judged {
    /// Whether the truth is a hundred times better than the error, or both are near the floor.
    pub fn is_sharp(&self) -> bool {
        100.0 * self.unsure <= self.distance || self.distance + self.unsure <= 8.0 * self.floor
    }

    /// Returns the true error over the stated error.
    pub fn below(&self) -> f64 {
        (self.distance - self.unsure).max(0.0) / self.stated
    }

    /// Returns the stated error over the true error, or over the floor.
    pub fn above(&self) -> f64 {
        self.stated / (self.distance + self.unsure).max(self.floor)
    }
}

/// Relative change of a scene's numbers for finite-difference slopes.
const CHANGE: f64 = 1e-10;

/// Returns angle and speed at the end.
fn end(scene: &Scene, tolerance: f64, method: Method) -> [f64; 2] {
    let options = Options {
        method,
        estimate: false,
        ..Options::default()
    };
    let run = simulate(&scene.clone().tolerance(tolerance), &options).unwrap();
    let last = run.summary.last;
    assert!(run.summary.stopped.is_none(), "{:?}", run.summary.stopped);
    [last.theta_rad, last.omega_rad_per_s]
}

/// Floors of angle and speed below which an error counts as accidental. They are the resolution of the motion itself:
/// the effect at the end of half a unit in the last place of the scene's lengths, start and duration, which are
/// decimals rounded to floats, plus half a unit of the result.
fn floors(scene: &Scene) -> [f64; 2] {
    const UNITS: f64 = 0.5;
    let base = end(scene, TIGHT, Method::Auto);
    let changed = |change: fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        let there = end(&scene, TIGHT, Method::Auto);
        [0, 1].map(|k| (there[k] - base[k]).abs() / CHANGE)
    };
    let slopes = [
        changed(|scene| scene.geometry.crank *= 1.0 + CHANGE),
        changed(|scene| scene.geometry.rod *= 1.0 + CHANGE),
        changed(|scene| scene.motion.speed *= 1.0 + CHANGE),
        changed(|scene| scene.motion.angle += TAU * CHANGE),
        changed(|scene| {
            if let Some(Extent::Duration(duration)) = &mut scene.run.extent {
                *duration *= 1.0 + CHANGE;
            }
        }),
    ];
    let sum = |k: usize| slopes.iter().map(|slope| slope[k]).sum::<f64>();
    [0, 1].map(|k| UNITS * f64::EPSILON * (sum(k) + base[k].abs()))
}

/// Tolerance of the reference runs.
const TIGHT: f64 = 1e-13;

/// Returns the distance from a run by a method unrelated to the one under test, and twice the distance between the two
/// such methods.
fn by_another(scene: &Scene, row: &PrecisionRow) -> [(f64, f64); 2] {
    let method: Method = row.method.parse().unwrap();
    let ends = [Method::Time, Method::Dop853].map(|other| end(scene, TIGHT, other));
    let library = matches!(method, Method::Dop853 | Method::Dopri5);
    let truth = ends[usize::from(!library)];
    let found = end(scene, row.tolerance, method);
    [0, 1].map(|k| {
        let unsure = 2.0 * (ends[0][k] - ends[1][k]).abs();
        ((found[k] - truth[k]).abs(), unsure)
    })
}

fn judge(index: usize, scene: &Scene, tolerances: &[f64]) -> Vec<Judged> {
    let options = PrecisionOptions {
        tolerances: tolerances.to_vec(),
        repeats: 1,
        most_s: 0.0,
        ..PrecisionOptions::default()
    };
    let result = precision(scene, &options).unwrap();
    let floors = floors(scene);
    let unsure = [
        result.reference_error_theta_rad,
        result.reference_error_omega_rad_per_s,
    ]
    .map(|unsure| match result.reference.contains("double-double") {
        true => unsure.unwrap(),
        false => f64::INFINITY,
    });
    let mut judged = Vec::new();
    for row in result.rows {
        if let Some(why) = &row.failure {
            // Only methods over the angle may be inapplicable.
            let over_angle = ["angle", "energy"].contains(&row.method.as_str());
            let at_rest = ["near to rest", "starts at rest"]
                .iter()
                .any(|at| why.contains(at));
            assert!(over_angle && at_rest, "{index} {}: {why}", row.method);
            continue;
        }
        let errors = [row.error_theta_rad, row.error_omega_rad_per_s].map(Option::unwrap);
        let stated = [row.estimate_theta_rad, row.estimate_omega_rad_per_s];
        // A missing estimate is below every error.
        let stated = stated.map(|stated| stated.unwrap_or(0.0));
        let both = [0, 1].map(|k| {
            // An error stated as a bound is a distance plus the error of the reference.
            let without = errors[k] - unsure[k];
            let bound = row.error_is_bound && 100.0 * unsure[k] > without;
            Judged {
                scene: index,
                method: row.method.clone(),
                tolerance: row.tolerance,
                what: ["theta", "omega"][k],
                distance: if bound { without } else { errors[k] },
                unsure: unsure[k],
                stated: stated[k],
                floor: floors[k],
            }
        });
        let mut others = None;
        for (k, mut one) in both.into_iter().enumerate() {
            if !one.is_sharp() {
                let others = others.get_or_insert_with(|| by_another(scene, &row));
                (one.distance, one.unsure) = others[k];
            }
            judged.push(one);
        }
    }
    judged
}

/// Judges all estimates of the scenes, on all processors.
pub fn estimates(cases: &[(Scene, [f64; 2])]) -> Vec<Judged> {
    let threads = thread::available_parallelism().map_or(2, usize::from);
    let every = |k: usize| {
        let mine = cases.iter().enumerate().skip(k).step_by(threads);
        let judged = mine.flat_map(|(i, (scene, tolerances))| judge(i, scene, tolerances));
        judged.collect::<Vec<_>>()
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|k| scope.spawn(move || every(k)))
            .collect();
        let results = workers.into_iter().map(|worker| worker.join().unwrap());
        results.flatten().collect()
    })
}
