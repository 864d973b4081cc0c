//! Test harness: runs the program in its own folder and inspects the files it leaves.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// Slider-crank with r = 50 mm, l = 150 mm, a flywheel and a slider; no load, no gravity.
pub const PUMP: &str = r#"
[geometry]
crank = "50 mm"
rod = "150 mm"

[crank]
inertia = "0.02 kg m^2"

[slider]
mass = "0.5 kg"
"#;

/// Rocker: the 50 mm rod reaches the guide, 10 mm below O, on part of the crank circle only.
pub const ROCKER: &str = r#"
[geometry]
crank = "50 mm"
rod = "50 mm"
offset = "10 mm"

[crank]
inertia = "0.02 kg m^2"

[slider]
mass = "0.5 kg"

[run]
duration = "1 s"
"#;

/// Returns the rocker's crank angle, from 0, at which its rod stands normal to the guide: r sin θ = l − e.
pub fn rocker_limit() -> f64 {
    (40.0f64 / 50.0).asin()
}

/// Crank with its weight 20 mm off the pivot, released 60 degrees from hanging straight down.
pub const PENDULUM: &str = r#"
[geometry]
crank = "50 mm"
rod = "150 mm"

[crank]
mass = "1 kg"
cg = "20 mm"
inertia = "0.0005 kg m^2"

[gravity]
acceleration = "9.80665 m/s^2"

[motion]
angle = "-30 deg"
"#;

/// Returns the pump in free motion.
pub fn free(run: &str) -> String {
    format!("{PUMP}\n[motion]\nspeed = \"10 rad/s\"\n\n[run]\n{run}\n")
}

/// Returns the pump at constant crank speed.
pub fn driven(run: &str) -> String {
    format!("{PUMP}\n[motion]\nkind = \"constant-speed\"\nspeed = \"10 rad/s\"\n\n[run]\n{run}\n")
}

/// One way to compute a motion: a scene, given its `[run]`, and options of `simulate`.
#[derive(Debug)]
pub struct Way {
    scene: fn(&str) -> String,
    options: &'static [&'static str],
}

/// The engines: time, angle, the planned engine for a motion without load, and prescribed motion.
pub const WAYS: [Way; 4] = [
    Way {
        scene: free,
        options: &["--method", "time"],
    },
    Way {
        scene: free,
        options: &["--method", "angle"],
    },
    Way {
        scene: free,
        options: &[],
    },
    Way {
        scene: driven,
        options: &[],
    },
];

/// Returns the ways for a free motion.
pub fn free_ways() -> &'static [Way] {
    &WAYS[..3]
}

impl Way {
    /// Returns summary and rows of the pump at 10 rad/s.
    #[track_caller]
    pub fn simulated(&self, run: &str) -> (Value, Rows) {
        self.simulated_at("10 rad/s", run, &[])
    }

    /// Returns summary and rows at another speed, with further options.
    #[track_caller]
    pub fn simulated_at(&self, speed: &str, run: &str, more: &[&str]) -> (Value, Rows) {
        let scene = (self.scene)(run).replace("10 rad/s", speed);
        Folder::with(&scene).simulated(&[self.options, more].concat())
    }
}

/// Output and exit status of the program.
#[derive(Debug)]
pub struct Outcome {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Outcome {
    /// Checks that the program succeeded and left standard error empty.
    #[track_caller]
    pub fn done(self) -> Outcome {
        assert_eq!(self.code, Some(0), "{self:?}");
        assert_eq!(self.stderr, "", "{self:?}");
        self
    }

    /// Checks the exit code, the absence of a result, and that the message has all these words.
    #[track_caller]
    pub fn fails(self, code: i32, words: &[&str]) -> Outcome {
        assert_eq!(self.stdout, "", "{self:?}");
        self.complains(code, words)
    }

    /// Checks the exit code, and that the message has all these words.
    #[track_caller]
    pub fn complains(self, code: i32, words: &[&str]) -> Outcome {
        assert_eq!(self.code, Some(code), "{self:?}");
        assert!(self.stderr.starts_with("error: "), "{self:?}");
        assert!(!self.stderr.contains("panicked"), "{self:?}");
        for word in words {
            assert!(self.stderr.contains(word), "`{word}` is not said: {self:?}");
        }
        self
    }

    /// Parses standard output as one JSON object.
    #[track_caller]
    pub fn json(&self) -> Value {
        match serde_json::from_str(&self.stdout) {
            Ok(Value::Object(object)) => Value::Object(object),
            _ => panic!("no JSON object: {self:?}"),
        }
    }
}

/// Working folder of the program.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Folder {
        Folder(tempfile::tempdir().expect("a temporary folder"))
    }

    /// Creates a folder with one scene, `scene.toml`.
    pub fn with(scene: &str) -> Folder {
        let folder = Folder::new();
        folder.write("scene.toml", scene);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("the temporary folder can be written");
    }

    pub fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect(name)
    }

    /// Returns the names of all entries of the folder, in alphabetical order.
    pub fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the temporary folder");
        let mut names: Vec<_> = entries
            .map(|entry| {
                entry
                    .expect("an entry")
                    .file_name()
                    .into_string()
                    .expect("a name")
            })
            .collect();
        names.sort();
        names
    }

    /// Returns the program with these arguments, not yet started, isolated from the user's environment.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_slider-crank"));
        command.args(arguments).current_dir(self.0.path());
        for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
            command.env_remove(name);
        }
        command
    }

    pub fn run(&self, arguments: &[&str]) -> Outcome {
        outcome(self.command(arguments).stdin(Stdio::null()))
    }

    /// Runs the program with a text on standard input.
    pub fn run_with_input(&self, arguments: &[&str], input: &str) -> Outcome {
        let mut child = self.start(arguments);
        give(&mut child, input);
        ended(child)
    }

    /// Starts the program with all three streams as pipes.
    pub fn start(&self, arguments: &[&str]) -> Child {
        self.command(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program starts")
    }

    /// Simulates `scene.toml`; returns summary and rows.
    #[track_caller]
    pub fn simulated(&self, more: &[&str]) -> (Value, Rows) {
        let mut arguments = vec!["simulate", "scene.toml", "--json", "--out", "rows.csv"];
        arguments.extend(more);
        let summary = self.run(&arguments).done().json();
        (summary, Rows::read(&self.read("rows.csv")))
    }

    /// Computes the kinematics of `scene.toml`; returns summary and rows.
    #[track_caller]
    pub fn kinematics(&self, more: &[&str]) -> (Value, Rows) {
        let mut arguments = vec!["kinematics", "scene.toml", "--json", "--out", "rows.csv"];
        arguments.extend(more);
        let summary = self.run(&arguments).done().json();
        (summary, Rows::read(&self.read("rows.csv")))
    }
}

/// Writes a text to the program's standard input and closes it.
pub fn give(child: &mut Child, input: &str) {
    let mut stdin = child.stdin.take().expect("a pipe");
    stdin
        .write_all(input.as_bytes())
        .expect("the program reads its input");
}

pub fn outcome(command: &mut Command) -> Outcome {
    read_outcome(command.output().expect("the program starts"))
}

/// Waits for a started program; returns its output and exit status.
pub fn ended(child: Child) -> Outcome {
    read_outcome(child.wait_with_output().expect("the program ends"))
}

fn read_outcome(output: std::process::Output) -> Outcome {
    let text = |bytes| String::from_utf8(bytes).expect("UTF-8 output");
    Outcome {
        code: output.status.code(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// Returns the path of a file of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Rows of a CSV file.
pub struct Rows {
    pub header: String,
    names: Vec<String>,
    /// Cells by row; empty ones are `None`.
    cells: Vec<Vec<Option<f64>>>,
}

impl Rows {
    /// Reads rows, and checks that every number is finite and has its shortest form.
    #[track_caller]
    pub fn read(text: &str) -> Rows {
        let header = text.lines().next().expect("a header").to_owned();
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let names = reader.headers().expect("a header");
        let names = names.iter().map(str::to_owned).collect();
        let cells = reader
            .records()
            .map(|record| {
                record
                    .expect("rows of equal length")
                    .iter()
                    .map(number)
                    .collect()
            })
            .collect();
        Rows {
            header,
            names,
            cells,
        }
    }

    pub fn len(&self) -> usize {
        self.cells.len()
    }

    /// Returns a column without empty cells.
    #[track_caller]
    pub fn column(&self, name: &str) -> Vec<f64> {
        let cells = self.cells_of(name);
        cells
            .into_iter()
            .map(|cell| cell.expect("no empty cell"))
            .collect()
    }

    #[track_caller]
    pub fn cells_of(&self, name: &str) -> Vec<Option<f64>> {
        let index = self.names.iter().position(|column| column == name);
        let index = index.unwrap_or_else(|| panic!("no column {name} in {}", self.header));
        self.cells.iter().map(|row| row[index]).collect()
    }

    /// Whether no cell is empty.
    pub fn complete(&self) -> bool {
        self.cells.iter().flatten().all(Option::is_some)
    }
}

#[track_caller]
fn number(cell: &str) -> Option<f64> {
    if cell.is_empty() {
        return None;
    }
    let value: f64 = cell
        .parse()
        .unwrap_or_else(|_| panic!("`{cell}` is not a number"));
    assert!(value.is_finite(), "`{cell}` is not finite");
    let shortest = format!("{value:e}");
    assert!(
        digits(cell).len() <= digits(&shortest).len(),
        "`{cell}` is not {shortest}"
    );
    Some(value)
}

/// Returns the significant digits of a number.
fn digits(number: &str) -> String {
    let mantissa = number.split('e').next().unwrap_or_default();
    let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    let digits = digits.trim_start_matches('0');
    digits.trim_end_matches('0').to_owned()
}

/// Returns a number of a JSON object by its path, like `final.t_s`.
#[track_caller]
pub fn at(object: &Value, path: &str) -> f64 {
    let value = path.split('.').fold(object, |value, key| &value[key]);
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{path} is {value}"))
}

/// Returns the keys of an object.
#[track_caller]
pub fn keys(object: &Value) -> Vec<&str> {
    let object = object.as_object().expect("an object");
    object.keys().map(String::as_str).collect()
}

/// Checks that an object has all these keys.
#[track_caller]
pub fn has_keys(object: &Value, expected: &[&str]) {
    let found = keys(object);
    for key in expected {
        assert!(found.contains(key), "no `{key}` among {found:?}");
    }
}

/// Checks equality up to the last digit, which the JSON reader of the tests may miss.
#[track_caller]
pub fn same(found: f64, expected: f64) {
    close(found, expected, f64::EPSILON * expected.abs());
}

#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected} +- {tolerance}"
    );
}
