//! Runs that end early: exit code 1, a message with the time reached, and the computed results are kept.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use serde_json::Value;

use super::program::{Folder, PENDULUM, ROCKER, Rows, at, close, free, rocker_limit, same};

/// Returns summary and rows of a run that stops with this word in its message.
#[track_caller]
fn stopped(folder: &Folder, more: &[&str], word: &str) -> (Value, Rows) {
    let mut arguments = vec!["simulate", "scene.toml", "--json", "--out", "rows.csv"];
    arguments.extend(more);
    let outcome = folder
        .run(&arguments)
        .complains(1, &[word, "t = ", "theta = "]);
    let summary = outcome.json();
    let reason = summary["stopped"].as_str().expect("a reason");
    assert!(outcome.stderr.contains(reason), "{outcome:?}");
    let rows = Rows::read(&folder.read("rows.csv"));
    assert!(rows.complete());
    assert!(rows.column("t_s").is_sorted());
    (summary, rows)
}

fn rocker(motion: &str) -> Folder {
    Folder::with(&format!("{ROCKER}\n[motion]\n{motion}\n"))
}

/// l < r + |e|: a crank at constant speed cannot pass its limit, and a crank alone runs into it.
#[test]
fn a_driven_rocker_and_a_rocker_without_rod_and_slider_end_at_the_limit_of_their_motion() {
    let massless = ROCKER.replace("[slider]\nmass = \"0.5 kg\"\n", "");
    assert_ne!(massless, ROCKER);
    for (scene, kind) in [
        (ROCKER, "constant-speed"),
        (&massless, "constant-speed"),
        (&massless, "free"),
    ] {
        for (speed, limit) in [
            ("10 rad/s", rocker_limit()),
            ("-10 rad/s", -(TAU / 2.0 + rocker_limit())),
        ] {
            let motion = format!("kind = \"{kind}\"\nspeed = \"{speed}\"");
            let folder = Folder::with(&format!("{scene}\n[motion]\n{motion}\n"));
            let (summary, rows) = stopped(&folder, &[], "limit of its motion");
            assert!(at(&summary, "final.t_s") < 1.0);
            close(at(&summary, "final.theta_rad"), limit, 0.01);
            if kind == "constant-speed" {
                // Torque and energy grow without bound at the limit.
                assert!(summary.get("driving_torque").is_none());
                assert!(summary["energy_residual"].is_null());
            }
            assert!(
                rows.len() >= 10,
                "{} rows up to there, {motion}",
                rows.len()
            );
            let angles = rows.column("theta_rad");
            assert!(
                angles
                    .iter()
                    .all(|theta| theta.abs() <= limit.abs() + 1e-12)
            );
            // The rod approaches the normal of the guide without reaching it.
            let inclinations = rows.column("phi_rad");
            assert!(inclinations.iter().all(|phi| phi.abs() <= TAU / 4.0));
        }
    }
}

/// Turns that a crank between limits can never complete are refused at once; a crank stopped by friction is reported.
#[test]
fn turns_that_are_never_completed_end_the_run() {
    let rocking = format!("{ROCKER}\n[motion]\nspeed = \"10 rad/s\"\n")
        .replace("duration = \"1 s\"", "revolutions = 1");
    let folder = Folder::with(&rocking.replace(
        "0.5 kg",
        "0.5 kg\"\n[[force]]\nkind = \"viscous\"\ncoefficient = \"0.1 N s/m",
    ));
    folder
        .run(&["simulate", "scene.toml"])
        .fails(2, &["revolutions", "between its limits", "help:"]);
    let slowed = free("revolutions = 1000")
        + "[friction]\ncoefficient = 0.3\n[gravity]\nacceleration = \"9.81 m/s^2\"\n";
    let (summary, _) = stopped(&Folder::with(&slowed), &[], "comes to rest");
    assert_eq!(at(&summary, "final.omega_rad_per_s"), 0.0);
    let turned = free("revolutions = 2") + "[friction]\ncoefficient = 0.01\n";
    let summary = Folder::with(&turned)
        .run(&["simulate", "scene.toml", "--json"])
        .done()
        .json();
    close(at(&summary, "final.theta_rad"), 2.0 * TAU, 1e-13);
}

/// Past the limit the crank swings back and the slider goes on, on the other branch; J ω² + m v² is conserved.
#[test]
fn a_rocker_passes_its_limit_and_keeps_its_energy() {
    let folder = rocker("speed = \"10 rad/s\"");
    let outcome = folder.run(&["simulate", "scene.toml", "--json", "--out", "rows.csv"]);
    let summary = outcome.done().json();
    let rows = Rows::read(&folder.read("rows.csv"));
    assert!(at(&summary, "energy_residual").abs() < 1e-8);
    let columns =
        ["omega_rad_per_s", "v_m_per_s", "theta_rad", "x_m"].map(|name| rows.column(name));
    let mut branches = [false; 2];
    for i in 0..rows.len() {
        let [omega, v, theta, x] = [0, 1, 2, 3].map(|k: usize| columns[k][i]);
        let energy = |omega: f64, v: f64| 0.02 * omega * omega + 0.5 * v * v;
        close(energy(omega, v), energy(columns[0][0], columns[1][0]), 1e-8);
        let beyond = x - 0.05 * theta.cos();
        close(beyond.hypot(0.01 + 0.05 * theta.sin()), 0.05, 1e-12);
        branches[usize::from(beyond < 0.0)] = true;
    }
    assert_eq!(branches, [true; 2], "the slider is found on both branches");
    let limits = summary["events"].as_array().expect("events");
    assert!(
        limits
            .iter()
            .filter(|event| event["kind"] == "limit")
            .count()
            >= 2
    );
}

#[test]
fn a_rocker_that_turns_back_before_its_limit_completes_its_run() {
    let spring = "[[force]]\nkind = \"spring\"\nstiffness = \"20 N/mm\"\nrest = \"95 mm\"\n";
    let folder = Folder::with(&format!(
        "{ROCKER}\n{spring}\n[motion]\nspeed = \"1 rad/s\"\n"
    ));
    let (summary, rows) = folder.simulated(&[]);
    assert!(
        rows.column("theta_rad")
            .iter()
            .all(|theta| theta.abs() < 0.5)
    );
    assert!(
        summary["events"]
            .as_array()
            .expect("a list")
            .iter()
            .any(|event| event["kind"] == "turning-point")
    );
    assert!(at(&summary, "energy_residual").abs() < 1e-6);
}

#[test]
fn a_start_out_of_reach_is_refused() {
    for kind in ["free", "constant-speed"] {
        let motion = format!("kind = \"{kind}\"\nangle = \"90 deg\"\nspeed = \"10 rad/s\"");
        rocker(&motion)
            .run(&["simulate", "scene.toml", "--json"])
            .fails(2, &["motion.angle", "help"]);
    }
    let at_90_degrees = ["explain", "scene.toml", "--at", "90 deg"];
    rocker("speed = \"10 rad/s\"")
        .run(&at_90_degrees)
        .fails(2, &["no position", "help:"]);
}

#[test]
fn the_work_limit_keeps_what_was_computed() {
    let folder = Folder::with(&free("duration = \"100 s\"\noutput_every = \"1 ms\""));
    let limit = ["--method", "time", "--max-evaluations", "1000"];
    let (summary, rows) = stopped(&folder, &limit, "--max-evaluations");
    let end = at(&summary, "final.t_s");
    assert!(end > 0.1 && end < 99.0, "stopped at {end} s");
    assert!(
        at(&summary, "evaluations") <= 1100.0,
        "a step beyond the limit at most"
    );
    for key in ["t_s", "theta_rad", "omega_rad_per_s"] {
        same(rows.column(key)[rows.len() - 1], at(&summary["final"], key));
    }
    let due = 2 + ((end - 1e-9) / 1e-3) as usize;
    assert_eq!(rows.len(), due, "all rows up to {end} s");
    assert!(
        summary["error_estimate"].is_null(),
        "of a run that was not completed"
    );
    let text = folder.run(&[&["simulate", "scene.toml"], &limit[..]].concat());
    assert_eq!(text.code, Some(1));
    assert!(text.stdout.contains("stopped early"), "{text:?}");
}

/// Printed and written output does not change how far a limited run goes.
#[test]
fn the_work_limit_counts_the_solution_only() {
    let folder = Folder::with(&free("duration = \"100 s\"\noutput_every = \"0.1 ms\""));
    let limit = ["--method", "time", "--max-evaluations", "1000"];
    let (with_rows, _) = stopped(&folder, &limit, "--max-evaluations");
    let arguments = [&["simulate", "scene.toml", "--json"][..], &limit].concat();
    let without = folder
        .run(&arguments)
        .complains(1, &["--max-evaluations"])
        .json();
    assert_eq!(with_rows["final"], without["final"]);
    assert_eq!(with_rows["evaluations"], without["evaluations"]);
}

#[test]
fn a_crank_that_never_completes_its_turns_says_so() {
    let at_rest = free("revolutions = 1").replace("10 rad/s", "0 rad/s");
    let driven = at_rest.replace("[motion]", "[motion]\nkind = \"constant-speed\"");
    for scene in [&at_rest, &driven] {
        Folder::with(scene)
            .run(&["simulate", "scene.toml"])
            .fails(2, &["at rest", "1 turn", "help:"]);
    }
}

/// The pendulum turns back for ever: the run stops with that message instead of following it.
#[test]
fn a_crank_that_swings_says_so_at_once() {
    let folder = Folder::with(&format!("{PENDULUM}\n[run]\nrevolutions = 1\n"));
    let mut child = folder.start(&["simulate", "scene.toml", "--json"]);
    let begun = Instant::now();
    while child.try_wait().expect("its status").is_none() {
        if begun.elapsed() > Duration::from_secs(20) {
            child.kill().expect("it can be stopped");
            child.wait().expect("an end");
            panic!("still running after 20 s");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    let output = child.wait_with_output().expect("its output");
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("does not complete 1 turn"), "{said}");
}

#[test]
fn a_load_without_a_value_says_where() {
    let load = "[[torque]]\nkind = \"expression\"\nvalue = \"sqrt(0.5 - t)\"\n";
    let folder = Folder::with(&format!("{}{load}", free("duration = \"1 s\"")));
    let (summary, _) = stopped(&folder, &[], "a load has no finite value");
    close(at(&summary, "final.t_s"), 0.5, 1e-6);
    let load = load.replace("0.5 - t", "t - 0.5");
    let folder = Folder::with(&format!("{}{load}", free("duration = \"1 s\"")));
    folder
        .run(&["simulate", "scene.toml"])
        .fails(2, &["no finite value", "start", "help:"]);
}
