//! `synthesis`: lengths for the wanted stroke and time ratio.

use std::f64::consts::PI;

use serde_json::Value;

use super::program::{Folder, Outcome};

fn run(folder: &Folder, more: &[&str]) -> Outcome {
    folder.run(&[&["synthesis"], more].concat())
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Returns crank, rod and offset.
#[track_caller]
fn lengths(found: &Value) -> [f64; 3] {
    ["crank_m", "rod_m", "offset_m"].map(|name| number(&found[name]))
}

/// Returns stroke and time ratio from the dead centres as points of the plane: O is at (0, 0), the guide on y = -e.
fn turn([crank, rod, offset]: [f64; 3]) -> [f64; 2] {
    let at = |reach: f64| (reach * reach - offset * offset).sqrt();
    let (outer, inner) = (at(rod + crank), at(rod - crank));
    // Angles of the line of the rod; at the inner dead centre the crank points away from the pin.
    let [far, near] = [outer, inner].map(|x| (-offset).atan2(x));
    let outward = PI + far - near;
    [outer - inner, outward / (2.0 * PI - outward)]
}

#[test]
fn every_choice_has_the_wanted_stroke_and_time_ratio() {
    let folder = Folder::new();
    for ratio in ["1.0001", "1.2", "2.5", "0.8", "0.4"] {
        for choice in [
            &[][..],
            &["--rod-ratio", "1.3"],
            &["--crank", "44 mm"],
            &["--rod", "50 mm"],
            &["--offset", "10 mm"],
        ] {
            let wanted = ["--stroke", "90 mm", "--time-ratio", ratio, "--json"];
            let run = run(&folder, &[&wanted[..], choice].concat());
            // No mechanism with so fast a return has so long a crank or offset; the message states this.
            if run.code == Some(2) {
                let wide: f64 = ratio.parse().expect("a number");
                assert!(!(0.5..2.0).contains(&wide), "{ratio} {choice:?}: {run:?}");
                run.complains(2, &["give one above"]);
                continue;
            }
            let found = run.done().json();
            let lengths = lengths(&found);
            let [stroke, time_ratio] = turn(lengths);
            let want: f64 = ratio.parse().expect("a number");
            // The stroke is a difference, in which the rounding of long rods remains.
            let error = 1e-15_f64.max(lengths[1] * f64::EPSILON);
            assert!(
                (stroke - 0.09).abs() < error,
                "{ratio} {choice:?}: {stroke}"
            );
            assert!(
                (time_ratio - want).abs() < 1e-12,
                "{ratio} {choice:?}: {time_ratio}"
            );
            let [crank, rod, offset] = lengths;
            assert!(rod > crank + offset.abs());
            match choice {
                ["--crank", _] => assert_eq!(crank, 0.044),
                ["--rod", _] => assert_eq!(rod, 0.05),
                ["--offset", _] => assert_eq!(offset.abs(), 0.01),
                ["--rod-ratio", _] => assert!((rod / crank - 1.3).abs() < 1e-14),
                _ => {}
            }
        }
    }
}

/// Every other rod with this stroke and time ratio has a smaller least transmission angle, whose cosine is (r + e)/l.
#[test]
fn the_default_has_the_best_transmission_angle() {
    let folder = Folder::new();
    for ratio in ["1.01", "1.3", "2.9"] {
        let wanted = ["--stroke", "1 m", "--time-ratio", ratio, "--json"];
        let cosine = |found: &Value| {
            let [crank, rod, offset] = lengths(found);
            (crank + offset) / rod
        };
        let best = run(&folder, &wanted).done().json();
        let [_, rod, _] = lengths(&best);
        let angle = number(&best["turn"]["transmission_min_rad"]);
        assert!((angle.cos() - cosine(&best)).abs() < 1e-14);
        for factor in [0.99, 0.999, 1.001, 1.01] {
            let other = format!("{} m", rod * factor);
            let other = run(&folder, &[&wanted[..], &["--rod", &other]].concat());
            let other = other.done().json();
            assert!(cosine(&other) > cosine(&best), "{ratio} {factor}");
        }
    }
}

#[test]
fn the_scene_that_is_written_has_the_lengths() {
    let folder = Folder::new();
    let wanted = ["--stroke", "90 mm", "--time-ratio", "1.2"];
    let text = run(&folder, &[&wanted[..], &["--out", "press.toml"]].concat());
    assert!(text.done().stdout.contains("stroke                 0.09 m"));
    let turn = folder.run(&["kinematics", "press.toml", "--json"]).done();
    let turn = turn.json();
    assert!((number(&turn["stroke_m"]) - 0.09).abs() < 1e-15);
    assert!((number(&turn["time_ratio"]) - 1.2).abs() < 1e-14);
}

#[test]
fn in_line_mechanisms_need_a_rod() {
    let folder = Folder::new();
    let wanted = ["--stroke", "90 mm", "--time-ratio", "1"];
    run(&folder, &wanted).fails(2, &["0.045 m", "--rod-ratio"]);
    let found = run(
        &folder,
        &[&wanted[..], &["--rod-ratio", "3.5", "--json"]].concat(),
    );
    assert_eq!(lengths(&found.done().json()), [0.045, 0.1575, 0.0]);
    let short = [&wanted[..], &["--rod", "45 mm"]].concat();
    run(&folder, &short).fails(2, &["rod 0.045", "above 0.045"]);
}

#[test]
fn what_no_mechanism_has_is_refused_with_what_there_is() {
    let folder = Folder::new();
    for (ratio, more, words) in [
        ("3", &[][..], &["time ratio of 3", "between 1/3 and 3"][..]),
        ("0", &[], &["between 1/3 and 3"]),
        ("nan", &[], &["between 1/3 and 3"]),
        ("1.2", &["--rod", "40 mm"], &["rod 0.04", "above 0.045"]),
        (
            "1.2",
            &["--crank", "45 mm"],
            &["crank 0.045", "below 0.045"],
        ),
        ("1.2", &["--rod-ratio", "1"], &["rod ratio 1", "above 1 "]),
        ("1.2", &["--crank", "4 N"], &["`N` is not the unit"]),
        (
            "1.2",
            &["--crank", "4 mm", "--rod", "9 mm"],
            &["cannot be used with"],
        ),
    ] {
        let wanted = ["--stroke", "90 mm", "--time-ratio", ratio];
        run(&folder, &[&wanted[..], more].concat()).fails(2, words);
    }
}
