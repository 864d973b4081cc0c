//! Command `check`: reports all errors of a scene file, of its plan for `simulate`, or of a data file.

use std::path::PathBuf;

use clap::Args;

use super::reading::ReadingArguments;
use super::streams::scene;
use super::watch::{print, say};
use crate::error::Error;
use crate::plan;
use crate::report::extension;
use crate::scene::{Measurement, Reading, load_table};

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene file, or measured motion or the table of a load as a file ending in .csv; `-` for a scene from standard
    /// input; without it the built-in Duarte engine
    scene: Option<PathBuf>,
    #[command(flatten)]
    reading: ReadingArguments,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let reading = arguments.reading.reading();
    let file = arguments.scene.as_ref();
    if let Some(file) = file.filter(|file| extension(file) == "csv") {
        let shown = file.display();
        if reading == Reading::default()
            && let Some(table) = load_table(file)?
        {
            let (gives, of, rows) = (table.gives, table.of.name(), table.rows);
            return print(&format!(
                "{shown}: nothing is wrong with a table of {gives} over {of} with {rows} rows\n"
            ));
        }
        let motion = Measurement::load(file, &reading)?;
        let (samples, column) = (motion.len(), motion.measured().name());
        print(&format!(
            "{shown}: nothing is wrong with {samples} samples of {column}\n"
        ))?;
        for note in motion.notes() {
            say(&format!("note: {note}"));
        }
        return Ok(());
    }
    if reading != Reading::default() {
        return Err(Error::refused(
            "options such as --column, --time and --decimal say how measured motion is read, and this is a scene",
            "give a file ending in .csv, or leave them out",
        ));
    }
    let scene = scene(file)?;
    plan::refuse(&scene)?;
    let name = match file {
        Some(file) if file.as_os_str() == "-" => "standard input".to_owned(),
        Some(file) => file.display().to_string(),
        None => "the built-in scene".to_owned(),
    };
    let title = scene.title.map(|title| format!(" ({title})"));
    let title = title.unwrap_or_default();
    print(&format!("{name}{title}: nothing is wrong\n"))
}
