//! `optimise`: the best design between bounds, subject to limits.

use std::f64::consts::{FRAC_PI_4, PI};

use serde_json::Value;

use super::program::{Folder, outcome};

const SCENE: &str = "# A shaper\n[geometry]\ncrank = \"140 mm\" # kept\nrod = \"310 mm\" # changed\n\
[motion]\nkind = \"constant-speed\"\nspeed = \"10 rad/s\"\n";

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Returns the minimum of a unimodal function by ternary search.
fn least(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let third = (high - low) / 3.0;
        match f(low + third) < f(high - third) {
            true => high -= third,
            false => low += third,
        }
    }
    f(0.5 * (low + high))
}

/// Trade-off between the transmission angle and an offset that speeds up the return. On the limit e = l cos 45 deg - r,
/// the time ratio is (pi + a)/(pi - a) with a = asin(e/(l - r)) - asin(e/(l + r)) from the triangles of the dead
/// centres.
#[test]
fn the_fastest_return_is_on_the_limit_of_the_transmission_angle() {
    let folder = Folder::with(SCENE);
    let found = folder.run(&[
        "optimise",
        "scene.toml",
        "--vary",
        "geometry.offset=0mm:150mm",
        "--vary",
        "geometry.rod=250mm:600mm",
        "--most",
        "time_ratio",
        "--subject",
        "transmission_min >= 45 deg",
        "--best",
        "best.toml",
        "--out",
        "searches.csv",
        "--json",
    ]);
    let found = found.done().json();
    let crank = 0.14;
    let ratio = |rod: f64| {
        let offset = rod * FRAC_PI_4.cos() - crank;
        let angle = (offset / (rod - crank)).asin() - (offset / (rod + crank)).asin();
        (PI + angle) / (PI - angle)
    };
    let most = -least(0.25, 0.6, |rod| -ratio(rod));
    let value = number(&found["value"]);
    assert!((value - most).abs() < 1e-8 * most, "{value} for {most}");
    assert_eq!(found["meets_subjects"], true);
    assert_eq!(found["subjects"][0]["is_active"], true);
    assert!(number(&found["subjects"][0]["value"]) >= FRAC_PI_4);
    assert_eq!(found["proof"]["is_complete"], true);
    assert_eq!(found["values"][0]["at_bound"], Value::Null);

    let best = folder.read("best.toml");
    let kept: Vec<_> = best.lines().filter(|line| SCENE.contains(line)).collect();
    assert_eq!(kept.len(), SCENE.lines().count() - 1, "{best}");
    assert!(best.contains(" # changed") && best.contains("offset = "));
    let turn = folder.run(&["kinematics", "best.toml", "--json"]).done();
    assert_eq!(number(&turn.json()["time_ratio"]), value);

    let searches = folder.read("searches.csv");
    let mut rows = csv::Reader::from_reader(searches.as_bytes());
    let header = rows.headers().expect("a header").clone();
    assert_eq!(header.get(2), Some("start_geometry_rod_m"));
    assert_eq!(header.get(5), Some("time_ratio"));
    let ends = rows.records().map(|row| row.expect("a row")[5].parse());
    let ends: Vec<f64> = ends.collect::<Result<_, _>>().expect("numbers");
    assert!(!ends.is_empty() && ends.iter().all(|end| *end <= value));
}

/// The acceleration has two equal maxima for short rods and one for long rods, so that the minimum of the maximum is at
/// the transition. Without offset, x'' = - r (cos theta + l' cos 2 theta + ...) is computed from differences of x.
#[test]
fn a_least_of_a_largest_is_found_at_its_edge() {
    let folder = Folder::with(SCENE);
    let vary = "geometry.rod=260mm:900mm";
    let arguments = ["optimise", "scene.toml", "--vary", vary];
    let goal = ["--least", "acceleration_max", "--json"];
    let found = folder.run(&[&arguments[..], &goal].concat()).done().json();
    let x = |rod: f64, theta: f64| {
        let (sin, cos) = theta.sin_cos();
        0.14 * cos + (rod * rod - (0.14 * sin).powi(2)).sqrt()
    };
    let largest = |rod: f64| {
        let second = |theta: f64| {
            let h = 1e-4;
            100.0 * (x(rod, theta + h) - 2.0 * x(rod, theta) + x(rod, theta - h)) / (h * h)
        };
        let thetas = (0..=2000).map(|i| PI * f64::from(i) / 2000.0);
        thetas.map(second).fold(f64::MIN, f64::max)
    };
    let rods = (0..=640).map(|i| 0.26 + 1e-3 * f64::from(i));
    let all = rods.map(largest).fold(f64::MAX, f64::min);
    let (value, rod) = (
        number(&found["value"]),
        number(&found["values"][0]["value"]),
    );
    assert!(value < all * (1.0 + 1e-5), "{value} for {all}");
    assert!((largest(rod) - value).abs() < 1e-5 * value);
}

#[test]
fn the_same_search_gives_the_same_whatever_the_number_of_threads() {
    let folder = Folder::with(SCENE);
    let arguments = [
        "optimise",
        "scene.toml",
        "--vary",
        "geometry.crank=50mm:200mm",
        "--vary",
        "geometry.offset=-100mm:100mm",
        "--least",
        "velocity_max",
        "--subject",
        "stroke >= 200 mm",
        "--subject",
        "time_ratio<=1.1",
        "--json",
    ];
    let [one, two] = ["1", "2"].map(|threads| {
        let mut command = folder.command(&arguments);
        outcome(command.env("RAYON_NUM_THREADS", threads))
            .done()
            .stdout
    });
    assert!(one.contains("\"is_complete\": true"), "{one}");
    assert_eq!(one, two);
}

#[test]
fn limits_that_no_design_keeps_are_said_with_the_one_that_misses_them_least() {
    let folder = Folder::with(SCENE);
    let vary = "geometry.rod=300mm:600mm";
    let arguments = ["optimise", "scene.toml", "--vary", vary];
    let goal = [
        "--least",
        "velocity_max",
        "--subject",
        "transmission_min >= 80 deg",
    ];
    let run = folder.run(&[&arguments[..], &goal].concat());
    let run = run.complains(1, &["no design was found that keeps all limits"]);
    assert!(run.stdout.contains("missed"), "{}", run.stdout);
    // The longest rod has the smallest swing.
    assert!(
        run.stdout.contains("0.6 m, the high bound"),
        "{}",
        run.stdout
    );
    // acos(140/600)
    let angle = (0.14_f64 / 0.6).acos().to_degrees();
    assert!(
        run.stdout.contains(&format!("{angle:.4}")),
        "{}",
        run.stdout
    );
}

#[test]
fn what_cannot_be_looked_for_is_refused_with_what_can() {
    let folder = Folder::with(SCENE);
    let rod = "geometry.rod=300mm:600mm";
    let subject = |limit| vec!["--vary", rod, "--least", "stroke", "--subject", limit];
    for (more, words) in [
        (
            vec!["--vary", "geometry.rod=1mm,2mm", "--least", "stroke"],
            vec!["geometry.rod = 1mm,2mm", "geometry.rod=100mm:200mm"],
        ),
        (
            vec!["--vary", "geometry.rod=1mm:2mm", "--least", "time_ratio"],
            vec!["none of 64 designs"],
        ),
        (
            vec!["--vary", rod, "--least", "class"],
            vec!["`class` is a word"],
        ),
        (subject("class >= 1"), vec!["`class` is a word"]),
        (
            vec!["--vary", rod, "--least", "fluctuation", "--fluctuation=nan"],
            vec!["a coefficient of fluctuation of NaN"],
        ),
        (
            vec!["--vary", rod, "--least", "omega"],
            vec!["give the scene a [run]"],
        ),
        (
            vec!["--vary", rod],
            vec!["--least <FIGURE>|--most <FIGURE>"],
        ),
        (
            subject("stroke = 1 m"),
            vec!["no limit of a figure", "transmission_min >= 40 deg"],
        ),
        (
            subject("stroke <= 1 N"),
            vec!["`N` is not the unit of a length"],
        ),
        (
            vec!["--vary", rod, "--least", "stroke", "--best", "scene.toml"],
            vec!["would be overwritten"],
        ),
    ] {
        let run = folder.run(&[&["optimise", "scene.toml"], &more[..]].concat());
        run.fails(2, &words);
    }
    assert_eq!(folder.names(), ["scene.toml"]);
}

#[test]
fn a_motion_is_searched_as_far_as_its_error_tells_designs_apart() {
    let run = "[slider]\nmass = \"1 kg\"\n[crank]\ninertia = \"0.02 kg m^2\"\n[run]\nduration = \"0.5 s\"\n";
    let scene = SCENE.replace("kind = \"constant-speed\"\n", "") + run;
    let folder = Folder::with(&scene);
    let vary = "crank.inertia=0.02kg*m^2:0.2kg*m^2";
    let arguments = ["optimise", "scene.toml", "--vary", vary];
    let found = folder.run(&[&arguments[..], &["--most", "omega_min", "--json"]].concat());
    let found = found.done().json();
    // The heaviest crank is the steadiest; from a dead centre, where the slider is at rest, the motion slows down.
    assert_eq!(found["values"][0]["at_bound"], "high");
    // In half a turn the energy reaches at most (I + m r^2) w^2, where the slider is as fast as the pin, times rod
    // effects below a tenth.
    assert!(
        number(&found["value"]) > 10.0 * (0.2 / 0.225_f64).sqrt() && number(&found["value"]) < 10.0
    );
    let resolution = number(&found["resolution"]);
    assert!(resolution > 0.0 && resolution < 1e-6, "{resolution}");
    for (figure, words) in [
        ("omega_min", "work limit of evaluations is reached"),
        ("fluctuation", "within the work limit of 1 evaluations"),
    ] {
        let limited = ["--most", figure, "--max-evaluations", "1"];
        let limited = folder.run(&[&arguments[..], &limited].concat());
        limited.fails(1, &["none of 64 designs", words]);
    }
}
