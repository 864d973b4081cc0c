//! Measured motions of `data/hard/`: compared with the polynomial that they sample, or refused with line and column.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use slider_crank::inverse::{FitKind, Inverse, InverseOptions, inverse};
use slider_crank::scene::{Expression, Load, Measurement, Reading, Scene};

fn hard(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
        .join("data/hard")
        .join(name)
}

const COEFFICIENTS: [f64; 11] = [2.0, 3.0, -1.0, 0.5, 0.6, -0.8, 0.4, 0.7, -0.5, -0.3, 0.4];

/// Returns the polynomial of `12-polynomial.csv`: angle, speed and acceleration at a time of the Unix clock.
fn motion(t: f64) -> [f64; 3] {
    let u = (t - 1_700_000_002.0) / 2.0;
    let mut sum = [0.0; 3];
    for c in COEFFICIENTS.iter().rev() {
        sum = [
            sum[0] * u + c,
            sum[1] * u + sum[0],
            sum[2] * u + 2.0 * sum[1],
        ];
    }
    [sum[0], sum[1] / 2.0, sum[2] / 4.0]
}

/// Returns the slider force of the scene in closed form: (J α)/x' + m (x' α + x'' ω²), x = r cos θ + √(l² − (e + r sin
/// θ)²).
fn force([theta, omega, alpha]: [f64; 3]) -> f64 {
    let (r, l, e, inertia, mass): (f64, f64, f64, f64, f64) = (0.05, 0.15, 0.01, 0.002, 0.4);
    let (sin, cos) = theta.sin_cos();
    let height = e + r * sin;
    let root = (l * l - height * height).sqrt();
    let dx = -r * sin - height * r * cos / root;
    let d2x = -r * cos
        + (height * r * sin - (r * cos).powi(2) - (height * r * cos / root).powi(2)) / root;
    inertia * alpha / dx + mass * (dx * alpha + d2x * omega * omega)
}

fn inverted(measurement: &Measurement, fit: FitKind) -> Inverse {
    let scene = Scene::load(hard("12-polynomial.toml")).expect("a scene");
    let options = InverseOptions {
        fit,
        ..InverseOptions::default()
    };
    inverse(&scene, measurement, &options).expect("an inversion")
}

/// Returns the errors of the slider force of all rows that have one, in standard errors.
fn errors(found: &Inverse) -> Vec<f64> {
    let rows = found.rows.iter();
    rows.filter_map(|row| Some((row.slider_force? - force(motion(row.t))) / row.slider_force_se?))
        .collect()
}

#[test]
fn a_polynomial_on_ill_scaled_time_gives_its_force() {
    let motion = Measurement::load(hard("12-polynomial.csv"), &Reading::default());
    let motion = motion.expect("samples");
    for fit in [FitKind::Polynomial, FitKind::Auto] {
        let found = inverted(&motion, fit);
        assert!(fit == FitKind::Auto || found.summary.fit.degree >= 10);
        assert!((found.summary.fit.sigma / 1e-4 - 1.0).abs() < 0.15);
        let notes = &found.summary.warnings;
        assert!(notes.iter().any(|note| note.contains("1 gap")), "{notes:?}");
        let errors = errors(&found);
        assert!(errors.len() > 210);
        let squares: f64 = errors.iter().map(|e| e * e).sum();
        let usual = (squares / errors.len() as f64).sqrt();
        assert!((0.2..1.8).contains(&usual), "{fit}: {usual}");
        assert!(errors.iter().all(|e| e.abs() < 4.5), "{fit}: {errors:?}");
    }
}

#[test]
fn without_noise_the_rounding_of_time_is_all_that_is_lost() {
    let times: Vec<f64> = (0..=256)
        .map(|i| 1_700_000_000.0 + f64::from(i) / 64.0)
        .collect();
    let angles = times.iter().map(|t| motion(*t)[0]).collect();
    let samples = Measurement::new(slider_crank::scene::Measured::Theta, times, angles);
    let found = inverted(&samples.expect("samples"), FitKind::Auto);
    for row in &found.rows {
        let [theta, omega, alpha] = motion(row.t);
        assert!((row.theta - theta).abs() < 1e-14);
        // The largest speed is 4.1 rad/s and the largest acceleration 26 rad/s².
        assert!((row.omega - omega).abs() < 1e-12, "{} {omega}", row.omega);
        assert!((row.alpha - alpha).abs() < 1e-10, "{} {alpha}", row.alpha);
    }
    assert!(errors(&found).iter().all(|e| e.abs() < 4.0));
}

fn refused(name: &str) -> Output {
    let out = tempfile::tempdir().expect("a folder");
    let rows = out.path().join("rows.csv");
    let output = Command::new(env!("CARGO_BIN_EXE_slider-crank"))
        .arg("inverse")
        .args([hard("12-polynomial.toml"), hard(name)])
        .args(["--out".as_ref(), rows.as_os_str()])
        .output()
        .expect("the program runs");
    let left = std::fs::read_dir(out.path()).expect("a folder").count();
    assert_eq!((left, output.status.code()), (0, Some(2)), "{name}");
    output
}

#[test]
fn data_that_are_no_motion_are_refused_with_their_place() {
    for (name, place, what) in [
        (
            "12-repeated.csv",
            "12-repeated.csv:10:1",
            "the time 1700000001 is repeated",
        ),
        (
            "14-one-sample.csv",
            "14-one-sample.csv:2:9",
            "1 sample where at least 6 are needed",
        ),
        (
            "14-nan.csv",
            "14-nan.csv:7:4",
            "`NaN` is not a finite number",
        ),
        (
            "14-wrong-column.csv",
            "14-wrong-column.csv:1:1",
            "no column is called theta, gamma, x or omega",
        ),
    ] {
        let output = refused(name);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(
            message.contains(place) && message.contains(what),
            "{message}"
        );
        assert!(output.stdout.is_empty());
    }
}

/// A known torque is no function of times that are equal in double precision.
#[test]
fn known_loads_need_times_that_doubles_tell_apart() {
    let rows = (0..40).map(|i| format!("1700000000.0000000{i:02},0.{i:02},2\n"));
    let text = format!(
        "t [s],theta [rad],motor [N m]\n{}",
        rows.collect::<String>()
    );
    let reading = Reading {
        known: vec!["motor".to_owned()],
        ..Reading::default()
    };
    let motion = Measurement::parse(Path::new("data.csv"), text, &reading).expect("samples");
    let scene = Scene::load(hard("12-polynomial.toml")).expect("a scene");
    let found = inverse(&scene, &motion, &InverseOptions::default());
    let wrong = found.expect_err("equal times").to_string();
    for part in ["data.csv:3:1", "let the time begin near 0"] {
        assert!(wrong.contains(part), "{wrong}");
    }
}

/// Times rounded to decimals are taken as even, which puts the last sample beyond its written time by up to half a digit:
/// a torque known at the written times is known there, too.
#[test]
fn known_loads_of_rounded_times_reach_the_last_sample() {
    let time = |i: usize| i as f64 / 799.0;
    let angle = |t: f64| 0.3 + 50.0 * t + 0.02 * (9.0 * t).sin() + 1e-4 * (1e6 * t).sin();
    let row = |i: usize| {
        format!(
            "{:.9},{:.9},{:.6}\n",
            time(i),
            angle(time(i)),
            2.0 + time(i)
        )
    };
    let rows: String = (0..800).map(row).collect();
    let reading = Reading {
        known: vec!["motor".to_owned()],
        ..Reading::default()
    };
    let text = format!("t [s],theta [rad],motor [N m]\n{rows}");
    let motion = Measurement::parse(Path::new("data.csv"), text, &reading).expect("samples");
    let elapsed = motion.elapsed();
    assert_ne!(elapsed[1], motion.times()[1], "even times");
    assert!(elapsed[799] <= motion.times()[799]);
    let scene = Scene::load(hard("12-polynomial.toml")).expect("a scene");
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("a force");
    for candidate in &found.summary.fit.candidates {
        assert!(candidate.log_likelihood.is_finite(), "{candidate:?}");
    }
}

/// A load without a value inside the record leaves the smoother without the equation, and that is said.
#[test]
fn a_smoother_without_the_equation_says_so() {
    let row = |i: usize| {
        let t = 0.01 * i as f64;
        format!("{t},{}\n", 0.3 + 20.0 * t + 1e-3 * (1e5 * t).sin())
    };
    let rows: String = (0..300).map(row).collect();
    let text = format!("t [s],theta [rad]\n{rows}");
    let motion =
        Measurement::parse(Path::new("data.csv"), text, &Reading::default()).expect("samples");
    let undefined =
        Expression::parse("0.1/(t-1.005)^2 + sqrt(abs(t-1.005)-0.004)").expect("a formula");
    let scene = Scene::load(hard("12-polynomial.toml"))
        .expect("a scene")
        .torque(Load::Expression(undefined));
    let found = inverse(&scene, &motion, &InverseOptions::default());
    let said = match found {
        Ok(found) => found.summary.warnings.join(" "),
        Err(refused) => refused.to_string(),
    };
    assert!(said.contains("no finite value along the motion"), "{said}");
}
