//! `inverse`: valid and damaged data files, columns, rows, keys.

use super::program::{Folder, PUMP, Rows, at, close, has_keys};

const COLUMNS: &str = "t_s,theta_rad,omega_rad_per_s,alpha_rad_per_s2,slider_force_n,slider_force_se_n,crank_torque_nm,near_dead_centre,crank_torque_se_nm";

/// Returns twelve samples of a crank that turns at 3 rad/s from 0.3 rad.
fn rows(separator: &str) -> Vec<String> {
    let row = |i: u32| {
        let t = f64::from(i) / 100.0;
        format!("{t}{separator}{:.6}", 0.3 + 3.0 * t)
    };
    (0..12).map(row).collect()
}

fn data(header: &str, rows: &[String]) -> String {
    format!("{header}\n{}\n", rows.join("\n"))
}

fn folder(data: &str) -> Folder {
    let folder = Folder::with(PUMP);
    folder.write("data.csv", data);
    folder
}

/// Checks that a damaged file ends the program with code 2, a message with these words, and no output of any kind.
#[track_caller]
fn refused(data: &str, words: &[&str]) {
    refused_with(data, &[], words);
}

#[track_caller]
fn refused_with(data: &str, options: &[&str], words: &[&str]) {
    let folder = folder(data);
    let outputs = [
        "--out",
        "rows.csv",
        "--residuals",
        "residuals.csv",
        "--plot",
        "figure.svg",
    ];
    let arguments = [
        &["inverse", "scene.toml", "data.csv"],
        &outputs[..],
        options,
    ]
    .concat();
    folder.run(&arguments).fails(2, words);
    assert_eq!(folder.names(), ["data.csv", "scene.toml"], "{data}");
}

/// Returns the usual file with one row in place of the fifth, which is on line 6.
fn with_row(row: &str) -> String {
    let mut rows = rows(",");
    rows[4] = row.to_owned();
    data("t [s],theta [rad]", &rows)
}

#[test]
fn damaged_numbers_are_shown_with_line_and_column() {
    for (row, words) in [
        ("0.04,abc", ["data.csv:6:6", "`abc` is not a number"]),
        ("abc,0.42", ["data.csv:6:1", "`abc` is not a number"]),
        ("0.04,", ["data.csv:6", "the value is missing"]),
        (",0.42", ["data.csv:6", "the value is missing"]),
        ("0.04,NaN", ["data.csv:6:6", "not a finite number"]),
        ("0.04,inf", ["data.csv:6:6", "not a finite number"]),
        ("0.04,1e999", ["data.csv:6:6", "not a finite number"]),
        (
            "0.04,0.42 rad",
            ["data.csv:6:6", "units belong in the header"],
        ),
        ("0.04,#REF!", ["data.csv:6:6", "`#REF!` is not a number"]),
        ("0.04,0.4.2", ["data.csv:6:6", "`0.4.2` is not a number"]),
        ("0.04,1e15", ["data.csv:6:6", "below 1e12"]),
        ("0.04,--0.4", ["data.csv:6:6", "is not a number"]),
        (
            "2026-01-01,0.42",
            ["data.csv:6:1", "`2026-01-01` is not a number"],
        ),
        (
            "0.04,1,234.5",
            ["data.csv:6:1", "3 values where the header has 2 columns"],
        ),
        (
            "0.04",
            ["data.csv:6:1", "1 value where the header has 2 columns"],
        ),
        ("0.04,\"0.42", ["data.csv:6:6", "a quote is not closed"]),
        ("0.04,\"0.4\n2\"", ["data.csv:6:6", "a quote is not closed"]),
        ("#N/A,0.42", ["data.csv:6:1", "`#N/A` is not a number"]),
        ("   \n0.04,abc", ["data.csv:7:6", "`abc` is not a number"]),
    ] {
        refused(&with_row(row), &words);
    }
}

#[test]
fn lines_are_counted_whatever_they_end_with() {
    let text = with_row("0.04,abc");
    for end in ["\r\n", "\r"] {
        let words = ["data.csv:6:6", "`abc` is not a number"];
        refused(&text.replace('\n', end), &words);
    }
    let tabs = with_row("0.04\t").replace(',', "\t");
    refused(&tabs, &["data.csv:6:6", "the value is missing"]);
}

#[test]
fn damaged_times_are_shown_with_line_and_column() {
    for (row, words) in [
        ("0.03,0.42", ["data.csv:6:1", "the time 0.03 is repeated"]),
        ("0.02,0.42", ["data.csv:6:1", "the time 0.02 follows 0.03"]),
        (
            "-0.04,0.42",
            ["data.csv:6:1", "the time -0.04 follows 0.03"],
        ),
    ] {
        refused(&with_row(row), &words);
    }
}

#[test]
fn a_value_as_long_as_a_file_is_not_shown_whole() {
    let row = format!("0.04,{}", "1".repeat(100_000));
    let folder = folder(&with_row(&row));
    let outcome = folder.run(&["inverse", "scene.toml", "data.csv"]);
    let said = outcome.fails(2, &["data.csv:6:6", "` is not a finite number"]);
    assert!(said.stderr.len() < 2000, "{} bytes", said.stderr.len());
}

#[test]
fn damaged_headers_are_shown() {
    for (header, words) in [
        (
            "theta [rad],value [rad]",
            ["data.csv:1", "no column holds the time"],
        ),
        (
            "t [s],value [rad]",
            ["data.csv:1", "no column is called theta, gamma, x or omega"],
        ),
        (
            "t [s],theta",
            ["data.csv:1:7", "the column `theta` has no unit"],
        ),
        (
            "t,theta [rad]",
            ["data.csv:1:1", "the column `t` has no unit"],
        ),
        (
            "t [s],theta [mm]",
            ["data.csv:1:7", "`mm` is not the unit of an angle"],
        ),
        (
            "t [s],x [deg]",
            ["data.csv:1:7", "`deg` is not the unit of a length"],
        ),
        (
            "t [s],theta [grad]",
            ["data.csv:1:7", "`grad` is not a known unit"],
        ),
        (
            "t [m],theta [rad]",
            ["data.csv:1:1", "`m` is not the unit of a time"],
        ),
        (
            "theta [rad],theta [deg]",
            ["data.csv:1", "no column holds the time"],
        ),
        (
            "t [s],t [ms]",
            ["data.csv:1:7", "two columns `t [s]` and `t [ms]`"],
        ),
        (
            "\"t [s],theta [rad]",
            ["data.csv:1:1", "a quote is not closed on its line"],
        ),
        (
            "t [s] theta [rad]",
            ["data.csv:1", "separated by comma, semicolon or tab"],
        ),
    ] {
        refused(&data(header, &rows(",")), &words);
    }
    refused(
        &data("t [s],theta [rad],theta [deg]", &rows(",")),
        &["two columns `theta [rad]` and `theta [deg]`"],
    );
    let no_header = rows(",").join("\n");
    refused(
        &no_header,
        &["data.csv:1:1", "there is no header", "--columns"],
    );
    refused_with(
        &data("t [s],theta [rad]", &rows(",")),
        &["--column", "x"],
        &["no column is called `x`"],
    );
    refused_with(
        &no_header,
        &["--columns", "t [s],theta"],
        &["--columns", "has no unit"],
    );
    refused_with(
        &data("t [s],theta [rad]", &rows(",")),
        &["--columns", "t [s],theta [rad]"],
        &["the file has a header", "leave --columns out"],
    );
    refused_with(
        &no_header,
        &["--columns", "t [s],theta [rad],note"],
        &["data.csv:1:1", "2 values where --columns has 3 columns"],
    );
}

#[test]
fn files_that_hold_too_little_or_something_else() {
    refused("", &["the file is empty"]);
    refused("\n\n", &["the file is empty"]);
    refused("# only a comment\n", &["the file is empty"]);
    refused(
        "t [s],theta [rad]\n",
        &["0 samples where at least 6 are needed"],
    );
    refused(
        &data("t [s],theta [rad]", &rows(",")[..5]),
        &["5 samples where at least 6 are needed"],
    );
    refused(
        &data("t [s];theta [rad]", &with_commas()),
        &["data.csv:2:3", "decimal comma", "--decimal comma"],
    );
    refused_with(
        &data("t [s],theta [rad]", &rows(",")),
        &["--decimal", "comma"],
        &["commas cannot be decimal", "semicolon or tab"],
    );
    refused_with(
        &data("t [s];theta [rad]", &with_commas()).replacen("0,01", "0.01", 1),
        &["--decimal", "comma"],
        &["data.csv:3:1", "`0.01` has a point"],
    );
    refused(
        &data("t [s];x [mm]", &["0;1,234.5".to_owned()]),
        &["data.csv:2:3", "separators of thousands"],
    );
    let zero = data("t [s],theta [rad]", &rows(",")).replace("0.33", "0\u{0}33");
    refused(&zero, &["line 3", "zero byte"]);
    for (bytes, words) in [
        (&b"\xff\xfet\0,"[..], "UTF-16 text with characters cut off"),
        (
            b"PK\x03\x04\x14\0",
            "an archive, as workbooks of spreadsheets are",
        ),
        (b"\x1f\x8b\x08\0", "the file is compressed"),
    ] {
        let folder = Folder::with(PUMP);
        std::fs::write(folder.path("data.csv"), bytes).expect("the folder can be written");
        folder
            .run(&["inverse", "scene.toml", "data.csv", "--out", "rows.csv"])
            .fails(2, &[words]);
        assert_eq!(folder.names(), ["data.csv", "scene.toml"]);
    }
    Folder::with(PUMP)
        .run(&["inverse", "scene.toml", "none.csv"])
        .fails(2, &["`none.csv` cannot be read"]);
    Folder::with(PUMP)
        .run(&["inverse", "scene.toml"])
        .fails(2, &["needs a scene and the data"]);
}

fn with_commas() -> Vec<String> {
    rows(";").iter().map(|row| row.replace('.', ",")).collect()
}

#[test]
fn values_that_the_mechanism_cannot_have() {
    let column = |header: &str, bad: &str| {
        let mut rows: Vec<String> = (0..12)
            .map(|i| format!("{},{}", f64::from(i) / 100.0, 120 - i))
            .collect();
        rows[4] = format!("0.04,{bad}");
        data(header, &rows)
    };
    refused(
        &column("t [s],gamma [deg]", "-116"),
        &["data.csv:6:6", "gamma = -116 deg cannot be reached"],
    );
    refused(
        &column("t [s],gamma [deg]", "200"),
        &["data.csv:6:6", "gamma = 200 deg cannot be reached"],
    );
    refused(
        &column("t [s],x [mm]", "20"),
        &["data.csv:6:6", "x = 20 mm cannot be reached"],
    );
    refused(
        &column("t [s],x [mm]", "260"),
        &[
            "data.csv:6:6",
            "x = 260 mm cannot be reached",
            "60 mm beyond",
        ],
    );
    refused(
        &column("t [s],x [mm]", "-116"),
        &["data.csv:6:6", "x = -116 mm cannot be reached"],
    );
}

#[test]
fn a_crank_angle_out_of_reach() {
    let folder = Folder::with(super::program::ROCKER);
    folder.write(
        "data.csv",
        &data(
            "t [s],theta [deg]",
            &rows(",")
                .iter()
                .map(|r| r.replace("0.420000", "80"))
                .collect::<Vec<_>>(),
        ),
    );
    folder
        .run(&["inverse", "scene.toml", "data.csv", "--out", "rows.csv"])
        .fails(2, &["data.csv:6:6", "theta = 80 deg cannot be reached"]);
}

#[test]
fn every_problem_of_a_file_is_listed() {
    let mut rows = rows(",");
    rows[2] = "0.02,abc".to_owned();
    rows[7] = "0.07,".to_owned();
    rows[9] = "0.09,1,2".to_owned();
    refused(
        &data("t [s],theta [rad]", &rows),
        &["data.csv:4:6", "data.csv:9", "data.csv:11"],
    );
}

#[test]
fn files_as_instruments_write_them() {
    let plain = data("t [s],theta [rad]", &rows(","));
    let degrees: Vec<String> = (0..12)
        .map(|i| {
            format!(
                "x;{};{}",
                i * 10,
                (0.3f64 + 0.03 * f64::from(i)).to_degrees()
            )
        })
        .collect();
    for (text, options) in [
        (plain.clone(), &[][..]),
        (
            data("t [s];theta [rad]", &with_commas()),
            &["--decimal", "comma"],
        ),
        (
            data("t [s]\ttheta [rad]", &with_commas()).replace(';', "\t"),
            &["--decimal", "comma"],
        ),
        (
            data("t [s];theta [rad];", &rows(";"))
                .replace('\n', ";\n")
                .replacen(";;", ";", 1),
            &[],
        ),
        (plain.replace('\n', "\r\n"), &[]),
        (format!("\u{feff}# bench 3\n{plain}\n\n# end\n"), &[]),
        (
            format!("# bench 3\n \n{plain}  \n").replace('\n', "\r"),
            &[],
        ),
        (data("t/s,theta/rad", &rows(",")), &[]),
        (data("t_s\ttheta_rad", &rows("\t")), &[]),
        (data("note;time (ms);theta [deg]", &degrees), &[]),
        (rows(",").join("\n"), &["--columns", "t [s],theta [rad]"]),
        (
            plain
                .replace("0.3,", "0.30,")
                .replace("theta [rad]", "theta / rad"),
            &[],
        ),
    ] {
        let folder = folder(&text);
        let arguments = [
            &[
                "inverse",
                "scene.toml",
                "data.csv",
                "--json",
                "--out",
                "rows.csv",
                "--degree",
                "1",
            ],
            options,
        ]
        .concat();
        let summary = folder.run(&arguments).done().json();
        close(
            summary["fit"]["coefficients"][1]
                .as_f64()
                .expect("a number"),
            3.0,
            1e-5,
        );
        let rows = Rows::read(&folder.read("rows.csv"));
        assert_eq!((rows.header.as_str(), rows.len()), (COLUMNS, 12));
        close(rows.column("omega_rad_per_s")[5], 3.0, 1e-5);
    }
}

/// At a dead centre no force on the slider stands for a torque; without load and gravity none is needed at rest.
#[test]
fn a_crank_at_rest_in_its_dead_centre_needs_no_torque() {
    let rows: Vec<String> = (0..30)
        .map(|i| format!("{:.2},0", 0.02 * f64::from(i)))
        .collect();
    let folder = folder(&data("t [s],theta [rad]", &rows));
    let inverse = ["inverse", "scene.toml", "data.csv", "--out", "rows.csv"];
    folder.run(&inverse).done();
    let rows = Rows::read(&folder.read("rows.csv"));
    for torque in rows.column("crank_torque_nm") {
        close(torque, 0.0, 1e-15);
    }
}

#[test]
fn a_sample_far_off_is_noted_even_among_few() {
    let mut rows: Vec<String> = (0..30)
        .map(|i| {
            format!(
                "{0:.2},{1:.6}",
                0.01 * f64::from(i),
                0.3 + 0.0301234 * f64::from(i) + 1.7e-5 * f64::from(i * i)
            )
        })
        .collect();
    let warnings = |rows: &[String]| {
        let folder = folder(&data("t [s],theta [rad]", rows));
        let run = folder.run(&["inverse", "scene.toml", "data.csv", "--json"]);
        run.done().json()["warnings"].to_string()
    };
    let clean = warnings(&rows);
    assert!(
        clean.contains("steps of 0.000001 rad") && !clean.contains("far off"),
        "{clean}"
    );
    rows[7] = "0.07,0.52".to_owned();
    let found = warnings(&rows);
    assert!(
        found.contains("1 sample is far off and hardly counts, the farthest at line 9 by 0.0"),
        "{found}"
    );
}

#[test]
fn gaps_and_columns_beside_are_noted() {
    let mut rows: Vec<String> = (0..40)
        .map(|i| {
            format!(
                "{},{:.6},0.1",
                f64::from(i) / 100.0,
                0.3 + 0.03 * f64::from(i)
            )
        })
        .collect();
    rows.drain(20..28);
    let summary = folder(&data("t [s],theta [rad],x [m]", &rows))
        .run(&["inverse", "scene.toml", "data.csv", "--json"])
        .done()
        .json();
    let warnings = summary["warnings"].to_string();
    assert!(warnings.contains("x beside it"), "{warnings}");
    assert!(
        warnings.contains("1 gap, the first before line 22 (time 0.28)"),
        "{warnings}"
    );
}

#[test]
fn figures_show_the_bulk_of_the_forces_and_those_of_the_paper() {
    let folder = Folder::with(PUMP);
    let row = |i: u32| {
        let i = f64::from(i);
        format!("{},{}", 0.001 * i, 0.3 + 0.02 * i + 1e-5 * i * i)
    };
    let rows: Vec<String> = (0..1000).map(row).collect();
    folder.write("data.csv", &data("t [s],theta [rad]", &rows));
    let arguments = ["inverse", "scene.toml", "data.csv", "--plot", "turns.svg"];
    folder.run(&arguments).done();
    let turns = folder.read("turns.svg");
    assert!(turns.contains("peaks at dead centres are cut off"));
    assert!(turns.contains("samples, one in 10"));
    let arguments = ["inverse", "--as-printed", "--plot", "duarte.svg"];
    let text = folder.run(&arguments).done().stdout;
    assert!(text.contains("spin-only [N]"), "{text}");
    let duarte = folder.read("duarte.svg");
    assert!(duarte.contains("(9) as printed") && !duarte.contains("cut off"));
}

#[test]
fn figures_of_a_measured_speed_have_its_name_and_unit() {
    let row = |i: u32| {
        format!(
            "{},{}",
            f64::from(i) / 100.0,
            20.0 + (f64::from(i) / 9.0).sin()
        )
    };
    let rows: Vec<String> = (0..100).map(row).collect();
    let folder = folder(&data("t [s],omega [rad/s]", &rows));
    let arguments = ["inverse", "scene.toml", "data.csv", "--plot", "speed.svg"];
    folder.run(&arguments).done();
    let figure = folder.read("speed.svg");
    for words in ["crank speed ω [rad/s]", "measured minus fitted [rad/s]"] {
        assert!(figure.contains(words), "{words}");
    }
}

/// All figures share one time axis, even if the last samples, at a dead centre, have no force.
#[test]
fn figures_of_a_motion_that_ends_at_a_dead_centre_have_the_same_time() {
    let row = |i: u32| {
        let t = f64::from(i) / 100.0;
        format!(
            "{t:.2},{:.7}",
            1.0 + 2.141_592_65 * (1.0 - (1.0 - t).powi(3))
        )
    };
    let rows: Vec<String> = (0..=100).map(row).collect();
    let folder = folder(&data("t [s],theta [rad]", &rows));
    let arguments = [
        "inverse",
        "scene.toml",
        "data.csv",
        "--plot",
        "end.svg",
        "--json",
    ];
    let summary = folder.run(&arguments).done().json();
    let bands = summary["dead_centre_bands"].as_array().expect("a list");
    assert_eq!(bands.last().expect("a band")["to_s"], 1.0);
    let last_time = folder.read("end.svg").matches(">1.0<").count();
    assert_eq!(last_time, 4);
}

#[test]
fn dead_centres_are_marked_over_all_of_many_turns() {
    let row = |i: u32| {
        let turned = 0.0628 * f64::from(i);
        format!(
            "{},{:.1}",
            0.001 * f64::from(i),
            turned + 0.1 * turned.sin()
        )
    };
    let rows: Vec<String> = (0..16_000).map(row).collect();
    let folder = folder(&data("t [s],theta [rad]", &rows));
    let options = ["--fit", "smoother", "--plot", "turns.svg", "--json"];
    let arguments = [&["inverse", "scene.toml", "data.csv"], &options[..]].concat();
    let bands = folder.run(&arguments).done().json();
    let bands = bands["dead_centre_bands"].as_array().expect("a list").len();
    assert!(bands > 80, "{bands}");
    let marks = format!("not determined, one in {}", bands.div_ceil(40));
    assert!(folder.read("turns.svg").contains(&marks), "{marks}");
}

#[test]
fn times_far_from_zero_are_noted() {
    let rows = |start: f64| -> Vec<String> {
        let row = |i: u32| {
            format!(
                "{:.2},{:.6}",
                start + 0.01 * f64::from(i),
                0.3 + 0.0301234 * f64::from(i)
            )
        };
        (0..40).map(row).collect()
    };
    for (start, noted) in [(0.0, false), (1e5, false), (1.7e9, true)] {
        let folder = folder(&data("t [s],theta [rad]", &rows(start)));
        let run = folder.run(&["inverse", "scene.toml", "data.csv", "--json"]);
        let warnings = run.done().json()["warnings"].to_string();
        assert_eq!(
            warnings.contains("counted from the first row"),
            noted,
            "{warnings}"
        );
    }
}

/// Exactly at a dead centre, where the lever arm is zero, the reason given is the lever arm.
#[test]
fn a_sample_at_a_dead_centre_is_named_as_one() {
    let rows: Vec<String> = (0..40)
        .map(|i| format!("{},{}", f64::from(i) / 64.0, f64::from(i) / 16.0))
        .collect();
    let folder = folder(&data("t [s],theta [rad]", &rows));
    let run = folder.run(&["inverse", "scene.toml", "data.csv", "--json"]);
    let bands = run.done().json()["dead_centre_bands"].to_string();
    assert!(bands.contains("the sign of the lever arm"), "{bands}");
    assert!(!bands.contains("normal to the guide"), "{bands}");
}

#[test]
fn the_summary_has_every_key() {
    let folder = Folder::new();
    for fit in ["polynomial", "smoother"] {
        let summary = folder
            .run(&["inverse", "--json", "--fit", fit])
            .done()
            .json();
        has_keys(&summary, &["fit", "dead_centre_bands", "warnings"]);
        let keys = [
            "kind",
            "degree",
            "coefficients",
            "standard_errors",
            "r_squared",
            "rms",
            "sigma",
        ];
        has_keys(&summary["fit"], &keys);
        assert_eq!(summary["fit"]["kind"], fit);
        assert!(at(&summary, "fit.r_squared") > 1.0 - 1e-12);
    }
}

#[test]
fn the_built_in_motion_gives_back_its_polynomial() {
    let summary = Folder::new()
        .run(&["inverse", "--json", "--degree", "4"])
        .done()
        .json();
    for (power, expected) in [0.0649, 0.522, 2.166, -2.129, 0.472]
        .into_iter()
        .enumerate()
    {
        close(
            summary["fit"]["coefficients"][power]
                .as_f64()
                .expect("a number"),
            expected,
            1e-13,
        );
    }
}

/// A data file in place of the scene gives one message, not a thousand errors.
#[test]
fn a_scene_that_is_forgotten_or_comes_second_is_said() {
    let rows: Vec<String> = (0..3000).map(|i| format!("{i},{i}")).collect();
    let folder = folder(&data("t [s],theta [deg]", &rows));
    let forgotten = folder.run(&["inverse", "data.csv"]);
    forgotten.fails(2, &["needs a scene and the data of a motion"]);
    let swapped = folder.run(&["inverse", "data.csv", "scene.toml"]);
    swapped.fails(
        2,
        &[
            "scene.toml is a scene",
            "the scene comes first",
            "SCENE DATA.csv",
        ],
    );
    let text = folder
        .run(&["simulate", "data.csv"])
        .fails(2, &["not TOML"])
        .stderr;
    assert!(text.matches("not TOML").count() <= 20, "{text}");
}

#[test]
fn options_that_go_wrong() {
    let folder = folder(&data("t [s],theta [rad]", &rows(",")));
    for (options, words) in [
        (
            &["--fit", "cubic"][..],
            "the fit is auto, polynomial or smoother",
        ),
        (&["--degree", "-1"], "--degree"),
        (
            &["--degree", "2.5"],
            "the degree is a whole number or `auto`",
        ),
        (
            &["--degree", "11"],
            "12 samples are too few for a polynomial: it needs 13",
        ),
        (&["--column", "y"], "none of theta, gamma, x and omega"),
        (&["--residuals", "-"], "write them to files"),
        (&["--json", "--out", "-"], "both the rows and the JSON"),
        (&["--as-printed"], "in line with the pivot"),
    ] {
        folder
            .run(&[&["inverse", "scene.toml", "data.csv"], options].concat())
            .fails(2, &[words]);
    }
    folder
        .run(&["inverse", "-", "-"])
        .fails(2, &["cannot both come from standard input"]);
}

#[test]
fn clearance_is_refused() {
    let scene = format!(
        "{PUMP}\n[clearance]\njoint = \"wrist-pin\"\nradial = \"0.1 mm\"\nbearing_radius = \"10 mm\"\nyoung_modulus = \"207 GPa\"\npoisson_ratio = 0.3\nrestitution = 0.9\n"
    );
    let folder = Folder::with(&scene);
    folder.write("data.csv", &data("t [s],theta [rad]", &rows(",")));
    folder
        .run(&["inverse", "scene.toml", "data.csv", "--out", "rows.csv"])
        .fails(2, &["clearance in a joint", "tight joints", "help:"]);
    assert_eq!(folder.names(), ["data.csv", "scene.toml"]);
}

#[test]
fn printed_forces_say_that_they_ignore_friction() {
    let in_line = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[crank]\nmass = \"1 kg\"\ncg = \"10 mm\"\ninertia = \"2e-3 kg m^2\"\n[rod]\nmass = \"0.3 kg\"\ncg = \"60 mm\"\ninertia = \"800 kg mm^2\"\n[slider]\nmass = \"0.4 kg\"\n";
    let words = "have no friction";
    for (friction, said) in [("", false), ("[friction]\ncoefficient = 0.1\n", true)] {
        let folder = Folder::with(&format!("{in_line}{friction}"));
        folder.write("data.csv", &data("t [s],theta [rad]", &rows(",")));
        let run = folder.run(&[
            "inverse",
            "scene.toml",
            "data.csv",
            "--as-printed",
            "--json",
        ]);
        let warnings = run.done().json()["warnings"].to_string();
        assert_eq!(warnings.contains(words), said, "{warnings}");
    }
}

#[test]
fn rows_with_joint_forces_residuals_and_figure() {
    let folder = folder(&data("t [s],theta [rad]", &rows(",")));
    let arguments = [
        "inverse",
        "scene.toml",
        "data.csv",
        "--reactions",
        "--out",
        "rows.csv",
        "--residuals",
        "residuals.csv",
        "--mean-cycle",
        "mean.csv",
        "--plot",
        "figure.svg",
    ];
    folder.run(&arguments).done();
    assert!(folder.read("mean.csv").starts_with(
        "theta_rad,cycles,slider_force_n,slider_force_se_n,slider_force_scatter_n,crank_torque_nm,crank_torque_se_nm,crank_torque_scatter_nm\n"
    ));
    let forces = Rows::read(&folder.read("rows.csv"));
    // The wrist pin carries the slider's inertia less the force on it; nothing else moves along x.
    let (pin, force) = (
        forces.column("wrist_pin_x_n"),
        forces.column("slider_force_n"),
    );
    let shaking = forces.column("shaking_x_n");
    for i in 0..pin.len() {
        close(
            pin[i],
            -shaking[i] - force[i],
            1e-12 * force[i].abs().max(1.0),
        );
    }
    assert!(
        folder
            .read("residuals.csv")
            .starts_with("t_s,theta_rad,fitted_theta_rad,residual_rad\n")
    );
    assert!(folder.read("figure.svg").starts_with("<svg"));
}

#[test]
fn check_reads_data_files() {
    let folder = folder(&data("t [s],theta [rad]", &rows(",")));
    let said = folder.run(&["check", "data.csv"]).done().stdout;
    assert_eq!(
        said,
        "data.csv: nothing is wrong with 12 samples of theta\n"
    );
    folder.write("data.csv", &with_row("0.04,abc"));
    folder
        .run(&["check", "data.csv"])
        .fails(2, &["data.csv:6:6", "is not a number"]);
}

/// `check` reads data with the options of `inverse`, and reports a scene as a scene.
#[test]
fn check_takes_the_options_of_reading() {
    let folder = folder(&data("t [s];theta [rad]", &rows(";")).replace('.', ","));
    folder
        .run(&["check", "data.csv"])
        .fails(2, &["decimal comma"]);
    let said = folder.run(&["check", "data.csv", "--decimal", "comma"]);
    assert!(said.done().stdout.contains("12 samples of theta"));
    folder.write("bare.csv", &format!("{}\n", rows(",").join("\n")));
    let columns = ["check", "bare.csv", "--columns", "t [s],theta [rad]"];
    assert!(folder.run(&columns).done().stdout.contains("12 samples"));
    folder
        .run(&["check", "scene.toml", "--decimal", "comma"])
        .fails(2, &["this is a scene"]);
}

/// A refused fit still carries the notes on irregularities of the data.
#[test]
fn a_refused_fit_says_what_is_odd_in_the_data() {
    let row = |i: u32| {
        let late = if i > 20 { 100 } else { 0 };
        format!(
            "{},{:.4}",
            f64::from(i + late) / 100.0,
            (0.02 * f64::from(i)).sin()
        )
    };
    let folder = folder(&data(
        "t [s],theta [rad]",
        &(0..32).map(row).collect::<Vec<_>>(),
    ));
    folder
        .run(&[
            "inverse",
            "scene.toml",
            "data.csv",
            "--fit",
            "polynomial",
            "--degree",
            "60",
        ])
        .fails(2, &["\nnote: 1 gap"]);
}

/// Positions of the right branch are unreachable on the left branch.
#[test]
fn positions_of_the_other_branch() {
    let rocker = super::program::ROCKER;
    let folder = Folder::with(&rocker.replace("offset", "branch = \"left\"\noffset"));
    let right: Vec<String> = (0..12)
        .map(|i| format!("{},{}", f64::from(i) / 100.0, 99 - i))
        .collect();
    folder.write("data.csv", &data("t [s],x [mm]", &right));
    folder.run(&["inverse", "scene.toml", "data.csv"]).fails(
        2,
        &["x = 99 mm cannot be reached: it belongs to no crank angle of the branch"],
    );
}

/// The standard error of a rod length appears in the error budget of `inverse`; other commands use the central value.
#[test]
fn uncertain_values_of_the_scene_have_their_share() {
    let text = data("t [s],theta [rad]", &rows(","));
    let uncertain = PUMP.replace("150 mm", "150 ± 1 mm");
    let [with, without] = [uncertain.as_str(), PUMP].map(|scene| {
        let folder = Folder::with(scene);
        folder.write("data.csv", &text);
        folder
    });
    let summary = with
        .run(&["inverse", "scene.toml", "data.csv", "--json"])
        .done()
        .json();
    let sources: Vec<&str> = (0..2)
        .filter_map(|k| summary["error_budget"][k]["source"].as_str())
        .collect();
    assert!(sources.contains(&"geometry.rod"), "{sources:?}");
    let shown = with.run(&["inverse", "scene.toml", "data.csv"]).done();
    assert!(shown.stdout.contains("geometry.rod"), "{}", shown.stdout);
    let [middle, same] =
        [with, without].map(|folder| folder.run(&["kinematics", "scene.toml"]).done().stdout);
    assert_eq!(middle, same);
}

#[test]
fn rows_without_a_value_are_gaps_where_an_option_says_so() {
    refused(&with_row("0.04,NaN"), &["data.csv:6:6", "--missing NaN"]);
    for (mark, cell) in [("NaN", "nan"), ("", ""), ("-999", "-999.00")] {
        let folder = folder(&with_row(&format!("0.04,{cell}")));
        let command = ["inverse", "scene.toml", "data.csv", "--out", "rows.csv"];
        let arguments = [&command[..], &["--missing", mark]].concat();
        let outcome = folder.run(&arguments).done();
        let is_said = outcome.stdout.contains("1 row without time or theta");
        assert!(is_said, "{outcome:?}");
        assert_eq!(folder.read("rows.csv").lines().count(), 12);
    }
}
