//! Values of a scene from run-downs and run-ups whose motion has a closed form.

use std::path::Path;

use slider_crank::error::Error;
use slider_crank::inverse::identify::{FreeValue, Identification, identify};
use slider_crank::scene::{Assigned, Draft, Measured, Measurement, NumberKey};

use super::noise::Random;

/// Returns a flywheel of J = 0.02 kg m² with massless rod and slider.
fn flywheel(loads: &str, inertia: f64) -> Draft {
    let text = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[crank]\ninertia = \"{inertia} kg m^2\"\n{loads}"
    );
    Draft::new(Path::new("flywheel.toml"), text)
}

const VISCOUS_AND_DRY: &str = "[[torque]]\nkind = \"viscous\"\ncoefficient = \"0.004 N m s\"\n[[torque]]\nkind = \"dry\"\nvalue = \"0.2 N m\"\n";

fn identified(draft: &Draft, keys: &[&str], motion: &Measurement) -> Result<Identification, Error> {
    identified_beside(draft, keys, &[], motion)
}

/// Identifies keys of a scene and other values, which are not in it.
fn identified_beside(
    draft: &Draft,
    keys: &[&str],
    others: &[FreeValue],
    motion: &Measurement,
) -> Result<Identification, Error> {
    let keys: Vec<NumberKey> = keys.iter().map(|key| key.parse().expect("a key")).collect();
    let free = keys.iter().map(|key| {
        let start = draft.number(key).expect("a number");
        FreeValue {
            key: key.to_string(),
            unit: key.unit().to_owned(),
            start,
            scale: start.abs(),
            is_sensor_zero: false,
        }
    });
    let scene_at = |values: &[f64]| {
        let numbers = keys.iter().zip(values);
        let numbers = numbers.map(|(key, value)| Assigned {
            key: *key,
            value: *value,
        });
        draft.with_numbers(&numbers.collect::<Vec<_>>())
    };
    let free = free.chain(others.iter().cloned());
    identify(&scene_at, &free.collect::<Vec<_>>(), motion)
}

/// Samples a motion with noise, rad.
fn sampled(theta: impl Fn(f64) -> f64, sigma: f64, seed: u64) -> Measurement {
    sampled_at(400, theta, sigma, seed)
}

fn sampled_at(rows: u32, theta: impl Fn(f64) -> f64, sigma: f64, seed: u64) -> Measurement {
    let mut random = Random((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let times: Vec<f64> = (0..rows).map(|i| f64::from(i) / f64::from(rows)).collect();
    let noisy = |t: &f64| theta(*t) + sigma * random.normal();
    let values = times.iter().map(noisy).collect();
    Measurement::new(Measured::Theta, times, values).expect("a measurement")
}

/// Returns the solution of J ω' = -c ω - d from ω(0) = w.
fn run_down(inertia: f64, c: f64, d: f64, w: f64) -> impl Fn(f64) -> f64 {
    move |t| {
        let tau = inertia / c;
        (w + d / c) * tau * (1.0 - (-t / tau).exp()) - d / c * t
    }
}

/// Counts the bands of viscous and dry friction that hold the true values, and checks that each is narrower than a
/// fraction of its value.
fn count_inside(motion: &Measurement, truths: [f64; 2], widest: f64, inside: &mut [usize; 2]) {
    let keys = ["torque[1].coefficient", "torque[2].value"];
    let found = identified(&flywheel(VISCOUS_AND_DRY, 0.02), &keys, motion).expect("told");
    for (k, truth) in truths.into_iter().enumerate() {
        let one = &found.values[k];
        inside[k] += usize::from((one.value - truth).abs() < one.half_band);
        assert!(one.half_band < widest * truth, "{one:?}");
    }
}

#[test]
fn friction_of_a_run_down_lies_within_its_band() {
    let (c, d) = (0.0055, 0.13);
    let mut inside = [0; 2];
    let records = 40;
    for seed in 0..records {
        let motion = sampled(run_down(0.02, c, d, 40.0), 3e-4, seed);
        let draft = flywheel(VISCOUS_AND_DRY, 0.02);
        let found = identified(
            &draft,
            &["torque[1].coefficient", "torque[2].value"],
            &motion,
        );
        let found = found.expect("told");
        for (k, truth) in [c, d].into_iter().enumerate() {
            let one = &found.values[k];
            inside[k] += usize::from((one.value - truth).abs() < one.half_band);
            assert!((one.value - truth).abs() < 2.5 * one.half_band, "{one:?}");
            assert!(one.half_band < 0.1 * truth, "{one:?}");
        }
        assert!(found.correlations[0][1] < -0.9);
    }
    // 38 of 40 are expected; fewer than 34 have a probability of one in a hundred.
    assert!(inside.iter().all(|count| *count >= 34), "{inside:?}");
}

/// A run-down to rest: what holds the crank there is not in the equation.
#[test]
fn friction_is_identified_beside_a_rest() {
    let (c, d, inertia, speed) = (0.008, 0.35, 0.02, 20.0);
    let down = run_down(inertia, c, d, speed);
    let stop = inertia / c * (1.0 + c * speed / d).ln();
    assert!(stop < 0.95, "{stop}");
    let draft = flywheel(&VISCOUS_AND_DRY.replace("0.004", "0.006"), inertia);
    let keys = ["torque[1].coefficient", "torque[2].value"];
    for seed in 0..5 {
        let motion = |t: f64| 0.4 + down(t.min(stop));
        let found = identified(&draft, &keys, &sampled(motion, 3e-4, seed)).expect("told");
        for (one, truth) in found.values.iter().zip([c, d]) {
            let off = (one.value - truth).abs() / one.standard_error;
            assert!(
                off < 4.0 && one.standard_error < 0.1 * truth,
                "{one:?}, not {truth}"
            );
        }
        let [said] = found.warnings.as_slice() else {
            panic!("{:?}", found.warnings);
        };
        assert!(said.contains("samples are left out"), "{said}");
    }
}

/// Of 20,000 rows means are taken: they tell friction seven times as well as 400 rows, and all rows that are not left out count.
#[test]
fn dense_rows_of_a_run_down_tell_more() {
    let (c, d, inertia, speed) = (0.008, 0.35, 0.02, 20.0);
    let down = run_down(inertia, c, d, speed);
    let stop = inertia / c * (1.0 + c * speed / d).ln();
    let draft = flywheel(&VISCOUS_AND_DRY.replace("0.004", "0.006"), inertia);
    let keys = ["torque[1].coefficient", "torque[2].value"];
    let motion = |t: f64| 0.4 + down(t.min(stop));
    let [few, many] = [400, 20_000]
        .map(|rows| identified(&draft, &keys, &sampled_at(rows, motion, 3e-4, 3)).expect("told"));
    for (k, truth) in [c, d].into_iter().enumerate() {
        let [few, many] = [&few, &many].map(|found| &found.values[k]);
        let ratio = few.standard_error / many.standard_error;
        assert!((5.0..10.0).contains(&ratio), "{few:?}, {many:?}");
        assert!(
            (many.value - truth).abs() < 4.0 * many.standard_error,
            "{many:?}, not {truth}"
        );
    }
    let part = many.samples as f64 / 20_000.0;
    assert!(
        (part - stop).abs() < 0.1,
        "{part} of the rows, and the crank turns for {stop} s"
    );
}

/// A turn and a half tells inertia, dry and viscous friction hardly apart: the values that would be likeliest are named, or
/// the keys that cannot be told apart, and the equation, which holds, is not blamed.
#[test]
fn a_record_too_short_for_its_keys_does_not_blame_the_equation() {
    let scene = flywheel(
        "[[torque]]\nkind = \"viscous\"\ncoefficient = \"0.002 N m s\"\n[[torque]]\nkind = \"dry\"\nvalue = \"0.1 N m\"\n[[torque]]\nkind = \"expression\"\nvalue = \"0.4*cos(theta)\"\n",
        0.03,
    );
    let keys = ["torque[1].coefficient", "torque[2].value", "crank.inertia"];
    let (c, d, inertia) = (0.0031, 0.17, 0.0277);
    let mut refused = 0;
    for seed in 0..10 {
        let motion = short(c, d, inertia, seed);
        if let Err(error) = identified(&scene, &keys, &motion) {
            let said = error.to_string();
            assert!(!said.contains("does not describe"), "{said}");
            refused += 1;
        }
    }
    assert!(refused > 0);
}

/// Samples 60 angles of J ω' = 0.4 cos θ − c ω − d from 55 rad/s, by steps of the classical Runge-Kutta method.
fn short(c: f64, d: f64, inertia: f64, seed: u64) -> Measurement {
    let rate = |[theta, omega]: [f64; 2]| [omega, (0.4 * theta.cos() - c * omega - d) / inertia];
    let beside = |at: [f64; 2], by: [f64; 2], h: f64| [at[0] + h * by[0], at[1] + h * by[1]];
    let (mut random, mut now, h) = (
        Random((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15)),
        [0.4, 55.0],
        5e-4,
    );
    let (mut times, mut values) = (Vec::new(), Vec::new());
    for row in 0..60 {
        times.push(3e-3 * f64::from(row));
        values.push(now[0] + 3e-4 * random.normal());
        for _ in 0..6 {
            let a = rate(now);
            let b = rate(beside(now, a, 0.5 * h));
            let c = rate(beside(now, b, 0.5 * h));
            let d = rate(beside(now, c, h));
            now =
                std::array::from_fn(|k| now[k] + h / 6.0 * (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]));
        }
    }
    Measurement::new(Measured::Theta, times, values).expect("a measurement")
}

/// Lengths and zero from a position of the slider: the motion has a closed form, for rod and slider have no mass. What wrong
/// lengths leave is no correlated noise, and a zero of a twelfth of the crank leaves a turning crank one that turns.
#[test]
fn lengths_from_a_position_of_the_slider_lie_within_their_bands() {
    const TRUTHS: [f64; 4] = [0.0503, 0.1488, 0.004, 0.004];
    const KEYS: [&str; 3] = ["geometry.crank", "geometry.rod", "geometry.offset"];
    let text = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\noffset = \"5 mm\"\n[crank]\ninertia = \"0.02 kg m^2\"\n{VISCOUS_AND_DRY}[motion]\nangle = \"0.7 rad\"\nspeed = \"40 rad/s\"\n"
    );
    let draft = Draft::new(Path::new("flywheel.toml"), text);
    let sensor_zero = FreeValue {
        key: "sensor.zero".to_owned(),
        unit: "m".to_owned(),
        start: 0.0,
        scale: 0.05,
        is_sensor_zero: true,
    };
    let down = run_down(0.02, 0.004, 0.2, 40.0);
    let [crank, rod, offset, zero] = TRUTHS;
    let position = |t: f64| {
        let (sin, cos) = (0.7 + down(t)).sin_cos();
        crank * cos + (rod * rod - (offset + crank * sin).powi(2)).sqrt() + zero
    };
    let (mut inside, mut squares) = ([0; 4], [0.0; 4]);
    let records = 40;
    for seed in 0..records {
        let angles = sampled(position, 5e-5, seed);
        let (times, values) = (angles.times().to_vec(), angles.values().to_vec());
        let motion = Measurement::new(Measured::X, times, values).expect("a measurement");
        let zero = std::slice::from_ref(&sensor_zero);
        let found = identified_beside(&draft, &KEYS, zero, &motion).expect("told");
        for (k, one) in found.values.iter().enumerate() {
            inside[k] += usize::from((one.value - TRUTHS[k]).abs() < one.half_band);
            squares[k] += ((one.value - TRUTHS[k]) / one.standard_error).powi(2);
        }
    }
    // 38 of 40 are expected; fewer than 34 have a probability of one in a hundred.
    assert!(inside.iter().all(|count| *count >= 34), "{inside:?}");
    // The mean of 40 squares has a standard deviation of 0.22.
    let means = squares.map(|sum| sum / records as f64);
    assert!(
        means.iter().all(|mean| (mean - 1.0).abs() < 0.7),
        "{means:?}"
    );
}

/// Noise with correlation 0.9 from sample to sample is white only after prewhitening: unmodelled, it would make the
/// equation seem wrong, or the bands four times too narrow.
#[test]
fn correlated_noise_leaves_friction_within_its_band() {
    let (c, d, kept) = (0.0055, 0.13, 0.9f64);
    let theta = run_down(0.02, c, d, 40.0);
    let mut inside = [0; 2];
    for seed in 0..20u64 {
        let mut random = Random((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
        let mut noise = 3e-4 * random.normal();
        let times: Vec<f64> = (0..600).map(|i| 0.0015 * f64::from(i)).collect();
        let noisy = times.iter().map(|t| {
            noise = kept * noise + 3e-4 * (1.0 - kept * kept).sqrt() * random.normal();
            theta(*t) + noise
        });
        let values = noisy.collect();
        let motion = Measurement::new(Measured::Theta, times, values).expect("a measurement");
        count_inside(&motion, [c, d], 0.6, &mut inside);
    }
    // 19 of 20 are expected; fewer than 16 have a probability of one in 400.
    assert!(inside.iter().all(|count| *count >= 16), "{inside:?}");
}

/// A coarse encoder says between which codes the crank is: several samples in one code are not independent.
#[test]
fn codes_of_a_coarse_encoder_tell_friction_within_its_band() {
    let (c, d, step) = (0.0055, 0.13, std::f64::consts::TAU / 360.0);
    let mut inside = [0; 2];
    for record in 0..40 {
        let theta = run_down(0.02, c, d, 25.0 + 0.5 * f64::from(record));
        let times: Vec<f64> = (0..1200).map(|i| 0.0008 * f64::from(i)).collect();
        let code = |t: &f64| step * (theta(*t) / step).floor();
        let values = times.iter().map(code).collect();
        let motion = Measurement::new(Measured::Theta, times, values).expect("a measurement");
        count_inside(&motion, [c, d], 0.3, &mut inside);
    }
    // Bound on the counts from 38 expected of 40.
    assert!(inside.iter().all(|count| *count >= 34), "{inside:?}");
}

/// The stated dry torque is a third too large, and the viscous one alone cannot compensate.
#[test]
fn an_equation_that_does_not_describe_the_record_is_said() {
    let motion = sampled(run_down(0.02, 0.004, 0.15, 40.0), 3e-4, 3);
    let draft = flywheel(VISCOUS_AND_DRY, 0.02);
    let text = match identified(&draft, &["torque[1].coefficient"], &motion) {
        Ok(found) => found.warnings.join(" "),
        Err(error) => error.to_string(),
    };
    assert!(text.contains("does not describe the record"), "{text}");
    assert!(text.contains("times the noise"), "{text}");
}

#[test]
fn a_known_torque_sets_the_scale_of_the_inertia() {
    let motor = "[[torque]]\nkind = \"constant\"\nvalue = \"2 N m\"\n";
    let inertia = 0.031;
    let motion = sampled(|t| 0.5 * 2.0 / inertia * t * t + 3.0 * t, 3e-4, 5);
    let found = identified(&flywheel(motor, 0.02), &["crank.inertia"], &motion).expect("told");
    let one = &found.values[0];
    assert!((one.value - inertia).abs() < 2.0 * one.half_band, "{one:?}");
    assert!(one.half_band < 1e-4 * inertia, "{one:?}");
}

#[track_caller]
fn refused(draft: &Draft, keys: &[&str], motion: &Measurement, words: &[&str]) {
    let error = identified(draft, keys, motion).expect_err("refused");
    let text = error.to_string();
    for word in words {
        assert!(text.contains(word), "{word}: {text}");
    }
}

#[test]
fn what_the_record_cannot_tell_is_refused() {
    let motion = sampled(run_down(0.02, 0.0055, 0.13, 40.0), 3e-4, 1);
    let draft = flywheel(VISCOUS_AND_DRY, 0.02);
    let all = ["torque[1].coefficient", "torque[2].value", "crank.inertia"];
    // J, c and d times one factor give the same motion.
    refused(
        &draft,
        &all,
        &motion,
        &["only their ratios", "`crank.inertia`"],
    );
    refused(&draft, &["geometry.rod"], &motion, &["does not depend"]);
    refused(
        &draft,
        &["crank.inertia", "crank.inertia"],
        &motion,
        &["twice"],
    );
    let rubbing = flywheel("[friction]\ncoefficient = 0.1\n", 0.02);
    refused(&rubbing, &["friction.coefficient"], &motion, &["dry"]);
}
