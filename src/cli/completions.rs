//! Command `completions`: writes shell completions and the man page.

use clap::{Args, Command};
use clap_complete::Shell;

use super::watch::print;
use crate::error::Error;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Writes for this shell to standard output, or the man page
    #[arg(value_name = "FOR", value_parser = ["bash", "zsh", "fish", "powershell", "elvish", "man"])]
    reader: String,
}

pub(super) fn run(arguments: &Arguments, mut program: Command) -> Result<(), Error> {
    let Ok(shell) = arguments.reader.parse::<Shell>() else {
        return print(&man(program)?);
    };
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut program, "slider-crank", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Returns the man page of the program, followed by that of each command.
fn man(mut command: Command) -> Result<String, Error> {
    let failed = Error::write("man page");
    command.build();
    let mut text = Vec::new();
    for one in std::iter::once(&command).chain(command.get_subcommands()) {
        let page = clap_mangen::Man::new(one.clone());
        page.render(&mut text).map_err(&failed)?;
    }
    Ok(String::from_utf8_lossy(&text).into_owned())
}
