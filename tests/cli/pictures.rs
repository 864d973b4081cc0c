//! What pictures show: chosen columns over a chosen column, peaks and poles as they are.

use super::program::{Folder, free};

const GOOD: &str = "duration = \"0.1 s\"";

/// Coordinates of the lines of a picture in a colour.
fn lines(svg: &str, colour: &str) -> Vec<Vec<(f64, f64)>> {
    let lines = svg.split("<polyline").skip(1);
    let of_colour = lines.filter(|line| line.contains(&format!("stroke=\"{colour}\"")));
    let points = |line: &str| {
        let points = line.split("points=\"").nth(1).expect("points");
        let points = points.split('"').next().expect("an end").split_whitespace();
        let number = |text: &str| text.parse::<f64>().expect("a number");
        points
            .filter_map(|point| point.split_once(','))
            .map(|(x, y)| (number(x), number(y)))
            .collect()
    };
    of_colour.map(points).collect()
}

#[test]
fn columns_are_chosen_by_their_names() {
    let folder = Folder::with(&free(GOOD));
    let plot = ["--reactions", "--plot", "x.svg", "--over", "theta"];
    let plot = [&["simulate", "scene.toml"][..], &plot].concat();
    let shown = ["--show", "x:cm,guide,energy,wrist_pin"];
    folder.run(&[&plot[..], &shown].concat()).done();
    let svg = folder.read("x.svg");
    for text in [
        "slider position x [cm]",
        "crank angle θ [°]",
        "forces [N]",
        "guide",
        "wrist pin x",
        "wrist pin y",
        "energies [J]",
        "whole energy",
    ] {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("slider velocity") && !svg.contains("time t"));
}

#[test]
fn what_is_no_column_is_refused_before_anything_is_written() {
    let folder = Folder::with(&free(GOOD));
    for (command, show, words) in [
        ("simulate", "guide", &["`guide`", "columns: t, theta"][..]),
        ("simulate", "x:kg", &["`kg`", "mm"]),
        ("kinematics", "nothing", &["`nothing`", "transmission"]),
        ("statics", "", &["names no column"]),
    ] {
        let outputs = ["--out", "rows.csv", "--plot", "x.svg", "--show", show];
        let arguments = [&[command, "scene.toml"][..], &outputs].concat();
        folder.run(&arguments).fails(2, words);
        assert_eq!(folder.names(), ["scene.toml"], "{command} {show}");
    }
    let two = [
        "simulate",
        "scene.toml",
        "--plot",
        "x.svg",
        "--over",
        "energy",
    ];
    folder.run(&two).fails(2, &["`energy`"]);
    let small = [
        "simulate",
        "scene.toml",
        "--plot",
        "x.svg",
        "--size",
        "40x20",
    ];
    folder
        .run(&small)
        .fails(2, &["too small for 4 panels", "at least"]);
    let wrong = ["simulate", "scene.toml", "--plot", "x.svg", "--size", "40"];
    folder.run(&wrong).fails(2, &["180x120"]);
}

/// Impacts are shorter than the time between rows: 45.9 kN in the summary, 31 kN at the rows.
#[test]
fn impacts_between_rows_are_drawn() {
    let folder = Folder::with("");
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/data/clearance-5000rpm.toml");
    let plot = ["--plot", "x.svg", "--show", "contact_force", "--json"];
    let summary = folder
        .run(&[&["simulate", scene][..], &plot].concat())
        .json();
    let peak = summary["clearance"]["force_peak_n"]
        .as_f64()
        .expect("a peak");
    assert!(peak > 45_000.0, "{peak}");
    assert!(
        folder
            .read("x.svg")
            .lines()
            .any(|line| line.trim() == "45000")
    );
}

/// The force that balances a torque has a pole at each dead centre, with other signs on either side.
#[test]
fn no_line_crosses_a_pole() {
    let folder = Folder::with(&free(GOOD));
    let plot = ["--plot", "x.svg", "--show", "slider_force"];
    let statics = ["statics", "scene.toml", "--torque", "1 N m"];
    folder.run(&[&statics[..], &plot].concat()).done();
    let svg = folder.read("x.svg");
    assert!(svg.contains("peaks cut off"));
    let lines = lines(&svg, "#0072B2");
    assert!(lines.len() >= 2, "{}", lines.len());
    let heights = |line: &[(f64, f64)]| {
        let all = line.iter().map(|(_, y)| *y);
        (
            all.clone().fold(f64::INFINITY, f64::min),
            all.fold(0.0, f64::max),
        )
    };
    let ends: Vec<_> = lines.iter().map(|line| heights(line)).collect();
    let top = ends
        .iter()
        .fold(f64::INFINITY, |top, (low, _)| top.min(*low));
    let bottom = ends
        .iter()
        .fold(0.0, |bottom: f64, (_, high)| bottom.max(*high));
    for (low, high) in ends {
        assert!(low > top || high < bottom, "{low} to {high} crosses");
    }
}
