//! Standard streams: data in pipes, messages on standard error, no escape codes, and closed pipes are harmless.

use std::io::{BufRead, BufReader};
use std::process::Stdio;

use super::program::{Folder, Outcome, ROCKER, Rows, driven, ended, free, give, outcome};

const GOOD: &str = "duration = \"0.1 s\"";

#[test]
fn a_dash_is_the_scene_on_standard_input() {
    let scene = free(GOOD);
    let folder = Folder::with(&scene);
    let from_file = folder
        .run(&["simulate", "scene.toml", "--json"])
        .done()
        .json();
    let from_pipe = folder
        .run_with_input(&["simulate", "-", "--json"], &scene)
        .done()
        .json();
    assert_eq!(from_file["final"], from_pipe["final"]);
    for command in ["simulate", "kinematics", "explain", "check"] {
        let shown = folder.run_with_input(&[command, "-"], &scene).done().stdout;
        assert!(!shown.is_empty(), "{command}");
        folder
            .run_with_input(&[command, "-"], "[geometry]\n")
            .fails(2, &["crank", "rod"]);
        folder
            .run_with_input(&[command, "-"], "")
            .fails(2, &["[geometry]"]);
    }
}

#[test]
fn rows_on_standard_output_send_the_summary_to_standard_error() {
    let folder = Folder::with(&free(GOOD));
    for (command, words) in [("simulate", "crank speed"), ("kinematics", "stroke")] {
        let outcome = folder.run(&[command, "scene.toml", "--out", "-"]);
        assert_eq!(outcome.code, Some(0));
        assert!(Rows::read(&outcome.stdout).len() > 100);
        assert!(outcome.stderr.contains(words), "{outcome:?}");
    }
}

#[test]
fn rows_and_json_do_not_share_standard_output() {
    let folder = Folder::with(&free(GOOD));
    for command in ["simulate", "kinematics"] {
        let outcome = folder.run(&[command, "scene.toml", "--json", "--out", "-"]);
        outcome.fails(2, &["standard output", "help:", "--out"]);
    }
}

#[test]
fn json_is_all_there_is_on_standard_output() {
    let folder = Folder::with(&free(GOOD));
    for arguments in [
        &["simulate", "scene.toml", "--json"][..],
        &["simulate", "scene.toml", "--json", "--out", "rows.csv"],
        &["kinematics", "scene.toml", "--json"],
        &["kinematics", "scene.toml", "--json", "--out", "rows.csv"],
        &["explain", "scene.toml", "--json"],
        &["schema"],
    ] {
        let outcome = folder.run(arguments).done();
        outcome.json();
        assert!(outcome.stdout.ends_with("}\n"), "{arguments:?}");
    }
}

/// Returns runs of every kind: successful, stopped, with bad arguments, with a bad scene.
fn runs() -> [&'static [&'static str]; 10] {
    [
        &["--help"],
        &["simulate"],
        &["simulate", "rocker.toml"],
        &["simulate", "--json"],
        &["simulate", "--unknown"],
        &["simulate", "bad.toml"],
        &["kinematics"],
        &["explain", "--at", "30 deg"],
        &["check", "bad.toml"],
        &["check", "missing.toml"],
    ]
}

fn folder_of_runs() -> Folder {
    let folder = Folder::new();
    folder.write("bad.toml", "[geometry]\ncrank = 50\n");
    folder.write(
        "rocker.toml",
        &format!("{ROCKER}\n[motion]\nspeed = \"10 rad/s\"\n"),
    );
    folder
}

fn has_no_escape_codes(outcome: &Outcome) {
    for stream in [&outcome.stdout, &outcome.stderr] {
        assert!(!stream.contains('\u{1b}'), "{outcome:?}");
    }
}

#[test]
fn in_a_pipe_there_are_no_escape_codes() {
    let folder = folder_of_runs();
    for arguments in runs() {
        has_no_escape_codes(&folder.run(arguments));
    }
}

#[test]
fn no_color_is_honoured_even_where_colour_is_forced() {
    let folder = folder_of_runs();
    let forced = |arguments: &[&str], no_color: Option<&str>| {
        let mut command = folder.command(arguments);
        command.env("CLICOLOR_FORCE", "1").stdin(Stdio::null());
        if let Some(value) = no_color {
            command.env("NO_COLOR", value);
        }
        outcome(&mut command)
    };
    assert!(
        forced(&["simulate", "--unknown"], None)
            .stderr
            .contains('\u{1b}')
    );
    for arguments in runs() {
        has_no_escape_codes(&forced(arguments, Some("1")));
    }
}

/// The output exceeds a pipe buffer, and the reader leaves after one line.
#[test]
fn a_reader_that_leaves_is_no_error() {
    let folder = Folder::with(&driven("duration = \"1 s\"\noutput_every = \"10 us\""));
    for arguments in [
        &["simulate", "scene.toml", "--out", "-"][..],
        &[
            "kinematics",
            "scene.toml",
            "--every",
            "0.01 deg",
            "--out",
            "-",
        ],
    ] {
        let mut child = folder.start(arguments);
        let mut reader = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut header = String::new();
        reader.read_line(&mut header).expect("a header");
        assert!(header.contains("theta_rad"), "{header}");
        drop(reader);
        ended(child).done();
    }
}

/// The reader closes before the program has read its scene, so that every write fails.
#[test]
fn a_reader_that_was_never_there_is_no_error() {
    let folder = Folder::new();
    for arguments in [
        &["simulate", "-"][..],
        &["simulate", "-", "--json"],
        &["simulate", "-", "--out", "-"],
        &["kinematics", "-"],
        &["kinematics", "-", "--json"],
        &["kinematics", "-", "--out", "-"],
        &["explain", "-"],
        &["explain", "-", "--json"],
        &["check", "-"],
    ] {
        let mut child = folder.start(arguments);
        drop(child.stdout.take());
        give(&mut child, &free(GOOD));
        let Outcome { code, stderr, .. } = ended(child);
        assert_eq!(code, Some(0), "{arguments:?}: {stderr}");
        assert!(
            !stderr.contains("panicked") && !stderr.contains("error"),
            "{arguments:?}: {stderr}"
        );
    }
}

/// A full disk causes an error message, not a panic.
#[cfg(target_os = "linux")]
#[test]
fn an_output_that_cannot_be_written_is_an_error() {
    let folder = Folder::with(&free(GOOD));
    for arguments in [
        &["simulate", "scene.toml"][..],
        &["simulate", "scene.toml", "--json"],
        &["simulate", "scene.toml", "--out", "-"],
        &["kinematics", "scene.toml"],
        &["explain", "scene.toml"],
        &["check", "scene.toml"],
        &["schema"],
    ] {
        let full = std::fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .expect("/dev/full");
        let mut command = folder.command(arguments);
        let child = command
            .stdin(Stdio::null())
            .stdout(full)
            .stderr(Stdio::piped())
            .spawn();
        let output = child
            .expect("the program starts")
            .wait_with_output()
            .expect("an end");
        let said = String::from_utf8(output.stderr).expect("UTF-8");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(
            said.starts_with("error: `standard output` cannot be written"),
            "{arguments:?}: {said}"
        );
    }
}

/// The system's names of open streams lead to the files behind them: output is appended to these files.
#[cfg(target_os = "linux")]
#[test]
fn files_that_are_open_already_are_not_replaced() {
    let folder = Folder::with(&free(GOOD));
    folder.write("log", "begun\n");
    let added = |arguments: &[&str], errors: bool| {
        let log = std::fs::OpenOptions::new()
            .append(true)
            .open(folder.path("log"))
            .expect("a log");
        let mut command = folder.command(arguments);
        command.stdin(Stdio::null());
        let (out, err) = match errors {
            true => (Stdio::piped(), log.into()),
            false => (log.into(), Stdio::piped()),
        };
        let child = command.stdout(out).stderr(err).spawn();
        let output = child.expect("the program starts").wait_with_output();
        let output = output.expect("an end");
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        let said = [output.stdout, output.stderr].concat();
        (folder.read("log"), String::from_utf8(said).expect("UTF-8"))
    };
    let rows = "t_s,theta_rad";
    let (log, said) = added(&["simulate", "scene.toml", "--out", "/dev/stdout"], false);
    assert!(log.starts_with(&format!("begun\n{rows}")), "{log}");
    assert!(said.contains("crank speed"), "{said}");
    let (log, said) = added(&["simulate", "scene.toml", "--out", "/dev/stderr"], true);
    assert_eq!(log.matches(rows).count(), 2, "{log}");
    assert!(log.starts_with("begun\n") && said.contains("crank speed"));
    folder
        .run(&["simulate", "scene.toml", "--plot", "/dev/stdout"])
        .fails(2, &["standard output", "help:"]);
}

#[test]
fn nothing_is_written_onto_what_is_read_or_twice_to_one_file() {
    let scene = free(GOOD);
    let folder = Folder::with(&scene);
    for command in ["simulate", "kinematics", "statics", "precision"] {
        folder
            .run(&[command, "scene.toml", "--out", "./scene.toml"])
            .fails(2, &["scene.toml", "is read by this command", "help:"]);
        folder
            .run(&[command, "scene.toml", "--out", "new", "--plot", "./new"])
            .fails(2, &["new", "two results", "help:"]);
    }
    let kept = std::fs::read_to_string(folder.path("scene.toml")).unwrap();
    assert_eq!(kept, scene);
    assert!(!folder.path("new").exists());
}

#[test]
fn nothing_is_written_onto_the_tables_of_a_scene() {
    let table = "theta [deg],torque [N m]\n0,1\n180,2\n360,1\n";
    let load = "[[torque]]\nkind = \"table\"\nfile = \"table.csv\"\nof = \"theta\"\nperiod = \"360 deg\"\n";
    let folder = Folder::with(&format!("{}\n{load}", free(GOOD)));
    folder.write("table.csv", table);
    let motion = "t [s],theta [rad]\n0,0\n1,1\n2,2\n3,3\n4,4\n5,5\n";
    folder.write("data.csv", motion);
    for arguments in [
        &["simulate", "scene.toml", "--out"][..],
        &["simulate", "scene.toml", "--plot"],
        &["kinematics", "scene.toml", "--out"],
        &["statics", "scene.toml", "--plot"],
        &["precision", "scene.toml", "--out"],
        &["inverse", "scene.toml", "data.csv", "--residuals"],
    ] {
        let arguments = [arguments, &["./table.csv"]].concat();
        let words = ["table.csv", "is read by this command", "help:"];
        folder.run(&arguments).fails(2, &words);
    }
    assert_eq!(folder.read("table.csv"), table);
}
