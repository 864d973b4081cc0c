//! Loose joint on the command line: columns, summary, figure.

use super::program::{Folder, Rows, at, close, repository};

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,x_m,v_m_per_s,a_m_per_s2,phi_rad,\
    crank_torque_nm,x_ideal_m,v_ideal_m_per_s,a_ideal_m_per_s2,journal_x_m,journal_y_m,contact_force_n";

fn scene(name: &str) -> String {
    repository(&format!("data/{name}"))
        .to_str()
        .expect("a plain path")
        .to_owned()
}

#[test]
fn rows_and_summary_show_the_loose_joint() {
    let folder = Folder::new();
    let scene = scene("clearance-5000rpm.toml");
    let run = [
        "simulate",
        &scene,
        "--torque",
        "--json",
        "--out",
        "rows.csv",
        "--plot",
        "motion.svg",
    ];
    let summary = folder.run(&run).done().json();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert_eq!(rows.header, COLUMNS);
    // One row per degree over three turns, plus the final state.
    assert_eq!(rows.len(), 1081);
    assert!(rows.complete());
    let joint = &summary["clearance"];
    assert_eq!(summary["engine"], "contact");
    assert_eq!(joint["joint"], "wrist-pin");
    // The literature on this case gives 6.61e10.
    assert!((at(joint, "stiffness_n_per_m_1_5") / 6.61e10 - 1.0).abs() < 1e-3);
    let kinds = |kind: &str| {
        let events = summary["events"].as_array().expect("events");
        events.iter().filter(|event| event["kind"] == kind).count() as f64
    };
    assert_eq!(kinds("impact"), at(joint, "impacts"));
    assert_eq!(kinds("separation"), at(joint, "separations"));
    assert_eq!(kinds("dead-centre"), 6.0);
    assert!(at(joint, "dissipated_j") > 0.0);
    assert!(folder.read("motion.svg").contains("path of the journal"));
    let text = folder.run(&["simulate", &scene]).done().stdout;
    for part in ["loose joint", "impacts", "reproducible", "beyond"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn rows_have_the_joint_forces_too() {
    let folder = Folder::new();
    let scene = scene("clearance-5000rpm.toml");
    let run = [
        "simulate",
        &scene,
        "--reactions",
        "--json",
        "--out",
        "rows.csv",
    ];
    let summary = folder.run(&run).done().json();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert!(rows.complete() && rows.len() == 1081);
    let column = |name: &str| rows.column(name);
    let (x, y) = (column("wrist_pin_x_n"), column("wrist_pin_y_n"));
    let (contact, guide) = (column("contact_force_n"), column("guide_n"));
    for i in 0..rows.len() {
        // The loose joint is the wrist pin, without friction; the slider has no weight.
        close(x[i].hypot(y[i]), contact[i], 1e-12 * contact[i]);
        assert!((guide[i] + y[i]).abs() <= 1e-12 * contact[i]);
    }
    let peak = at(&summary, "peaks.wrist_pin.value_n");
    assert!(contact.iter().all(|force| *force <= peak * (1.0 + 1e-9)));
    assert!((peak / at(&summary, "clearance.force_peak_n") - 1.0).abs() < 1e-3);
}

#[test]
fn the_plan_names_the_loose_joint() {
    let folder = Folder::new();
    let scene = scene("gupta-clearance.toml");
    let text = folder.run(&["explain", &scene]).done().stdout;
    for part in [
        "contact",
        "joint clearance",
        "crank pin",
        "impact, separation",
    ] {
        assert!(text.contains(part), "{part}: {text}");
    }
    let words = ["method time", "clearance", "help:"];
    folder
        .run(&["simulate", &scene, "--method", "time"])
        .fails(2, &words);
}

/// Without friction the joint force is the contact force, whose maximum lies between the samples.
#[test]
fn the_largest_contact_force_is_that_of_the_joint() {
    let folder = Folder::new();
    let scene = scene("clearance-5000rpm.toml");
    let summary = folder
        .run(&["simulate", &scene, "--reactions", "--no-estimate", "--json"])
        .done()
        .json();
    let (contact, joint) = (
        at(&summary, "clearance.force_peak_n"),
        at(&summary, "peaks.wrist_pin.value_n"),
    );
    assert!((contact / joint - 1.0).abs() < 1e-10, "{contact} {joint}");
}

#[test]
fn energy_that_goes_out_is_not_said_to_be_put_in() {
    let folder = Folder::new();
    for name in [
        "clearance-5000rpm.toml",
        "hard/11-clearance-free-crank.toml",
        "gupta-clearance-30rpm.toml",
    ] {
        let scene = scene(name);
        let run = ["simulate", &scene, "--no-estimate"];
        let text = folder.run(&run).done().stdout;
        let work = at(
            &folder.run(&[&run[..], &["--json"]].concat()).done().json(),
            "clearance.work_j",
        );
        let way = if work < 0.0 {
            "J out of the mechanism"
        } else {
            "J into the mechanism"
        };
        assert!(text.contains(way), "{work}: {text}");
        let line = text
            .lines()
            .find(|line| line.contains("energy lost"))
            .expect("a line");
        assert!(!line.contains('-'), "{line}");
    }
}
