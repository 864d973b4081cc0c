//! Motions measured by their speed alone, from a known crank angle.

use std::f64::consts::PI;
use std::path::Path;

use super::noise::Random;
use super::simulated::{crank_and_slider, needed};
use slider_crank::inverse::identify::{FreeKey, identify_keys};
use slider_crank::inverse::{FitKind, InverseOptions, inverse};
use slider_crank::scene::{Beside, Draft, Measured, Measurement, Reading};

/// Returns θ, ω and θ̈ of an uneven rotation.
fn uneven(sense: f64, t: f64) -> [f64; 3] {
    let (sin, cos) = (2.0 * t).sin_cos();
    [
        0.4 + sense * (25.0 * t + 1.5 * sin),
        sense * (25.0 + 3.0 * cos),
        sense * -6.0 * sin,
    ]
}

#[test]
fn the_torque_of_a_measured_speed_lies_within_its_band() {
    for (sense, noise) in [(1.0, 1e-3), (-1.0, 1e-2), (1.0, 0.1)] {
        let mut random = Random(0x5eed_0001);
        let times: Vec<f64> = (0..800).map(|i| 0.004 * f64::from(i)).collect();
        let reading = |t: &f64| uneven(sense, *t)[1] + noise * random.normal();
        let speeds = times.iter().map(reading).collect();
        let motion = Measurement::new(Measured::Omega, times.clone(), speeds).expect("samples");
        let scene = crank_and_slider().start(0.4, sense * 28.0);
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        let factor = found.summary.band_factor;
        let (mut covered, mut squares, mut of_torque) = (0, 0.0, 0.0);
        for row in &found.rows {
            let [theta, omega, alpha] = uneven(sense, row.t);
            assert!((row.theta - theta).abs() < 0.2 * noise, "{row:?}");
            let torque = needed([theta, omega, alpha]);
            let (value, se) = (row.crank_torque.unwrap(), row.crank_torque_se.unwrap());
            covered += usize::from((value - torque).abs() <= factor * se);
            squares += (value - torque).powi(2);
            of_torque += torque * torque;
        }
        let share = covered as f64 / times.len() as f64;
        let error = (squares / of_torque).sqrt();
        assert!(share > 0.85, "{noise}: {share}");
        assert!(error < 0.05, "{noise}: {error}");
        let warnings = &found.summary.warnings;
        let is_said = |warning: &String| warning.contains("does not show where the crank is");
        assert!(warnings.iter().any(is_said), "{warnings:?}");
    }
}

fn read(text: &str, reading: &Reading) -> Measurement {
    Measurement::parse(Path::new("speed.csv"), text.to_owned(), reading).expect("samples")
}

#[test]
fn a_column_of_the_speed_is_found_by_name_or_unit() {
    let plain = Reading::default();
    let rows = "0,60\n1,60\n2,120\n3,120\n4,60\n5,60\n6,60\n";
    let named = read(&format!("t [s],Speed [rpm]\n{rows}"), &plain);
    assert_eq!(named.measured(), Measured::Omega);
    assert!((named.values()[2] - 4.0 * PI).abs() < 1e-14);
    let by_unit = Reading {
        motion: Some("2".to_owned()),
        ..Reading::default()
    };
    let chosen = read(&format!("t [s],tacho [rad/s]\n{rows}"), &by_unit);
    assert_eq!(chosen.measured(), Measured::Omega);
    // The position tells more.
    let both = read(
        "t [s],omega [rad/s],theta [rad]\n0,1,0\n1,1,1\n2,1,2\n3,1,3\n4,1,4\n5,1,5\n6,1,6\n",
        &plain,
    );
    assert_eq!(both.measured(), Measured::Theta);
    assert!(both.beside().is_empty());
}

/// Solution of J ω' = -c ω - d, without the slider's inertia.
#[test]
fn friction_of_a_run_down_by_its_speed_lies_within_its_band() {
    let scene = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[crank]\ninertia = \"0.02 kg m^2\"\n[[torque]]\nkind = \"viscous\"\ncoefficient = \"0.004 N m s\"\n[[torque]]\nkind = \"dry\"\nvalue = \"0.2 N m\"\n";
    let draft = Draft::new(Path::new("flywheel.toml"), scene.to_owned());
    let keys = ["torque[1].coefficient", "torque[2].value"];
    let free = keys.map(|key| key.parse::<FreeKey>().expect("a key"));
    let (inertia, c, d) = (0.02, 0.0055, 0.13);
    let mut inside = [0; 2];
    for seed in 0..40u64 {
        let mut random = Random((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let times: Vec<f64> = (0..400).map(|i| 0.0025 * f64::from(i)).collect();
        let speed = |t: &f64| (40.0 + d / c) * (-t * c / inertia).exp() - d / c;
        let speeds = times.iter().map(|t| speed(t) + 0.01 * random.normal());
        let motion = Measurement::new(Measured::Omega, times.clone(), speeds.collect());
        let found = identify_keys(
            &draft,
            &|scene| scene,
            &free,
            &motion.expect("samples"),
            None,
        );
        for (k, value) in found.expect("told").values.iter().enumerate() {
            let off = (value.value - [c, d][k]).abs();
            inside[k] += usize::from(off < value.half_band);
            assert!(value.half_band < 0.1 * [c, d][k], "{value:?}");
        }
    }
    // 38 of 40 are expected; fewer than 34 have a probability of one in a hundred.
    assert!(inside.iter().all(|count| *count >= 34), "{inside:?}");
}

#[test]
fn what_a_speed_does_not_tell_is_refused() {
    let times: Vec<f64> = (0..50).map(|i| 0.01 * f64::from(i)).collect();
    let speeds = times.iter().map(|t| 10.0 + t).collect();
    let motion = Measurement::new(Measured::Omega, times, speeds).expect("samples");
    let options = InverseOptions {
        fit: FitKind::Polynomial,
        ..InverseOptions::default()
    };
    let refused = inverse(&crank_and_slider(), &motion, &options).expect_err("refused");
    assert!(refused.to_string().contains("a speed"), "{refused}");
    let draft = Draft::new(
        Path::new("s.toml"),
        "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[crank]\ninertia = \"0.02 kg m^2\"\n"
            .to_owned(),
    );
    let zero = ["sensor.zero".parse::<FreeKey>().expect("a key")];
    let refused = identify_keys(&draft, &|scene| scene, &zero, &motion, None);
    assert!(
        refused
            .expect_err("refused")
            .to_string()
            .contains("a speed")
    );
    let angles = vec![0.1; motion.len()];
    let both = motion.with(Beside::Sensor(Measured::Theta), angles);
    let refused = both.expect_err("refused").to_string();
    assert!(refused.contains("a sensor of the speed"), "{refused}");
}
