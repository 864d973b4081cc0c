//! Text of `inverse`: it fits a screen for any record, and warns of motions that contradict the scene.

use std::f64::consts::TAU;

use super::program::{Folder, PUMP};

/// Returns a record of the crank angle, in the unit of the header, over time in s.
fn record(header: &str, rows: usize, step: f64, angle: impl Fn(f64) -> f64) -> String {
    let row = |i: usize| {
        let t = step * i as f64;
        // Noise from a linear congruential generator.
        let noise = (i as u64)
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407)
            >> 40;
        format!(
            "{t},{:.6}\n",
            angle(t) + 2e-3 * (noise as f64 / (1u64 << 24) as f64 - 0.5)
        )
    };
    format!("{header}\n{}", (0..rows).map(row).collect::<String>())
}

/// Returns the standard output of `inverse` for a scene with this speed.
fn said(speed: &str, data: &str, options: &[&str]) -> String {
    let scene = format!("{PUMP}\n[motion]\nspeed = \"{speed}\"\n");
    let folder = Folder::with(&scene);
    folder.write("data.csv", data);
    let run = [&["inverse", "scene.toml", "data.csv"], options].concat();
    folder.run(&run).done().stdout
}

#[test]
fn the_text_fits_a_screen() {
    let turning = |t: f64| 0.3 + 10.0 * t + 0.1 * (10.0 * t).sin();
    for (rows, step, options) in [
        (400, 0.02, &[][..]),
        (1500, 0.05, &[]),
        (60, 0.01, &["--fit", "polynomial", "--degree", "30"]),
        (60, 0.01, &["--fit", "polynomial", "--degree", "12"]),
    ] {
        let text = said(
            "10 rad/s",
            &record("t [s],theta [rad]", rows, step, turning),
            options,
        );
        assert!(
            text.lines().count() <= 40,
            "{} lines\n{text}",
            text.lines().count()
        );
        assert!(
            text.lines()
                .filter(|line| line.starts_with("no slider force"))
                .count()
                <= 5,
            "{text}"
        );
        for name in ["slider force", "crank torque", "  residuals"] {
            let line = text
                .lines()
                .find(|line| line.starts_with(name))
                .expect(name);
            assert!(line.contains(" +- "), "{line}");
        }
        assert_eq!(
            text.contains("coefficient 0"),
            options.contains(&"polynomial"),
            "{text}"
        );
    }
    let text = said(
        "10 rad/s",
        &record("t [s],theta [rad]", 1500, 0.05, turning),
        &[],
    );
    let line = text
        .lines()
        .find(|line| line.starts_with("no slider force"))
        .expect("dead centres");
    assert!(
        line.contains(" stretches, ") && line.contains(" % of the rows, the longest from t = "),
        "{line}"
    );
}

#[test]
fn a_motion_that_contradicts_the_scene_is_said() {
    let turning = |speed: f64| move |t: f64| 0.3 + speed * t;
    let text = |stated: &str, speed: f64, rows: usize, step: f64| {
        said(
            stated,
            &record("t [s],theta [rad]", rows, step, turning(speed)),
            &[],
        )
    };
    let plain = text("10 rad/s", 12.0, 300, 0.02);
    assert!(
        !plain.contains("[motion] speed") && !plain.contains("rows in a turn"),
        "{plain}"
    );
    let back = text("10 rad/s", -12.0, 300, 0.02);
    assert!(
        back.contains("against the sense of the scene's [motion] speed"),
        "{back}"
    );
    let degrees = text("10 rad/s", 573.0, 300, 2e-3);
    assert!(
        degrees.contains("57.300 times the scene's [motion] speed")
            || degrees.contains("57.299 times")
            || degrees.contains("57.301 times"),
        "{degrees}"
    );
    let slow = text("10 rad/s", 0.5, 300, 0.1);
    assert!(
        slow.contains("0.050 times the scene's [motion] speed"),
        "{slow}"
    );
    let radians = said(
        "10 rad/s",
        &record("t [s],theta [deg]", 300, 0.02, turning(10.0)),
        &[],
    );
    assert!(
        radians.contains("0.017 times the scene's [motion] speed"),
        "{radians}"
    );
    // 20 rows in 12 turns.
    let few = text("10 rad/s", 10.0, 20, 12.0 * TAU / 190.0);
    assert!(few.contains("1.6 rows in a turn"), "{few}");
    // A swing has no steady speed that could contradict the scene.
    let swing = said(
        "10 rad/s",
        &record("t [s],theta [rad]", 300, 0.02, |t| 1.0 + 0.5 * t.sin()),
        &[],
    );
    assert!(!swing.contains("[motion] speed"), "{swing}");
}
