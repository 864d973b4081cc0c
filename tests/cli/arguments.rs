//! Command-line arguments: every argument has help text, and meaningless values are refused.

use super::program::{Folder, driven, free};

/// Returns the commands that the program lists.
fn commands(folder: &Folder) -> Vec<String> {
    let help = folder.run(&["--help"]).done().stdout;
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed = listed.take_while(|line| !line.trim().is_empty());
    let words = listed.filter_map(|line| line.split_whitespace().next());
    words
        .filter(|word| *word != "help")
        .map(str::to_owned)
        .collect()
}

#[test]
fn the_commands_of_this_version_are_listed() {
    let mut found = commands(&Folder::new());
    found.sort();
    let all = "animate check compare completions explain identify inverse kinematics optimise precision reproduce schema simulate statics sweep synthesis";
    assert_eq!(found.join(" "), all);
}

/// Returns the lines of a help text that introduce an argument, and whether a description follows: on the same line
/// after two spaces, or on the next line, indented deeper.
fn arguments(help: &str) -> Vec<(String, bool)> {
    let lines: Vec<&str> = help.lines().collect();
    let indent = |line: &str| line.len() - line.trim_start().len();
    let mut found = Vec::new();
    for (i, line) in lines.iter().enumerate() {
        let content = line.trim_start();
        if indent(line) == 0 || !content.starts_with(['-', '[', '<']) {
            continue;
        }
        let beside = content
            .split("  ")
            .skip(1)
            .any(|part| !part.trim().is_empty());
        let below = lines.get(i + 1).is_some_and(|next| {
            indent(next) > indent(line) && !next.trim_start().starts_with(['-', '['])
        });
        found.push((content.to_owned(), beside || below));
    }
    found
}

#[test]
fn every_command_and_every_argument_has_help() {
    let folder = Folder::new();
    for command in commands(&folder) {
        let help = folder.run(&[&command, "--help"]).done().stdout;
        let first = help.lines().next().unwrap_or_default();
        assert!(
            !first.is_empty() && !first.starts_with("Usage"),
            "{command}: {help}"
        );
        let arguments = arguments(&help);
        assert!(!arguments.is_empty(), "{command}: {help}");
        for (argument, has_help) in arguments {
            assert!(has_help, "{command}: no help for {argument}");
        }
        assert_eq!(folder.run(&["help", &command]).done().stdout, help);
    }
}

#[test]
fn the_version_is_that_of_the_package() {
    let shown = Folder::new().run(&["--version"]).done().stdout;
    assert_eq!(
        shown,
        format!("slider-crank {}\n", env!("CARGO_PKG_VERSION"))
    );
}

#[test]
fn no_command_at_all_shows_the_commands() {
    let outcome = Folder::new().run(&[]);
    assert_eq!((outcome.code, outcome.stdout.as_str()), (Some(2), ""));
    assert!(outcome.stderr.contains("simulate"), "{outcome:?}");
}

#[test]
fn what_no_command_takes_is_refused() {
    let folder = Folder::with(&free("duration = \"0.1 s\""));
    for (arguments, word) in [
        (&["simulat"][..], "simulat"),
        (&["simulate", "--fast"], "--fast"),
        (&["simulate", "scene.toml", "other.toml"], "other.toml"),
        (&["schema", "scene.toml"], "scene.toml"),
        (&["check", "--json"], "--json"),
        (&["simulate", "--out"], "--out"),
        (&["simulate", "--method", "euler"], "euler"),
        (&["simulate", "--tolerance", "small"], "small"),
        (&["simulate", "--max-evaluations", "1.5"], "1.5"),
        (&["simulate", "--max-events", "-1"], "-1"),
        (&["precision", "--repeats", "0"], "--repeats"),
        (&["precision", "--most-time", "nan"], "--most-time"),
    ] {
        folder.run(arguments).fails(2, &[word]);
    }
}

#[test]
fn angles_have_units() {
    let folder = Folder::new();
    for (arguments, words) in [
        (
            ["kinematics", "--every", "1"],
            ["`1` has no unit", "40 deg"],
        ),
        (
            ["kinematics", "--every", "1 mm"],
            ["`mm` is not the unit", "40 deg"],
        ),
        (["kinematics", "--every", "0 deg"], ["0 deg", "positive"]),
        (
            ["kinematics", "--every=-1 deg", "--json"],
            ["-1 deg", "positive"],
        ),
        (["explain", "--at", "30"], ["`30` has no unit", "40 deg"]),
        (["explain", "--at", "up"], ["`up`", "40 deg"]),
    ] {
        folder.run(&arguments).fails(2, &words);
    }
}

/// Negative values are refused for being negative, not parsed as options.
#[test]
fn values_below_zero_are_values() {
    let folder = Folder::new();
    for (arguments, words) in [
        (&["kinematics", "--every", "-1 deg"][..], "must be positive"),
        (&["statics", "--every", "-1 deg"], "must be positive"),
        (&["statics", "--tilt", "-5 deg"], "from 0 to below 90"),
        (
            &["statics", "--weight", "1 N", "--drum-radius", "-2 mm"],
            "must be positive",
        ),
        (
            &["kinematics", "--stroke", "-8 mm", "--rod-ratio", "3"],
            "must be positive",
        ),
        (
            &["kinematics", "--stroke", "8 mm", "--rod-ratio", "-3"],
            "a ratio above one",
        ),
        (&["simulate", "--tolerance", "-1"], "1e-14 to 0.1"),
        (
            &["simulate", "--steady-state", "--fluctuation", "-1"],
            "between 0 and 2",
        ),
        (&["precision", "--tolerances", "-1"], "between 0 and 1"),
    ] {
        folder.run(arguments).fails(2, &[words]);
    }
}

/// Options for reading a file are refused where no file is read.
#[test]
fn reading_options_need_a_file() {
    let folder = Folder::new();
    for option in ["--column=x", "--columns=t [s],x [mm]", "--decimal=comma"] {
        for command in ["inverse", "check"] {
            folder
                .run(&[command, option])
                .fails(2, &["measured motion is read", "help:"]);
        }
    }
}

#[test]
fn a_step_that_is_a_slip_of_the_unit_is_refused() {
    let folder = Folder::new();
    let outcome = folder.run(&["kinematics", "--every", "1e-9 deg", "--out", "rows.csv"]);
    outcome.fails(2, &["--every", "rows", "help:"]);
    assert_eq!(folder.names(), [""; 0]);
}

#[test]
fn a_tolerance_out_of_range_is_refused() {
    let folder = Folder::new();
    for tolerance in ["0", "-1e-9", "nan", "inf", "1e-17", "1"] {
        let argument = format!("--tolerance={tolerance}");
        folder
            .run(&["simulate", &argument])
            .fails(2, &["tolerance", "1e-14 to 0.1"]);
    }
}

#[test]
fn a_method_that_cannot_serve_the_scene_is_refused_with_the_reason() {
    let folder = Folder::with(&driven("duration = \"0.1 s\""));
    let load = "[[torque]]\nkind = \"expression\"\nvalue = \"sin(t)\"\n";
    folder.write(
        "free.toml",
        &format!("{}{load}", free("duration = \"0.1 s\"")),
    );
    for command in ["simulate", "explain"] {
        let run = |scene, method| folder.run(&[command, scene, "--method", method]);
        run("free.toml", "energy").fails(2, &["energy cannot serve", "depends on t", "help:"]);
        let words = ["closed-form cannot serve a free motion", "constant-speed"];
        run("free.toml", "closed-form").fails(2, &words);
        for method in ["time", "dop853", "dopri5", "energy", "angle"] {
            run("scene.toml", method).fails(2, &[method, "cannot serve", "prescribed", "help:"]);
        }
        for method in ["auto", "closed-form"] {
            run("scene.toml", method).done();
        }
        for method in ["auto", "time", "dop853", "dopri5"] {
            run("free.toml", method).done();
        }
    }
}

#[test]
fn explain_names_the_stepper_and_whose_it_is() {
    let folder = Folder::new();
    for (method, stepper) in [
        ("time", "Gauss collocation"),
        ("dop853", "Dop853 of ode_solvers"),
        ("dopri5", "Dopri5 of ode_solvers"),
    ] {
        let said = folder.run(&["explain", "--method", method]).done().stdout;
        let line = said.lines().find(|line| line.contains("stepper"));
        assert!(line.is_some_and(|line| line.contains(stepper)), "{said}");
    }
}
