//! Largest joint forces: compared with formulas and with dense rows, for every engine and with impacts.

use crate::support::machines;
use slider_crank::plan::Method;
use slider_crank::scene::{
    Clearance, Crank, Every, Friction, Joint, Load, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, Peaks, Row, Summary, simulate, simulate_rows};

fn run(scene: &Scene, method: Method) -> (Summary, Vec<Row>) {
    let mut rows = Vec::new();
    let options = Options {
        reactions: true,
        method,
        ..Options::default()
    };
    let run = simulate_rows(scene, &options, &mut rows).expect("a run");
    (run.summary, rows)
}

fn values(peaks: &Peaks) -> [f64; 5] {
    peaks.named().map(|(_, peak)| peak.value_n)
}

/// Returns the sizes of the forces in a row, in the order of the peaks.
fn sizes(row: &Row) -> [f64; 5] {
    let f = row.reactions.expect("asked for");
    let size = |[x, y]: [f64; 2]| x.hypot(y);
    [
        size(f.crank_bearing),
        size(f.crank_pin),
        size(f.wrist_pin),
        f.guide.abs(),
        size(f.shaking),
    ]
}

/// Engine whose crank has weight as well.
fn engine() -> Scene {
    machines::engine(0.01).crank(Crank {
        mass: 1.2,
        cg: 0.01,
        inertia: 4e-3,
        ..Crank::default()
    })
}

/// Slider alone at constant crank speed: m r ω² (1 + r/l) at the outer dead centre.
#[test]
fn the_largest_inertia_force_of_a_slider_is_that_of_the_formula() {
    let (r, l, mass, speed) = (0.05, 0.16, 0.3, 80.0);
    for start in [-0.6, 0.3, 2.0] {
        let scene = Scene::new(r, l)
            .slider(Slider { mass })
            .constant_speed(start, speed)
            .revolutions(1.0);
        let peaks = run(&scene, Method::Auto).0.peaks.expect("asked for");
        let wanted = mass * r * speed * speed * (1.0 + r / l);
        for peak in [
            peaks.wrist_pin,
            peaks.crank_pin,
            peaks.crank_bearing,
            peaks.shaking,
        ] {
            assert!(
                (peak.value_n / wanted - 1.0).abs() < 1e-10,
                "{peak:?} {wanted}"
            );
            let theta = start + speed * peak.t_s;
            assert!(theta.sin().abs() < 1e-4 && theta.cos() > 0.0, "{theta}");
            assert!(peak.added_n < 1e-7 * wanted);
        }
    }
}

/// Checks that no row is above the peak, and that the highest row comes close to it.
#[track_caller]
fn is_the_top_of_rows(name: &str, scene: &Scene, method: Method, close: f64) {
    let step = Every::Time(2.5e-5);
    let (summary, rows) = run(&scene.clone().output_every(step), method);
    assert_eq!(summary.stopped, None, "{name}");
    let peaks = values(
        &summary
            .peaks
            .unwrap_or_else(|| panic!("{name}: {:?}", summary.warnings)),
    );
    let mut highest = [0.0f64; 5];
    for row in &rows {
        for (best, size) in highest.iter_mut().zip(sizes(row)) {
            *best = best.max(size);
        }
    }
    for (peak, highest) in peaks.iter().zip(highest) {
        let above = highest / peak - 1.0;
        assert!((-close..1e-8).contains(&above), "{name}: {peak} {highest}");
    }
}

#[test]
fn no_row_is_above_the_peaks() {
    let motor = |now: &slider_crank::scene::Instant| 4.0 - 0.05 * now.omega;
    let free = engine().start(0.3, 40.0).duration(0.3);
    let turning = Load::function(Variables::OMEGA, motor);
    let beating = Load::function(Variables::T, |now| 3.0 * (70.0 * now.t).sin());
    let rough = Friction {
        coefficient: 0.15,
        static_coefficient: 0.2,
    };
    let rubbing = Scene {
        friction: Some(rough),
        ..free.clone()
    };
    let mut rocking = engine().start(4.5, 6.0).duration(0.3);
    rocking.geometry.offset = 0.14;
    for (name, scene, method) in [
        (
            "closed form",
            engine().constant_speed(0.3, -90.0).duration(0.2),
            Method::Auto,
        ),
        ("energy", free.clone(), Method::Auto),
        ("angle", free.clone().torque(turning.clone()), Method::Angle),
        ("time", free.clone().torque(beating.clone()), Method::Time),
        (
            "angle, loads of time",
            free.clone().torque(beating.clone()).force(beating.clone()),
            Method::Angle,
        ),
        ("dop853", free.clone().torque(beating), Method::Dop853),
        ("rocker", rocking, Method::Auto),
    ] {
        is_the_top_of_rows(name, &scene, method, 1e-5);
    }
    // The friction force jumps where the slider reverses: rows approach the peak to within their spacing.
    is_the_top_of_rows("friction", &rubbing, Method::Auto, 1e-3);
    let stopping = rubbing.torque(Load::Viscous(0.02)).duration(2.0);
    is_the_top_of_rows("coming to rest", &stopping, Method::Auto, 1e-3);
}

#[test]
fn a_rod_that_is_hardly_long_enough_has_narrow_peaks() {
    for excess in [1e-4, 1e-6] {
        let mut scene = engine().constant_speed(0.3, 20.0).revolutions(1.0);
        scene.geometry.rod = 0.06 * (1.0 + excess);
        let (summary, _) = run(&scene, Method::Auto);
        let Some(peaks) = summary.peaks else {
            assert!(
                summary
                    .warnings
                    .iter()
                    .any(|w| w.to_string().contains("largest joint forces"))
            );
            continue;
        };
        // Near sin(theta) = 1, where the rod is nearly normal to the guide, the rows are spaced by the width of the
        // peak.
        let reactions = |theta: f64| {
            let at = Scene { ..scene.clone() }
                .constant_speed(theta, 20.0)
                .duration(0.0);
            sizes(&run(&at, Method::Auto).1[0])
        };
        let width = (excess * 0.06_f64 / 0.05).sqrt();
        let mut highest = [0.0f64; 5];
        for i in -400..=400 {
            let theta = std::f64::consts::FRAC_PI_2 + 0.01 * f64::from(i) * width;
            for (best, size) in highest.iter_mut().zip(reactions(theta)) {
                *best = best.max(size);
            }
        }
        for (peak, highest) in values(&peaks).iter().zip(highest) {
            assert!(
                highest <= peak * (1.0 + 1e-9) && highest > 0.999 * peak,
                "{peak} {highest}"
            );
        }
    }
}

#[test]
fn peaks_of_impacts_are_found_between_rows() {
    for joint in [Joint::CrankPin, Joint::WristPin] {
        let clearance = Clearance {
            bearing_radius: Some(0.01),
            young_modulus: Some(207e9),
            poisson_ratio: Some(0.3),
            restitution: Some(0.8),
            ..Clearance::new(joint, 2e-4)
        };
        let scene = Scene {
            clearance: Some(clearance),
            ..engine().start(0.3, 50.0).duration(0.01)
        };
        let few = run(&scene, Method::Auto).0.peaks.expect("asked for");
        let close = scene.output_every(Every::Time(1e-7));
        let (summary, rows) = run(&close, Method::Auto);
        assert_eq!(Some(few), summary.peaks, "rows do not matter");
        let mut highest = [0.0f64; 5];
        for row in &rows {
            for (best, size) in highest.iter_mut().zip(sizes(row)) {
                *best = best.max(size);
            }
        }
        for (peak, highest) in values(&few).iter().zip(highest) {
            assert!(
                highest <= peak * (1.0 + 1e-9) && highest > 0.9999 * peak,
                "{peak} {highest}"
            );
        }
    }
}

#[test]
fn peaks_are_given_for_what_was_asked_and_finished_only() {
    let scene = engine().start(0.3, 40.0).duration(0.1);
    let plain = simulate(&scene, &Options::default())
        .expect("a run")
        .summary;
    assert_eq!(plain.peaks, None);
    let cut = Options {
        reactions: true,
        method: Method::Time,
        max_evaluations: 50,
        ..Options::default()
    };
    let summary = simulate(&scene, &cut).expect("a run").summary;
    assert!(summary.stopped.is_some() && summary.peaks.is_none());
    let none = run(&scene.duration(0.0), Method::Auto)
        .0
        .peaks
        .expect("a state");
    assert!(none.crank_bearing.value_n > 0.0 && none.crank_bearing.t_s == 0.0);
}
