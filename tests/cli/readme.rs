//! The README agrees with the program. Its Rust example is a documentation test of the library.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use slider_crank::scene::Expression;

fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn readme() -> String {
    fs::read_to_string(repository().join("README.md")).expect("README.md")
}

/// Returns the contents of all code blocks of one language, in order.
fn blocks(language: &str) -> Vec<String> {
    let text = readme();
    let mut found = Vec::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if let Some(name) = line.strip_prefix("```") {
            let block: Vec<_> = lines.by_ref().take_while(|line| *line != "```").collect();
            if name == language {
                found.push(block.join("\n") + "\n");
            }
        }
    }
    assert!(!found.is_empty(), "no {language} block in README.md");
    found
}

/// Runs the program in the repository and returns its standard output.
fn run(arguments: &[String]) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_slider-crank"));
    let output = command.args(arguments).current_dir(repository()).output();
    let output = output.expect("the program starts");
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8");
    let said = text(output.stderr);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}: {said}");
    text(output.stdout)
}

/// Splits a command line into words; quotes protect spaces.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            c => words.last_mut().expect("a word").push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Returns the command lines of the README.
fn command_lines() -> Vec<String> {
    blocks("sh").concat().lines().map(str::to_owned).collect()
}

#[test]
fn every_command_line_works() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut shown = BTreeSet::new();
    for line in command_lines() {
        if line == "cargo test" {
            continue;
        }
        let Some(arguments) = line.strip_prefix("cargo run --release -- ") else {
            panic!("not a command of this package: {line}");
        };
        shown.insert(check_works(arguments, folder.path()));
    }
    assert_eq!(shown, commands(), "every command is shown");
    assert!(command_lines().contains(&"cargo test".to_owned()));
}

/// Runs a command line with its files in a folder; returns the command.
fn check_works(line: &str, folder: &Path) -> String {
    let mut arguments = words(line);
    let mut files = Vec::new();
    for i in 1..arguments.len() {
        let names_a_file = ["--out", "--plot", "--report"].contains(&arguments[i - 1].as_str());
        if names_a_file && arguments[i] != "-" {
            let path = folder.join(&arguments[i]);
            arguments[i] = path.to_str().expect("a plain path").to_owned();
            files.push(path);
        }
    }
    assert!(!run(&arguments).is_empty(), "{line}");
    let written = |file: &PathBuf| fs::metadata(file).is_ok_and(|about| about.len() > 100);
    assert!(files.iter().all(written), "{line}");
    arguments.swap_remove(0)
}

#[test]
fn every_example_of_the_help_works() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut shown = BTreeSet::new();
    for command in commands() {
        let help = run(&[command, "--help".to_owned()]);
        let examples = help.lines().skip_while(|line| *line != "Examples:").skip(1);
        for line in examples.filter_map(|line| line.trim().strip_prefix("slider-crank ")) {
            shown.insert(check_works(line, folder.path()));
        }
    }
    assert!(shown.len() > 10, "{shown:?}");
}

/// Returns the commands that the program lists.
fn commands() -> BTreeSet<String> {
    let help = run(&["--help".to_owned()]);
    let listed = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed = listed.take_while(|line| !line.trim().is_empty());
    let names = listed.filter_map(|line| line.split_whitespace().next());
    names
        .filter(|name| *name != "help")
        .map(str::to_owned)
        .collect()
}

/// Returns the first cells of the rows of the table with this header.
fn first_column(header: &str) -> Vec<String> {
    let text = readme();
    let rows = text
        .lines()
        .skip_while(|line| !line.starts_with(header))
        .skip(2);
    let rows = rows.take_while(|line| line.starts_with('|'));
    rows.map(|row| row.split('|').nth(1).unwrap_or_default().trim().to_owned())
        .collect()
}

#[test]
fn the_table_of_commands_is_complete() {
    let listed = first_column("| command |");
    let listed: BTreeSet<_> = listed
        .iter()
        .map(|name| name.trim_matches('`').to_owned())
        .collect();
    assert_eq!(listed, commands());
}

#[test]
fn every_function_of_formulas_is_named() {
    let help = Expression::parse("none(1)").expect_err("no function").help;
    let (_, functions) = help.split_once("functions ").expect("the functions");
    let text = readme();
    assert!(functions.split(", ").count() > 15, "{functions}");
    for function in functions.split(", ") {
        assert!(text.contains(&format!("`{function}`")), "{function}");
    }
}

/// Compares two lines with numbers to a relative 1e-6, because their last digits may depend on the machine.
fn same(shown: &str, found: &str) -> bool {
    let (shown, found) = (shown.split_whitespace(), found.split_whitespace());
    let (shown, found): (Vec<_>, Vec<_>) = (shown.collect(), found.collect());
    let agree = |(a, b): (&&str, &&str)| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) => (a - b).abs() <= 1e-6 * a.abs().max(1.0),
        _ => a == b,
    };
    shown.len() == found.len() && shown.iter().zip(&found).all(agree)
}

#[test]
fn the_output_shown_is_that_of_the_first_command() {
    let output = run(&["simulate".to_owned()]);
    let mut lines = output.lines();
    let block = &blocks("text")[0];
    for shown in block.lines() {
        assert!(
            lines.any(|line| same(shown, line)),
            "`{shown}` does not follow in\n{output}"
        );
    }
    assert!(same("a 1.0000001 b", "a 1 b"));
    assert!(!same("a 1.00001 b", "a 1 b") && !same("a b", "a c") && !same("a", "a b"));
}

/// The errors in the README agree with `precision` to a factor of three; errors of rounding size agree in that alone.
#[test]
fn the_errors_shown_are_those_of_precision() {
    let arguments = [
        "precision",
        "--repeats",
        "1",
        "--json",
        "--tolerances",
        "1e-6,1e-9,1e-12",
    ];
    let result: Value = serde_json::from_str(&run(&arguments.map(str::to_owned))).expect("JSON");
    let rows = result["scenes"][0]["rows"].as_array().expect("rows");
    let text = readme();
    let shown = text
        .lines()
        .skip_while(|line| !line.starts_with("| method and tolerance |"))
        .skip(2)
        .take_while(|line| line.starts_with('|'));
    let mut seen = 0;
    for line in shown {
        let cells: Vec<_> = line.split('|').map(str::trim).collect();
        let (method, tolerance) = cells[1].split_once(' ').expect("method and tolerance");
        let tolerance: f64 = tolerance.parse().expect("a tolerance");
        let row = rows
            .iter()
            .find(|row| row["method"] == method && row["tolerance"] == tolerance)
            .unwrap_or_else(|| panic!("no row for {line}"));
        for (cell, key) in [(2, "error_theta_rad"), (3, "estimate_theta_rad")] {
            let shown: f64 = cells[cell].parse().expect("a number");
            let found = row[key].as_f64().expect("a number");
            let rounding = shown < 1e-12 && found < 1e-12;
            assert!(
                rounding || (shown / 3.0..3.0 * shown).contains(&found),
                "{line}: {found:e}"
            );
        }
        seen += 1;
    }
    assert!(seen > 4, "{seen} rows");
}

#[test]
fn the_scene_shown_is_right() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for scene in blocks("toml") {
        let file = folder.path().join("scene.toml");
        fs::write(&file, scene).expect("the temporary folder can be written");
        let file = file.to_str().expect("a plain path").to_owned();
        run(&["check".to_owned(), file.clone()]);
        run(&["simulate".to_owned(), file]);
    }
}

/// The tables of keys and of loads name exactly the sections, keys and kinds of the schema.
#[test]
fn every_section_key_and_kind_of_load_is_named() {
    let schema: Value = serde_json::from_str(&run(&["schema".to_owned()])).expect("JSON");
    let sections = schema["properties"].as_object().expect("sections");
    let sections = sections.iter().filter(|(name, _)| *name != "title");
    let (mut tables, mut keys, mut kinds) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for (name, section) in sections {
        let (name, one) = match section.get("items") {
            Some(one) => (format!("`[[{name}]]`"), one),
            None => (format!("`[{name}]`"), section),
        };
        tables.insert(name);
        let properties = one["properties"].as_object().expect("keys");
        keys.extend(properties.keys().map(|key| format!("`{key}`")));
        if section.get("items").is_some() {
            let words = one["properties"]["kind"]["enum"].as_array().expect("kinds");
            kinds.extend(
                words
                    .iter()
                    .map(|word| format!("`{}`", word.as_str().expect("a word"))),
            );
        }
    }
    let shown: BTreeSet<_> = first_column("| table |")
        .into_iter()
        .filter(|cell| cell.starts_with('`'))
        .collect();
    assert_eq!(shown, tables);
    let shown: BTreeSet<_> = first_column("| kind of load |").into_iter().collect();
    assert_eq!(shown, kinds);
    let text = readme();
    for key in keys {
        assert!(text.contains(&key), "{key} is not named");
    }
}

#[test]
fn every_file_named_is_there() {
    let text = readme();
    let names: BTreeSet<_> = text
        .split(|c: char| c.is_whitespace() || "`|,".contains(c))
        .filter(|word| word.starts_with("data/") && word.len() > 5 || word.starts_with("LICENSE-"))
        .map(|word| word.trim_end_matches(['.', ':', ';']))
        .collect();
    assert!(names.len() > 8, "{names:?}");
    for name in names {
        assert!(repository().join(name).is_file(), "no {name}");
    }
}

#[test]
fn every_scene_in_data_is_named() {
    let text = readme();
    for entry in fs::read_dir(repository().join("data")).expect("data") {
        let name = entry
            .expect("an entry")
            .file_name()
            .into_string()
            .expect("a plain name");
        assert!(
            !name.ends_with(".toml") || text.contains(&format!("`data/{name}`")),
            "data/{name}"
        );
    }
}
