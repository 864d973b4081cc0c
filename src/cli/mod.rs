//! Command line: one file per command, from arguments to computation to report.

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
mod simulate;
mod statics;
mod streams;
mod sweep;
mod synthesis;
mod values;
mod watch;

use std::io::IsTerminal;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::error::Error;
use crate::{report, scene};
use watch::{print, say, say_styled};

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
    Schema,
    /// What shells complete, and the man page
    Completions(completions::Arguments),
}

/// Runs the program with the arguments of the process.
pub fn main() -> ExitCode {
    let program = || help::with_groups(Arguments::command());
    let matches = program().get_matches();
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
        Command::Schema => report::json(&scene::schema()).and_then(|text| print(&text)),
        Command::Completions(arguments) => completions::run(&arguments, program()),
    };
    watch::clear();
    match result {
        Ok(()) => ExitCode::SUCCESS,
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
