//! `precision`: rows, figure, folders, exit codes.

use super::program::{Folder, ROCKER, free};

const HEADER: &str = "scene,method,tolerance,error_theta_rad,error_omega_rad_per_s,estimate_theta_rad,wall_s,evaluations,steps";
/// Returns the pump, run for half a second.
fn pump() -> String {
    free("duration = \"0.5 s\"")
}

const FAST: [&str; 4] = ["--tolerances", "1e-5,1e-9", "--repeats", "1"];

fn with_fast<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    let mut all = vec!["precision"];
    all.extend(arguments);
    all.extend(FAST);
    all
}

#[test]
fn rows_have_the_columns_of_the_contract() {
    let folder = Folder::new();
    folder.run(&with_fast(&["--out", "p.csv", "--plot", "p.svg"]));
    let rows = folder.read("p.csv");
    let mut lines = rows.lines();
    assert_eq!(lines.next(), Some(HEADER));
    let lines: Vec<Vec<&str>> = lines.map(|line| line.rsplitn(9, ',').collect()).collect();
    assert_eq!(lines.len(), 10, "five methods, two tolerances");
    for cells in &lines {
        for number in &cells[..7] {
            let number: f64 = number.parse().expect("a number");
            assert!(number.is_finite() && number >= 0.0);
        }
    }
    let svg = folder.read("p.svg");
    for text in ["dop853", "energy", "[rad]", "[s]", "Duarte"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn one_result_goes_to_standard_output() {
    let folder = Folder::with(&pump());
    let rows = folder.run(&with_fast(&["scene.toml", "--out", "-"]));
    assert_eq!(rows.code, Some(0));
    assert!(rows.stdout.starts_with(HEADER));
    let svg = folder.run(&with_fast(&["scene.toml", "--plot", "-"]));
    assert!(svg.stdout.starts_with("<svg") && svg.stdout.trim_end().ends_with("</svg>"));
    let json = folder.run(&with_fast(&["scene.toml", "--json"]));
    let json: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let scene = &json["scenes"][0];
    assert!(
        scene["reference_error_theta_rad"]
            .as_f64()
            .expect("a number")
            < 1e-10
    );
    assert!(scene["rows"].as_array().expect("rows").len() >= 4);
    let text = folder.run(&with_fast(&["scene.toml"])).stdout;
    for word in ["reference", "dopri5", "1e-5", "evaluations"] {
        assert!(text.contains(word), "{word}: {text}");
    }
    for both in [
        ["--out", "-", "--json"].as_slice(),
        &["--out", "-", "--plot", "-"],
    ] {
        let outcome = folder.run(&with_fast(both));
        assert_eq!(outcome.code, Some(2), "{both:?}");
    }
}

#[test]
fn a_folder_means_its_scene_files() {
    let folder = Folder::with(&pump());
    folder.write("another.toml", &pump());
    folder.write("notes.txt", "no scene");
    folder.run(&with_fast(&[".", "--out", "p.csv"]));
    let rows = folder.read("p.csv");
    let single = folder.run(&with_fast(&["scene.toml", "--out", "-"]));
    assert_eq!(
        rows.lines().count() - 1,
        2 * (single.stdout.lines().count() - 1)
    );
    let empty = Folder::new();
    let outcome = empty.run(&with_fast(&["."]));
    assert!(outcome.code == Some(2) && outcome.stderr.contains("no scene file"));
}

#[test]
fn what_cannot_be_computed_leaves_empty_rows() {
    let folder = Folder::with(&pump());
    let alone = ROCKER.replace("[slider]\nmass = \"0.5 kg\"\n", "");
    let fast = format!("{alone}\n[motion]\nspeed = \"30 rad/s\"\n");
    folder.write("rocker.toml", &fast);
    let outcome = folder.run(&with_fast(&["rocker.toml", "scene.toml", "--out", "p.csv"]));
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    let rows = folder.read("p.csv");
    assert!(rows.lines().any(|line| line.ends_with(",,,,,,")), "{rows}");
    assert!(
        rows.lines()
            .any(|line| line.contains("dop853") && !line.ends_with(','))
    );
}

/// Jamming ends the motion, and a loose joint has one engine only: neither has a reference to be measured against.
#[test]
fn jamming_and_loose_joints_have_rows_that_say_why() {
    let folder = Folder::new();
    let hard = concat!(env!("CARGO_MANIFEST_DIR"), "/data/hard");
    let [jam, loose] =
        ["09-jamming", "11-clearance-free-crank"].map(|name| format!("{hard}/{name}.toml"));
    let outcome = folder.run(&with_fast(&[&jam, &loose, "--out", "p.csv"]));
    assert_eq!(outcome.code, Some(1), "{}", outcome.stderr);
    for words in ["jams", "no other method reaches the end"] {
        assert!(
            outcome.stdout.contains(words),
            "{words}: {}",
            outcome.stdout
        );
    }
    let rows = folder.read("p.csv");
    let lines = rows.lines().skip(1).map(|line| line.rsplitn(9, ','));
    let lines: Vec<Vec<&str>> = lines.map(Iterator::collect).collect();
    assert_eq!(lines.len(), 8);
    for cells in &lines {
        let loose = cells[8].contains("Loose");
        assert!(
            cells[5].is_empty() && cells[3].is_empty() != loose,
            "{rows}"
        );
        assert_eq!(cells[7] == "contact", loose, "{rows}");
    }
}

#[test]
fn wrong_arguments_are_named() {
    let folder = Folder::new();
    for (wrong, word) in [
        ("0", "between 0 and 1"),
        ("1e-6,abc", "abc"),
        ("1e-30", "tolerance"),
    ] {
        let outcome = folder.run(&["precision", "--repeats", "1", "--tolerances", wrong]);
        assert_eq!(outcome.code, Some(2), "{wrong}");
        assert!(outcome.stderr.contains(word), "{}", outcome.stderr);
    }
    assert_eq!(folder.run(&["precision", "missing.toml"]).code, Some(2));
}
