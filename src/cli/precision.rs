//! Command `precision`: compares the methods by time and error.

use std::borrow::Cow;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};

use clap::Args;

use super::outputs::Plot;
use super::streams::{check_files, create, draw, fill, is_standard, origin, page, scene};
use super::watch::{print, say};
use crate::error::Error;
use crate::precision::{Precision, PrecisionOptions};
use crate::report;
use crate::scene::Scene;

#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Scene files, folders of scene files, `-` for standard input; without one the built-in Duarte engine
    scenes: Vec<PathBuf>,
    /// Tolerances, separated by commas; without it 1e-4 to 1e-13 in decades
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = tolerance, allow_hyphen_values = true)]
    tolerances: Vec<f64>,
    /// Writes the rows as CSV to this file, `-` for standard output
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    plot: Plot,
    /// Writes error against time as one HTML page to this file
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
    /// Prints the comparison as one JSON object
    #[arg(long)]
    json: bool,
    /// Timed runs of each method at each tolerance
    #[arg(long, value_name = "COUNT", default_value_t = PrecisionOptions::default().repeats, value_parser = clap::value_parser!(u32).range(1..))]
    repeats: u32,
    /// Most time for repeated runs of one scene, in seconds
    #[arg(long, value_name = "SECONDS", default_value_t = PrecisionOptions::default().most_s, value_parser = seconds, allow_hyphen_values = true)]
    most_time: f64,
    /// Work limit: most evaluations of the equation in one run
    #[arg(long, value_name = "COUNT", default_value_t = PrecisionOptions::default().max_evaluations)]
    max_evaluations: u64,
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.trim().parse() {
        Ok(tolerance) if tolerance > 0.0 && tolerance < 1.0 => Ok(tolerance),
        _ => Err("give numbers between 0 and 1, like 1e-6,1e-9".to_owned()),
    }
}

impl Arguments {
    fn options(&self) -> PrecisionOptions {
        PrecisionOptions {
            tolerances: match self.tolerances.is_empty() {
                true => PrecisionOptions::default().tolerances,
                false => self.tolerances.clone(),
            },
            repeats: self.repeats,
            most_s: self.most_time,
            max_evaluations: self.max_evaluations,
        }
    }

    /// Returns the files that are written.
    fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let files = [&self.out, &self.plot.plot, &self.report];
        files.into_iter().flatten()
    }

    /// Whether text goes to standard output: true if no other result does.
    fn text_on_stdout(&self) -> Result<bool, Error> {
        let files = self.files().filter(|file| is_standard(Some(file)));
        match files.count() + usize::from(self.json) {
            0 => Ok(true),
            1 => Ok(false),
            _ => Err(Error::refused(
                "more than one of rows, figure and JSON would go to standard output",
                "write to files: --out rows.csv --plot figure.svg",
            )),
        }
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(seconds) if seconds >= 0.0 => Ok(seconds),
        _ => Err("give a number of seconds that is zero or more".to_owned()),
    }
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Error> {
    let text_on_stdout = arguments.text_on_stdout()?;
    let files = scene_files(&arguments.scenes)?;
    let scenes: Vec<Scene> = match &files[..] {
        [] => vec![scene(None)?],
        files => files.iter().map(titled).collect::<Result<_, _>>()?,
    };
    let tables = scenes.iter().flat_map(Scene::table_files);
    let read: Vec<&Path> = files.iter().map(PathBuf::as_path).chain(tables).collect();
    let written: Vec<PathBuf> = arguments.files().cloned().collect();
    check_files(&read, &written)?;
    let rows = create(arguments.out.as_ref())?;
    let plot = arguments.plot.open()?;
    let page = page(arguments.report.as_ref())?;
    let results = compare(&scenes, &arguments.options(), text_on_stdout)?;
    fill(rows, || Ok(report::precision_csv(&results)))?;
    let size = arguments.plot.size;
    draw(plot, || report::precision_figure(&results, size))?;
    let file = files.first();
    fill(page, || report::precision_page(&results, &origin(file)))?;
    if arguments.json {
        print(&report::json(&serde_json::json!({ "scenes": results }))?)?;
    }
    let failed = results.iter().filter(|result| !result.has_results());
    match failed.count() {
        0 => Ok(()),
        failed => Err(Error::Incomplete(format!(
            "{failed} of {} scenes cannot be computed to their end; their rows are empty",
            scenes.len()
        ))),
    }
}

/// Compares the methods on each scene, and shows each comparison once computed.
fn compare(
    scenes: &[Scene],
    options: &PrecisionOptions,
    text_on_stdout: bool,
) -> Result<Vec<Precision>, Error> {
    let mut results = Vec::new();
    for (number, scene) in scenes.iter().enumerate() {
        if scenes.len() > 1 && std::io::stderr().is_terminal() {
            let title = scene.title.as_deref().unwrap_or_default();
            say(&format!("{} of {}: {title}", number + 1, scenes.len()));
        }
        let result = match crate::precision::precision(scene, options) {
            Err(error @ (Error::Refused { .. } | Error::Scene(_))) if scenes.len() > 1 => {
                Precision::refused(scene, &error)
            }
            result => result?,
        };
        if text_on_stdout {
            let gap = if number > 0 { "\n" } else { "" };
            print(&format!("{gap}{}", report::precision(&result)))?;
        } else {
            for note in report::precision_notes(&result) {
                say(&format!("note: {}: {note}", result.scene));
            }
        }
        results.push(result);
    }
    Ok(results)
}

/// Returns all named scene files; for a folder its files `*.toml`, sorted.
fn scene_files(named: &[PathBuf]) -> Result<Vec<PathBuf>, Error> {
    let files = named.iter().map(|path| match path.is_dir() {
        true => files_of(path),
        false => Ok(vec![path.clone()]),
    });
    Ok(files.collect::<Result<Vec<_>, _>>()?.concat())
}

fn files_of(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let entries = std::fs::read_dir(folder)
        .and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
    let mut files: Vec<PathBuf> = entries.map_err(Error::read(folder))?;
    files.retain(|path| path.is_file() && path.extension().is_some_and(|end| end == "toml"));
    if files.is_empty() {
        return Err(Error::refused(
            format!("the folder `{}` holds no scene file", folder.display()),
            "name a scene file, or a folder with files *.toml",
        ));
    }
    files.sort();
    Ok(files)
}

/// Loads a scene; the file name replaces a missing title.
fn titled(file: &PathBuf) -> Result<Scene, Error> {
    let mut scene = scene(Some(file))?;
    let name = file.file_stem().map(|name| name.to_string_lossy());
    scene.title = scene.title.or(name.map(Cow::into_owned));
    Ok(scene)
}
