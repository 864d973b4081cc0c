//! The commands: arguments -> question -> report. One file each.

mod animate;
mod check;
mod compare;
mod completions;
mod explain;
mod help;
mod identify;
mod inverse;
mod kinematics;
mod optimise;
mod outputs;
mod precision;
mod reading;
mod reproduce;
mod schema;
mod simulate;
mod statics;
mod streams;
mod sweep;
mod synthesis;
mod watch;

use std::io::IsTerminal;
use std::path::PathBuf;
use std::process::ExitCode;

use clap::{FromArgMatches, Parser, Subcommand};

use crate::error::Error;
use crate::report::Origin;
use crate::scene::unit::{self, Quantity};
use crate::scene::{DUARTE, Scene};
use outputs::{Outputs, Plot, PlotOfRows};
use streams::{
    Streams, check_files, create, draw, fill, is_standard, page, print, say, say_styled,
};

/// Dynamics of the offset slider-crank from its Lagrange equation.
#[derive(Debug, Parser)]
#[command(version, about, long_about = None, help_expected = true, max_term_width = 100)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Forward motion: summary, rows, joint forces
    Simulate(simulate::Arguments),
    /// Slider force and crank torque from a measured motion
    Inverse(inverse::Arguments),
    /// Values of a scene from a measured motion, with their errors
    Identify(identify::Arguments),
    /// One turn in closed form: dead centres, stroke, time ratio, extremes
    Kinematics(kinematics::Arguments),
    /// Several motions over each other: scenes, rows, measurements; their differences
    Compare(compare::Arguments),
    /// The mechanism to scale: in motion as GIF, at an angle as DXF or picture
    Animate(animate::Arguments),
    /// Speed against error: every method at a ladder of tolerances
    Precision(precision::Arguments),
    /// Static slider force against crank torque, with the band that friction allows
    Statics(statics::Arguments),
    /// Key figures of many designs: any scene keys varied
    Sweep(sweep::Arguments),
    /// The best design between bounds, subject to limits of key figures
    Optimise(optimise::Arguments),
    /// Crank, rod and offset for a wanted stroke and time ratio
    Synthesis(synthesis::Arguments),
    /// Every number and figure of the four papers beside ours, with the verdict
    Reproduce(reproduce::Arguments),
    /// The equation, what is modelled and why, and what will compute it
    Explain(explain::Arguments),
    /// Says all that is wrong with a scene file or a data file
    Check(check::Arguments),
    /// JSON Schema of scene files
    Schema(schema::Arguments),
    /// What shells complete, and the man page
    Completions(completions::Arguments),
}

/// Whether the computation was completed.
enum Outcome {
    Done,
    /// What was computed is kept; the message says up to where.
    Incomplete(String),
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let matches = help::command().get_matches();
    let arguments = Arguments::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    let takes_requests = matches!(
        arguments.command,
        Command::Simulate(_) | Command::Sweep(_) | Command::Inverse(_) | Command::Optimise(_)
    );
    let stop = &watch::start(takes_requests);
    let result = match arguments.command {
        Command::Simulate(arguments) => simulate::run(&arguments, stop),
        Command::Inverse(arguments) => inverse::run(&arguments, stop),
        Command::Identify(arguments) => identify::run(&arguments),
        Command::Kinematics(arguments) => kinematics::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Animate(arguments) => animate::run(&arguments),
        Command::Precision(arguments) => precision::run(&arguments),
        Command::Statics(arguments) => statics::run(&arguments),
        Command::Sweep(arguments) => sweep::run(&arguments, stop),
        Command::Optimise(arguments) => optimise::run(&arguments, stop),
        Command::Synthesis(arguments) => synthesis::run(&arguments),
        Command::Reproduce(arguments) => reproduce::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Schema(arguments) => schema::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
    };
    watch::clear();
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Incomplete(message)) => {
            say(&format!("error: {message}"));
            ExitCode::from(1)
        }
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            match &error {
                Error::Scene(problems) => say_styled(&problems.render(colour())),
                other => say(&format!("error: {other}")),
            }
            ExitCode::from(error.exit_status())
        }
    }
}

fn colour() -> bool {
    std::io::stderr().is_terminal()
        && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// The scene of a command: a file, or the built-in engine.
fn scene(file: Option<&PathBuf>) -> Result<Scene, Error> {
    match file {
        Some(file) => Scene::load(file),
        None => Ok(Scene::duarte()),
    }
}

/// Where a result comes from: the text of its scene, as far as it can be read again, and the command.
fn origin(file: Option<&PathBuf>) -> Origin {
    Origin {
        scene: match file {
            Some(file) if is_standard(Some(file)) => None,
            Some(file) => std::fs::read_to_string(file).ok(),
            None => Some(DUARTE.to_owned()),
        },
        command: command_line(),
    }
}

/// The command of this process as a shell reads it.
fn command_line() -> String {
    let quoted = |argument: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
        match !argument.is_empty() && argument.chars().all(plain) {
            true => argument,
            false => format!("'{}'", argument.replace('\'', "'\\''")),
        }
    };
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|argument| quoted(argument.to_string_lossy().into_owned()));
    std::iter::once("slider-crank".to_owned())
        .chain(arguments)
        .collect::<Vec<_>>()
        .join(" ")
}

fn quantity(text: &str, quantity: Quantity) -> Result<f64, String> {
    unit::parse(text, quantity).map_err(|error| error.to_string())
}

fn angle(text: &str) -> Result<f64, String> {
    quantity(text, Quantity::Angle)
}

fn length(text: &str) -> Result<f64, String> {
    match quantity(text, Quantity::Length)? {
        length if length > 0.0 => Ok(length),
        _ => Err("the length must be positive, like \"27 mm\"".to_owned()),
    }
}

fn positive_angle(text: &str) -> Result<f64, String> {
    match angle(text)? {
        step if step > 0.0 => Ok(step),
        _ => Err("the angle must be positive, like \"1 deg\"".to_owned()),
    }
}

/// Refuses a crank angle between rows (rad) so small that it is a slip of the unit.
fn check_rows_of_turn(every: f64) -> Result<(), Error> {
    const MOST_ROWS: f64 = 1e8;
    if std::f64::consts::TAU / every > MOST_ROWS {
        return Err(Error::refused(
            format!("--every {every} rad gives more than {MOST_ROWS} rows"),
            "give an angle like \"1 deg\"",
        ));
    }
    Ok(())
}
