//! The parts of a sweep put together.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::super::output::Output;
use super::ranges::SweepSummary;
use super::tally::Tally;
use super::{cells, texts};
use crate::error::Error;
use crate::sweep::Goal;

/// The file of a part, open at its first design.
struct Part {
    path: PathBuf,
    lines: std::io::Lines<BufReader<File>>,
    /// The line of the first design, and its number from 1.
    first: (String, usize),
}

/// Puts the files of the parts of a sweep together, in any order: the whole to `out`, and what it ranges over, with
/// percentiles if they are asked for.
///
/// # Errors
/// [`Error::Read`]; [`Error::Refused`] if no part has the header, or at the first design that is missing or there twice;
/// [`Error::Write`].
pub fn merge(
    paths: &[PathBuf],
    out: Option<&Path>,
    goals: &[Goal],
    percentiles: bool,
) -> Result<SweepSummary, Error> {
    let mut header = String::new();
    let parts = paths.iter().map(|path| Part::open(path, &mut header));
    let mut parts: Vec<Part> = parts
        .filter_map(Result::transpose)
        .collect::<Result<_, _>>()?;
    parts.sort_by_key(|part| part.first.1);
    let mut tally = Tally::new(&texts(&header)?, percentiles, goals)?;
    let mut out = out.map(Output::create).transpose()?;
    let mut put = |line: &str| match &mut out {
        Some(out) => out.write(format!("{line}\n").as_bytes()),
        None => Ok(()),
    };
    put(&header)?;
    let mut next = 1;
    for Part { path, lines, first } in parts {
        for line in std::iter::once(Ok(first.0)).chain(lines) {
            let line = line.map_err(|source| unread(&path, source))?;
            let found = design(&path, &line)?;
            if found != next {
                return Err(not_next(&path, found, next));
            }
            next += 1;
            put(&line)?;
            tally.take(&cells(&line)?);
        }
    }
    out.map_or(Ok(()), Output::finish)?;
    Ok(tally.found())
}

impl Part {
    /// Opens a file and takes its header, if it has one; none without designs.
    fn open(path: &Path, header: &mut String) -> Result<Option<Part>, Error> {
        let failed = |source| unread(path, source);
        let mut lines = BufReader::new(File::open(path).map_err(failed)?).lines();
        let mut line = lines.next().transpose().map_err(failed)?;
        if line
            .as_ref()
            .is_some_and(|line| line.starts_with("design,"))
        {
            *header = line.unwrap_or_default();
            line = lines.next().transpose().map_err(failed)?;
        }
        let Some(line) = line else { return Ok(None) };
        let first = design(path, &line)?;
        Ok(Some(Part {
            path: path.to_owned(),
            lines,
            first: (line, first),
        }))
    }
}

fn unread(path: &Path, source: std::io::Error) -> Error {
    Error::Read {
        file: path.to_owned(),
        source,
    }
}

/// The number of the design of a row.
fn design(path: &Path, line: &str) -> Result<usize, Error> {
    let cell = line.split(',').next().unwrap_or_default();
    cell.parse().map_err(|_| {
        Error::refused(
            format!(
                "`{}` has a row that begins with `{cell}`, which is no number of a design",
                path.display()
            ),
            "give the files that `sweep --shard` wrote",
        )
    })
}

fn not_next(path: &Path, found: usize, next: usize) -> Error {
    let what = match found < next {
        true => format!("design {found} in `{}` is there twice", path.display()),
        false => format!(
            "design {next} is missing: `{}` goes on with {found}",
            path.display()
        ),
    };
    Error::refused(what, "give every part of one sweep once")
}
