//! Values of a scene file with standard errors: their share in the error of the force.

use std::path::Path;

use slider_crank::inverse::{Inverse, InverseOptions, inverse, inverse_of_uncertain};
use slider_crank::scene::{Draft, Measured, Measurement};

/// Returns a press with standard errors of the rod length and the slider mass.
fn scene(rod: &str, mass: &str) -> Draft {
    let text = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"{rod}\"\noffset = \"8 mm\"\n[slider]\nmass = \"{mass}\"\n\
         [crank]\nmass = \"2 kg\"\ninertia = \"0.02 kg m^2\"\n[[torque]]\nkind = \"constant\"\nvalue = \"0.1 ± 0.02 N m\"\n\
         [[torque]]\nkind = \"expression\"\nvalue = \"0.2 +- 0.1\"\n"
    );
    Draft::new(Path::new("press.toml"), text)
}

/// Samples θ = 0.3 + 10 t + 0.2 sin 6t with errors of 1e-4 rad from an aperiodic sine.
fn motion() -> Measurement {
    let times: Vec<f64> = (0..400).map(|i| 0.004 * f64::from(i)).collect();
    let angle = |(i, t): (usize, &f64)| {
        let noise = (1e4 * (i as f64).powi(2)).sin();
        0.3 + 10.0 * t + 0.2 * (6.0 * t).sin() + 1.4e-4 * noise
    };
    let angles = times.iter().enumerate().map(angle).collect();
    Measurement::new(Measured::Theta, times, angles).expect("a motion")
}

fn forces(found: &Inverse) -> Vec<Option<f64>> {
    found.rows.iter().map(|row| row.slider_force).collect()
}

/// Half the difference of the forces with a value one standard error higher and lower equals the error in the budget,
/// and accounts for the increase of the variance of each row.
#[test]
fn errors_of_the_scene_are_those_of_the_computation_with_other_values() {
    let options = InverseOptions::default();
    let run = |rod: &str, mass: &str| {
        let scene = scene(rod, mass).scene().expect("a scene");
        inverse(&scene, &motion(), &options).expect("an inversion")
    };
    let draft = scene("150 +- 0.6 mm", "1.5 kg +/- 20 g");
    let uncertain = draft.uncertain().expect("uncertain values");
    let keys: Vec<&str> = uncertain.iter().map(|one| one.key.as_str()).collect();
    assert_eq!(keys, ["geometry.rod", "slider.mass", "torque[1].value"]);
    let written = draft.scene().expect("a scene");
    assert_eq!(written.geometry.rod, 0.15);
    let found = inverse_of_uncertain(&written, &uncertain, &motion(), &options);
    let found = found.expect("an inversion");
    let base = run("150 mm", "1.5 kg");
    let mut variances = vec![0.0; found.rows.len()];
    for (key, low, high) in [
        (
            "geometry.rod",
            run("149.4 mm", "1.5 kg"),
            run("150.6 mm", "1.5 kg"),
        ),
        (
            "slider.mass",
            run("150 mm", "1480 g"),
            run("150 mm", "1520 g"),
        ),
    ] {
        let [low, high] = [forces(&low), forces(&high)];
        let (mut sum, mut count) = (0.0, 0.0);
        for (row, pair) in low.iter().zip(&high).enumerate() {
            let ((Some(low), Some(high)), Some(_)) = (pair, found.rows[row].slider_force) else {
                continue;
            };
            let square = (0.5 * (high - low)).powi(2);
            variances[row] += square;
            (sum, count) = (sum + square, count + 1.0);
        }
        let expected = f64::sqrt(sum / count);
        let budget = &found.summary.error_budget;
        let part = budget.iter().find(|part| part.source == key).expect(key);
        assert!(
            (part.force_se_n / expected - 1.0).abs() < 0.02,
            "{key}: {part:?}, {expected}"
        );
    }
    // The error of the torque in the scene enters directly, divided by the lever arm.
    for (row, variance) in found.rows.iter().zip(variances) {
        let alone = base
            .rows
            .iter()
            .find(|other| other.t == row.t)
            .expect("the row");
        if let (Some(whole), Some(noise)) = (row.slider_force_se, alone.slider_force_se) {
            let torque = 0.02 / found.lever_arm(row);
            let expected = (noise * noise + variance + torque * torque).sqrt();
            assert!(
                (whole / expected - 1.0).abs() < 0.03,
                "{}: {whole}, {expected}",
                row.t
            );
        }
    }
}

/// Slider position along [`motion`], by the loop closure, with errors of 10 µm: the sensor is aligned with the dead centres
/// of each scene, so the error of a length is what is left after the alignment.
#[test]
fn errors_of_lengths_are_those_of_an_aligned_sensor() {
    let angles = motion();
    let position = |(i, theta): (usize, &f64)| {
        let height = 0.008 + 0.05 * theta.sin();
        let noise = (1e4 * ((i + 400) as f64).powi(2)).sin();
        0.05 * theta.cos() + (0.15f64.powi(2) - height * height).sqrt() + 1.4e-5 * noise
    };
    let values = angles.values().iter().enumerate().map(position).collect();
    let motion = Measurement::new(Measured::X, angles.times().to_vec(), values);
    let motion = motion.expect("a motion");
    let options = InverseOptions::default();
    let run = |rod: &str| {
        let scene = scene(rod, "1.5 kg").scene().expect("a scene");
        forces(&inverse(&scene, &motion, &options).expect("an inversion"))
    };
    let draft = scene("150 +- 0.5 mm", "1.5 kg");
    let uncertain = draft.uncertain().expect("uncertain values");
    let written = draft.scene().expect("a scene");
    let found = inverse_of_uncertain(&written, &uncertain, &motion, &options);
    let found = found.expect("an inversion");
    let (low, high) = (run("149.5 mm"), run("150.5 mm"));
    let rows = low.iter().zip(&high).zip(&found.rows);
    let halves = rows.filter_map(|((low, high), row)| {
        row.slider_force?;
        Some(0.5 * ((*high)? - (*low)?))
    });
    let (count, sum) = halves.fold((0.0, 0.0), |(n, sum), half| (n + 1.0, sum + half * half));
    let expected = f64::sqrt(sum / count);
    let budget = &found.summary.error_budget;
    let part = budget.iter().find(|part| part.source == "geometry.rod");
    let part = part.expect("the rod").force_se_n;
    // The noise of the turning points is in the runs alone.
    assert!(
        (part / expected - 1.0).abs() < 0.3,
        "{part}, expected {expected}"
    );
}

#[test]
fn errors_that_say_nothing_are_refused() {
    for (rod, words) in [
        ("150 +- -0.1 mm", "negative"),
        ("150 +- 0.1 kg", "not the unit of a length"),
        ("150 +- 0.1", "has no unit"),
        ("150 +- mm", "does not begin with a number"),
    ] {
        let error = scene(rod, "1 kg").scene().expect_err(rod).to_string();
        assert!(error.contains(words), "{rod}: {error}");
    }
}
