//! `kinematics` with forces, sensitivities, changed lengths and sizing.

use super::program::{Folder, PUMP, Rows, at, close, repository};

fn run(more: &[&str]) -> (serde_json::Value, Rows) {
    let folder = Folder::new();
    let scene = repository("data/obaseki-alfred.toml");
    let arguments = [
        "kinematics",
        scene.to_str().unwrap(),
        "--json",
        "--out",
        "rows.csv",
    ];
    let outcome = folder.run(&[&arguments[..], more].concat()).done();
    (outcome.json(), Rows::read(&folder.read("rows.csv")))
}

/// Extremes of the driving torque in 40-digit arithmetic, for both senses of rotation.
#[test]
fn forces_at_constant_speed() {
    let (summary, rows) = run(&["--forces", "--every", "5 deg"]);
    for (path, want) in [
        ("forces.inward.min.value", -316.0611128),
        ("forces.inward.max.value", 185.2973566),
        ("forces.outward.max.value", 47.50780798),
        ("forces.outward.min.value", -81.30245599),
        ("forces.masses.rotating_kg", 0.35),
        ("forces.masses.reciprocating_kg", 1.05),
    ] {
        close(at(&summary, path), want, 1e-7 * want.abs());
    }
    assert!(rows.complete());
    // With the crank's inertia balanced, the pin transmits the whole torque.
    for (torque, tangential) in rows
        .column("crank_torque_nm")
        .iter()
        .zip(rows.column("crank_tangential_n"))
    {
        close(*torque, 0.04 * tangential, 1e-10);
    }
    for (guide, lateral) in rows
        .column("guide_n")
        .iter()
        .zip(rows.column("wrist_pin_y_n"))
    {
        close(guide + lateral, 0.0, 1e-10);
    }
}

/// Extremes in 40-digit arithmetic.
#[test]
fn extremes_with_other_offsets() {
    let scene = std::fs::read_to_string(repository("data/obaseki-alfred.toml")).unwrap();
    for (offset, stroke, inward, ratio) in [
        (
            "10 mm",
            0.08170069013,
            [-133.7494065, 130.3897829],
            1.237506101,
        ),
        ("0 mm", 0.08, [-85.72588325, 105.0859843], 1.0),
    ] {
        let offset = format!("offset = \"{offset}\"");
        let folder = Folder::with(&scene.replace("offset = \"20 mm\"", &offset));
        let asked = ["kinematics", "scene.toml", "--forces", "--json"];
        let summary = folder.run(&asked).done().json();
        close(at(&summary, "stroke_m"), stroke, 1e-10);
        close(at(&summary, "time_ratio"), ratio, 1e-8);
        close(at(&summary, "forces.inward.min.value"), inward[0], 1e-6);
        close(at(&summary, "forces.inward.max.value"), inward[1], 1e-6);
    }
}

/// Clockwise, the stroke with the high torque becomes the outward one.
#[test]
fn reversed_rotation_exchanges_the_strokes() {
    let scene = std::fs::read_to_string(repository("data/obaseki-alfred.toml")).unwrap();
    let folder = Folder::with(&scene.replace("speed = \"251 rad/s\"", "speed = \"-251 rad/s\""));
    let summary = folder
        .run(&["kinematics", "scene.toml", "--forces", "--json"])
        .done()
        .json();
    close(at(&summary, "forces.outward.min.value"), -316.0611128, 1e-6);
    close(at(&summary, "forces.inward.max.value"), 47.50780798, 1e-6);
}

#[test]
fn sensitivity_and_change_agree_for_a_small_change() {
    let (_, rows) = run(&[
        "--sensitivity",
        "--change",
        "rod=64.0001 mm",
        "--every",
        "15 deg",
    ]);
    for (slope, change) in [
        ("x_by_rod", "x_change_m"),
        ("v_by_rod_per_s", "v_change_m_per_s"),
        ("a_by_rod_per_s2", "a_change_m_per_s2"),
    ] {
        let size = rows
            .column(slope)
            .iter()
            .fold(0.0f64, |m, v| m.max(v.abs()));
        for (slope, change) in rows.column(slope).iter().zip(rows.column(change)) {
            close(change / 1e-7, *slope, 1e-4 * size);
        }
    }
    assert!(rows.header.contains("crank_torque_by_offset_n"));
}

/// Forces at constant speed omit friction at the guide, and the output states this.
#[test]
fn friction_that_is_left_out_is_named() {
    let scene = repository("data/ng.toml");
    let asked = ["kinematics", scene.to_str().unwrap(), "--json"];
    let folder = Folder::new();
    let warnings = |more: &[&str]| {
        let summary = folder.run(&[&asked[..], more].concat()).done().json();
        summary["warnings"].as_array().unwrap().len()
    };
    assert_eq!((warnings(&[]), warnings(&["--forces"])), (0, 1));
}

/// If a force is a formula of the position, the torque slope is unknown: its cells are empty and the output states
/// this.
#[test]
fn a_torque_of_unknown_slope_is_left_out() {
    let force =
        "[[force]]\nkind = \"expression\"\nvalue = \"-3*x^3\"\n[motion]\nspeed = \"20 rad/s\"";
    let folder = Folder::with(&format!("{PUMP}\n{force}\n"));
    let asked = [
        "kinematics",
        "scene.toml",
        "--sensitivity",
        "--json",
        "--out",
        "rows.csv",
    ];
    let summary = folder.run(&asked).done().json();
    assert!(
        summary["warnings"][0].as_str().unwrap().contains("slope"),
        "{summary}"
    );
    let rows = Rows::read(&folder.read("rows.csv"));
    assert!(
        rows.cells_of("crank_torque_by_rod_n")
            .iter()
            .all(Option::is_none)
    );
    assert!(rows.cells_of("a_by_rod_per_s2").iter().all(Option::is_some));
}

#[test]
fn sizing_from_the_stroke() {
    let folder = Folder::with(PUMP);
    let sized = [
        "kinematics",
        "scene.toml",
        "--stroke",
        "80 mm",
        "--rod-ratio",
        "1.6",
        "--json",
    ];
    let outcome = folder.run(&sized);
    assert_eq!(outcome.code, Some(0), "{outcome:?}");
    assert!(
        outcome.stderr.contains("crank 0.04 m, rod 0.064 m"),
        "{}",
        outcome.stderr
    );
    close(at(&outcome.json(), "stroke_m"), 0.08, 1e-16);
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = Folder::with(PUMP);
    for (arguments, words) in [
        (&["--forces"][..], &["speed"][..]),
        (&["--change", "crank=1 kg"], &["--change", "length"]),
        (&["--change", "lever=1 mm"], &["crank, rod and offset"]),
        (&["--change", "crank=-1 mm"], &["crank"]),
        (&["--stroke", "80 mm"], &["--rod-ratio"]),
        (&["--stroke", "80 mm", "--rod-ratio", "0.9"], &["ratio"]),
        (
            &["--stroke", "80 mm", "--rod-ratio", "1e300"],
            &["a rod of 1e300 crank lengths", "too long"],
        ),
        (
            &["--stroke", "1e300 m", "--rod-ratio", "4"],
            &["a stroke of 1e300 m", "too long"],
        ),
        (&["--balance", "0.5"], &["<--forces|--diagram <NAME>>"]),
        (&["--forces", "--balance", "nan"], &["a balance of NaN"]),
        (&["--forces", "--balance", "inf"], &["a balance of inf"]),
        (&["--forces", "--balance", "1e300"], &["a balance of 1e300"]),
        (&["--forces", "--balance", "-1"], &["a balance of -1"]),
    ] {
        folder
            .run(&[&["kinematics", "scene.toml"][..], arguments].concat())
            .fails(2, words);
    }
}

#[test]
fn the_plot_has_its_axes() {
    let folder = Folder::with(PUMP);
    folder
        .run(&[
            "kinematics",
            "scene.toml",
            "--change",
            "crank=55 mm",
            "--plot",
            "turn.svg",
        ])
        .done();
    let plot = folder.read("turn.svg");
    for text in [
        "slider position [mm]",
        "crank angle θ [°]",
        "slider position x, changed",
    ] {
        assert!(plot.contains(text), "{text}");
    }
}
