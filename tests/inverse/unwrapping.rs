//! Crank angles as instruments write them: reduced to a turn, to a cycle or by a counter, with gaps, values that are far off, and
//! sensors that hold. A flywheel that turns evenly needs no torque.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use super::noise::Random;
use slider_crank::inverse::{Inverse, InverseOptions, inverse};
use slider_crank::scene::{Crank, Measured, Measurement, Reading, Scene, Slider};

const SPEED: f64 = 80.0;
const NOISE: f64 = 1e-4;

fn flywheel() -> Scene {
    Scene::new(0.05, 0.15).crank(Crank {
        inertia: 0.03,
        ..Crank::default()
    })
}

/// Returns times, s, and crank angles, rad, of an even rotation with this number of rows in a turn.
fn turning(turns: f64, in_a_turn: f64) -> (Vec<f64>, Vec<f64>) {
    let mut random = Random(7919);
    let rows = (turns * in_a_turn) as usize;
    let times = (0..rows).map(|k| k as f64 * TAU / SPEED / in_a_turn);
    let times: Vec<f64> = times.collect();
    let angle = |t: &f64| 0.3 + SPEED * t + NOISE * random.normal();
    let angles = times.iter().map(angle).collect();
    (times, angles)
}

/// Slider position of the flywheel's mechanism, m.
fn x(theta: &f64) -> f64 {
    let rod = (0.15f64.powi(2) - (0.05 * theta.sin()).powi(2)).sqrt();
    0.05 * theta.cos() + rod
}

fn found(times: Vec<f64>, angles: Vec<f64>) -> Inverse {
    let motion = Measurement::new(Measured::Theta, times, angles).expect("samples");
    inverse(&flywheel(), &motion, &InverseOptions::default()).expect("an inversion")
}

/// Noise tells the speed of a stretch of a few turns to 1e-3 of it.
#[track_caller]
fn turns_evenly(found: &Inverse, from: f64) {
    for row in &found.rows {
        let off = row.theta - from - SPEED * row.t;
        assert!(off.abs() < 0.01, "{}: {}", row.t, row.theta);
        assert!((row.omega - SPEED).abs() < 0.1, "{}: {}", row.t, row.omega);
    }
}

#[test]
fn angles_reduced_to_one_or_two_turns_are_continued() {
    for [low, period] in [[0.0, TAU], [-PI, TAU], [0.0, 2.0 * TAU], [-TAU, 2.0 * TAU]] {
        let (times, angles) = turning(9.0, 60.0);
        let reduced = angles.iter().map(|a| (a - low).rem_euclid(period) + low);
        let found = found(times, reduced.collect());
        turns_evenly(&found, 0.3);
    }
}

/// As few as 5 rows in a turn, of which one is a value that no angle has, and one is 0.
#[test]
fn values_that_are_far_off_do_not_stop_the_continuation() {
    for in_a_turn in [5.0, 7.0, 100.0] {
        let (times, angles) = turning(12.0, in_a_turn);
        let mut reduced: Vec<f64> = angles.iter().map(|a| a.rem_euclid(TAU)).collect();
        reduced[20] = 17.9;
        reduced[33] = 0.0;
        turns_evenly(&found(times, reduced), 0.3);
    }
}

/// Half a turn to 2.3 turns pass without a row: the speed on both sides says how many.
#[test]
fn the_turns_of_a_gap_are_those_of_the_speed_about_it() {
    for missing in [50, 98, 150, 230] {
        let (times, angles) = turning(9.0, 100.0);
        let kept = |k: &usize| !(400..400 + missing).contains(k);
        let rows: Vec<usize> = (0..times.len()).filter(kept).collect();
        let times = rows.iter().map(|k| times[*k]).collect();
        let reduced = rows.iter().map(|k| angles[*k].rem_euclid(TAU)).collect();
        turns_evenly(&found(times, reduced), 0.3);
    }
}

/// Before a gap of a turn the crank is three times as fast as after it: one turn or two may have passed.
#[test]
fn a_gap_between_different_speeds_is_refused() {
    let time = |k: usize| 1e-3 * k as f64;
    let angle = |t: f64| {
        if t < 0.3 {
            60.0 * t
        } else {
            18.0 + 20.0 * (t - 0.3)
        }
    };
    let rows: Vec<usize> = (0..250).chain(420..700).collect();
    let times = rows.iter().map(|k| time(*k)).collect();
    let reduced = rows
        .iter()
        .map(|k| angle(time(*k)).rem_euclid(TAU))
        .collect();
    let motion = Measurement::new(Measured::Theta, times, reduced).expect("samples");
    let refused = inverse(&flywheel(), &motion, &InverseOptions::default());
    let said = refused.expect_err("not known").to_string();
    assert!(said.contains("nor how far"), "{said}");
}

/// A counter of 16 bits with 3600 counts in a turn, whose period is 18.2 turns, and one that is reset by whole turns.
#[test]
fn counters_that_wrap_or_are_reset_are_continued() {
    let (times, angles) = turning(30.0, 40.0);
    let count = |angle: &f64| (angle / TAU * 3600.0).floor() as i64;
    for wrapped in [
        |count: i64, _: usize| (count + 40_000) % 65_536,
        |count: i64, k: usize| if k < 600 { count } else { count - 5 * 3600 },
    ] {
        let mut text = "t [s],count\n".to_owned();
        for (k, (t, angle)) in times.iter().zip(&angles).enumerate() {
            text += &format!("{t},{}\n", wrapped(count(angle), k));
        }
        let reading = Reading {
            counts_per_turn: Some(3600),
            ..Reading::default()
        };
        let motion = Measurement::parse(Path::new("counts.csv"), text, &reading).expect("counts");
        let found = inverse(&flywheel(), &motion, &InverseOptions::default()).expect("a motion");
        let from = found.rows[0].theta;
        turns_evenly(&found, from);
    }
}

/// For less than half a turn, and for nearly a whole one, the sensor shows its last value.
#[test]
fn a_sensor_that_holds_is_not_followed() {
    for rows in [40, 95] {
        let (times, mut angles) = turning(9.0, 100.0);
        let last = angles[399];
        angles[400..400 + rows].fill(last);
        let found = found(times, angles);
        turns_evenly(&found, 0.3);
        let said = found.summary.warnings.join("\n");
        assert!(
            said.contains("at sample 401 and before the value is the same"),
            "{said}"
        );
    }
}

/// A slider position that is logged three or ten times as often as it is measured, and one that stays for 1.4 turns.
#[test]
fn a_position_that_a_sensor_holds_is_not_followed() {
    let mut scene = flywheel();
    scene.motion.angle = 0.3;
    scene.motion.speed = SPEED;
    for held in ["each three times", "each ten times", "for 140 rows"] {
        let (times, angles) = turning(9.0, 100.0);
        let mut values: Vec<f64> = angles.iter().map(x).collect();
        for row in 0..values.len() {
            values[row] = match held {
                "each three times" => values[row - row % 3],
                "each ten times" => values[row - row % 10],
                _ if (400..540).contains(&row) => values[399],
                _ => values[row],
            };
        }
        let motion = Measurement::new(Measured::X, times, values).expect("samples");
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect(held);
        turns_evenly(&found, 0.3);
    }
}

/// A crank that becomes quicker, with gaps of up to 0.7 turns: the motion that begins at the angle of the scene has all turns,
/// also where it is found as the mirror image of another one.
#[test]
fn positions_keep_their_turns_over_gaps() {
    let mut scene = flywheel();
    (scene.motion.angle, scene.motion.speed) = (5.0554, 5.0);
    let angle = |t: &f64| 5.0554 + 5.0 * t + 30.0 * t * t;
    let gaps = [441..471, 1349..1379];
    let times = (0..1500).filter(|k| !gaps.iter().any(|gap| gap.contains(k)));
    let times: Vec<f64> = times.map(|k| k as f64 / 750.0).collect();
    for (measured, seed) in [Measured::X, Measured::Gamma].into_iter().zip([7, 11]) {
        let mut random = Random(seed);
        let shown = |t: &f64| {
            let x = x(&angle(t));
            match measured {
                Measured::X => x + 2e-5 * random.normal(),
                // Law of cosines.
                _ => {
                    ((0.05f64.powi(2) + 0.15f64.powi(2) - x * x) / 0.015).acos()
                        + 4e-4 * random.normal()
                }
            }
        };
        let values = times.iter().map(shown).collect();
        let motion = Measurement::new(measured, times.clone(), values).expect("samples");
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("a motion");
        let begin = ((found.rows[0].theta - angle(&0.0)) / TAU).round() * TAU;
        for row in &found.rows {
            let off = row.theta - angle(&row.t) - begin;
            assert!(off.abs() < 0.05, "{measured:?}, {}: {off}", row.t);
        }
    }
}

/// A slider of 1 kg on a light crank, driven from rest by a constant torque: the speed swings by a factor of two in each turn, as
/// energy has it, and two gaps leave out a fiftieth of the rows each. The motion is integrated by the Runge-Kutta method.
#[test]
fn a_crank_whose_speed_swings_keeps_its_turns() {
    let (inertia, mass, torque, begin) = (1e-3, 1.0, 0.95, 0.2);
    let slopes = |theta: f64| {
        let h = 1e-4;
        let [before, here, after] = [-h, 0.0, h].map(|h| x(&(theta + h)));
        [
            (after - before) / (2.0 * h),
            (after - 2.0 * here + before) / (h * h),
        ]
    };
    let rate = |[theta, omega]: [f64; 2]| {
        let [x1, x2] = slopes(theta);
        let needed = torque - mass * x1 * x2 * omega * omega;
        [omega, needed / (inertia + mass * x1 * x1)]
    };
    let (rows, steps) = (800, 20);
    let h = 1.0 / f64::from((rows - 1) * steps);
    let mut state = [0.3, 0.0];
    let mut angles = Vec::new();
    for row in 0..rows {
        angles.push(state[0]);
        let moves = f64::from(row) / f64::from(rows - 1) >= begin;
        for _ in 0..if moves { steps } else { 0 } {
            let add = |h: f64, b: [f64; 2]| [0, 1].map(|k| state[k] + h * b[k]);
            let a = rate(state);
            let b = rate(add(0.5 * h, a));
            let c = rate(add(0.5 * h, b));
            let d = rate(add(h, c));
            state = [0, 1].map(|k| state[k] + h / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]));
        }
    }
    let mut random = Random(7919);
    let shown = |theta: &f64| x(theta) + 2e-5 * random.normal();
    let values: Vec<f64> = angles.iter().map(shown).collect();
    let gaps = [320..336, 560..576];
    let told = |row: &usize| !gaps.iter().any(|gap| gap.contains(row));
    let seen: Vec<usize> = (0..rows as usize).filter(told).collect();
    let at = |list: &[f64]| seen.iter().map(|row| list[*row]).collect();
    let times: Vec<f64> = (0..rows)
        .map(|row| f64::from(row) / f64::from(rows - 1))
        .collect();
    let motion = Measurement::new(Measured::X, at(&times), at(&values)).expect("samples");
    let slider = Slider { mass };
    let crank = Crank {
        inertia,
        ..Crank::default()
    };
    let scene = Scene::new(0.05, 0.15)
        .slider(slider)
        .crank(crank)
        .start(0.3, 1.0);
    let found = inverse(&scene, &motion, &InverseOptions::default()).expect("a motion");
    for (found, row) in found.rows.iter().zip(&seen) {
        let off = found.theta - angles[*row];
        assert!(off.abs() < 0.05, "{}: {off} rad", found.t);
    }
}

/// A crank at rest for nine tenths of the record repeats its positions without a sensor that holds them: all count, and they
/// tell where the torque begins.
#[test]
fn positions_at_rest_are_not_held() {
    let (rows, begin) = (300, 0.9);
    let times: Vec<f64> = (0..rows).map(|k| f64::from(k) / 300.0).collect();
    let angle = |t: &f64| 0.5 + 3.0 * (t - begin).max(0.0).powi(2);
    let values = times.iter().map(|t| x(&angle(t))).collect();
    let motion = Measurement::new(Measured::X, times, values).expect("samples");
    let found = inverse(&flywheel(), &motion, &InverseOptions::default()).expect("a motion");
    assert_eq!(found.summary.fit.outliers, 0);
    for row in found.rows.iter().filter(|row| row.t < begin - 0.01) {
        let torque = row.crank_torque.expect("a torque");
        assert!(torque.abs() < 1e-3, "{}: {torque}", row.t);
    }
}

/// A crank leaves rest and turns quicker and quicker. Positions in steps of a thousandth of the crank show it neither elsewhere at
/// rest nor on a way between the values that repeat.
#[test]
fn positions_in_steps_show_rest() {
    let begin = 0.2;
    for start in [4.0, 2.0, 5.5] {
        let angle = |t: &f64| start + 80.0 * (t - begin).max(0.0).powi(4);
        let times: Vec<f64> = (0..1500).map(|k| f64::from(k) / 1500.0).collect();
        let shown = |t: &f64| (x(&angle(t)) / 5e-5).round() * 5e-5;
        let values = times.iter().map(shown).collect();
        let motion = Measurement::new(Measured::X, times, values).expect("samples");
        let scene = flywheel().start(start, 1.0);
        let found = inverse(&scene, &motion, &InverseOptions::default()).expect("a motion");
        for row in &found.rows {
            let off = (row.theta - angle(&row.t)).rem_euclid(TAU);
            println!(
                "DBG {start} {} {} {} {}",
                row.t,
                row.theta,
                angle(&row.t),
                row.omega
            );
            assert!(
                off.min(TAU - off) < 0.05,
                "{start}, {}: {}",
                row.t,
                row.theta
            );
        }
    }
}

/// The index mark of the crank angle is 30 degrees off beside a slider position that is right.
#[test]
fn sensors_that_contradict_each_other_are_named() {
    let (times, angles) = turning(6.0, 60.0);
    let mut random = Random(104_729);
    let shown = |theta: &f64| x(theta) + 1e-5 * random.normal();
    let positions: Vec<f64> = angles.iter().map(shown).collect();
    for (off, is_named) in [(PI / 6.0, true), (0.0, false)] {
        let shown = angles.iter().map(|angle| angle + off).collect();
        let motion = Measurement::new(Measured::Theta, times.clone(), shown)
            .and_then(|motion| {
                let beside = slider_crank::scene::Beside::Sensor(Measured::X);
                motion.with(beside, positions.clone())
            })
            .expect("samples");
        let found = inverse(&flywheel(), &motion, &InverseOptions::default()).expect("a motion");
        let said = found.summary.warnings.join("\n");
        assert_eq!(
            said.contains("x differs from the motion"),
            is_named,
            "{said}"
        );
    }
}
