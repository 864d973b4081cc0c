//! Merges the CSV files of the parts of a sweep into one file and one summary.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::ranges::SweepSummary;
use super::tally::Tally;
use crate::error::Error;
use crate::report::csv;
use crate::report::output::Output;
use crate::sweep::Goal;

/// Rows of a part as lines, with the number of its first design, from 1.
struct PartFile<'a> {
    path: &'a Path,
    lines: Box<dyn Iterator<Item = io::Result<String>>>,
    first: usize,
}

/// Merges the files of the parts of a sweep, given in any order, into `out`; returns counts, ranges and Pareto front,
/// with percentiles if asked for. Refused if no part has the header, or at the first missing or repeated design.
pub fn merge(
    paths: &[PathBuf],
    out: Option<&Path>,
    goals: &[Goal],
    percentiles: bool,
) -> Result<SweepSummary, Error> {
    let mut header = String::new();
    let mut parts = Vec::new();
    for path in paths {
        parts.extend(PartFile::open(path, &mut header)?);
    }
    parts.sort_by_key(|part| part.first);
    let mut tally = Tally::new(&csv::texts(&header)?, percentiles, goals)?;
    let mut out = out.map(Output::create).transpose()?;
    let mut put = |line: &str| match &mut out {
        Some(out) => out.write(format!("{line}\n").as_bytes()),
        None => Ok(()),
    };
    put(&header)?;
    let mut next = 1;
    for PartFile { path, lines, .. } in parts {
        for line in lines {
            let line = line.map_err(Error::read(path))?;
            let (found, shown) = (design(path, &line)?, path.display());
            if found != next {
                let what = match found < next {
                    true => format!("design {found} in `{shown}` is there twice"),
                    false => format!("design {next} is missing: `{shown}` goes on with {found}"),
                };
                return Err(Error::refused(what, "give every part of one sweep once"));
            }
            next += 1;
            put(&line)?;
            tally.take(&csv::read(&line)?);
        }
    }
    out.map_or(Ok(()), Output::finish)?;
    Ok(tally.found())
}

impl PartFile<'_> {
    /// Opens a file and reads its header, if present; none without designs.
    fn open<'a>(path: &'a Path, header: &mut String) -> Result<Option<PartFile<'a>>, Error> {
        let failed = Error::read(path);
        let mut lines = BufReader::new(File::open(path).map_err(&failed)?).lines();
        let mut next = || lines.next().transpose().map_err(&failed);
        let mut line = next()?;
        if let Some(names) = line.take_if(|line| line.starts_with("design,")) {
            *header = names;
            line = next()?;
        }
        let Some(line) = line else { return Ok(None) };
        let first = design(path, &line)?;
        let lines = Box::new(std::iter::once(Ok(line)).chain(lines));
        Ok(Some(PartFile { path, lines, first }))
    }
}

/// Returns the number of the design of a row.
fn design(path: &Path, line: &str) -> Result<usize, Error> {
    let cell = line.split(',').next().unwrap_or_default();
    cell.parse().map_err(|_| {
        let shown = path.display();
        Error::refused(
            format!(
                "`{shown}` has a row that begins with `{cell}`, which is no number of a design"
            ),
            "give the files that `sweep --shard` wrote",
        )
    })
}
