//! Directions of data flow, read from the sources: scene -> mechanism -> plan -> engine -> trajectory -> simulate ->
//! report -> cli.

mod circles;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Modules that each module may name besides itself. No module knows those to its right.
const MAY_NAME: &[(&str, &[&str])] = &[
    ("numeric", &[]),
    ("error", &["scene"]),
    ("scene", &["numeric", "error"]),
    ("mechanism", &["scene", "numeric", "error"]),
    ("engine", &["numeric"]),
    ("plan", &["scene", "mechanism", "numeric", "error"]),
    ("trajectory", &["engine", "numeric"]),
    (
        "simulate",
        &[
            "scene",
            "mechanism",
            "plan",
            "engine",
            "trajectory",
            "numeric",
            "error",
        ],
    ),
    (
        "kinematics",
        &["scene", "mechanism", "plan", "numeric", "error"],
    ),
    (
        "statics",
        &[
            "scene",
            "mechanism",
            "plan",
            "kinematics",
            "numeric",
            "error",
        ],
    ),
    (
        "explain",
        &["scene", "mechanism", "plan", "numeric", "error"],
    ),
    (
        "sweep",
        &[
            "scene",
            "mechanism",
            "plan",
            "simulate",
            "kinematics",
            "numeric",
            "error",
        ],
    ),
    ("figure", &["error"]),
    ("optimise", &["scene", "sweep", "numeric", "error"]),
    (
        "precision",
        &["scene", "mechanism", "plan", "simulate", "numeric", "error"],
    ),
    (
        "reproduce",
        &[
            "figure",
            "scene",
            "mechanism",
            "simulate",
            "kinematics",
            "statics",
            "numeric",
            "error",
        ],
    ),
    (
        "inverse",
        &["scene", "mechanism", "plan", "numeric", "error"],
    ),
    (
        "report",
        &[
            "figure",
            "scene",
            "simulate",
            "kinematics",
            "statics",
            "explain",
            "optimise",
            "sweep",
            "precision",
            "reproduce",
            "inverse",
            "error",
        ],
    ),
    (
        "cli",
        &[
            "figure",
            "simulate",
            "kinematics",
            "statics",
            "explain",
            "optimise",
            "sweep",
            "precision",
            "reproduce",
            "inverse",
            "report",
            "scene",
            "plan",
            "error",
        ],
    ),
];

/// Largest number of lines of a file.
const MOST_LINES: usize = 300;

/// Source file: place below `src`, text, and code without comments and literals.
struct Source {
    place: String,
    text: String,
    code: String,
}

impl Source {
    fn new(place: &str, text: &str) -> Source {
        Source {
            place: place.to_owned(),
            text: text.to_owned(),
            code: code_of(text),
        }
    }

    /// Returns the modules of the file, from the outermost.
    fn modules(&self) -> Vec<&str> {
        let path = self.place.trim_end_matches(".rs");
        path.split('/')
            .filter(|part| !["mod", "lib", "main"].contains(part))
            .collect()
    }

    /// Returns the outermost module of the file; none for `main.rs` and `lib.rs`.
    fn module(&self) -> Option<&str> {
        self.modules().first().copied()
    }

    /// Returns every outermost module that the file names, including its own.
    fn names(&self) -> BTreeSet<String> {
        let mut found = BTreeSet::new();
        for root in ["crate::", "slider_crank::"] {
            for rest in after_word(&self.code, root) {
                found.extend(first_names(rest));
            }
        }
        // A chain of `super` as long as the list of modules leads to the root.
        let depth = self.modules().len();
        for rest in after_word(&self.code, &"super::".repeat(depth.max(1))) {
            let rest = rest.trim_start_matches("super::");
            let known = |name: &String| MAY_NAME.iter().any(|(module, _)| module == name);
            found.extend(first_names(rest).into_iter().filter(known));
        }
        found
    }

    fn calls_macro(&self, name: &str) -> bool {
        after_word(&self.code, &format!("{name}!")).next().is_some()
    }
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    collect(&root, &mut files);
    let sources: Vec<_> = files
        .iter()
        .map(|file| {
            let place = file.strip_prefix(&root).expect("below src");
            let place = place.to_str().expect("a plain path").replace('\\', "/");
            Source::new(&place, &fs::read_to_string(file).expect("a source file"))
        })
        .collect();
    assert!(sources.len() > 20, "{} files found in src", sources.len());
    sources
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of sources") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
}

/// Returns the code without comments, string and character literals.
fn code_of(text: &str) -> String {
    let chars: Vec<char> = text.chars().collect();
    let starts = |i: usize, what: &str| {
        let mut what = what.chars().enumerate();
        what.all(|(k, c)| chars.get(i + k) == Some(&c))
    };
    let mut code = String::new();
    let mut i = 0;
    while i < chars.len() {
        let in_word = i > 0 && (chars[i - 1].is_alphanumeric() || chars[i - 1] == '_');
        let raw = (chars[i] == 'r' || starts(i, "br")) && !in_word;
        if starts(i, "//") {
            while i < chars.len() && chars[i] != '\n' {
                i += 1;
            }
        } else if starts(i, "/*") {
            let mut depth = 0;
            while i < chars.len() {
                if starts(i, "/*") {
                    (depth, i) = (depth + 1, i + 2);
                } else if starts(i, "*/") {
                    (depth, i) = (depth - 1, i + 2);
                } else {
                    i += 1;
                }
                if depth == 0 {
                    break;
                }
            }
        } else if let (true, Some((hashes, begin))) = (raw, raw_string(&chars, i)) {
            let end = format!("\"{}", "#".repeat(hashes));
            i = begin;
            while i < chars.len() && !starts(i, &end) {
                i += 1;
            }
            i += end.len();
        } else if chars[i] == '"' {
            i += 1;
            while i < chars.len() && chars[i] != '"' {
                i += if chars[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
        } else if chars[i] == '\'' && (starts(i + 1, "\\") || chars.get(i + 2) == Some(&'\'')) {
            // A character literal; other quotes begin a lifetime.
            i += if starts(i + 1, "\\") { 3 } else { 2 };
            while i < chars.len() && chars[i] != '\'' {
                i += 1;
            }
            i += 1;
        } else {
            code.push(chars[i]);
            i += 1;
        }
    }
    code
}

/// Returns the number of hashes of the raw string that begins here, and the start of its text.
fn raw_string(chars: &[char], at: usize) -> Option<(usize, usize)> {
    let prefix = chars[at..]
        .iter()
        .take_while(|c| "br".contains(**c))
        .count();
    let rest = &chars[at + prefix..];
    let hashes = rest.iter().take_while(|c| **c == '#').count();
    (rest.get(hashes) == Some(&'"')).then_some((hashes, at + prefix + hashes + 1))
}

/// Returns the text after each occurrence of a word that does not continue another one.
fn after_word<'a>(code: &'a str, word: &str) -> impl Iterator<Item = &'a str> {
    let continues =
        |before: &str| before.ends_with(|c: char| c.is_alphanumeric() || c == '_' || c == ':');
    let length = word.len();
    code.match_indices(word)
        .filter(move |(at, _)| !continues(&code[..*at]))
        .map(move |(at, _)| &code[at + length..])
        .collect::<Vec<_>>()
        .into_iter()
}

/// Returns the first names of a path or of a group of paths: `a::b` gives a, `{a, b::{c, d}}` gives a and b.
fn first_names(path: &str) -> Vec<String> {
    let Some(group) = path.strip_prefix('{') else {
        return vec![name(path)];
    };
    let mut names = Vec::new();
    let (mut depth, mut part) = (1, String::new());
    for c in group.chars() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => (),
        }
        if depth == 0 || (depth == 1 && c == ',') {
            names.push(name(&part));
            part.clear();
        } else {
            part.push(c);
        }
        if depth == 0 {
            break;
        }
    }
    names.retain(|name| !name.is_empty());
    names
}

/// Returns the identifier at the start of a text.
fn name(text: &str) -> String {
    let text = text.trim_start();
    text.chars()
        .take_while(|c| c.is_alphanumeric() || *c == '_')
        .collect()
}

/// Returns the names in a file that are forbidden there.
fn forbidden(source: &Source) -> Vec<String> {
    let Some(module) = source.module() else {
        let cli = |name: &String| source.place == "main.rs" && name == "cli";
        return source
            .names()
            .into_iter()
            .filter(|name| !cli(name))
            .collect();
    };
    let allowed = MAY_NAME.iter().find(|(name, _)| *name == module);
    let (_, allowed) = allowed.unwrap_or_else(|| panic!("src/{}: a new module", source.place));
    let may = |name: &String| name == module || allowed.contains(&name.as_str());
    source
        .names()
        .into_iter()
        .filter(|name| !may(name))
        .collect()
}

#[test]
fn modules_name_only_what_is_on_their_left() {
    let mut wrong = Vec::new();
    let mut edges = 0;
    for source in sources() {
        edges += source.names().len();
        for name in forbidden(&source) {
            wrong.push(format!("src/{} names {name}", source.place));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(edges > 50, "{edges} names found in all");
}

#[test]
fn a_name_is_found_however_it_is_written() {
    let plan = |text: &str| forbidden(&Source::new("plan.rs", text));
    assert_eq!(
        plan("use crate::scene::Scene; fn f(s: &crate::mechanism::Body) {}"),
        [""; 0]
    );
    assert_eq!(plan("use crate::engine::time;"), ["engine"]);
    assert_eq!(
        plan("use crate::{error::Error, simulate::{self, plan}, cli};"),
        ["cli", "simulate"]
    );
    assert_eq!(
        plan("let x = f(crate::trajectory::Trajectory::new());"),
        ["trajectory"]
    );
    assert_eq!(plan("use super::report;"), ["report"]);
    assert_eq!(plan("use super::Thing;"), [""; 0]);
    assert_eq!(plan("mod inside { use super::super::report; }"), ["report"]);
    assert_eq!(plan("use slider_crank::cli;"), ["cli"]);
    assert_eq!(
        plan("// crate::cli\n/* crate::cli /* */ crate::cli */ /// [`crate::cli`]"),
        [""; 0]
    );
    assert_eq!(
        plan(r####"let (a, b) = ("\"crate::cli", r#""crate::cli"#);"####),
        [""; 0]
    );
    assert_eq!(
        plan("fn f<'a>(c: char) { if c == '\"' { crate::cli::main() } else { '\\'' }; }"),
        ["cli"]
    );

    let deep = |text: &str| forbidden(&Source::new("engine/energy/mod.rs", text));
    assert_eq!(
        deep("use crate::engine::energy::Run;"),
        [""; 0],
        "a module of engine"
    );
    assert_eq!(deep("use super::super::scene::Scene;"), ["scene"]);
    assert_eq!(
        forbidden(&Source::new("main.rs", "slider_crank::cli::main()")),
        [""; 0]
    );
    assert_eq!(
        forbidden(&Source::new(
            "main.rs",
            "slider_crank::simulate::simulate()"
        )),
        ["simulate"]
    );
}

#[test]
fn one_file_names_ode_solvers() {
    let naming: Vec<_> = sources()
        .into_iter()
        .filter(|source| after_word(&source.code, "ode_solvers").next().is_some())
        .map(|source| source.place)
        .collect();
    assert_eq!(naming, ["engine/runge_kutta.rs"]);
}

#[test]
fn only_the_commands_print() {
    let prints = |source: &Source| {
        let macros = ["print", "println", "eprint", "eprintln", "dbg"];
        macros.iter().any(|name| source.calls_macro(name))
    };
    for source in sources() {
        let may = source.place == "main.rs" || source.module() == Some("cli");
        assert!(may || !prints(&source), "src/{} prints", source.place);
    }
    assert!(prints(&Source::new(
        "plan.rs",
        "fn f() { println!(\"{}\", 1) }"
    )));
    assert!(!prints(&Source::new(
        "plan.rs",
        "fn f() { /* println!() */ print(\"dbg!\") }"
    )));
}

#[test]
fn files_are_short() {
    let mut wrong = Vec::new();
    for source in sources() {
        let lines = source.text.lines().count();
        let place = source.place.as_str();
        if lines > MOST_LINES {
            wrong.push(format!("src/{place} has {lines} lines"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Returns major and minor number of a version of Rust.
fn version(text: &str) -> [u32; 2] {
    let mut numbers = text.split('.').map(|part| part.parse().expect("a version"));
    std::array::from_fn(|_| numbers.next().unwrap_or(0))
}

/// Returns the platform of the compiler.
fn host() -> String {
    let output = std::process::Command::new("rustc").arg("-vV").output();
    let about = String::from_utf8(output.expect("rustc").stdout).expect("UTF-8");
    let host = about.lines().find_map(|line| line.strip_prefix("host: "));
    host.expect("a host").to_owned()
}

/// Cargo.toml and README state the same version of Rust, and it suffices for every dependency.
#[test]
fn the_stated_rust_is_enough_for_every_dependency() {
    let root = env!("CARGO_MANIFEST_DIR");
    let metadata = |more: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO"));
        // Only the present platform: packages of others are absent on a machine that builds for it.
        command.args(["metadata", "--format-version=1", "--locked"]);
        command.args(["--filter-platform", &host()]).args(more);
        command.current_dir(root).output().expect("cargo")
    };
    // Packages that only the Python package needs are absent on a machine that has not built it.
    let mut output = metadata(&["--offline"]);
    if !output.status.success() {
        output = metadata(&[]);
    }
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let packages = metadata["packages"].as_array().expect("packages");
    let stated = |package: &serde_json::Value| package["rust_version"].as_str().map(version);
    let ours = packages
        .iter()
        .find(|package| package["name"] == "slider-crank");
    let ours = ours.and_then(stated).expect("rust-version in Cargo.toml");
    for package in packages {
        assert!(
            stated(package).is_none_or(|needed| needed <= ours),
            "{}",
            package["name"]
        );
    }
    let readme = fs::read_to_string(Path::new(root).join("README.md")).expect("README.md");
    let said = format!("Rust, {}.{} or later", ours[0], ours[1]);
    assert!(readme.contains(&said), "README.md does not say `{said}`");
}

/// Features of the language that are younger than the stated Rust; clippy knows those of the library.
#[test]
fn no_source_is_younger_than_the_stated_rust() {
    const YOUNGER: [(&str, &str); 2] = [
        ("; _]", "lengths of arrays are inferred since 1.89"),
        ("cfg_select!", "since 1.95"),
    ];
    for source in sources() {
        for (text, since) in YOUNGER {
            assert!(
                !source.code.contains(text),
                "src/{}: `{text}`: {since}",
                source.place
            );
        }
    }
}
