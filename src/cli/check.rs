//! `check`: all that is wrong with a scene file.

use std::path::PathBuf;

use clap::Args;

use super::{Outcome, print, scene};
use crate::error::Error;

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, `-` for standard input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let scene = scene(arguments.scene.as_ref())?;
    let name = match &arguments.scene {
        Some(file) if file.as_os_str() == "-" => "standard input".to_owned(),
        Some(file) => file.display().to_string(),
        None => "the built-in scene".to_owned(),
    };
    let title = scene
        .title
        .map(|title| format!(" ({title})"))
        .unwrap_or_default();
    print(&format!("{name}{title}: nothing is wrong\n"))?;
    Ok(Outcome::Done)
}
