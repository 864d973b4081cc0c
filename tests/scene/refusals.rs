//! `check` refuses exactly what `simulate` refuses, in the same words: for the files of the repository, and for scenes
//! derived from them by omitting and inserting parts.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use proptest::prelude::*;
use slider_crank::error::Error;
use slider_crank::plan;
use slider_crank::scene::{Draft, Scene, Slider, Varied};
use slider_crank::simulate::{Options, simulate};

use crate::support::random::cases;

const FOLDERS: [&str; 3] = ["data", "data/hard", "tests/bad"];

/// Lines that a mutation may insert or substitute; a new table is appended, because later lines would belong to it.
const LINES: [&str; 22] = [
    "angle = \"0 deg\"",
    "angle = \"180 deg\"",
    "angle = \"90 deg\"",
    "angle = \"1.3 rad\"",
    "speed = \"0 rad/s\"",
    "speed = \"13 rad/s\"",
    "kind = \"constant-speed\"",
    "model = \"massless\"",
    "model = \"spin-only\"",
    "mass = \"0 kg\"",
    "inertia = \"0 kg m^2\"",
    "offset = \"20 mm\"",
    "contact_law = \"massless-link\"",
    "revolutions = 3",
    "duration = \"1 ms\"",
    "[friction]\ncoefficient = 0.2",
    "[clearance]\njoint = \"wrist-pin\"\nradial = \"0.1 mm\"",
    "[clearance]\njoint = \"crank-pin\"\nradial = \"0.1 mm\"\ncontact_law = \"massless-link\"",
    "[[torque]]\nkind = \"expression\"\nvalue = \"sin(50*t)/(50*t)\"",
    "[[torque]]\nkind = \"expression\"\nvalue = \"ln(theta - 1)\"",
    "[[force]]\nkind = \"expression\"\nvalue = \"1e300*exp(100*omega)\"",
    "[[force]]\nkind = \"constant\"\nvalue = \"12 N\"",
];

fn scenes(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = fs::read_dir(folder).expect("a folder");
    let mut files: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    files.retain(|file| {
        file.extension()
            .is_some_and(|extension| extension == "toml")
    });
    files.sort();
    files
}

/// Returns the refusal of a short run of a scene, if it cannot start.
fn refused(scene: &Scene) -> Option<Error> {
    let options = Options {
        estimate: false,
        max_evaluations: 500,
        ..Options::default()
    };
    simulate(scene, &options).err()
}

/// Returns a scene file with lines omitted, replaced and added; of sections with one name the last stays.
fn mutated(file: &Path, changes: &[(usize, usize, u8)]) -> Option<Draft> {
    let text = fs::read_to_string(file).ok()?;
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    for (place, line, how) in changes {
        let at = place % lines.len().max(1);
        let new = LINES[line % LINES.len()];
        let key = |line: &str| {
            line.split(['=', '\n'])
                .next()
                .unwrap_or("")
                .trim()
                .to_owned()
        };
        let same = lines.iter().position(|line| key(line) == key(new));
        match (how % 4, same) {
            (0, _) if !lines.is_empty() => {
                lines.remove(at);
            }
            (_, Some(same)) if !new.starts_with("[[") => {
                // An existing table is removed with its keys.
                if new.contains('\n') {
                    let end = (same + 1..lines.len()).find(|i| lines[*i].starts_with('['));
                    lines.drain(same..end.unwrap_or(lines.len()));
                    lines.push(new.to_owned());
                } else {
                    lines[same] = new.to_owned();
                }
            }
            _ if new.starts_with('[') => lines.push(new.to_owned()),
            _ => {}
        }
    }
    Some(Draft::new(file, lines.join("\n")))
}

#[test]
fn what_is_not_refused_begins() {
    let files: Vec<_> = ["data", "data/hard"].into_iter().flat_map(scenes).collect();
    let (begun, not) = (Cell::new(0), Cell::new(0));
    let said = RefCell::new(BTreeSet::new());
    let mut runner = proptest::test_runner::TestRunner::new(cases(600));
    let change = (0usize..60, 0usize..1000, any::<u8>());
    let strategy = (0usize..1000, prop::collection::vec(change, 1..5));
    let result = runner.run(&strategy, |(file, changes)| {
        let Some(Ok(scene)) =
            mutated(&files[file % files.len()], &changes).map(|draft| draft.scene())
        else {
            return Ok(());
        };
        match (plan::refuse(&scene), refused(&scene)) {
            (Ok(()), None) => begun.set(begun.get() + 1),
            (Err(problems), Some(Error::Scene(same))) => {
                prop_assert_eq!(problems.to_string(), same.to_string());
                not.set(not.get() + 1);
                said.borrow_mut()
                    .extend(problems.list().iter().map(|problem| problem.field.clone()));
            }
            (checked, ran) => prop_assert!(false, "{checked:?} against {ran:?}: {scene:#?}"),
        }
        Ok(())
    });
    result.expect("the same verdict");
    let (begun, not, said) = (begun.get(), not.get(), said.take());
    assert!(
        begun > 100 && not > 100,
        "{begun} begun, {not} not: {said:?}"
    );
    assert!(said.len() > 8, "{said:?}");
}

fn run(command: &str, file: &Path) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_slider-crank"));
    program.arg(command).arg(file);
    if command == "simulate" {
        program.args(["--no-estimate", "--max-evaluations", "500"]);
    }
    program.output().expect("the program runs")
}

#[test]
fn check_says_what_simulate_says() {
    for file in FOLDERS.into_iter().flat_map(scenes) {
        let [checked, simulated] = ["check", "simulate"].map(|command| run(command, &file));
        let refused = |output: &Output| output.status.code() == Some(2);
        assert_eq!(refused(&checked), refused(&simulated), "{}", file.display());
        if refused(&checked) {
            let words = |output: Output| String::from_utf8_lossy(&output.stderr).into_owned();
            assert_eq!(words(checked), words(simulated), "{}", file.display());
        }
    }
}

/// A scene from a file is refused with all reasons, each with its line.
#[test]
fn all_reasons_are_given_at_once_with_their_lines() {
    let text = "[geometry]\ncrank = \"34 mm\"\nrod = \"79 mm\"\n[slider]\nmass = \"1 kg\"\n[motion]\nangle = \"0 deg\"\nspeed = \"2 rad/s\"\n[[torque]]\nkind = \"expression\"\nvalue = \"sin(t)/t\"\n[[force]]\nkind = \"expression\"\nvalue = \"ln(t - 1)\"\n";
    let scene = Draft::new(Path::new("press.toml"), text)
        .scene()
        .expect("a scene");
    let problems = plan::refuse(&scene).expect_err("three reasons and no run");
    let place = |problem| problems.place(problem).map(|(line, _)| line);
    let list: Vec<_> = problems
        .list()
        .iter()
        .map(|p| (p.field.as_str(), place(p)))
        .collect();
    assert_eq!(
        list,
        [
            ("run", None),
            ("motion.angle", Some(7)),
            ("torque[1].value", Some(11)),
            ("force[1].value", Some(14)),
        ]
    );
}

/// A rod with neither translation nor inertia moves nothing, and the acceleration would be NaN.
#[test]
fn a_mechanism_without_any_inertia_is_refused() {
    let text = "[geometry]\ncrank = \"34 mm\"\nrod = \"79 mm\"\n[rod]\nmodel = \"spin-only\"\nmass = \"1 kg\"\ncg = \"10 mm\"\ninertia = \"0 kg m^2\"\n[motion]\nspeed = \"13 rad/s\"\n[run]\nduration = \"1 s\"\n";
    let scene = Draft::new(Path::new("rod.toml"), text)
        .scene()
        .expect("a scene");
    let error = refused(&scene).expect("no motion").to_string();
    assert!(error.contains("the mechanism has no inertia"), "{error}");
}

/// Values in messages have the digits that people type, without rounding noise.
#[test]
fn values_are_shown_without_noise() {
    for (mass, shown) in [
        (-1.9500000000000002, "-1.95 kg"),
        (-5e-6, "-0.000005 kg"),
        (-1e-15, "-1e-15 kg"),
        (-100_000.0, "-100000 kg"),
        (-1e40, "-1e40 kg"),
        (-0.12345678, "-0.12345678 kg"),
    ] {
        let scene = Scene::new(0.05, 0.15).slider(Slider { mass });
        let problems = scene.check().unwrap_err();
        let what = format!("{shown} is negative");
        assert_eq!(problems.list()[0].what, what);
    }
    for (offset, shown) in [(0.3, "0.3 m"), (0.2 + 1e-9, "0.200000001 m")] {
        let problems = Scene::new(0.05, 0.15).offset(offset).check().unwrap_err();
        let what = &problems.list()[0].what;
        assert!(what.contains(shown) && what.contains("0.2 m"), "{what}");
    }
}

/// A draft reports the problem of a load every time, also for scenes with other values.
#[test]
fn what_is_wrong_with_a_load_is_said_again() {
    let text = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n[[torque]]\nkind = \"dry\"\nvalue = \"1 N m\"\nof = \"theta\"\n";
    let draft = Draft::new(Path::new("brake.toml"), text);
    let rod: [Varied; 1] = ["geometry.rod = 160mm".parse().expect("a varied key")];
    for _ in 0..2 {
        assert!(draft.scene().is_err());
        assert!(draft.with_values(&rod, &[rod[0].value(0)]).is_err());
    }
}
