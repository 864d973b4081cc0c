//! Scenes and files that cannot be used: exit code 2, every problem with its line, no result.

use super::program::{Folder, driven, free};

const COMMANDS: [&str; 4] = ["simulate", "kinematics", "explain", "check"];

/// A misspelt key in line 4, a negative mass in line 7, a wrong unit in line 10, a missing unit in line 13.
const BAD: &str = r#"[geometry]
crank = "50 mm"
rod = "150 mm"
ofset = "5 mm"

[slider]
mass = "-1 kg"

[motion]
speed = "10 mm"

[run]
duration = 1.5
"#;

#[test]
fn all_problems_are_shown_with_their_lines() {
    let folder = Folder::with(BAD);
    let said = COMMANDS.map(|command| {
        let words = [
            "scene.toml:4:",
            "did you mean `offset`",
            "scene.toml:7:",
            "negative",
            "scene.toml:10:",
            "`mm` is not the unit",
            "scene.toml:13:",
            "has no unit",
        ];
        folder.run(&[command, "scene.toml"]).fails(2, &words).stderr
    });
    assert!(
        said.iter().all(|text| *text == said[0]),
        "every command says the same: {said:?}"
    );
    let lines: Vec<_> = said[0]
        .lines()
        .filter(|line| line.contains("scene.toml:"))
        .collect();
    let number = |line: &str| line.split(':').nth(1).and_then(|n| n.parse::<u32>().ok());
    let numbers: Vec<_> = lines.iter().filter_map(|line| number(line)).collect();
    assert!(
        numbers.is_sorted() && numbers.len() == lines.len(),
        "in the order of the file: {lines:?}"
    );
    assert!(
        said[0].contains("mass = \"-1 kg\""),
        "the line itself is shown: {}",
        said[0]
    );
}

#[test]
fn what_is_not_toml_is_shown_with_its_line() {
    let folder = Folder::with("[geometry]\ncrank = \"50 mm\nrod = \"150 mm\"\n");
    for command in COMMANDS {
        folder
            .run(&[command, "scene.toml"])
            .fails(2, &["scene.toml:2:"]);
    }
}

#[test]
fn a_file_that_cannot_be_read_is_named() {
    let folder = Folder::with(&free("duration = \"1 s\""));
    for command in COMMANDS {
        folder
            .run(&[command, "missing.toml"])
            .fails(2, &["missing.toml", "cannot be read"]);
        folder
            .run(&[command, "."])
            .fails(2, &["`.`", "cannot be read"]);
    }
}

#[test]
fn a_table_that_cannot_be_read_is_named_with_the_line_that_asks_for_it() {
    let load = "[[torque]]\nkind = \"table\"\nfile = \"missing.csv\"\nof = \"t\"\n";
    let folder = Folder::with(&format!("{load}{}", free("duration = \"1 s\"")));
    for command in COMMANDS {
        folder
            .run(&[command, "scene.toml"])
            .fails(2, &["scene.toml:3:", "missing.csv"]);
    }
}

/// A formula or table may lack a value at some states; the program reports this and prints no placeholder there.
#[test]
fn a_load_without_a_value_is_said() {
    let load =
        |formula: &str| format!("[[torque]]\nkind = \"expression\"\nvalue = \"{formula}\"\n");
    let prescribed = driven("duration = \"1 s\"");
    let folder = Folder::with(&format!("{}{prescribed}", load("sqrt(theta - 2)")));
    let explain = |angle| folder.run(&["explain", "scene.toml", "--at", angle]);
    explain("1 rad").fails(
        2,
        &["torque[1]", "no finite value", "theta = 1 rad", "help:"],
    );
    explain("3 rad").done();
    for (command, words) in [
        ("simulate", "the range of the driving torque is not given"),
        ("statics", "a load has no finite value at some crank angles"),
    ] {
        let shown = folder.run(&[command, "scene.toml"]).done().stdout;
        assert!(shown.contains(words), "{shown}");
        assert!(!shown.contains("NaN"), "{shown}");
    }
    let always = Folder::with(&format!("{}{prescribed}", load("sqrt(theta + 1)")));
    for command in ["simulate", "statics"] {
        let shown = always.run(&[command, "scene.toml"]).done().stdout;
        assert!(!shown.contains("warning"), "{shown}");
    }
    let long = driven("revolutions = 101");
    let long = Folder::with(&format!("{}{long}", load("sin(theta)")));
    let shown = long.run(&["simulate", "scene.toml"]).done().stdout;
    assert!(shown.contains("more than 100 turns"), "{shown}");
}

#[test]
fn a_mechanism_that_cannot_be_assembled_is_refused() {
    let geometry = "[geometry]\ncrank = \"50 mm\"\nrod = \"100 mm\"\noffset = \"200 mm\"\n";
    let folder = Folder::with(geometry);
    for command in COMMANDS {
        folder
            .run(&[command, "scene.toml"])
            .fails(2, &["scene.toml:", "help"]);
    }
}

#[test]
fn a_run_has_to_say_how_long_it_is() {
    let folder = Folder::with(&free(""));
    for command in ["simulate", "check"] {
        let words = ["how long", "help", "duration", "revolutions"];
        folder.run(&[command, "scene.toml"]).fails(2, &words);
    }
    for command in ["kinematics", "explain"] {
        folder.run(&[command, "scene.toml"]).done();
    }
}

#[test]
fn a_free_mechanism_without_inertia_is_refused() {
    let folder = Folder::with(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[run]\nduration = \"1 s\"\n",
    );
    folder
        .run(&["simulate", "scene.toml"])
        .fails(2, &["no inertia", "help:"]);
    folder.run(&["kinematics", "scene.toml"]).done();
}

/// At a change point, with crank and rod in one line, the equation does not determine the motion from rest. A motion
/// that arrives there with speed continues with a warning.
#[test]
fn a_start_at_a_change_point_is_refused() {
    let scene = free("duration = \"1 s\"").replace("150 mm", "50 mm");
    for angle in ["90 deg", "-90 deg", "270 deg"] {
        let there = scene.replace("[motion]", &format!("[motion]\nangle = \"{angle}\""));
        for scene in [there.replace("10 rad/s", "0 rad/s"), there] {
            Folder::with(&scene)
                .run(&["simulate", "scene.toml"])
                .fails(2, &["change point", "help:"]);
        }
    }
    let folder = Folder::with(&scene);
    let shown = folder.run(&["simulate", "scene.toml"]).done().stdout;
    assert!(shown.contains("warning") && shown.contains("change point"));
    let shown = folder.run(&["kinematics", "scene.toml"]).done().stdout;
    assert!(
        shown.contains("change-point") && shown.contains("warning"),
        "{shown}"
    );
}

#[test]
fn brackets_may_be_nested_at_will() {
    let brackets = "(".repeat(30_000);
    let scene = format!("[geometry]\ncrank = \"50 {brackets}mm\"\nrod = \"150 mm\"\n");
    let folder = Folder::with(&scene);
    folder.write("motion.csv", &format!("t [s],theta [{brackets}deg]\n0,1\n"));
    for file in ["scene.toml", "motion.csv"] {
        folder
            .run(&["check", file])
            .fails(2, &["bracket", "not closed"]);
    }
}

#[test]
fn of_very_many_problems_the_first_are_shown_and_all_counted() {
    let load = "[[torque]]\nkind = \"constant\"\nvalue = \"2 kg\"\n";
    let scene = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n{}",
        load.repeat(20_000)
    );
    let folder = Folder::with(&scene);
    let said = folder
        .run(&["check", "scene.toml"])
        .fails(2, &["scene.toml:6:", "19980 more problems"]);
    assert!(said.stderr.lines().count() < 200, "{}", said.stderr);
}

#[test]
fn one_mistake_in_a_column_is_shown_three_times_and_counted() {
    let folder = Folder::new();
    for (name, row) in [
        ("comma", "0.5;1,5\n"),
        ("missing", "0.5;\n"),
        ("formula", "#DIV/0!;1\n"),
        ("repeated", "0.5;1\n"),
    ] {
        let text = format!("t [s];theta [deg]\n0.1;1\n{}", row.repeat(100));
        folder.write("motion.csv", &text);
        let said = folder
            .run(&["check", "motion.csv"])
            .fails(2, &["more like these"])
            .stderr;
        assert_eq!(said.matches("error: ").count(), 4, "{name}: {said}");
        let rest = if name == "repeated" {
            "96 problems more"
        } else {
            "97 problems more"
        };
        assert!(said.contains(rest), "{name}: {said}");
    }
}

#[test]
fn what_a_title_says_is_shown_not_obeyed() {
    let folder = Folder::with(&format!(
        "title = \"a\\u001b[31mb\\u0007\"\n{}",
        driven("duration = \"0.1 s\"")
    ));
    for command in ["simulate", "kinematics", "check", "explain", "statics"] {
        let shown = folder.run(&[command, "scene.toml"]).done().stdout;
        assert!(shown.contains("a\\u{1b}[31mb\\u{7}"), "{command}: {shown}");
        let commands = |c: char| c.is_control() && c != '\n';
        assert!(!shown.contains(commands), "{command}: {shown:?}");
    }
    let title: String = folder
        .run(&["simulate", "scene.toml", "--json"])
        .done()
        .json()["scene"]
        .as_str()
        .expect("a title")
        .to_owned();
    assert_eq!(title, "a\u{1b}[31mb\u{7}");
    folder.write(
        "free.toml",
        "title = \"a\\u001b[31mb\"\n[geometry]\ncrank = \"5 cm\"\nrod = \"15 cm\"\n\
         [slider]\nmass = \"1 kg\"\n[crank]\ninertia = \"0.1 kg m^2\"\n\
         [motion]\nspeed = \"10 rad/s\"\n[run]\nduration = \"0.1 s\"\n",
    );
    let cells = [
        "precision",
        "free.toml",
        "--tolerances",
        "1e-8",
        "--out",
        "-",
    ];
    let told = folder.run(&cells);
    assert!(told.stdout.contains("a\\u{1b}[31mb,"), "{told:?}");
    assert!(!told.stderr.contains('\u{1b}'), "{told:?}");
    let name = "a\u{1b}[31m.toml";
    let said = folder
        .run(&["check", name])
        .fails(2, &["a\\u{1b}[31m.toml"])
        .stderr;
    assert!(!said.contains('\u{1b}'), "{said:?}");
    folder.write(name, "[geometry]\ncrank = \"\\u001b[31m\"\n");
    let said = folder
        .run(&["check", name])
        .fails(2, &["a\\u{1b}[31m.toml"])
        .stderr;
    assert!(!said.contains('\u{1b}'), "{said:?}");
}

/// The offset equals the rounded sum of crank and rod, and exceeds the exact sum.
#[test]
fn an_offset_one_rounding_beyond_crank_plus_rod_is_refused() {
    let scene = |offset: &str| {
        format!(
            "[geometry]\ncrank = \"1 m\"\nrod = \"1.8640046154075482 m\"\noffset = \"{offset} m\"\n"
        )
    };
    for offset in ["2.8640046154075485", "-2.8640046154075485"] {
        let folder = Folder::with(&scene(offset));
        for command in ["kinematics", "check"] {
            folder
                .run(&[command, "scene.toml"])
                .fails(2, &["cannot be assembled", "geometry.offset"]);
        }
    }
    Folder::with(&scene("2.864004615407548"))
        .run(&["kinematics", "scene.toml"])
        .done();
}

#[test]
fn the_table_of_a_load_is_told_from_a_motion() {
    let folder = Folder::new();
    for (header, what) in [
        ("theta [deg],pressure [bar]", "a pressure over theta"),
        ("theta [rad];torque [N m]", "a torque over theta"),
        ("t [s],F [kN]", "a force over t"),
    ] {
        let separator = if header.contains(';') { ';' } else { ',' };
        let rows: String = (0..=72)
            .map(|i| format!("{}{separator}{}\n", 10 * i, i % 7))
            .collect();
        folder.write("load.csv", &format!("{header}\n{rows}"));
        let said = folder.run(&["check", "load.csv"]).done().stdout;
        assert!(said.contains(what) && said.contains("73 rows"), "{said}");
        folder.write("load.csv", &format!("{header}\n{rows}{rows}"));
        folder
            .run(&["check", "load.csv"])
            .fails(2, &["load.csv line 75"]);
    }
    folder.write(
        "motion.csv",
        "t [s],x [mm]\n0,1\n1,2\n2,3\n3,5\n4,9\n5,12\n",
    );
    let said = folder.run(&["check", "motion.csv"]).done().stdout;
    assert!(said.contains("6 samples of x"), "{said}");
}
