//! Input and output files of a command: checks for conflicts, opening, and writing.

use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::watch::{self, print, say};
use crate::error::Error;
use crate::report::{self, Origin, Output, extension, place};
use crate::scene::{DUARTE, Draft, Scene};

/// Files and streams of a command, checked before any computation.
pub(super) struct Streams {
    rows_on_stdout: bool,
    json: bool,
    written: Vec<PathBuf>,
}

impl Streams {
    /// Checks the outputs: rows to `rows`, a JSON summary to standard output if `json`, other results to `files`. Refuses
    /// two results with one target, and a result that would overwrite an input.
    pub fn new(
        read: &[Option<&PathBuf>],
        rows: Option<&PathBuf>,
        files: &[Option<&PathBuf>],
        json: bool,
    ) -> Result<Streams, Error> {
        let rows_on_stdout = is_standard(rows);
        if rows_on_stdout && std::io::stdout().is_terminal() {
            watch::clear();
        }
        if files.iter().any(|file| is_standard(*file)) {
            return Err(Error::refused(
                "a figure, a page or residuals would go to standard output, where the summary is",
                "write them to files, like --plot figure.svg",
            ));
        }
        if rows_on_stdout && json {
            return Err(Error::refused(
                "both the rows and the JSON summary would go to standard output",
                "write the rows to a file: --out rows.csv",
            ));
        }
        let files = files.iter().flatten().copied();
        let written: Vec<PathBuf> = rows.into_iter().chain(files).cloned().collect();
        let read: Vec<&Path> = read.iter().flatten().map(|file| file.as_path()).collect();
        check_files(&read, &written)?;
        Ok(Streams {
            rows_on_stdout,
            json,
            written,
        })
    }

    /// Loads the scene of the command, whose tables no result may overwrite.
    pub fn scene(&self, file: Option<&PathBuf>) -> Result<Scene, Error> {
        let scene = scene(file)?;
        self.spare_tables(&scene)?;
        Ok(scene)
    }

    /// Loads the text of the scene, whose tables no result may overwrite.
    pub fn draft(&self, file: Option<&PathBuf>) -> Result<Draft, Error> {
        let draft = draft(file)?;
        if let Ok(scene) = draft.scene() {
            self.spare_tables(&scene)?;
        }
        Ok(draft)
    }

    /// Refuses results that would overwrite a table of a scene.
    pub fn spare_tables(&self, scene: &Scene) -> Result<(), Error> {
        check_files(&scene.table_files().collect::<Vec<_>>(), &self.written)
    }

    /// Whether a text summary goes to standard output.
    pub fn text_on_stdout(&self) -> bool {
        !(self.json || self.rows_on_stdout)
    }

    /// Shows a result: as JSON if asked for, else as text, on standard error if the rows go to standard output.
    pub fn show(
        &self,
        result: &impl Serialize,
        text: impl FnOnce() -> String,
    ) -> Result<(), Error> {
        match (self.json, self.rows_on_stdout) {
            (true, _) => print(&report::json(result)?),
            (false, false) => print(&text()),
            (false, true) => {
                say(text().trim_end());
                Ok(())
            }
        }
    }
}

/// Refuses two results with one file, and a result that would overwrite an input.
pub(super) fn check_files(read: &[&Path], written: &[PathBuf]) -> Result<(), Error> {
    for (index, path) in written.iter().enumerate() {
        let (shown, here) = (path.display(), place(path));
        if is_standard(Some(path)) || (here.exists() && !here.is_file()) {
            continue;
        }
        if read.iter().any(|file| place(file) == here) {
            return Err(Error::refused(
                format!("`{shown}` is read by this command and would be overwritten"),
                "write the result to another file",
            ));
        }
        if written[..index].iter().any(|other| place(other) == here) {
            return Err(Error::refused(
                format!("two results would be written to `{shown}`"),
                "give each its own file",
            ));
        }
    }
    Ok(())
}

/// Refuses a path whose extension is not among the formats `written`.
pub(super) fn check_extension(path: Option<&PathBuf>, written: &[&str]) -> Result<(), Error> {
    let is_known = |path: &Path| written.contains(&&*extension(path));
    let Some(path) = path.filter(|path| path.extension().is_some() && !is_known(path)) else {
        return Ok(());
    };
    let (shown, format) = (path.display(), written[0].to_uppercase());
    let other = path.with_extension(written[0]);
    Err(Error::refused(
        format!("`{shown}` would hold {format}, which its ending does not say"),
        format!("write it to `{}`", other.display()),
    ))
}

/// Whether a path stands for standard input or output.
pub(super) fn is_standard(path: Option<&PathBuf>) -> bool {
    path.is_some_and(|path| report::is_standard_output(path))
}

/// Refuses scene and data that are both read from standard input.
pub(super) fn check_inputs(scene: Option<&PathBuf>, data: Option<&PathBuf>) -> Result<(), Error> {
    if is_standard(scene) && is_standard(data) {
        return Err(Error::refused(
            "scene and data cannot both come from standard input",
            "give one of them as a file",
        ));
    }
    Ok(())
}

/// Opens an optional output, `-` for standard output.
pub(super) fn create(path: Option<&PathBuf>) -> Result<Option<Output>, Error> {
    path.map(|path| Output::create(path)).transpose()
}

/// Writes a text to an optional output.
pub(super) fn fill(
    output: Option<Output>,
    text: impl FnOnce() -> Result<String, Error>,
) -> Result<(), Error> {
    output.map_or(Ok(()), |output| output.text(&text()?))
}

/// Draws a figure, given as SVG, to an optional picture.
pub(super) fn draw(
    picture: Option<Output>,
    svg: impl FnOnce() -> Result<String, Error>,
) -> Result<(), Error> {
    picture.map_or(Ok(()), |picture| picture.draw(&svg()?))
}

/// Opens an optional page, whose extension must be one of a page.
pub(super) fn page(path: Option<&PathBuf>) -> Result<Option<Output>, Error> {
    check_extension(path, &["html", "htm"])?;
    create(path)
}

/// Loads the text of a scene: a file, or the built-in engine.
pub(super) fn draft(file: Option<&PathBuf>) -> Result<Draft, Error> {
    file.map_or_else(|| Ok(Draft::duarte()), |file| Draft::load(file))
}

/// Loads the scene of a command: a file, or the built-in engine.
pub(super) fn scene(file: Option<&PathBuf>) -> Result<Scene, Error> {
    Ok(draft(file)?.scene()?)
}

/// Returns the origin of a result: text of the scene, if readable a second time, and command.
pub(super) fn origin(file: Option<&PathBuf>) -> Origin {
    Origin {
        scene: match file {
            Some(file) if is_standard(Some(file)) => None,
            Some(file) => std::fs::read_to_string(file).ok(),
            None => Some(DUARTE.to_owned()),
        },
        command: command_line(),
    }
}

/// Returns the command line of this process, quoted for a shell.
pub(super) fn command_line() -> String {
    let quoted = |argument: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
        match !argument.is_empty() && argument.chars().all(plain) {
            true => argument,
            false => format!("'{}'", argument.replace('\'', "'\\''")),
        }
    };
    let arguments = std::env::args_os().skip(1);
    let arguments = arguments.map(|argument| quoted(argument.to_string_lossy().into_owned()));
    let line = std::iter::once("slider-crank".to_owned()).chain(arguments);
    line.collect::<Vec<_>>().join(" ")
}
