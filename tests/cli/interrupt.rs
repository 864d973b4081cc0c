//! Ctrl-C and SIGTERM: computed results are kept, and no file is half-written.
#![cfg(unix)]

use std::io::Read;
use std::process::{Child, Command};
use std::time::{Duration, Instant};

use super::program::{Folder, free};

/// Signals a process and waits for its end; returns exit status and standard error.
#[track_caller]
fn interrupted(mut child: Child, signal: &str) -> (Option<i32>, String) {
    let process = child.id().to_string();
    let sent = Command::new("kill").args([signal, &process]).status();
    assert!(sent.expect("kill").success());
    let status = child.wait().expect("an end");
    let mut said = String::new();
    let stderr = child.stderr.as_mut().expect("standard error");
    stderr.read_to_string(&mut said).expect("a text");
    (status.code(), said)
}

/// Waits until a file has this number of lines.
#[track_caller]
fn wait_for(folder: &Folder, name: &str, lines: usize) {
    let begun = Instant::now();
    while !folder.names().iter().any(|file| file == name)
        || folder.read(name).lines().count() < lines
    {
        assert!(begun.elapsed() < Duration::from_secs(60), "no `{name}`");
        std::thread::sleep(Duration::from_millis(2));
    }
}

/// Checks that all rows are complete numbers in order of time.
#[track_caller]
fn check_rows(text: &str) -> usize {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows = reader.records().map(|row| row.expect("complete rows"));
    let times: Vec<f64> = rows.map(|row| row[0].parse().expect("a time")).collect();
    assert!(text.ends_with('\n') && times.windows(2).all(|t| t[0] < t[1]));
    times.len()
}

/// Scene and arguments of a run that takes far longer than the test.
fn endless(method: &'static str) -> (Folder, [&'static str; 7]) {
    let run = "duration = \"1e6 s\"\noutput_every = \"0.5 s\"";
    let folder = Folder::with(&free(run).replace("[run]", "[[torque]]\nkind = \"viscous\"\ncoefficient = \"1e-9 N m s\"\n[[torque]]\nkind = \"expression\"\nvalue = \"1e-6*sin(t)\"\n[run]"));
    (
        folder,
        [
            "simulate",
            "scene.toml",
            "--out",
            "rows.csv",
            "--no-estimate",
            "--method",
            method,
        ],
    )
}

#[test]
fn a_run_keeps_its_rows() {
    for (k, method) in ["time", "auto", "dop853", "time", "auto"]
        .into_iter()
        .enumerate()
    {
        let (folder, arguments) = endless(method);
        let child = folder.start(&arguments);
        std::thread::sleep(Duration::from_millis(300 + 170 * k as u64));
        let (code, said) = interrupted(child, ["-INT", "-TERM"][k % 2]);
        assert_eq!(code, Some(1), "{method}: {said}");
        assert!(
            said.contains("interrupted") && said.contains("t = "),
            "{said}"
        );
        assert_eq!(folder.names(), ["rows.csv", "scene.toml"]);
        assert!(check_rows(&folder.read("rows.csv")) > 1);
    }
}

#[test]
fn a_sweep_goes_on_where_it_was_interrupted() {
    let folder = Folder::with(&free("duration = \"400 s\""));
    let vary = [
        "sweep",
        "scene.toml",
        "--vary",
        "motion.speed=5rad/s:50rad/s:200",
    ];
    let arguments = [
        &vary[..],
        &["--method", "time", "--no-estimate", "--out", "rows.csv"],
    ]
    .concat();
    let child = folder.start(&arguments);
    wait_for(&folder, "rows.csv.part", 3);
    let (code, said) = interrupted(child, "-INT");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("goes on from `rows.csv.part`"), "{said}");
    folder.run(&arguments).done();
    let whole = folder.read("rows.csv");
    let again = [&arguments[..arguments.len() - 1], &["again.csv"]].concat();
    folder.run(&again).done();
    assert_eq!(whole, folder.read("again.csv"));
}

/// An interrupted search reports its best design so far, and that it is unproved.
#[test]
fn a_search_says_the_best_design_so_far() {
    let folder = Folder::with(&free("duration = \"1000 s\""));
    let vary = "motion.speed=5rad/s:50rad/s";
    let arguments = ["optimise", "scene.toml", "--method", "time", "--vary", vary];
    let goal = ["--least", "theta", "--out", "rows.csv", "--json"];
    let mut child = folder.start(&[&arguments[..], &goal].concat());
    std::thread::sleep(Duration::from_secs(2));
    let mut stdout = child.stdout.take().expect("standard output");
    let (code, said) = interrupted(child, "-INT");
    let mut shown = String::new();
    stdout.read_to_string(&mut shown).expect("a text");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("interrupted"), "{said}");
    // Before the first design the program reports nothing.
    if folder.names().contains(&"rows.csv".to_owned()) {
        let found: serde_json::Value = serde_json::from_str(&shown).expect("JSON");
        assert_eq!(found["interrupted"], true);
        assert_eq!(found["proof"]["is_complete"], false);
        assert!(found["values"][0]["value"].as_f64().expect("a speed") >= 5.0);
    }
}

/// Commands without partial results leave no file when interrupted.
#[test]
fn a_command_without_rows_to_keep_leaves_no_file() {
    let (folder, _) = endless("time");
    let arguments = [
        "precision",
        "scene.toml",
        "--out",
        "table.csv",
        "--tolerances",
        "1e-12",
    ];
    let child = folder.start(&arguments);
    std::thread::sleep(Duration::from_millis(700));
    let (code, said) = interrupted(child, "-INT");
    assert_eq!(code, Some(1), "{said}");
    assert!(said.contains("interrupted"), "{said}");
    assert_eq!(folder.names(), ["scene.toml"]);
}
