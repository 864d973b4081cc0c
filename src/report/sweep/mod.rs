//! The designs of a sweep: rows, what they range over, and where they are kept until all are there.

mod file_lock;
mod merge;
mod ranges;
mod resumable_file;
mod tally;

use std::ops::Range;
use std::path::Path;

use rayon::prelude::*;

use super::csv::{self, CsvCell};
use super::decimate::Thinned;
use super::output::{Output, is_standard_output, is_stream};
use super::table::Table;
use crate::error::Error;
use crate::scene::printable;
use crate::sweep::{self, Design, Goal, Sweep};
pub use merge::merge;
pub use ranges::{
    FrontDesign, Spread, SweepExtreme, SweepRange, SweepSummary, VariedKey, sweep_page, sweep_text,
};
use resumable_file::Growing;
use tally::Tally;

/// Rows of `sweep`, in the order of the designs.
///
/// A file grows beside its target under the name of the target with `.part` at its end, and takes its name
/// when all rows are in it; if the sweep is cut off, the next one of the same scene, values and options goes
/// on where it ended. The header stands in the first part of a sweep only, so that the files of all parts
/// make the whole when they are put one after the other.
#[derive(Debug)]
pub struct SweepWriter<'a> {
    sweep: &'a Sweep,
    range: Range<usize>,
    target: Target,
    tally: Tally,
    /// Rows that were there already.
    kept: usize,
    /// Rows that are kept.
    shown: Option<Thinned<Vec<CsvCell>>>,
}

/// What is summed up beside the ranges.
#[derive(Clone, Debug, Default)]
pub struct SweepAsked {
    /// The designs of their Pareto front are named.
    pub goals: Vec<Goal>,
    /// Whether figures have percentiles; those of a sample do without being asked.
    pub percentiles: bool,
    /// Most rows that are kept by columns, if any are to be: for a page, or for code.
    pub kept: Option<usize>,
}

/// Most rows on a page.
pub const MOST_ON_PAGE: usize = 50_000;

#[derive(Debug)]
enum Target {
    Nothing,
    Stream(Output),
    File(Growing),
}

impl<'a> SweepWriter<'a> {
    /// Opens the target of part `part` of `parts`, counted from 1: none, `-` for standard output, or a file;
    /// takes up what an earlier sweep left.
    ///
    /// # Errors
    /// [`Error::Write`]; [`Error::Refused`] if a goal is no figure of the sweep, if what was left is of another
    /// sweep, or one is writing it.
    pub fn new(
        path: Option<&Path>,
        sweep: &'a Sweep,
        [part, parts]: [usize; 2],
        asked: &SweepAsked,
    ) -> Result<SweepWriter<'a>, Error> {
        let mut shown = asked.kept.map(Thinned::new);
        let header = header(sweep);
        let mut tally = Tally::new(
            &header,
            asked.percentiles || sweep.sample().is_some(),
            &asked.goals,
        )?;
        let names: Vec<CsvCell> = header.iter().map(|name| CsvCell::from(&**name)).collect();
        let header = if part == 1 { line(&names) } else { Vec::new() };
        let range = sweep.part(part, parts)?;
        let mut kept = 0;
        let target = match path {
            None => Target::Nothing,
            Some(path) if is_standard_output(path) || is_stream(path) => {
                let mut output = Output::create(path)?;
                output.write(&header)?;
                Target::Stream(output)
            }
            Some(path) => {
                let mark = format!(
                    "sweep {:016x} {}..{}",
                    sweep.identity(),
                    range.start,
                    range.end
                );
                let mut last = String::new();
                let file = Growing::open(path, &mark, &header, |row| {
                    let found = csv::read(row)?;
                    tally.take(&found);
                    if let Some(shown) = &mut shown {
                        shown.take(found);
                    }
                    kept += 1;
                    row.clone_into(&mut last);
                    Ok(())
                })?;
                // The tables that a scene names may have changed though its own file has not.
                if kept > 0 {
                    let design = sweep.design(range.start + kept - 1);
                    if line(&cells_of(sweep, &design)) != last.as_bytes() {
                        return Err(file.of_another());
                    }
                }
                Target::File(file)
            }
        };
        Ok(SweepWriter {
            sweep,
            range,
            target,
            tally,
            kept,
            shown,
        })
    }

    /// The designs that are not there yet.
    pub fn missing(&self) -> Range<usize> {
        (self.range.start + self.kept).min(self.range.end)..self.range.end
    }

    /// Writes rows; those of a file are safe when this returns.
    pub fn take(&mut self, designs: &[Design]) -> Result<(), Error> {
        let written = !matches!(self.target, Target::Nothing);
        let made = designs.par_iter().map(|design| {
            let cells = cells_of(self.sweep, design);
            let line = if written { line(&cells) } else { Vec::new() };
            (cells, line)
        });
        let mut text = Vec::new();
        for (cells, line) in made.collect::<Vec<_>>() {
            text.extend(line);
            self.tally.take(&cells);
            if let Some(shown) = &mut self.shown {
                shown.take(cells);
            }
        }
        match &mut self.target {
            Target::Nothing => Ok(()),
            Target::Stream(output) => output.write(&text),
            Target::File(file) => file.append(&text),
        }
    }

    /// The rows that were kept.
    pub fn table(&self) -> Option<Table> {
        let shown = self.shown.as_ref()?;
        let mut table = Table::of_rows(&header(self.sweep), shown.kept());
        table.stride = shown.stride();
        Some(table)
    }

    /// Completes the output and sums up, after `wall_s` seconds of computation.
    pub fn finish(self, wall_s: f64) -> Result<SweepSummary, Error> {
        match self.target {
            Target::Nothing => {}
            Target::Stream(output) => output.finish()?,
            Target::File(file) => file.finish()?,
        }
        Ok(self
            .tally
            .summary(self.sweep, &self.range, self.kept, wall_s))
    }
}

fn header(sweep: &Sweep) -> Vec<String> {
    let varied = sweep.varied().iter().map(|one| one.column());
    let figures = sweep.figures().iter().map(ToString::to_string);
    let all = ["design".to_owned()].into_iter().chain(varied);
    let all = all.chain(["status".to_owned()]).chain(figures);
    all.chain(["notes".to_owned()]).collect()
}

fn cells_of(sweep: &Sweep, design: &Design) -> Vec<CsvCell> {
    let mut cells = vec![CsvCell::from((design.index + 1) as f64)];
    for (varied, value) in sweep.varied().iter().zip(&design.values) {
        let number = value.number.filter(|_| varied.has_numbers());
        cells.push(number.map_or_else(|| CsvCell::from(&*printable(&value.text)), CsvCell::from));
    }
    cells.push(design.outcome.name().into());
    let figures = sweep.figures().iter();
    cells.extend(figures.map(|figure| match figure.cell(design) {
        sweep::Cell::Number(number) => number.into(),
        sweep::Cell::Word(word) => word.into(),
        sweep::Cell::Empty => CsvCell::EMPTY,
    }));
    // A row is a line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(CsvCell::from(&*printable(&notes)));
    cells
}

/// Cells as one line of CSV.
fn line(cells: &[CsvCell]) -> Vec<u8> {
    let mut text = Vec::new();
    csv::cells(cells, &mut text);
    text
}
