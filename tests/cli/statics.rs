//! `statics`: columns, rows, options and refusals.

use super::program::{Folder, PUMP, ROCKER, Rows, at, close, has_keys};

const COLUMNS: &str = "theta_rad,slider_force_n,slider_force_min_n,slider_force_max_n,side_thrust_n,transmission_rad,self_locking";

fn rows(folder: &Folder, more: &[&str]) -> Rows {
    let arguments = [&["statics", "scene.toml", "--out", "rows.csv"][..], more].concat();
    folder.run(&arguments).done();
    Rows::read(&folder.read("rows.csv"))
}

/// The force is torque/(r sin θ) where the rod lies in the normal plane of the guide: at 90 degrees, with the guide
/// through the pivot, x' = −r.
#[test]
fn rows_have_the_columns_and_one_turn() {
    let folder = Folder::with(PUMP);
    let found = rows(
        &folder,
        &[
            "--torque",
            "2 N m",
            "--friction",
            "0.1",
            "--every",
            "10 deg",
        ],
    );
    assert_eq!((found.header.as_str(), found.len()), (COLUMNS, 37));
    let cell = |name: &str| found.cells_of(name)[9].expect("a value");
    close(cell("slider_force_n"), 2.0 / 0.05, 1e-12);
    // tan φ = 1/sqrt(8) with sin φ = 1/3.
    let thrust = 40.0 / 8f64.sqrt();
    close(cell("side_thrust_n"), thrust, 1e-12);
    close(cell("slider_force_min_n"), 40.0 - 0.1 * thrust, 1e-12);
    close(cell("slider_force_max_n"), 40.0 + 0.1 * thrust, 1e-12);
    for dead_centre in [0, 18, 36] {
        assert_eq!(found.cells_of("slider_force_n")[dead_centre], None);
        assert_eq!(found.cells_of("side_thrust_n")[dead_centre], None);
    }
    let filled = found.cells_of("slider_force_n").iter().flatten().count();
    assert_eq!(filled, 34);
}

#[test]
fn a_force_gives_the_torque() {
    let folder = Folder::with(PUMP);
    let found = rows(
        &folder,
        &["--force", "-40 N", "--every", "90 deg", "--details"],
    );
    let header = COLUMNS
        .replace("slider_force", "crank_torque")
        .replace("_n,crank", "_nm,crank");
    let header = header.replace("max_n,", "max_nm,") + ",velocity_ratio,crank_pin_angle_rad";
    assert_eq!(found.header, header);
    close(found.column("crank_torque_nm")[1], -2.0, 1e-12);
    close(found.column("velocity_ratio")[1], 1.0, 1e-14);
    assert!(found.complete(), "a torque exists at the dead centres too");
}

#[test]
fn weight_drum_and_tilt_are_torque_and_friction() {
    let folder = Folder::with(PUMP);
    let a = rows(
        &folder,
        &[
            "--weight",
            "9.81 N",
            "--drum-radius",
            "27 mm",
            "--tilt",
            "45 deg",
        ],
    );
    let b = rows(&folder, &["--torque", "264.87 N mm", "--friction", "1"]);
    for column in ["slider_force_n", "slider_force_min_n", "slider_force_max_n"] {
        for (a, b) in a.cells_of(column).iter().zip(b.cells_of(column)) {
            match (a, b) {
                (Some(a), Some(b)) => close(*a, b, 1e-12 * b.abs().max(1.0)),
                (a, b) => assert_eq!((*a, b), (None, None)),
            }
        }
    }
}

/// The summary of a rocker names its limits, blocked ranges and locked ranges; blocked rows are empty.
#[test]
fn a_rocker_is_blocked_and_locked() {
    let folder = Folder::with(ROCKER);
    let found = rows(&folder, &["--torque", "1 N m", "--friction", "0.5"]);
    assert_eq!(found.cells_of("slider_force_n")[90], None);
    assert_eq!(found.cells_of("transmission_rad")[90], None);
    assert!(found.column("self_locking").contains(&1.0));
    let summary = folder
        .run(&["statics", "scene.toml", "--friction", "0.5", "--json"])
        .done()
        .json();
    has_keys(
        &summary,
        &[
            "scene",
            "class",
            "sought",
            "friction",
            "least",
            "positions",
            "warnings",
        ],
    );
    let kinds: Vec<_> = summary["positions"]
        .as_array()
        .unwrap()
        .iter()
        .map(|p| p["kind"].as_str().unwrap())
        .collect();
    for kind in [
        "dead-centre",
        "rod-normal-to-guide",
        "blocked",
        "self-locking",
    ] {
        assert!(kinds.contains(&kind), "{kind} in {kinds:?}");
    }
}

#[test]
fn the_built_in_scene_shows_a_result() {
    let folder = Folder::new();
    let shown = folder.run(&["statics"]).done().stdout;
    assert!(
        shown.contains("slider force [N]") && shown.contains("dead-centre"),
        "{shown}"
    );
    folder.run(&["statics", "--plot", "plot.svg"]).done();
    assert!(folder.read("plot.svg").contains("slider force [N]"));
}

#[test]
fn a_calibration_takes_a_reading_back_to_its_force() {
    let folder = Folder::new();
    folder.write("c.csv", "force [kN];volt\n0;0.5\n1;2.5\n2;4.5\n");
    let result = folder
        .run(&[
            "statics",
            "--calibration",
            "c.csv",
            "--reading",
            "3.5",
            "--json",
        ])
        .done()
        .json();
    close(at(&result, "fit.slope"), 2e-3, 1e-15);
    close(
        result["forces"][0]["force_n"].as_f64().unwrap(),
        1500.0,
        1e-9,
    );
    let far = [
        "statics",
        "--calibration",
        "c.csv",
        "--reading",
        "1e300",
        "--json",
    ];
    let result = folder.run(&far).done().json();
    close(at(&result["forces"][0], "force_n"), 5e302, 1e290);
    assert!(
        result["warnings"][0]
            .to_string()
            .contains("outside the loads")
    );
}

#[test]
fn what_cannot_be_meant_is_refused() {
    let folder = Folder::with(PUMP);
    folder.write("c.csv", "force [N],volt\n0,1\n1,x\n");
    for (arguments, words) in [
        (&["--torque", "2 N"][..], &["--torque", "torque"][..]),
        (&["--torque", "2 N m", "--force", "1 N"], &["--force"]),
        (&["--friction", "-0.1"], &["-0.1"]),
        (&["--friction", "0.1", "--tilt", "10 deg"], &["--tilt"]),
        (&["--tilt", "90 deg"], &["tilt"]),
        (&["--weight", "9 N"], &["--drum-radius"]),
        (&["--every", "0 deg"], &["positive"]),
        (&["--every", "1e-9 deg"], &["rows"]),
        (&["--out", "-", "--json"], &["standard output"]),
    ] {
        folder
            .run(&[&["statics", "scene.toml"][..], arguments].concat())
            .fails(2, words);
    }
    folder
        .run(&["statics", "--calibration", "c.csv"])
        .fails(2, &["c.csv line 3", "column 2", "`x`"]);
    folder.write("c.csv", "force [N],volt\n1,0.1\n2,0.1\n4,0.1\n");
    folder
        .run(&["statics", "--calibration", "c.csv"])
        .fails(2, &["c.csv", "do not depend on the load"]);
}

#[test]
fn the_summary_has_the_self_locking_range() {
    // mu |sin phi| >= |cos phi| where |sin theta| >= l cos(atan mu)/r.
    let folder = Folder::with(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"60 mm\"\n[friction]\ncoefficient = 1.0\n",
    );
    let summary = folder
        .run(&["statics", "scene.toml", "--torque", "1 N m", "--json"])
        .done()
        .json();
    let from = (0.06 / 2f64.sqrt() / 0.05).asin();
    let ranges = summary["self_locking_rad"].as_array().expect("ranges");
    assert_eq!(ranges.len(), 2, "{ranges:?}");
    let edge = |i: usize, k: usize| ranges[i][k].as_f64().expect("a number");
    assert!(
        (edge(0, 0) - from).abs() < 1e-12
            && (edge(0, 1) - (std::f64::consts::PI - from)).abs() < 1e-12
    );
    assert!(
        (edge(1, 0) - (std::f64::consts::PI + from)).abs() < 1e-12,
        "{ranges:?}"
    );
    let without = folder
        .run(&[
            "statics",
            "scene.toml",
            "--torque",
            "1 N m",
            "--friction",
            "0",
            "--json",
        ])
        .done()
        .json();
    assert_eq!(
        without["self_locking_rad"].as_array().map(Vec::len),
        Some(0)
    );
}
