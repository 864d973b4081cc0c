//! Pictures: chosen columns over a chosen column, with true peaks and poles.

use super::program::{Folder, driven, free};

const GOOD: &str = "duration = \"0.1 s\"";

/// Returns the coordinates of a picture's lines of one colour.
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

/// Impacts are shorter than the row interval: 45.9 kN in the summary, 31 kN at the rows.
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
    assert!(folder.read("x.svg").contains(">45000<"));
}

/// The force that balances a torque has a pole at each dead centre, with opposite signs on its two sides.
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

/// For a guide through the pivot, the pose follows from the triangle of crank, rod and guide.
#[test]
fn a_linkage_is_drawn_in_millimetres() {
    let folder = Folder::with("[geometry]\ncrank = \"30 mm\"\nrod = \"50 mm\"\n");
    let at = ["--at", "90 deg", "--out", "linkage.dxf"];
    folder
        .run(&[&["animate", "scene.toml"][..], &at].concat())
        .done();
    let dxf = folder.read("linkage.dxf");
    let lines: Vec<&str> = dxf.lines().collect();
    assert_eq!(lines.len() % 2, 0, "codes and values");
    assert!(dxf.ends_with("0\nENDSEC\n0\nEOF\n"));
    let rod = lines
        .windows(2)
        .position(|pair| pair == ["8", "ROD"])
        .expect("the rod");
    let value = |code: &str| -> f64 {
        let pairs = lines[rod..].chunks(2);
        let mut found = pairs.filter(|pair| pair[0] == code).map(|pair| pair[1]);
        found.next().expect("a value").parse().expect("a number")
    };
    let ends = ["10", "20", "11", "21"].map(value);
    for (found, expected) in ends.iter().zip([0.0, 30.0, 40.0, 0.0]) {
        assert!((found - expected).abs() < 1e-12, "{ends:?}");
    }
    let picture = [
        "animate",
        "scene.toml",
        "--at",
        "90 deg",
        "--out",
        "linkage.png",
    ];
    folder.run(&picture).done();
    let beyond = ["animate", "scene.toml", "--out", "linkage.txt"];
    folder.run(&beyond).fails(2, &["linkage.txt"]);
}

#[test]
fn a_motion_is_animated() {
    let folder = Folder::with(&free(GOOD));
    let motion = ["animate", "scene.toml", "--frames", "5", "--seconds", "1"];
    folder
        .run(&[&motion[..], &["--out", "motion.gif"]].concat())
        .done();
    let gif = std::fs::read(folder.path("motion.gif")).expect("a file");
    assert!(gif.starts_with(b"GIF89a") && gif.ends_with(&[0x3b]));
    // A graphic control extension precedes each frame; its delay is 20 hundredths of a second.
    let control = [0x21, 0xf9, 0x04];
    let frames: Vec<_> = gif
        .windows(6)
        .filter(|part| part.starts_with(&control))
        .collect();
    assert_eq!(frames.len(), 5);
    assert!(frames.iter().all(|frame| frame[4] == 20), "{frames:?}");
    let both = ["animate", "scene.toml", "--at", "1 deg", "--out", "x.gif"];
    folder.run(&both).fails(2, &["--at"]);
}

/// Uniform motions at 30 and 33 rad/s separate at 3 rad/s.
#[test]
fn motions_are_compared() {
    let folder = Folder::with(&driven("duration = \"0.1 s\""));
    let other = folder.read("scene.toml");
    let speed = other
        .lines()
        .find(|line| line.starts_with("speed"))
        .expect("a speed");
    let faster = other.replace(speed, "speed = \"33 rad/s\"");
    let slower = other.replace(speed, "speed = \"30 rad/s\"");
    std::fs::write(folder.path("fast.toml"), faster).expect("a file");
    std::fs::write(folder.path("slow.toml"), slower).expect("a file");
    folder
        .run(&["simulate", "slow.toml", "--out", "slow.csv"])
        .done();
    for first in ["slow.toml", "slow.csv"] {
        let compare = [
            "compare",
            first,
            "fast.toml",
            "--json",
            "--out",
            "both.csv",
            "--plot",
            "x.svg",
        ];
        let found = folder.run(&compare).json();
        let differences = found["differences"].as_array().expect("a list");
        let theta = differences
            .iter()
            .find(|one| one["column"] == "theta_rad")
            .expect("theta");
        let largest = theta["largest"].as_f64().expect("a number");
        assert!((largest - 0.3).abs() < 1e-12, "{theta}");
        assert!((theta["at_s"].as_f64().expect("a time") - 0.1).abs() < 1e-12);
        let rows = folder.read("both.csv");
        assert!(rows.starts_with("t_s,theta_of_1_rad,theta_of_2_rad,theta_difference_2_rad,"));
        assert!(folder.read("x.svg").contains("crank angle θ, motion 2"));
    }
    folder.run(&["compare", "slow.toml"]).fails(2, &["2"]);
}

#[test]
fn times_that_motions_do_not_share_are_told() {
    let folder = Folder::new();
    for (name, duration) in [("long.toml", "1 s"), ("short.toml", "0.6 s")] {
        let run = format!("duration = \"{duration}\"\noutput_every = \"0.25 s\"");
        folder.write(name, &driven(&run));
    }
    let compare = ["compare", "long.toml", "short.toml"];
    let words = "at 3 of the 5 times of motion 1, t = 0 to 0.5 s";
    let text = folder.run(&compare).done().stdout;
    let line = text.lines().find(|line| line.starts_with("compared "));
    assert!(line.is_some_and(|line| line.ends_with(words)), "{text}");
    let found = folder.run(&[&compare[..], &["--json"]].concat()).json();
    assert_eq!(found["rows"], 3);
    let warning = found["warnings"][0].as_str().expect("a warning");
    assert_eq!(warning, format!("short.toml is compared only {words}"));
    let compare = ["compare", "short.toml", "long.toml", "--json"];
    let found = folder.run(&compare).done().json();
    assert_eq!(
        (&found["rows"], found["warnings"].as_array()),
        (&4.into(), Some(&vec![]))
    );
}

#[test]
fn ends_and_warnings_of_runs_are_told_by_what_shows_their_motions() {
    let folder = Folder::new();
    let hard = |name| format!("{}/data/hard/{name}", env!("CARGO_MANIFEST_DIR"));
    let [jams, changes] = ["09-jamming.toml", "02-change-point.toml"].map(hard);
    let compare = ["compare", &jams, &changes, "--json"];
    let outcome = folder
        .run(&compare)
        .complains(1, &["09-jamming.toml", "the slider jams"]);
    let warnings = outcome.json()["warnings"].to_string();
    for words in [
        "the slider jams",
        "02-change-point.toml: the lengths make a change point",
    ] {
        assert!(warnings.contains(words), "{warnings}");
    }
    let animate = |scene| ["animate", scene, "--frames", "2", "--out", "motion.gif"];
    folder
        .run(&animate(&jams))
        .complains(1, &["the slider jams"]);
    let outcome = folder.run(&animate(&changes));
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(
        outcome
            .stderr
            .contains("warning: the lengths make a change point"),
        "{outcome:?}"
    );
}

/// The motion of a scene against its own angle in degrees of a turn, as an encoder shows it.
#[test]
fn a_measured_angle_is_compared_over_the_turns() {
    let folder = Folder::with(&free("duration = \"1 s\"\noutput_every = \"1 ms\""));
    let (_, rows) = folder.simulated(&[]);
    let mut measured = "t [s],theta [deg]\n".to_owned();
    for (t, theta) in rows.column("t_s").iter().zip(rows.column("theta_rad")) {
        measured += &format!("{t},{}\n", theta.to_degrees().rem_euclid(360.0));
    }
    folder.write("measured.csv", &measured);
    let text = folder
        .run(&["compare", "scene.toml", "measured.csv"])
        .done()
        .stdout;
    let line = text
        .lines()
        .find(|line| line.contains("differs by at most"));
    let line = line.unwrap_or_else(|| panic!("{text}"));
    let after = line.split("at most ").nth(1).expect("a size");
    let size: f64 = after
        .split(' ')
        .next()
        .expect("a number")
        .parse()
        .expect("a number");
    assert!(size < 1e-6, "{line}");
}
