//! Summary of `simulate`: its keys, and numbers known independently.

use std::f64::consts::PI;

use serde_json::Value;

use super::program::{
    Folder, PENDULUM, PUMP, WAYS, at, close, driven, free, free_ways, has_keys, keys,
};

/// Checks that no number in a JSON text is NaN or infinite: such values are `null`, which only these keys may be.
fn finite(value: &Value, path: &str) {
    let may_be_absent = [
        "estimate_cost",
        "error_estimate",
        "stepper",
        "max_step",
        "at",
    ];
    match value {
        Value::Null => {
            let key = path.rsplit('.').next().unwrap_or_default();
            assert!(may_be_absent.contains(&key), "{path} is null");
        }
        Value::Object(object) => object
            .iter()
            .for_each(|(key, value)| finite(value, &format!("{path}.{key}"))),
        Value::Array(list) => list.iter().for_each(|value| finite(value, path)),
        _ => (),
    }
}

fn sorted(object: &Value) -> Vec<&str> {
    let mut keys = keys(object);
    keys.sort();
    keys
}

#[test]
fn the_summary_has_every_key() {
    let losses = "[[torque]]\nkind = \"viscous\"\ncoefficient = \"1e-4 N m s/rad\"\n";
    let run = "duration = \"1 s\"";
    for (scene, engine) in [
        (format!("{}{losses}", free(run)), None),
        (free(run), None),
        (driven(run), Some("closed-form")),
    ] {
        let folder = Folder::with(&format!("title = \"A pump\"\n{scene}"));
        let summary = folder
            .run(&["simulate", "scene.toml", "--json"])
            .done()
            .json();
        let expected = [
            "scene",
            "engine",
            "plan",
            "final",
            "revolutions",
            "error_estimate",
            "energy_residual",
            "evaluations",
            "wall_s",
            "omega_min",
            "omega_max",
            "events",
            "warnings",
        ];
        has_keys(&summary, &expected);
        assert_eq!(summary["scene"], "A pump");
        assert_eq!(summary["engine"], summary["plan"]["engine"]);
        if let Some(engine) = engine {
            assert_eq!(summary["engine"], engine);
        }
        assert_eq!(
            sorted(&summary["final"]),
            ["omega_rad_per_s", "t_s", "theta_rad"]
        );
        assert_eq!(
            sorted(&summary["error_estimate"]),
            ["omega_rad_per_s", "theta_rad"]
        );
        let events = summary["events"].as_array().expect("a list");
        assert_eq!(events.len(), 3, "10 rad in all");
        for event in events {
            assert_eq!(
                sorted(event),
                ["kind", "omega_rad_per_s", "t_s", "theta_rad"]
            );
            assert_eq!(event["kind"], "dead-centre");
        }
        assert_eq!(summary["warnings"], Value::Array(Vec::new()));
        assert!(summary.get("stopped").is_none(), "the run was completed");
        assert!(at(&summary, "energy_residual").abs() < 1e-9);
        assert!(at(&summary, "wall_s") >= 0.0);
        assert_eq!(
            at(&summary, "evaluations") == 0.0,
            summary["engine"] == "closed-form"
        );
        finite(&summary, "summary");
    }
}

#[test]
fn the_summary_for_people_says_the_same() {
    let folder = Folder::with(&free("duration = \"1 s\""));
    let summary = folder
        .run(&["simulate", "scene.toml", "--json"])
        .done()
        .json();
    let text = folder.run(&["simulate", "scene.toml"]).done().stdout;
    for name in [
        "engine",
        "crank angle",
        "crank speed",
        "turns",
        "energy residual",
        "cost",
        "events",
    ] {
        assert!(text.contains(name), "no {name} in {text}");
    }
    let angle = format!("{:.12}", at(&summary, "final.theta_rad"));
    assert!(text.contains(&angle), "no {angle} in {text}");
    assert!(text.contains("3 dead centres, 0 turning points"), "{text}");
    assert!(
        text.contains("omega [rad/s]"),
        "a table of a few rows follows: {text}"
    );
    assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
}

#[test]
fn dead_centres_in_line_are_at_multiples_of_half_a_turn() {
    for way in WAYS {
        let (summary, _) = way.simulated("revolutions = 3");
        let events = summary["events"].as_array().expect("a list");
        assert_eq!(
            events.len(),
            6,
            "the start does not count, the end does: {way:?}"
        );
        for (i, event) in events.iter().enumerate() {
            close(at(event, "theta_rad"), (i + 1) as f64 * PI, 1e-12);
            // At the dead centres the slider is at rest and the flywheel has all the energy.
            close(at(event, "omega_rad_per_s"), 10.0, 1e-8);
        }
        let times: Vec<_> = events.iter().map(|event| at(event, "t_s")).collect();
        assert!(times.is_sorted(), "{times:?}");
    }
}

#[test]
fn a_pendulum_turns_back_where_it_came_from() {
    let folder = Folder::with(&format!("{PENDULUM}\n[run]\nduration = \"2 s\"\n"));
    let (summary, rows) = folder.simulated(&[]);
    let events = summary["events"].as_array().expect("a list");
    let turning: Vec<_> = events
        .iter()
        .filter(|event| event["kind"] == "turning-point")
        .collect();
    assert!(turning.len() >= 4, "{events:?}");
    for (i, event) in turning.iter().enumerate() {
        let side = if i % 2 == 0 { -150.0f64 } else { -30.0 };
        close(at(event, "theta_rad"), side.to_radians(), 1e-8);
        assert_eq!(at(event, "omega_rad_per_s"), 0.0);
    }
    let theta = rows.column("theta_rad");
    assert!(
        theta
            .iter()
            .all(|theta| (-150.0001..-29.9999).contains(&theta.to_degrees()))
    );
    // At the lowest position all potential energy has become kinetic: ½ J ω² = m g k (1 − cos 60°).
    let fastest = (2.0 * 9.80665 * 0.02 * 0.5 / 0.0005f64).sqrt();
    close(at(&summary, "omega_max"), fastest, 1e-7);
    close(at(&summary, "omega_min"), -fastest, 1e-7);
}

/// Without load ½ M ω² is constant: the crank is slowest where x'² is largest, and fastest at the dead centres.
#[test]
fn extreme_speeds_are_those_of_the_motion() {
    let (kinematics, _) = Folder::with(PUMP).kinematics(&[]);
    let steepest = at(&kinematics, "velocity_max.value");
    let least = 10.0 * (0.02 / (0.02 + 0.5 * steepest * steepest)).sqrt();
    for way in free_ways() {
        for run in ["duration = \"1 s\"", "revolutions = 2"] {
            let (summary, _) = way.simulated(run);
            close(at(&summary, "omega_min"), least, 1e-8);
            close(at(&summary, "omega_max"), 10.0, 1e-8);
        }
        // A run too short to reach the minimum has its lowest speed at its end.
        for run in ["duration = \"50 ms\"", "revolutions = 0.1"] {
            let (summary, _) = way.simulated(run);
            let last = at(&summary, "final.omega_rad_per_s");
            assert!(last > least + 0.1, "{run}: {way:?}");
            close(at(&summary, "omega_min"), last, 1e-12);
            close(at(&summary, "omega_max"), 10.0, 1e-12);
        }
    }
}

#[test]
fn extreme_speeds_do_not_depend_on_what_is_listed_or_written() {
    for way in free_ways() {
        let run = |options: &[&str]| {
            way.simulated_at("10 rad/s", "duration = \"1 s\"", options)
                .0
        };
        let (listed, unlisted) = (run(&["--reactions"]), run(&["--max-events", "0"]));
        for key in ["omega_min", "omega_max"] {
            close(at(&listed, key), at(&unlisted, key), 1e-9);
        }
        assert_eq!(listed["final"], unlisted["final"]);
    }
}

#[test]
fn methods_agree_within_their_stated_errors() {
    let folder = Folder::with(&free("duration = \"1 s\"\ntolerance = 1e-8"));
    let run = |more: &[&str]| folder.simulated(more).0;
    let reference = run(&["--tolerance", "1e-13"]);
    for options in [
        &["--method", "auto"][..],
        &["--method", "time"],
        &["--method", "dop853"],
        &["--method", "dopri5"],
        &["--method", "dopri5", "--tolerance", "1e-5"],
        &["--method", "dop853", "--tolerance", "1e-11"],
    ] {
        let summary = run(options);
        for key in ["theta_rad", "omega_rad_per_s"] {
            let stated = at(&summary["error_estimate"], key);
            let error = (at(&summary["final"], key) - at(&reference["final"], key)).abs();
            let allowed = stated + at(&reference["error_estimate"], key);
            assert!(
                error <= allowed,
                "{key} with {options:?}: {error} > {allowed}"
            );
            assert!(stated < 1e-2, "{key} with {options:?}");
        }
    }
}

#[test]
fn a_tighter_tolerance_costs_more_and_errs_less() {
    let folder = Folder::with(&free("duration = \"1 s\""));
    let run = |tolerance| {
        folder
            .simulated(&["--method", "time", "--tolerance", tolerance])
            .0
    };
    let [loose, tight] = ["1e-6", "1e-12"].map(run);
    assert!(at(&tight, "evaluations") > at(&loose, "evaluations"));
    let error = |summary| at(summary, "error_estimate.theta_rad");
    assert!(error(&tight) < 1e-3 * error(&loose));
}

#[test]
fn the_error_estimate_can_be_left_out() {
    let folder = Folder::with(&free("duration = \"1 s\""));
    let (with, _) = folder.simulated(&["--method", "time"]);
    let (without, _) = folder.simulated(&["--method", "time", "--no-estimate"]);
    assert!(at(&with, "estimate_cost.evaluations") > 0.0);
    assert!(without["error_estimate"].is_null() && without["estimate_cost"].is_null());
    assert_eq!(with["final"], without["final"]);
    assert_eq!(with["evaluations"], without["evaluations"]);
    let text = folder
        .run(&["simulate", "scene.toml", "--no-estimate"])
        .done()
        .stdout;
    assert!(text.contains("error not estimated"), "{text}");
}

#[test]
fn the_list_of_events_is_bounded_and_says_so() {
    for way in WAYS {
        let run = |more: &[&str]| way.simulated_at("10 rad/s", "revolutions = 5", more).0;
        let (all, few) = (run(&[]), run(&["--max-events", "3"]));
        let events = |summary: &Value| summary["events"].as_array().expect("a list").clone();
        assert_eq!(events(&all).len(), 10, "{way:?}");
        assert_eq!(events(&few), events(&all)[..3], "{way:?}");
        assert_eq!(few["events_total"], 10);
        let warning = few["warnings"][0].as_str().expect("a warning");
        assert!(
            warning.contains("10 events") && warning.contains("first 3"),
            "{warning}"
        );
    }
}

/// Returns the longest run of mantissa digits of a number in a text, without leading zeros.
fn digits(text: &str) -> usize {
    let numbers = text.split(|c: char| !(c.is_ascii_digit() || c == '.'));
    let length = |number: &str| number.replace('.', "").trim_start_matches('0').len();
    numbers.map(length).max().unwrap_or(0)
}

#[test]
fn people_see_six_digits_where_no_error_is_known() {
    let scene = "[geometry]\ncrank = \"47 mm\"\nrod = \"155.83 mm\"\noffset = \"3 mm\"\n[rod]\nmass = \"0.86 kg\"\ncg = \"51.07 mm\"\ninertia = \"3564.05 kg mm^2\"\n[slider]\nmass = \"0.5 kg\"\n[motion]\nkind = \"constant-speed\"\nspeed = \"300 1/min\"\n[run]\nrevolutions = 1.1\n";
    let folder = Folder::with(scene);
    for arguments in [
        &[
            "simulate",
            "scene.toml",
            "--reactions",
            "--torque",
            "--no-estimate",
        ][..],
        &["kinematics", "scene.toml", "--forces"],
        &["kinematics", "scene.toml", "--change", "rod=151 mm"],
        &["statics", "scene.toml", "--torque", "0.3 N m"],
    ] {
        let text = folder.run(arguments).done().stdout;
        let summary = text.split("\n\n").next().unwrap_or_default();
        let lines = summary
            .lines()
            .filter(|line| !(line.starts_with("cost") || line.contains("+-")));
        for line in lines {
            assert!(digits(line) <= 6, "{arguments:?}: {line}");
        }
    }
    // The exact speed, the angle beside the time of each largest force, the engine by its bare name.
    let text = folder
        .run(&["simulate", "scene.toml", "--reactions"])
        .done()
        .stdout;
    let line = |name: &str| {
        let line = text.lines().find(|line| line.starts_with(name));
        line.unwrap_or_else(|| panic!("no {name} in {text}"))
            .to_owned()
    };
    assert!(line("  crank speed").ends_with(" 31.4159 rad/s"), "{text}");
    assert!(!text.contains("0.0e0"), "{text}");
    assert_eq!(
        line("engine").split_whitespace().last(),
        Some("closed-form")
    );
    assert!(
        line("crank pin").contains(" s, ") && line("crank pin").ends_with(" deg"),
        "{text}"
    );
    let summary = folder
        .run(&["simulate", "scene.toml", "--reactions", "--json"])
        .done()
        .json();
    let peak = |key: &str| at(&summary, &format!("peaks.crank_pin.{key}"));
    assert!((peak("theta_rad") - 10.0 * std::f64::consts::PI * peak("t_s")).abs() < 1e-9);
}
