//! `sweep --sample`, `--least`, `--merge`: random designs, the best of them, and merged parts.

use serde_json::Value;

use super::program::{Folder, at};

const SCENE: &str = "[geometry]\ncrank = \"50 +- 0.1 mm\"\nrod = \"150 +- 0.2 mm\"\noffset = \"10 mm\"\n\
[crank]\ninertia = \"0.02 kg m^2\"\n[slider]\nmass = \"0.6 kg\"\n\
[motion]\nspeed = \"20 rad/s\"\n[run]\nduration = \"0.1 s\"\n";

/// Columns of a file of rows, by name.
struct Rows(Vec<(String, Vec<Option<f64>>)>);

impl Rows {
    fn read(text: &str) -> Rows {
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names = reader.headers().expect("a header").clone();
        let mut columns: Vec<_> = names
            .iter()
            .map(|name| (name.to_owned(), Vec::new()))
            .collect();
        for row in reader.records() {
            for (cell, (_, column)) in row.expect("a row").iter().zip(&mut columns) {
                column.push(cell.parse().ok());
            }
        }
        Rows(columns)
    }

    #[track_caller]
    fn numbers(&self, name: &str) -> Vec<f64> {
        let column = self.0.iter().find(|(known, _)| known == name);
        let (_, column) = column.unwrap_or_else(|| panic!("no column {name}"));
        column.iter().map(|cell| cell.expect("a number")).collect()
    }

    fn names(&self) -> Vec<&str> {
        self.0.iter().map(|(name, _)| name.as_str()).collect()
    }
}

/// Returns the range of a figure from a summary.
#[track_caller]
fn figure<'a>(summary: &'a Value, column: &str) -> &'a Value {
    let figures = summary["figures"].as_array().expect("figures");
    let found = figures.iter().find(|figure| figure["column"] == column);
    found.unwrap_or_else(|| panic!("no {column} in {summary}"))
}

fn stroke(crank: f64, rod: f64, offset: f64) -> f64 {
    let side = |reach: f64| (reach * reach - offset * offset).sqrt();
    side(rod + crank) - side(rod - crank)
}

#[test]
fn the_tolerances_of_a_scene_are_sampled_and_their_effect_is_the_propagated_one() {
    let folder = Folder::with(SCENE);
    let arguments = [
        "sweep",
        "scene.toml",
        "--sample",
        "1000",
        "--figures",
        "stroke,time_ratio",
    ];
    let summary = folder.run(&[&arguments[..], &["--out", "rows.csv", "--json"]].concat());
    let summary = summary.done().json();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert_eq!(
        rows.names(),
        [
            "design",
            "geometry_crank_m",
            "geometry_rod_m",
            "status",
            "stroke_m",
            "time_ratio",
            "notes"
        ]
    );
    let (cranks, rods) = (
        rows.numbers("geometry_crank_m"),
        rows.numbers("geometry_rod_m"),
    );
    let strokes = rows.numbers("stroke_m");
    assert_eq!(strokes.len(), 1000);
    for ((crank, rod), found) in cranks.iter().zip(&rods).zip(&strokes) {
        let wanted = stroke(*crank, *rod, 0.01);
        assert!((found - wanted).abs() < 1e-15, "{found}, {wanted}");
    }
    // First-order error propagation; the stratified sample's own scatter is far below 1 %.
    let (dr, dl) = (
        (stroke(0.0501, 0.15, 0.01) - stroke(0.0499, 0.15, 0.01)) / 2.0,
        (stroke(0.05, 0.1502, 0.01) - stroke(0.05, 0.1498, 0.01)) / 2.0,
    );
    let (mean, deviation) = (stroke(0.05, 0.15, 0.01), dr.hypot(dl));
    let spread = &figure(&summary, "stroke_m")["spread"];
    assert!((at(spread, "mean") - mean).abs() < 0.01 * deviation);
    assert!((at(spread, "standard_deviation") / deviation - 1.0).abs() < 0.01);
    for (name, deviations) in [("p2_5", -1.959964), ("p50", 0.0), ("p97_5", 1.959964)] {
        let off = (at(spread, name) - mean) / deviation - deviations;
        assert!(off.abs() < 0.1, "{name} is {off} deviations off");
    }
}

#[test]
fn every_part_of_a_range_has_one_design_and_keys_are_independent() {
    let folder = Folder::with(SCENE);
    let drawn = |seed: &str| {
        let vary = [
            "--vary",
            "geometry.offset=0mm:20mm",
            "--vary",
            "crank.mass=1kg,2kg,3kg,4kg",
        ];
        let more = [
            "--sample",
            "400",
            "--figures",
            "stroke",
            "--out",
            "-",
            "--seed",
            seed,
        ];
        let text = folder.run(&[&["sweep", "scene.toml"], &vary[..], &more[..]].concat());
        let rows = Rows::read(&text.stdout);
        [
            rows.numbers("geometry_offset_m"),
            rows.numbers("crank_mass_kg"),
        ]
    };
    let [offsets, masses] = drawn("7");
    let mut parts: Vec<usize> = offsets
        .iter()
        .map(|e| (e / 0.02 * 400.0) as usize)
        .collect();
    assert!(parts.windows(2).any(|pair| pair[1] < pair[0]), "in order");
    parts.sort_unstable();
    assert_eq!(parts, (0..400).collect::<Vec<_>>());
    for mass in [1.0, 2.0, 3.0, 4.0] {
        let of: Vec<f64> = masses
            .iter()
            .zip(&offsets)
            .filter(|(m, _)| **m == mass)
            .map(|(_, e)| *e)
            .collect();
        assert_eq!(of.len(), 100);
        // Four standard deviations of the mean of 100 uniform values.
        let mean = of.iter().sum::<f64>() / 100.0;
        assert!((mean - 0.01).abs() < 4.0 * 0.02 / 1200f64.sqrt(), "{mean}");
    }
    assert_eq!(drawn("7"), [offsets.clone(), masses]);
    assert_ne!(drawn("8")[0], offsets);
}

#[test]
fn parts_of_a_sample_merge_into_the_whole() {
    let folder = Folder::with(SCENE);
    let sweep = |more: &[&str]| {
        let sample = [
            "sweep",
            "scene.toml",
            "--sample",
            "50",
            "--figures",
            "stroke,guide_peak",
        ];
        folder.run(&[&sample[..], more].concat()).done()
    };
    let whole = sweep(&["--out", "whole.csv", "--json"]).json();
    for part in ["1/3", "2/3", "3/3"] {
        sweep(&[
            "--shard",
            part,
            "--out",
            &format!("part-{}.csv", &part[..1]),
        ]);
    }
    let merge = ["sweep", "--merge", "part-3.csv", "part-1.csv", "part-2.csv"];
    let more = ["--out", "merged.csv", "--percentiles", "--json"];
    let merged = folder.run(&[&merge[..], &more].concat()).done().json();
    assert_eq!(folder.read("merged.csv"), folder.read("whole.csv"));
    for of in ["figures", "status", "designs"] {
        assert_eq!(merged[of], whole[of]);
    }
    for (parts, words) in [
        (
            &["part-1.csv", "part-3.csv"][..],
            &["design 17 is missing", "part-3.csv"][..],
        ),
        (
            &["part-1.csv", "part-2.csv", "part-2.csv"],
            &["twice", "part-2.csv"],
        ),
        (&["part-2.csv", "part-3.csv"], &["status", "first part"]),
        (&["part-1.csv", "scene.toml"], &["scene.toml", "[geometry]"]),
        (&["part-1.csv", "none.csv"], &["none.csv"]),
    ] {
        let arguments = [&["sweep", "--out", "new.csv", "--merge"], parts].concat();
        folder.run(&arguments).fails(2, words);
        assert!(!folder.path("new.csv").exists());
    }
}

#[test]
fn no_design_is_better_than_one_of_the_pareto_front() {
    let folder = Folder::with(SCENE);
    let vary = [
        "--vary",
        "geometry.offset=0mm:60mm:13",
        "--vary",
        "geometry.rod=120mm:200mm:9",
    ];
    let goals = [
        "--most",
        "time_ratio",
        "--most",
        "transmission_min",
        "--least",
        "stroke",
    ];
    let sweep = [
        &["sweep", "scene.toml"],
        &vary[..],
        &goals,
        &["--figures", "class"],
    ]
    .concat();
    let summary = folder.run(&[&sweep[..], &["--out", "rows.csv", "--json"]].concat());
    let summary = summary.done().json();
    let rows = Rows::read(&folder.read("rows.csv"));
    let columns = [
        ("time_ratio", -1.0),
        ("transmission_min_rad", -1.0),
        ("stroke_m", 1.0),
    ];
    let values = columns.map(|(name, sign)| {
        rows.numbers(name)
            .into_iter()
            .map(|v| sign * v)
            .collect::<Vec<_>>()
    });
    let beats = |one: usize, other: usize| {
        values.iter().all(|of| of[one] <= of[other]) && values.iter().any(|of| of[one] < of[other])
    };
    let count = values[0].len();
    let wanted: Vec<usize> = (0..count)
        .filter(|one| !(0..count).any(|other| beats(other, *one)))
        .map(|one| one + 1)
        .collect();
    let front = summary["pareto_front"].as_array().expect("a front");
    let mut found: Vec<usize> = front.iter().map(|one| at(one, "design") as usize).collect();
    found.sort_unstable();
    assert_eq!(found, wanted);
    assert!(wanted.len() > 1 && wanted.len() < count);
    for one in front {
        let row = at(one, "design") as usize - 1;
        // The JSON reader is accurate to one unit in the last place.
        let off = at(one, "figures.stroke_m") - values[2][row];
        assert!(off.abs() <= 4e-16 * values[2][row]);
    }
}

#[test]
fn figures_that_cannot_be_are_refused() {
    let folder = Folder::with(SCENE);
    let vary = ["--vary", "geometry.offset=0mm:10mm:2"];
    for (more, words) in [
        (&["--figures", "strok"][..], &["strok", "`stroke`"][..]),
        (&["--figures", "xyz"], &["xyz", "time_ratio"]),
        (&["--figures", "flywheel_added_inertia"], &["--fluctuation"]),
        (&["--least", "guide_peak"], &["guide_peak_n", "--figures"]),
        (&["--sample", "0"], &["--sample"]),
    ] {
        folder
            .run(&[&["sweep", "scene.toml"], &vary[..], more].concat())
            .fails(2, words);
    }
    folder.write(
        "still.toml",
        &SCENE.replace("[run]\nduration = \"0.1 s\"\n", ""),
    );
    let still = [&["sweep", "still.toml"], &vary[..], &["--figures", "omega"]].concat();
    folder.run(&still).fails(2, &["[run]"]);
}

#[test]
fn diagrams_are_those_of_the_scene_with_its_values_written_out() {
    let gas =
        "[[force]]\nkind = \"gas\"\nbore = \"80 mm\"\nfile = \"p.csv\"\nperiod = \"360 deg\"\n";
    let folder = Folder::with(&format!("{SCENE}{gas}"));
    folder.write(
        "p.csv",
        "theta [deg],pressure [bar]\n0,3\n90,5\n180,1\n270,1\n360,3\n",
    );
    let vary = ["--vary", "geometry.offset=10mm,5mm", "--out", "-"];
    let named = ["--figures", "indicated_work,turning_moment_fluctuation"];
    let text = folder.run(&[&["sweep", "scene.toml"], &vary[..], &named].concat());
    let rows = Rows::read(&text.stdout);
    let turn = folder.run(&["kinematics", "scene.toml", "--forces", "--json"]);
    let turn = turn.done().json();
    for (column, path) in [
        ("indicated_work_j", "diagrams.indicated.work_j"),
        (
            "turning_moment_fluctuation_j",
            "diagrams.turning_moment.fluctuation_j",
        ),
    ] {
        let (found, wanted) = (rows.numbers(column), at(&turn, path));
        assert!((found[0] - wanted).abs() <= 4e-16 * wanted.abs() && found[1] != found[0]);
    }
}
