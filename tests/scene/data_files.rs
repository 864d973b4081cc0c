//! Data files as instruments write them: time stamps of a clock that started long ago.

use std::fmt::Write;
use std::path::Path;

use slider_crank::inverse::{FitKind, Inverse, InverseOptions, inverse};
use slider_crank::scene::{Measured, Measurement, Reading, Scene, Slider};

const MICROSECONDS: i64 = 1_000_000;

/// Returns uneven times from 0 on, in microseconds.
fn microseconds() -> Vec<i64> {
    (0..400).map(|i| 2500 * i + 37 * (i * i % 11)).collect()
}

/// Returns θ(t), rad, for t in s.
fn theta(t: f64) -> f64 {
    0.4 + 16.0 * t + 0.3 * (5.0 * t).sin()
}

/// Returns a file with these times as decimals of a second; the motion begins at the first one.
fn file(stamps: &[i64]) -> String {
    let mut text = "t [s],theta [rad]\n".to_owned();
    for stamp in stamps {
        let value = theta((stamp - stamps[0]) as f64 / 1e6);
        let (whole, part) = (stamp / MICROSECONDS, stamp % MICROSECONDS);
        writeln!(text, "{whole}.{part:06},{value:.9}").expect("a line");
    }
    text
}

fn read(text: &str) -> Measurement {
    let file = Path::new("data.csv");
    Measurement::parse(file, text.to_owned(), &Reading::default()).expect("samples")
}

fn inverted(measurement: &Measurement, fit: FitKind) -> Inverse {
    let scene = Scene::new(0.05, 0.15).slider(Slider { mass: 2.0 });
    let options = InverseOptions {
        fit,
        ..InverseOptions::default()
    };
    inverse(&scene, measurement, &options).expect("an inversion")
}

#[test]
fn time_stamps_of_a_clock_lose_nothing() {
    let near: Vec<i64> = microseconds();
    let far: Vec<i64> = near.iter().map(|t| t + 1_700_000_000_123_456).collect();
    let [near_text, far_text] = [file(&near), file(&far)];
    // Blank lines and quotes are handled by the slower reader.
    let quoted = far_text.replacen("1700000000.123456", "\"1700000000.123456\"", 1);
    assert_ne!(quoted, far_text);
    for fit in FitKind::ALL {
        let expected = inverted(&read(&near_text), fit);
        for text in [&far_text, &quoted] {
            let found = inverted(&read(text), fit);
            assert!((found.summary.fit.time_origin_s - 1_700_000_000.123_456).abs() < 1e-6);
            let said = |words: &str| {
                found
                    .summary
                    .warnings
                    .iter()
                    .any(|w| w.to_string().contains(words))
            };
            assert!(said("refer to the time since t = 1700000000.123456 s"));
            assert_eq!(
                found.summary.fit.coefficients,
                expected.summary.fit.coefficients
            );
            for ((row, right), stamp) in found.rows.iter().zip(&expected.rows).zip(&far) {
                let shown = format!("{}.{:06}", stamp / MICROSECONDS, stamp % MICROSECONDS);
                assert_eq!(row.t, shown.parse::<f64>().expect("a number"));
                let t = right.t;
                assert_eq!(
                    *row,
                    slider_crank::inverse::InverseRow { t: row.t, ..*right },
                    "{t}"
                );
            }
        }
    }
    assert_eq!(read(&near_text).origin(), 0.0);
}

#[test]
fn time_stamps_finer_than_a_double_are_told_apart() {
    let mut text = "t [s],theta [rad]\n".to_owned();
    for i in 0..40 {
        writeln!(text, "1700000000.0000000{i:02},{}", 0.01 * f64::from(i)).expect("a line");
    }
    let measurement = read(&text);
    let elapsed = measurement.elapsed();
    assert!((0..40).all(|i| elapsed[i] == format!("{i}e-9").parse::<f64>().expect("a number")));
    let repeated = text.replace("000000007,", "000000006,");
    let wrong = Measurement::parse(Path::new("data.csv"), repeated, &Reading::default());
    let wrong = wrong.expect_err("a repeated time").to_string();
    assert!(
        wrong.contains("data.csv:9:1") && wrong.contains("is repeated"),
        "{wrong}"
    );
}

/// A delimiter inside quotes does not separate cells.
#[test]
fn a_cell_behind_quotes_is_found() {
    let text = "note,t [s],theta [rad]\n\"slow, at first\",0,0.1\n\"then, faster\",0.1,fast\n";
    let wrong = Measurement::parse(Path::new("data.csv"), text.to_owned(), &Reading::default());
    let wrong = wrong.expect_err("a word").to_string();
    assert!(
        wrong.contains("`fast` is not a number") && wrong.contains("data.csv:3:20"),
        "{wrong}"
    );
}

/// A crank that stops, or rests before it starts, also repeats extreme values.
#[test]
fn a_rest_is_no_end_of_a_range() {
    let times: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
    let smooth = |t: &f64| {
        let s = (t - 1.0).clamp(0.0, 1.0);
        4.0 * s * s * s * (10.0 - 15.0 * s + 6.0 * s * s)
    };
    for digits in [1e-12, 1e-4] {
        let values = times.iter().map(|t| (smooth(t) / digits).round() * digits);
        let values = values.collect();
        let motion = Measurement::new(Measured::Theta, times.clone(), values).expect("samples");
        assert!(motion.notes().is_empty(), "{:?}", motion.notes());
    }
}

/// Returns rows of a file with six decimals.
fn plain_rows() -> Vec<String> {
    let angle = |t: f64| 0.3 + 2.0 * t + t * t;
    let row = |i: i32| (0.01 * f64::from(i), angle(0.01 * f64::from(i)));
    let rows = (1..=40).map(row);
    rows.map(|(t, theta)| format!("{t:.6},{theta:.6}"))
        .collect()
}

/// Samples without motion are accepted with a note.
#[test]
fn samples_that_are_all_equal_are_noted() {
    let times: Vec<f64> = (0..40).map(f64::from).collect();
    for (measured, value, shown) in [
        (Measured::Theta, 0.5, "theta are 0.5 rad"),
        (Measured::Gamma, 1.5, "gamma are 1.5 rad"),
        (Measured::X, 0.15, "x are 0.15 m"),
    ] {
        let notes = |values: Vec<f64>| {
            let motion = Measurement::new(measured, times.clone(), values);
            motion.expect("samples").notes().join("\n")
        };
        let mut values = vec![value; 40];
        let said = notes(values.clone());
        assert!(said.contains(shown) && said.contains("no motion"), "{said}");
        values[20] += 1e-9;
        assert!(!notes(values).contains("no motion"));
    }
}

/// Times in a wrong unit make the speeds overflow.
#[test]
fn times_too_close_to_each_other_are_refused() {
    let rows = (1..=40).map(|i| format!("{i}e-310,0.{i:02}\n"));
    let text = format!("t [s],theta [rad]\n{}", rows.collect::<String>());
    let wrong = Measurement::parse(Path::new("data.csv"), text, &Reading::default());
    let wrong = wrong.expect_err("an impossible unit").to_string();
    for part in ["within 3.9e-309 s", "data.csv:41:1", "check their unit"] {
        assert!(wrong.contains(part), "{wrong}");
    }
}

/// Decimal commas in a comma-separated file are reported with advice to use other separators.
#[test]
fn decimal_commas_between_commas_are_seen() {
    let rows = plain_rows().join("\n").replace('.', ",");
    let wrong = Measurement::parse(
        Path::new("data.csv"),
        format!("t [s],theta [rad]\n{rows}\n"),
        &Reading::default(),
    );
    let wrong = wrong.expect_err("four values a row").to_string();
    for part in [
        "4 values where the header has 2",
        "data.csv:2:1",
        "have decimal commas",
    ] {
        assert!(wrong.contains(part), "{wrong}");
    }
}

/// Blanks around a number are ignored, including non-breaking ones.
#[test]
fn blanks_that_do_not_break_lines_are_blanks() {
    let text = format!("t [s],theta [rad]\n{}\n", plain_rows().join("\n"));
    let expected = read(&text);
    let found = read(&text.replace(',', ",\u{a0}"));
    assert_eq!(found.values(), expected.values());
    assert_eq!(found.resolution(), expected.resolution());
}

/// With very many wrong times, the first are listed and the others counted, in no more time than reading.
#[test]
fn very_many_wrong_times_are_counted() {
    let rows = (0..200_000).map(|i| format!("{},{i}\n", i / 2));
    let text = format!("t [s],theta [deg]\n{}", rows.collect::<String>());
    let wrong = Measurement::parse(Path::new("data.csv"), text, &Reading::default());
    let wrong = wrong.expect_err("repeated times").to_string();
    for part in [
        "the time 0 is repeated",
        "the time 2 is repeated",
        "99997 problems more",
    ] {
        assert!(wrong.contains(part), "{wrong}");
    }
    assert!(!wrong.contains("the time 3 is repeated"), "{wrong}");
    let times = (0..40).map(|i| f64::from(i / 4)).collect();
    let wrong = Measurement::new(Measured::Theta, times, vec![0.0; 40]);
    let wrong = wrong.expect_err("repeated times");
    let fields: Vec<&str> = wrong.list().iter().map(|one| one.field.as_str()).collect();
    assert_eq!(
        fields,
        ["time, sample 2", "time, sample 3", "time, sample 4", ""]
    );
}
