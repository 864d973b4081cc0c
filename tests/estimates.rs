//! Error estimates against true errors, over random scenes.

use std::f64::consts::TAU;
use std::thread;

use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngSeed, TestRunner};
use slider_crank::plan::Method;
use slider_crank::scene::{
    Branch, Crank, Expression, Extent, Gravity, InertiaAbout, Load, Rod, Scene, Slider,
};
use slider_crank::study::{Options, PrecisionOptions, PrecisionRow, precision, simulate};

const SCENES: usize = 520;

/// A load on the crank or on the slider, of the size of the torque and the force given.
#[derive(Clone, Copy, Debug)]
enum Part {
    Gravity,
    Torque,
    CrankLoss,
    SliderLoss,
    Motor,
    Spring,
    OfAngle,
    OfSpeed,
    OfTime,
}

const PARTS: [Part; 9] = [
    Part::Gravity,
    Part::Torque,
    Part::CrankLoss,
    Part::SliderLoss,
    Part::Motor,
    Part::Spring,
    Part::OfAngle,
    Part::OfSpeed,
    Part::OfTime,
];

fn expression(text: String) -> Load {
    Load::Expression(Expression::parse(&text).unwrap())
}

/// `size` is from −1 to 1, `energy` (J) the kinetic energy of the mechanism, roughly.
fn with_part(scene: Scene, part: Part, size: f64, r: f64, speed: f64, energy: f64) -> Scene {
    let torque = 0.2 * size * energy;
    let force = torque / r;
    let damping = 0.3 * torque.abs() / speed.abs();
    match part {
        Part::Gravity => scene.gravity(Gravity::standard()),
        Part::Torque => scene.torque(Load::Constant(torque)),
        Part::CrankLoss => scene.torque(Load::Viscous(damping)),
        Part::SliderLoss => scene.force(Load::Viscous(damping / (r * r))),
        Part::Motor => scene.torque(Load::Motor {
            stall: torque.abs().copysign(speed),
            no_load_speed: 1.3 * speed,
        }),
        Part::Spring => scene.force(Load::Spring {
            stiffness: force.abs() / r,
            rest: 2.0 * r,
        }),
        Part::OfAngle => scene.force(expression(format!("{force} * sin(2*theta + 0.3)"))),
        Part::OfSpeed => {
            let drag = damping / speed.abs();
            scene.torque(expression(format!("-{drag} * omega * abs(omega)")))
        }
        Part::OfTime => {
            let rate = 0.7 * speed.abs();
            scene.force(expression(format!("{force} * sin({rate}*t)")))
        }
    }
}

/// A mechanism with loads, one to six turns of it at its first speed, and two tolerances.
fn case() -> impl Strategy<Value = (Scene, [f64; 2])> {
    let lengths = (0.02..0.2f64, -3.0..1.0f64, -0.9..0.9f64, any::<bool>());
    let masses = (0.1..2.0f64, 0.0..2.0f64, 0.0..2.0f64, -0.1..0.1f64);
    let motion = (0.0..TAU, 0.5..2.3f64, any::<bool>(), 0.3..4.0f64);
    let load = || prop::sample::select(&PARTS[..]);
    let loads = (
        0..4usize,
        [load(), load(), load()],
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0],
    );
    let tolerances = [-12.0..-5.0f64, -12.0..-5.0];
    (lengths, masses, motion, loads, tolerances).prop_map(
        |(lengths, masses, motion, (count, parts, sizes), tolerances)| {
            let (r, room, offset, left) = lengths;
            let e = offset * r;
            let l = r + e.abs() + 10f64.powf(room) * 2.0 * r;
            let (crank, rod, slider, aside) = masses;
            let (angle, speed, clockwise, turns) = motion;
            let speed = 10f64.powf(speed) * if clockwise { -1.0 } else { 1.0 };
            let energy = 0.5 * (crank + 0.6 * rod + 0.5 * slider) * (r * speed).powi(2);
            let mut scene = Scene::new(r, l)
                .offset(e)
                .branch(if left { Branch::Left } else { Branch::Right })
                .crank(Crank {
                    inertia: crank * r * r,
                    ..Crank::default()
                })
                .rod(Rod {
                    mass: rod,
                    cg: 0.4 * l,
                    cg_lateral: aside * l,
                    inertia: 0.1 * rod * l * l,
                    inertia_about: InertiaAbout::Cg,
                    ..Rod::default()
                })
                .slider(Slider { mass: slider })
                .start(angle, speed)
                .duration(turns * TAU / speed.abs());
            for (part, size) in parts.into_iter().zip(sizes).take(count) {
                scene = with_part(scene, part, size, r, speed, energy);
            }
            (scene, tolerances.map(|exponent: f64| 10f64.powf(exponent)))
        },
    )
}

fn cases(seed: u64, count: usize) -> Vec<(Scene, [f64; 2])> {
    let mut runner = TestRunner::new(ProptestConfig {
        rng_seed: RngSeed::Fixed(seed),
        ..ProptestConfig::default()
    });
    let case = case();
    (0..count)
        .map(|_| case.new_tree(&mut runner).unwrap().current())
        .collect()
}

/// An error of angle or speed, as it is and as it was stated.
#[derive(Clone, Copy, Debug)]
struct Judged {
    scene: usize,
    tolerance: f64,
    /// Bounds of the true error.
    error: [f64; 2],
    stated: f64,
    /// What rounding the scene's own numbers does to the result.
    floor: f64,
}

const RELATIVE: f64 = 1e-8;

fn last(scene: &Scene, tolerance: f64, method: Method) -> Option<[f64; 2]> {
    let options = Options {
        method,
        estimate: false,
        ..Options::default()
    };
    let run = simulate(&scene.clone().tolerance(tolerance), &options).ok()?;
    let last = run.summary.last;
    run.summary
        .stopped
        .is_none()
        .then_some([last.theta_rad, last.omega_rad_per_s])
}

/// Changes of angle and speed at the end if lengths, start and duration change by one unit in the last place
/// each.
fn floors(scene: &Scene) -> [f64; 2] {
    let base = last(scene, 1e-13, Method::Auto).unwrap();
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut scene = scene.clone();
        change(&mut scene);
        let there = last(&scene, 1e-13, Method::Auto).unwrap();
        [0, 1].map(|k| (there[k] - base[k]).abs() * f64::EPSILON / RELATIVE)
    };
    let changes = [
        changed(&|scene| scene.geometry.crank *= 1.0 + RELATIVE),
        changed(&|scene| scene.geometry.rod *= 1.0 + RELATIVE),
        changed(&|scene| scene.motion.speed *= 1.0 + RELATIVE),
        changed(&|scene| scene.motion.angle += TAU * RELATIVE),
        changed(&|scene| match &mut scene.run.extent {
            Some(Extent::Duration(duration)) => *duration *= 1.0 + RELATIVE,
            _ => unreachable!(),
        }),
    ];
    [0, 1]
        .map(|k| changes.iter().map(|change| change[k]).sum::<f64>() + f64::EPSILON * base[k].abs())
}

fn measure(cases: &[(Scene, [f64; 2])]) -> Vec<(usize, PrecisionRow, [f64; 2], [f64; 2])> {
    let one = |(index, (scene, tolerances)): (usize, &(Scene, [f64; 2]))| {
        let options = PrecisionOptions {
            tolerances: tolerances.to_vec(),
            repeats: 1,
            most_s: 0.0,
            ..PrecisionOptions::default()
        };
        let result = precision(scene, &options).unwrap();
        let floors = floors(scene);
        let refs = [
            result.reference_error_theta_rad.unwrap(),
            result.reference_error_omega_rad_per_s.unwrap(),
        ];
        result
            .rows
            .into_iter()
            .map(move |row| (index, row, floors, refs))
            .collect::<Vec<_>>()
    };
    let threads = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|k| {
                scope.spawn(move || {
                    let mine = cases.iter().enumerate().skip(k).step_by(threads);
                    mine.flat_map(one).collect::<Vec<_>>()
                })
            })
            .collect();
        workers
            .into_iter()
            .flat_map(|worker| worker.join().unwrap())
            .collect()
    })
}

#[test]
fn measure_them() {
    let seed = std::env::var("SEED").map_or(5, |s| s.parse().unwrap());
    let cases = cases(seed, SCENES);
    let begun = std::time::Instant::now();
    for (i, row, floors, refs) in measure(&cases) {
        if row.failure.is_some() {
            println!("FAIL {i} {} {:?}", row.method, row.failure);
            continue;
        }
        println!(
            "ROW {i} {} {:e} {:e} {:e} {:e} {:e} {} {:e} {:e} {:e} {:e}",
            row.method,
            row.tolerance,
            row.error_theta_rad.unwrap_or(-1.0),
            row.estimate_theta_rad.unwrap_or(-1.0),
            row.error_omega_rad_per_s.unwrap_or(-1.0),
            row.estimate_omega_rad_per_s.unwrap_or(-1.0),
            row.error_is_bound,
            floors[0],
            floors[1],
            refs[0],
            refs[1]
        );
    }
    println!("TIME {:?}", begun.elapsed());
}
