//! Invariants of motion: a mechanism and its images must move alike.

use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::scene::{Branch, Scene};
use slider_crank::simulate::{Options, Row, Simulation, Summary, simulate, simulate_rows};

use super::image::{Image, Setting};
use super::random::magnitude;

/// The branch on this side.
pub fn branch(left: bool) -> Branch {
    if left { Branch::Left } else { Branch::Right }
}

/// Bodies as [`Setting::new`] takes them.
pub type Bodies = [f64; 7];

/// Strategy for arbitrary bodies.
pub fn bodies() -> impl Strategy<Value = Bodies> {
    [
        0.1..3.0f64,
        0.05..2.0f64,
        -0.2..1.2f64,
        -0.3..0.3f64,
        0.05..0.3f64,
        0.05..2.0f64,
        -4.0..4.0f64,
    ]
}

/// Strategy for changes of units.
pub fn scaling() -> impl Strategy<Value = Image> {
    (
        magnitude(1e-3, 1e3),
        magnitude(1e-3, 1e3),
        magnitude(1e-2, 1e2),
    )
        .prop_map(|(length, mass, time)| Image {
            length,
            mass,
            time,
            ..Image::SAME
        })
}

/// Runs a scene; a case that jams in its guide is rejected.
fn run(scene: &Scene, method: Method, tolerance: f64) -> Result<Simulation, TestCaseError> {
    let options = Options {
        method,
        ..Options::default()
    };
    let run = simulate(&scene.clone().tolerance(tolerance), &options).expect("a run");
    match &run.summary.stopped {
        None => Ok(run),
        Some(why) if why.to_string().contains("jams") => Err(TestCaseError::reject("jams")),
        Some(why) => panic!("{why}"),
    }
}

/// Whether the motion passes a limit, that is changes its branch.
fn passes_limits(run: &Simulation) -> bool {
    run.summary.events.iter().any(|event| event.kind == "limit")
}

/// Method and judgement of the motions of one kind of scenes.
#[derive(Clone, Copy)]
pub struct Kind {
    pub method: Method,
    /// Whether only motions that pass a limit count.
    pub limits: bool,
    /// Allowed error beyond the stated ones, in tolerances.
    pub slack: f64,
}

/// Largest accepted ratio of true to stated error.
const STATED: f64 = 2.0;

/// Checks that both runs keep the energy balance and that their ends differ by no more than the stated errors.
pub fn tolerances_agree(setting: &Setting, kind: Kind, finer: Method) -> Result<(), TestCaseError> {
    let scene = setting.scene(&Image::SAME);
    let run_of = |method, tolerance| run(&scene, method, tolerance);
    let (run, finer) = (run_of(kind.method, 1e-9)?, run_of(finer, 1e-12)?);
    prop_assume!(!kind.limits || passes_limits(&run));
    for (run, allowed) in [(&run, 1e-7), (&finer, 1e-10)] {
        prop_assert!(
            run.summary.energy_residual.abs() < allowed,
            "{:e}",
            run.summary.energy_residual
        );
    }
    ends_agree(&run, &finer, &Image::SAME, kind.slack * 1e-9)
}

/// Checks that the end of one run, mapped into the image, equals the end of the other to the stated errors.
fn ends_agree(
    here: &Simulation,
    there: &Simulation,
    image: &Image,
    slack: f64,
) -> Result<(), TestCaseError> {
    let (a, b) = (&here.summary, &there.summary);
    let (ea, eb) = (a.error_estimate.unwrap(), b.error_estimate.unwrap());
    let (theta, omega) = image.state(a.last.theta_rad, a.last.omega_rad_per_s);
    let (apart, allowed) = (
        (b.last.theta_rad - theta).abs(),
        ea.theta_rad + eb.theta_rad,
    );
    let least = (1e-14 + slack) * (1.0 + theta.abs());
    prop_assert!(
        apart <= STATED * allowed + least,
        "theta {theta}: {apart:e}, stated {ea:?} {eb:?}, {} {}",
        a.engine,
        b.engine
    );
    let (apart, allowed) = (
        (b.last.omega_rad_per_s - omega).abs(),
        ea.omega_rad_per_s / image.time + eb.omega_rad_per_s,
    );
    let least = (1e-14 + slack) * a.omega_max.abs().max(a.omega_min.abs()) / image.time;
    prop_assert!(
        apart <= STATED * allowed + least,
        "omega {omega}: {apart:e}, stated {ea:?} {eb:?}, {} {}",
        a.engine,
        b.engine
    );
    Ok(())
}

/// Checks that the image of the mechanism performs the image of its motion, with the same events.
pub fn image_moves_alike(
    setting: &Setting,
    image: &Image,
    kind: Kind,
) -> Result<(), TestCaseError> {
    let here = run(&setting.scene(&Image::SAME), kind.method, 1e-10)?;
    prop_assume!(!kind.limits || passes_limits(&here));
    let there = run(&setting.scene(image), kind.method, 1e-10)?;
    ends_agree(&here, &there, image, kind.slack * 1e-10)?;
    // An event at the very end may be found by only one of the runs.
    let before = |run: &Simulation, time: f64| -> Vec<(&str, f64)> {
        let events = run
            .summary
            .events
            .iter()
            .map(|event| (event.kind, event.t_s / time));
        events
            .filter(|(_, t)| *t < (1.0 - 1e-6) * setting.duration)
            .collect()
    };
    let (a, b) = (before(&here, 1.0), before(&there, image.time));
    prop_assert_eq!(a.len(), b.len(), "{:?} {:?}", &a, &b);
    for (a, b) in a.iter().zip(&b) {
        prop_assert_eq!(a.0, b.0);
        prop_assert!((a.1 - b.1).abs() < 1e-7 * setting.duration, "{a:?} {b:?}");
    }
    Ok(())
}

/// Checks that the motion, run back from its end, returns to its start, to the stated errors propagated to the start.
pub fn runs_back(setting: &Setting, kind: Kind) -> Result<(), TestCaseError> {
    let scene = setting.scene(&Image::SAME).tolerance(1e-10);
    let there = run(&scene, kind.method, 1e-10)?;
    prop_assume!(!kind.limits || passes_limits(&there));
    let mut rows: Vec<Row> = Vec::new();
    simulate_rows(
        &scene,
        &Options {
            method: kind.method,
            ..Options::default()
        },
        &mut rows,
    )
    .unwrap();
    let (end, stated) = (rows.last().unwrap(), there.summary.error_estimate.unwrap());
    let leaning = (end.x - setting.lengths[0] * end.theta.cos()) / setting.lengths[1];
    // Next to the limit the crank angle does not determine the position on the curve.
    prop_assume!(leaning.abs() > 0.2);
    let mut back = setting.scene(&Image {
        backwards: Some(setting.duration),
        ..Image::SAME
    });
    back.geometry.branch = branch(leaning < 0.0);
    let from = |theta: f64, omega: f64| {
        let run = run(&back.clone().start(theta, -omega), kind.method, 1e-10)?;
        Ok::<Summary, TestCaseError>(run.summary)
    };
    let (theta, omega) = (end.theta, end.omega);
    let (found, h) = (from(theta, omega)?, 1e-6);
    let (moved, faster) = (from(theta + h, omega)?, from(theta, omega + h)?);
    let own = found.error_estimate.unwrap();
    for (what, value, want, error) in [
        (
            "theta",
            (|s| s.last.theta_rad) as fn(&Summary) -> f64,
            setting.start.0,
            own.theta_rad,
        ),
        (
            "omega",
            |s| s.last.omega_rad_per_s,
            -setting.start.1,
            own.omega_rad_per_s,
        ),
    ] {
        let slope = |other| (value(other) - value(&found)).abs() / h;
        let allowed =
            error + slope(&moved) * stated.theta_rad + slope(&faster) * stated.omega_rad_per_s;
        let apart = (value(&found) - want).abs();
        prop_assert!(
            apart <= STATED * allowed + (1e-13 + kind.slack * 1e-10) * (1.0 + want.abs()),
            "{what}: {apart:e}, stated {allowed:e}"
        );
        prop_assert!(
            allowed < 1e-4 * setting.start.1.abs().max(1.0),
            "{what}: {allowed:e} can tell nothing"
        );
    }
    Ok(())
}
