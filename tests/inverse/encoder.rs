//! Encoder codes of a crank at constant speed, whose force has a closed form.

use std::f64::consts::TAU;
use std::path::Path;

use rayon::prelude::*;
use slider_crank::inverse::{Carrier, InverseOptions, inverse};
use slider_crank::scene::{Crank, Measured, Measurement, Reading, Scene, Slider};

use super::noise::Random;
use super::white_snap::white_snap;

const R: f64 = 0.05;
const L: f64 = 0.15;
const SPEED: f64 = 10.0;
const MASS: f64 = 2.0;

/// Returns the force on the slider: its mass times x'' ω², with x = r cos θ + √(l² − r² sin² θ).
fn force(theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let rod = (L * L - R * R * sin * sin).sqrt();
    let half = R * R * sin * cos;
    let bent = (R * R * (cos * cos - sin * sin)) / rod + half * half / rod.powi(3);
    MASS * SPEED * SPEED * (-R * cos - bent)
}

/// With many samples in each step, the samples give the times of the code transitions. A speed of 10 (1 + 0.2 cos 4t)
/// rad/s has the force m (x'' ω² + x' θ̈) in closed form.
#[test]
fn samples_that_stand_in_one_step_tell_its_passages() {
    const DEPTH: f64 = 0.2;
    for (steps, rows) in [(64.0, 3000), (256.0, 20_000), (1024.0, 120_000)] {
        let step = TAU / steps;
        let times: Vec<f64> = (0..rows).map(|i| f64::from(i) / f64::from(rows)).collect();
        let angle = |t: f64| 0.3 + SPEED * (t + DEPTH * (4.0 * t).sin() / 4.0);
        let codes = times
            .iter()
            .map(|t| ((angle(*t) / step).floor() + 0.5) * step);
        let motion = Measurement::new(Measured::Theta, times.clone(), codes.collect());
        let scene = Scene::new(R, L).slider(Slider { mass: MASS });
        let motion = motion.expect("a motion");
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        let factor = found.summary.band_factor;
        let (mut inside, mut all, mut width, mut size) = (0.0, 0.0, 0.0, 0.0);
        for (row, t) in found.rows.iter().zip(times) {
            let (Some(found), Some(se)) = (row.slider_force, row.slider_force_se) else {
                continue;
            };
            let theta = angle(t);
            let omega = SPEED * (1.0 + DEPTH * (4.0 * t).cos());
            let alpha = -4.0 * SPEED * DEPTH * (4.0 * t).sin();
            let (sin, cos) = theta.sin_cos();
            let rod = (L * L - R * R * sin * sin).sqrt();
            let slope = -R * sin - R * R * sin * cos / rod;
            let exact = force(theta) * (omega / SPEED).powi(2) + MASS * slope * alpha;
            all += 1.0;
            inside += f64::from(u8::from((found - exact).abs() <= factor * se));
            width += se * se;
            size += exact * exact;
        }
        assert!(inside >= 0.9 * all, "{steps} steps: {inside} of {all}");
        let part = (width / size).sqrt();
        assert!(
            part < 16.0 / steps,
            "{steps} steps: errors of {part} of the force"
        );
    }
}

/// Codes truncated like those of a counter, not centred, with an index mark that is off by part of a step: the error of
/// the zero is in the band and in the budget.
#[test]
fn the_zero_of_an_encoder_is_in_the_band() {
    let offs = [256.0, 1024.0].map(|steps| [-0.9, 0.0, 0.9].map(|off| (steps, off)));
    offs.concat().into_par_iter().for_each(|(steps, off)| {
        let step = TAU / steps;
        let times: Vec<f64> = (0..1500).map(|i| 0.0013 * f64::from(i)).collect();
        let angles: Vec<f64> = times.iter().map(|t| 0.3 + SPEED * t).collect();
        let codes = angles
            .iter()
            .map(|a| ((a / step).floor() + 0.5 + off) * step);
        let motion = Measurement::new(Measured::Theta, times, codes.collect()).expect("a motion");
        let scene = Scene::new(R, L).slider(Slider { mass: MASS });
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        let factor = found.summary.band_factor;
        let (mut inside, mut all) = (0.0, 0.0);
        for (row, angle) in found.rows.iter().zip(&angles) {
            let (Some(found), Some(se)) = (row.slider_force, row.slider_force_se) else {
                continue;
            };
            all += 1.0;
            inside += f64::from(u8::from((found - force(*angle)).abs() <= factor * se));
        }
        assert!(
            inside >= 0.9 * all,
            "{steps} steps, off by {off}: {inside} of {all}"
        );
        let budget = &found.summary.error_budget;
        let zero = budget.iter().find(|part| part.source.contains("encoder"));
        let share: f64 = budget.iter().map(|part| part.share).sum();
        assert!(zero.is_some() && (share - 1.0).abs() < 1e-9, "{budget:?}");
    });
}

/// Crank that moves from rest to rest by 30 degrees, along 10 s³ − 15 s⁴ + 6 s⁵: its acceleration is known, and at rest
/// one step holds many samples. The error of the torque is at most 1.5 times that of white snap with the plain codes.
#[test]
fn a_crank_at_rest_stays_in_its_step() {
    const INERTIA: f64 = 0.02;
    const MOVE: f64 = TAU / 12.0;
    const LASTS: f64 = 0.25;
    let motion = |t: f64| {
        let begun = (t / 0.6).floor();
        let s = ((t - 0.6 * begun) / LASTS).min(1.0);
        let angle = s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
        let alpha = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (LASTS * LASTS);
        [0.6 + MOVE * (begun + angle), MOVE * alpha]
    };
    for steps in [256.0, 1024.0, 4096.0] {
        let step = TAU / steps;
        let times: Vec<f64> = (0..1500).map(|i| 0.002 * f64::from(i)).collect();
        let codes = times
            .iter()
            .map(|t| ((motion(*t)[0] / step).floor() + 0.5) * step);
        let codes: Vec<f64> = codes.collect();
        let plain = white_snap(&times, &codes, &vec![true; codes.len()]);
        let record = Measurement::new(Measured::Theta, times.clone(), codes);
        let scene = Scene::new(R, L).crank(Crank {
            mass: 1.0,
            inertia: INERTIA,
            ..Crank::default()
        });
        let options = InverseOptions::default();
        let found = inverse(&scene, &record.expect("a record"), &options).expect("an inversion");
        let factor = found.summary.band_factor;
        let (mut inside, mut off, mut off_plainly) = (0.0, 0.0, 0.0);
        for (row, plain) in found.rows.iter().zip(plain) {
            let [torque, se] =
                [row.crank_torque, row.crank_torque_se].map(|value| value.expect("a torque"));
            let exact = INERTIA * motion(row.t)[1];
            inside += f64::from(u8::from((torque - exact).abs() <= factor * se));
            off += (torque - exact).powi(2);
            off_plainly += (INERTIA * plain[2] - exact).powi(2);
        }
        let (part, covered) = ((off / off_plainly).sqrt(), inside / times.len() as f64);
        assert!(covered >= 0.9, "{steps} steps: {covered} covered");
        assert!(part < 1.5, "{steps} steps: {part} times as far off");
    }
}

/// A swing of 0.73 periods from sample to sample looks like noise, which an encoder does not have.
#[test]
fn noise_of_more_than_a_count_is_told() {
    let noted = |periods: f64| {
        let count = |i: u32| (256.0 * (0.2 + 0.1 * (TAU * periods * f64::from(i)).sin())).round();
        let rows = (0..60).map(|i| format!("{i},{}\n", count(i)));
        let text = format!("t [s],theta [counts]\n{}", rows.collect::<String>());
        let reading = Reading {
            counts_per_turn: Some(256),
            ..Reading::default()
        };
        let motion = Measurement::parse(Path::new("swing.csv"), text, &reading).expect("a motion");
        let scene = Scene::new(R, L).slider(Slider { mass: MASS });
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
        let mut warnings = found.summary.warnings.iter();
        warnings.any(|warning| warning.contains("counts of the encoder, and no more than one"))
    };
    assert!(noted(0.73));
    assert!(!noted(0.03));
}

/// An encoder errs by no more than a count, and has no hum: a swing of a fixed frequency beside noise of some counts is one of the
/// torque, and there are no odds to tell.
#[test]
fn a_tone_of_counts_is_one_of_the_torque() {
    const INERTIA: f64 = 0.02;
    const TORQUE: f64 = 0.5;
    const PULSATION: f64 = TAU * 40.0;
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let counts = f64::from(1 << 16);
    let mut row = |i: u32| {
        let t = 1e-3 * f64::from(i);
        let swing = -TORQUE / (INERTIA * PULSATION * PULSATION) * (PULSATION * t).sin();
        let angle = 0.3 + 20.0 * t + swing + 3e-4 * random.normal();
        format!("{t},{}\n", (angle / TAU * counts).round())
    };
    let rows: String = (0..800).map(&mut row).collect();
    let reading = Reading {
        counts_per_turn: Some(1 << 16),
        ..Reading::default()
    };
    let text = format!("t [s],theta [counts]\n{rows}");
    let motion = Measurement::parse(Path::new("ripple.csv"), text, &reading).expect("a motion");
    let scene = Scene::new(R, L).crank(Crank {
        mass: 1.0,
        inertia: INERTIA,
        ..Crank::default()
    });
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("an inversion");
    let [tone] = found.summary.fit.tones[..] else {
        panic!("{:?}", found.summary.fit.tones);
    };
    assert_eq!(tone.carrier, Carrier::Torque);
    assert!((tone.amplitude - TORQUE).abs() < 0.1 * TORQUE, "{tone:?}");
    assert_eq!(tone.log_odds, None);
    let mut warnings = found.summary.warnings.iter();
    let said = warnings.find(|warning| warning.starts_with("a tone of "));
    let said = said.expect("a warning");
    assert!(
        said.ends_with("is taken for one of the torque, and is in the result"),
        "{said}"
    );
}
