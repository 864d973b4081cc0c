//! `simulate --steady-state`: a run that starts in the periodic motion.

use std::f64::consts::TAU;

use super::program::{Folder, PUMP, Rows, close, driven, free};

const LOADS: &str = "\n[[torque]]\nkind = \"motor\"\nstall = \"6 N m\"\nno_load_speed = \"100 rad/s\"\n\
    \n[[force]]\nkind = \"viscous\"\ncoefficient = \"15 N s/m\"\n";

fn scene(rest: &str) -> String {
    format!("{PUMP}{LOADS}\n[motion]\nangle = \"25 deg\"\nspeed = \"10 rad/s\"\n{rest}")
}

#[test]
fn a_run_without_an_extent_is_one_period() {
    let folder = Folder::new();
    folder.write("scene.toml", &scene(""));
    let options = ["--steady-state", "--out", "rows.csv", "--json"];
    let json = folder
        .run(&[&["simulate", "scene.toml"][..], &options].concat())
        .done()
        .json();
    let steady = &json["steady_state"];
    let value = |key: &str| steady[key]["value"].as_f64().unwrap();
    let rows = Rows::read(&folder.read("rows.csv"));
    let omega = rows.column("omega_rad_per_s");
    close(omega[0], value("omega_rad_per_s"), 1e-12);
    close(omega[omega.len() - 1], omega[0], 1e-10);
    close(rows.column("t_s")[rows.len() - 1], value("period_s"), 1e-10);
    close(
        value("period_s"),
        TAU / value("omega_mean_rad_per_s"),
        1e-14,
    );
    assert!(steady.get("flywheel").is_none());
    assert_eq!(json["revolutions"].as_f64().unwrap().round(), 1.0);
}

#[test]
fn the_flywheel_comes_with_the_fluctuation() {
    let folder = Folder::new();
    folder.write("scene.toml", &scene("\n[run]\nduration = \"0.5 s\"\n"));
    let options = ["--steady-state", "--fluctuation", "0.01"];
    let arguments = [&["simulate", "scene.toml"][..], &options].concat();
    let text = folder.run(&arguments).done().stdout;
    for word in ["steady state", "fluctuation", "to be added to the crank"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    let json = folder
        .run(&[&arguments[..], &["--json"]].concat())
        .done()
        .json();
    close(json["final"]["t_s"].as_f64().unwrap(), 0.5, 1e-15);
    let wheel = &json["steady_state"]["flywheel"];
    close(wheel["fluctuation"]["value"].as_f64().unwrap(), 0.01, 1e-9);
}

#[test]
fn a_plain_run_says_nothing_of_it() {
    let folder = Folder::new();
    let json = folder.run(&["simulate", "--json"]).done().json();
    assert!(json.get("steady_state").is_none());
}

#[test]
fn what_has_none_is_refused_and_nothing_is_written() {
    let folder = Folder::new();
    folder.write("driven.toml", &driven("duration = \"1 s\""));
    let arguments = [
        "simulate",
        "driven.toml",
        "--steady-state",
        "--out",
        "rows.csv",
    ];
    folder.run(&arguments).fails(2, &["prescribes"]);
    let load = "[[torque]]\nkind = \"expression\"\nvalue = \"2 - 0.1*theta\"\n";
    folder.write(
        "driven.toml",
        &format!("{load}{}", free("duration = \"1 s\"")),
    );
    let words = ["does not repeat", "theta stands outside of sin"];
    let outcome = folder.run(&arguments).fails(2, &words);
    assert!(!outcome.stderr.contains("--method"), "{outcome:?}");
    assert!(!folder.path("rows.csv").exists());
    folder
        .run(&["simulate", "--fluctuation", "0.02"])
        .fails(2, &["--steady-state"]);
    folder
        .run(&["simulate", "--steady-state", "--fluctuation", "x"])
        .fails(2, &["x"]);
}

/// A torque of this slope takes thousands of evaluations a cycle: the limit is one of the search, not of each cycle.
#[test]
fn a_search_ends_at_its_work_limit_and_says_so() {
    let folder = Folder::new();
    let load = "[[torque]]\nkind = \"expression\"\nvalue = \"-1e6*(omega - 1)\"\n";
    folder.write(
        "scene.toml",
        &format!("{load}{}", free("duration = \"1 s\"")),
    );
    for limit in ["10000", "100000"] {
        folder
            .run(&[
                "simulate",
                "scene.toml",
                "--steady-state",
                "--max-evaluations",
                limit,
            ])
            .fails(
                1,
                &["no steady state", &format!("limit of {limit} evaluations")],
            );
    }
}

/// Four-stroke engine: cycle, steady state and flywheel, alone and in a sweep.
#[test]
fn cycles_of_two_turns() {
    let folder = Folder::new();
    let engine = concat!(env!("CARGO_MANIFEST_DIR"), "/data/four-stroke.toml");
    let explained = folder.run(&["explain", engine]).done().stdout;
    for words in [
        "cycle of the loads     2 turns",
        "repeats after 2 turns",
        "repeats at every angle",
    ] {
        assert!(explained.contains(words), "{words}: {explained}");
    }
    let json = folder.run(&["explain", engine, "--json"]).done().json();
    assert_eq!(json["plan"]["cycle"]["turns"], 2);
    let shown = folder
        .run(&["simulate", engine, "--steady-state"])
        .done()
        .stdout;
    assert!(
        shown.contains("(2 turns)") && shown.contains("left after a cycle"),
        "{shown}"
    );
    let sweep = [
        "sweep",
        engine,
        "--vary",
        "crank.inertia=0.1kg m^2,0.2kg m^2",
        "--no-motion",
        "--steady-state",
        "--fluctuation",
        "0.02",
        "--out",
        "designs.csv",
    ];
    folder.run(&sweep).done();
    let mut rows = csv::Reader::from_path(folder.path("designs.csv")).unwrap();
    let names = rows.headers().unwrap().clone();
    let column = |name: &str| names.iter().position(|other| other == name).unwrap();
    let [turns, fluctuation, wheel] =
        ["cycle_turns", "fluctuation", "flywheel_added_inertia_kg_m2"].map(column);
    let rows: Vec<_> = rows.records().map(Result::unwrap).collect();
    let number = |row: usize, column: usize| rows[row][column].parse::<f64>().unwrap();
    assert_eq!([number(0, turns), number(1, turns)], [2.0, 2.0]);
    assert!((number(0, fluctuation) / 0.151_378_592_1 - 1.0).abs() < 1e-8);
    // The flywheel is reduced by the inertia that the crank already has.
    assert!((number(0, wheel) - number(1, wheel) - 0.1).abs() < 1e-9);
}
