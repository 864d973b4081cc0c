//! Wrong scenes: each is refused with the line, the error and the remedy.
//!
//! Every file of `tests/bad` begins with its expected problems, one line for each:
//!
//! ```text
//! # expect line 5 column 8: words of the message … more of them; help: words of the help
//! # expect no line: ...
//! ```
//!
//! Column and help may be omitted. A file has exactly the problems it announces.

use std::fs;
use std::panic;
use std::path::{Path, PathBuf};

use proptest::prelude::*;
use slider_crank::error::Error;
use slider_crank::scene::{Problem, Problems, Scene};

/// Expected problem, as announced in a file.
struct Expectation {
    text: String,
    line: Option<usize>,
    column: Option<usize>,
    what: Vec<String>,
    help: Vec<String>,
}

impl Expectation {
    fn read(text: &str) -> Expectation {
        let (place, words) = text.split_once(':').expect("a colon after the place");
        let (what, help) = words.split_once("; help:").unwrap_or((words, ""));
        let number = |name: &str| {
            let mut words = place.split_whitespace().skip_while(|word| *word != name);
            words
                .nth(1)
                .map(|n| n.parse().expect("a number after line and column"))
        };
        let fragments = |text: &str| {
            text.split('…')
                .map(|part| part.trim().to_owned())
                .filter(|part| !part.is_empty())
                .collect()
        };
        Expectation {
            text: text.to_owned(),
            line: number("line"),
            column: number("column"),
            what: fragments(what),
            help: fragments(help),
        }
    }

    fn fits(&self, problems: &Problems, problem: &Problem) -> bool {
        let place = problems.place(problem);
        place.map(|(line, _)| line) == self.line
            && self
                .column
                .is_none_or(|column| place.map(|(_, found)| found) == Some(column))
            && in_order(&problem.what, &self.what)
            && in_order(&problem.help, &self.help)
    }
}

/// Whether all fragments occur in the text in this order.
fn in_order(text: &str, fragments: &[String]) -> bool {
    let mut rest = text;
    fragments
        .iter()
        .all(|fragment| match rest.find(fragment.as_str()) {
            Some(at) => {
                rest = &rest[at + fragment.len()..];
                true
            }
            None => false,
        })
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad")
}

fn files() -> Vec<PathBuf> {
    let mut files: Vec<_> = fs::read_dir(folder())
        .expect("tests/bad")
        .map(|entry| entry.expect("an entry of tests/bad").path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .collect();
    files.sort();
    files
}

/// Returns the differences of a file from its announcement; empty if there are none.
fn disagreement(file: &Path) -> Vec<String> {
    let bytes = fs::read(file).expect("a file of tests/bad");
    let text = String::from_utf8_lossy(&bytes);
    let expected: Vec<Expectation> = text
        .lines()
        .map_while(|line| line.strip_prefix("# expect "))
        .map(Expectation::read)
        .collect();
    if expected.is_empty() {
        return vec!["announces nothing".to_owned()];
    }
    let problems = match Scene::load(file) {
        Ok(_) => return vec!["is accepted".to_owned()],
        Err(Error::Scene(problems)) => problems,
        Err(error) => return vec![format!("found: {error}")],
    };
    let mut wrong = Vec::new();
    let mut left: Vec<&Problem> = problems.list().iter().collect();
    for expectation in &expected {
        match left
            .iter()
            .position(|problem| expectation.fits(&problems, problem))
        {
            Some(at) => {
                left.remove(at);
            }
            None => wrong.push(format!("missing: {}", expectation.text)),
        }
    }
    for problem in left {
        let place = problems.place(problem);
        wrong.push(format!(
            "not announced: {place:?} {}; help: {}",
            problem.what, problem.help
        ));
    }
    let lines: Vec<_> = problems
        .list()
        .iter()
        .map(|p| problems.place(p).map(|p| p.0))
        .collect();
    if !lines.is_sorted() {
        wrong.push(format!("not in the order of the file: lines {lines:?}"));
    }
    wrong.extend(unseen(file, &problems));
    wrong
}

/// Returns the problems that the rendered text, plain or coloured, fails to show.
fn unseen(file: &Path, problems: &Problems) -> Vec<String> {
    let plain = problems.render(false);
    let mut missing = Vec::new();
    for problem in problems.list() {
        let place = problems.place(problem);
        let place = place.map_or(String::new(), |(line, column)| format!(":{line}:{column}"));
        let place = format!("{}{place}", file.display());
        for part in [&place, &problem.what, &problem.help] {
            if !plain.contains(part.as_str()) {
                missing.push(format!("not shown: {part}"));
            }
        }
    }
    if plain.contains('\u{1b}') || !problems.render(true).contains('\u{1b}') {
        missing.push("colour where none is asked for, or none where it is".to_owned());
    }
    missing
}

#[test]
fn every_bad_scene_is_refused_as_it_announces() {
    let files = files();
    assert!(files.len() >= 50, "{} files in tests/bad", files.len());
    let mut report = String::new();
    for file in &files {
        let wrong = panic::catch_unwind(|| disagreement(file))
            .unwrap_or_else(|_| vec!["makes the reader or its messages panic".to_owned()]);
        for line in wrong {
            let name = file.file_stem().expect("a file name").to_string_lossy();
            report += &format!("{name}: {line}\n");
        }
    }
    assert!(report.is_empty(), "\n{report}");
}

/// A table that no scene names would test nothing.
#[test]
fn every_bad_table_is_named_by_a_scene() {
    let scenes: String = files()
        .iter()
        .map(|file| String::from_utf8_lossy(&fs::read(file).expect("a scene")).into_owned())
        .collect();
    for entry in fs::read_dir(folder().join("tables")).expect("tests/bad/tables") {
        let name = entry
            .expect("a table")
            .file_name()
            .into_string()
            .expect("a plain name");
        assert!(scenes.contains(&format!("\"tables/{name}\"")), "{name}");
    }
}

#[test]
fn an_empty_file_has_no_geometry() {
    for text in ["", "\n", "\u{feff}", "# nothing yet\n"] {
        let problems = Scene::parse(Path::new("empty.toml"), text).expect_err("an empty scene");
        let [problem] = problems.list() else {
            panic!("{problems}")
        };
        assert_eq!(problem.field, "geometry");
        assert!(problem.what.contains("[geometry]"), "{}", problem.what);
        assert!(problems.render(false).contains("empty.toml"));
    }
}

#[test]
fn a_file_that_is_not_there_and_a_folder_are_named() {
    for file in [folder().join("nowhere.toml"), folder()] {
        let error = Scene::load(&file).expect_err("no scene");
        assert!(matches!(error, Error::Read { .. }), "{error}");
        assert!(
            error.to_string().contains(&file.display().to_string()),
            "{error}"
        );
        assert_eq!(error.exit_status(), 2);
    }
}

#[test]
fn a_wrong_scene_is_the_users_to_change() {
    let error = Scene::load(folder().join("several-problems.toml")).expect_err("a bad scene");
    assert_eq!(error.exit_status(), 2);
}

/// Scene with every section.
const GOOD: &str = r#"title = "Prüfstand №1"

[geometry]
crank = "50 mm"
rod = "150 mm"
offset = "-5 mm"
branch = "left"

[crank]
mass = "2 kg"
cg = "5 mm"
inertia = "0.02 kg·m²"

[rod]
model = "rigid"
mass = "400 g"
cg = "60 mm"
inertia = "27 kg cm^2"
inertia_about = "crank-pin"

[slider]
density = "7850 kg/m^3"
length = "80 mm"
width = "60 mm"
depth = "50 mm"

[gravity]
acceleration = "9.80665 m s⁻²"
direction = "-90°"

[[torque]]
kind = "motor"
stall = "6 N m"
no_load_speed = "1500 rpm"

[[torque]]
kind = "expression"
value = "2 - 0.01*omega + 0.3*sin(2*theta)^2"

[[torque]]
kind = "table"
file = "tables/torque.csv"
of = "theta"
period = "360 deg"

[[force]]
kind = "spring"
stiffness = "2 N/mm"
rest = "160 mm"

[[force]]
kind = "gas"
file = "tables/pressure.csv"
bore = "80 mm"

[friction]
coefficient = 0.1
static_coefficient = 0.12

[clearance]
joint = "crank-pin"
radial = "0.5 mm"
young_modulus = "207 GPa"
restitution = 0.9

[motion]
kind = "free"
angle = "30 deg"
speed = "100 rad/s"

[run]
duration = "2 s"
output_every = "1 ms"
tolerance = 1e-9
"#;

/// Texts that are difficult for readers of numbers, units, formulas and TOML.
const TOKENS: &[&str] = &[
    "\"",
    "'",
    "\"\"\"",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    "=",
    ".",
    ",",
    "#",
    "\n",
    "\r",
    "\\",
    "\\u0041",
    "\\t",
    "\t",
    "-",
    "−",
    "+",
    "^",
    "**",
    "/",
    "(",
    ")",
    "0",
    "1e999",
    "1e-999",
    "-1",
    "nan",
    "inf",
    "0x1F",
    "1_0",
    "e",
    "π",
    "é",
    "×",
    "·",
    "²",
    "⁻",
    "°",
    "µ",
    "😀",
    "\u{feff}",
    "\u{a0}",
    "\u{0}",
    "true",
    "2020-01-01",
    "kg",
    "mm",
    " ",
    "theta",
    "sin",
    "max(",
    "torque",
    "[geometry]",
    "[[force]]",
    "kind",
    "value = ",
];

/// Mutation of a text.
#[derive(Clone, Debug)]
enum Mutation {
    /// Inserts a token at a place; the number is taken modulo the length.
    Insert(usize, &'static str),
    /// Overwrites some bytes.
    Bytes(usize, Vec<u8>),
    /// Removes bytes.
    Remove(usize, usize),
    /// Removes a line.
    RemoveLine(usize),
    /// Copies a line to the place of another.
    CopyLine(usize, usize),
    /// Truncates the text.
    Cut(usize),
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = any::<usize>;
    prop_oneof![
        6 => (at(), proptest::sample::select(TOKENS)).prop_map(|(at, token)| Mutation::Insert(at, token)),
        3 => (at(), proptest::collection::vec(any::<u8>(), 1..4)).prop_map(|(at, bytes)| Mutation::Bytes(at, bytes)),
        3 => (at(), 1usize..12).prop_map(|(at, count)| Mutation::Remove(at, count)),
        2 => at().prop_map(Mutation::RemoveLine),
        2 => (at(), at()).prop_map(|(from, to)| Mutation::CopyLine(from, to)),
        1 => at().prop_map(Mutation::Cut),
    ]
}

fn mutated(text: &str, mutations: &[Mutation]) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for mutation in mutations {
        let length = bytes.len().max(1);
        match mutation {
            Mutation::Insert(at, token) => {
                let at = at % length;
                bytes.splice(at.min(bytes.len())..at.min(bytes.len()), token.bytes());
            }
            Mutation::Bytes(at, new) => {
                let at = (at % length).min(bytes.len());
                let end = (at + new.len()).min(bytes.len());
                bytes.splice(at..end, new.iter().copied());
            }
            Mutation::Remove(at, count) => {
                let at = (at % length).min(bytes.len());
                bytes.drain(at..(at + count).min(bytes.len()));
            }
            Mutation::RemoveLine(_) | Mutation::CopyLine(..) => {
                let mut lines: Vec<Vec<u8>> =
                    bytes.split(|b| *b == b'\n').map(<[u8]>::to_vec).collect();
                let count = lines.len();
                match mutation {
                    Mutation::CopyLine(from, to) => {
                        lines.insert(to % count, lines[from % count].clone())
                    }
                    Mutation::RemoveLine(at) => drop(lines.remove(at % count)),
                    _ => {}
                }
                bytes = lines.join(&b'\n');
            }
            Mutation::Cut(at) => bytes.truncate(at % length),
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Reads a text and, if it is wrong, renders all its problems.
fn read_and_render(text: &str) {
    if let Err(problems) = Scene::parse(&folder().join("mutated.toml"), text) {
        assert!(!problems.list().is_empty());
        for problem in problems.list() {
            problems.place(problem);
            assert!(!problem.what.is_empty() && !problem.help.is_empty());
        }
        problems.render(false);
        problems.render(true);
    }
}

#[test]
fn the_scene_that_is_mutated_is_right() {
    Scene::parse(&folder().join("good.toml"), GOOD).expect("a good scene");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10_000, failure_persistence: None, rng_seed: crate::support::seed::seed(7), ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_the_reader_panic(mutations in proptest::collection::vec(mutation(), 1..6)) {
        read_and_render(&mutated(GOOD, &mutations));
    }

    #[test]
    fn no_value_makes_the_reader_panic(
        value in "[-−+0-9.eE×é²µ°/()*^ a-z\\\\\"\\\\t]{0,24}",
        line in 0usize..80,
    ) {
        let lines: Vec<String> = GOOD
            .lines()
            .enumerate()
            .map(|(i, text)| match text.split_once(" = ") {
                Some((key, _)) if i == line => format!("{key} = \"{value}\""),
                _ => text.to_owned(),
            })
            .collect();
        read_and_render(&lines.join("\n"));
    }
}
