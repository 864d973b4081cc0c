//! Command `completions`: writes shell completions and the man page.

use clap::{Args, Command, ValueEnum};
use clap_complete::Shell;

use super::streams::Outcome;
use super::watch::print;
use crate::error::Error;

/// Arguments of `completions`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Writes for this shell to standard output, or the man page
    #[arg(value_name = "FOR")]
    reader: Reader,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Reader {
    Bash,
    Zsh,
    Fish,
    #[value(name = "powershell")]
    PowerShell,
    Elvish,
    Man,
}

/// Writes the completions for a shell, or the man page.
pub(super) fn run(arguments: &Arguments, mut program: Command) -> Result<Outcome, Error> {
    let shell = match arguments.reader {
        Reader::Bash => Shell::Bash,
        Reader::Zsh => Shell::Zsh,
        Reader::Fish => Shell::Fish,
        Reader::PowerShell => Shell::PowerShell,
        Reader::Elvish => Shell::Elvish,
        Reader::Man => {
            print(&man(program)?)?;
            return Ok(Outcome::Done);
        }
    };
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut program, "slider-crank", &mut text);
    print(&String::from_utf8_lossy(&text))?;
    Ok(Outcome::Done)
}

/// Returns the man page of the program, followed by that of each command.
fn man(mut command: clap::Command) -> Result<String, Error> {
    let failed = |source| Error::Write {
        target: "man page".to_owned(),
        source,
    };
    command.build();
    let mut text = Vec::new();
    clap_mangen::Man::new(command.clone())
        .render(&mut text)
        .map_err(failed)?;
    for one in command.get_subcommands() {
        let page = clap_mangen::Man::new(one.clone());
        page.render(&mut text).map_err(failed)?;
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}
