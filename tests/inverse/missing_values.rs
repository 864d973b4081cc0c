//! Records whose sensors did not give a value at every time.

use std::path::Path;

use super::noise::Random;
use super::simulated::{crank_and_slider, needed, position};
use slider_crank::inverse::{Inverse, InverseOptions, inverse};
use slider_crank::scene::{Beside, Measured, Measurement, Reading};

/// Returns θ, ω and θ̈ of an uneven rotation.
fn uneven(t: f64) -> [f64; 3] {
    let (sin, cos) = (2.0 * t).sin_cos();
    [25.0 * t + 1.5 * sin, 25.0 + 3.0 * cos, -6.0 * sin]
}

fn times() -> impl Iterator<Item = f64> {
    (0..400).map(|i| 0.004 * f64::from(i))
}

fn reading(missing: &[&str]) -> Reading {
    Reading {
        missing: missing.iter().map(|text| (*text).to_owned()).collect(),
        ..Reading::default()
    }
}

fn read(text: &str, missing: &[&str]) -> Result<Measurement, String> {
    let found = Measurement::parse(Path::new("gaps.csv"), text.to_owned(), &reading(missing));
    found.map_err(|problems| problems.to_string())
}

/// Returns the text of a record in which `cell` stands for each seventh angle, and for the thirtieth time; and the text without
/// these rows.
fn with_gaps(cell: &str) -> [String; 2] {
    let head = "t [s],theta [rad]\n";
    let [mut whole, mut rest] = [head.to_owned(), head.to_owned()];
    for (row, t) in times().enumerate() {
        let theta = uneven(t)[0];
        match row {
            _ if row % 7 == 3 => whole += &format!("{t},{cell}\n"),
            30 => whole += &format!("{cell},{theta}\n"),
            _ => {
                let line = format!("{t},{theta}\n");
                whole += &line;
                rest += &line;
            }
        }
    }
    [whole, rest]
}

#[test]
fn rows_without_a_value_are_gaps_where_that_is_said() {
    for (cell, missing) in [("NaN", "nan"), ("", ""), ("-999", "-999")] {
        let [whole, rest] = with_gaps(cell);
        let found = read(&whole, &[missing]).expect("samples");
        let expected = read(&rest, &[]).expect("samples");
        assert_eq!(found.times(), expected.times());
        assert_eq!(found.values(), expected.values());
        let is_noted = |note: &String| {
            note.contains("58 rows without time or theta") && note.contains("line 5")
        };
        assert!(found.notes().iter().any(is_noted), "{:?}", found.notes());
        // Rows 3 and 10 are missing: the ninth sample is in row 9, two lines below its number.
        assert_eq!(found.place(8), "line 11");
    }
}

#[test]
fn missing_values_are_refused_where_nothing_is_said_of_them() {
    for cell in ["NaN", ""] {
        let [whole, _] = with_gaps(cell);
        let refused = read(&whole, &["NA"]).expect_err("values are missing");
        assert!(
            refused.contains("gaps.csv:5") && refused.contains("--missing"),
            "{refused}"
        );
    }
}

/// A mark of missing values is no torque.
#[test]
fn a_known_torque_has_no_gaps() {
    let row = |t: f64| {
        format!(
            "{t},{},{}\n",
            uneven(t)[0],
            if t == 0.4 { "-999" } else { "1" }
        )
    };
    let rows: String = times().map(row).collect();
    let reading = Reading {
        known: vec!["motor".to_owned()],
        ..reading(&["-999"])
    };
    let text = format!("t [s],theta [rad],motor [N m]\n{rows}");
    let found = Measurement::parse(Path::new("gaps.csv"), text, &reading);
    let refused = found.expect_err("a value is missing").to_string();
    assert!(refused.contains("gaps.csv:102"), "{refused}");
}

/// Returns the root mean square error of the torque and the part of the rows that the band covers.
fn judged(found: &Inverse) -> [f64; 2] {
    let (mut squares, mut covered) = (0.0, 0.0);
    for row in &found.rows {
        let off = row.crank_torque.expect("a torque") - needed(uneven(row.t));
        let se = row.crank_torque_se.expect("an error");
        squares += off * off;
        covered += f64::from(u8::from(off.abs() <= found.summary.band_factor * se));
    }
    let count = found.rows.len() as f64;
    [(squares / count).sqrt(), covered / count]
}

/// A slow sensor of the slider's position is a hundred times as fine as the fast one of the angle.
#[test]
fn a_slow_sensor_counts_by_the_values_that_it_has() {
    let (coarse, fine, every) = (1e-2, 5e-6, 10);
    let mut random = Random(0x5eed_0063);
    let angles: Vec<f64> = times()
        .map(|t| uneven(t)[0] + coarse * random.normal())
        .collect();
    let slow = |(row, t): (usize, f64)| match row % every {
        0 => position(uneven(t)[0])[0] + fine * random.normal(),
        _ => f64::NAN,
    };
    let positions: Vec<f64> = times().enumerate().map(slow).collect();
    let alone = Measurement::new(Measured::Theta, times().collect(), angles).expect("samples");
    let both = alone.clone().with(Beside::Sensor(Measured::X), positions);
    let scene = crank_and_slider().start(0.0, 28.0);
    let [alone, both] = [alone, both.expect("samples")].map(|samples| {
        inverse(&scene, &samples, &InverseOptions::default()).expect("an inversion")
    });
    let ([error, covered], [of_one, _]) = (judged(&both), judged(&alone));
    assert!(error < 0.3 * of_one, "{error} of {of_one}");
    assert!(covered > 0.85, "{covered}");
    // The standard error of a standard deviation is σ/√(2n).
    let sigma = both.summary.fit.beside[0].sigma;
    let four = 4.0 * fine / (2.0 * times().count() as f64 / every as f64).sqrt();
    assert!((sigma - fine).abs() < four, "{sigma}");
}

#[test]
fn a_sensor_of_few_values_is_refused() {
    let angles = times().map(|t| uneven(t)[0]).collect();
    let samples = Measurement::new(Measured::Theta, times().collect(), angles).expect("samples");
    for given in [0, 5] {
        let mut positions = vec![f64::NAN; samples.len()];
        positions[..given].fill(0.2);
        let with = samples.clone().with(Beside::Sensor(Measured::X), positions);
        let refused = with.expect_err("too few").to_string();
        let what = format!("x: {given} samples where at least 6 are needed");
        assert!(refused.contains(&what), "{refused}");
    }
}
