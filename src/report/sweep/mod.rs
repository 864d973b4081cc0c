//! Output of a sweep: rows as CSV in a resumable file, ranges of the key figures, merging of parts.

mod file_lock;
mod merge;
mod ranges;
mod resumable_file;
mod tally;

use std::ops::Range;
use std::path::Path;

use super::csv::{self, CsvCell};
use super::decimate::Decimated;
use super::output::{Output, is_standard_output, is_stream};
use super::table::Table;
use crate::error::Error;
use crate::scene::printable;
use crate::sweep::{self, Design, Goal, Sweep};
pub use merge::merge;
pub use ranges::{
    FrontDesign, Spread, SweepExtreme, SweepRange, SweepSummary, VariedKey, sweep_page, sweep_text,
};
use resumable_file::ResumableFile;
use tally::Tally;

/// Writer of the rows of `sweep`, in the order of the designs.
///
/// Rows go to a file named like the target with `.part` appended, which becomes the target when complete; after an
/// interruption, the next sweep of equal scene, values and options resumes from it. Only the first part of a sweep has
/// the header: the concatenated files of all parts are the file of the whole.
#[derive(Debug)]
pub struct SweepWriter<'a> {
    sweep: &'a Sweep,
    range: Range<usize>,
    target: Target,
    tally: Tally,
    /// Number of rows found in the file of an interrupted sweep.
    kept: usize,
    /// Rows kept in memory for a table.
    shown: Option<Decimated<Vec<CsvCell>>>,
}

/// Options of the summary of a sweep.
#[derive(Clone, Debug, Default)]
pub struct SweepSummaryOptions {
    /// Goals of the Pareto front; none for no front.
    pub goals: Vec<Goal>,
    /// Whether to compute percentiles, which a sample always has.
    pub percentiles: bool,
    /// Maximum number of rows kept as a table, for a page or for code; none for no table.
    pub kept: Option<usize>,
}

/// Maximum number of designs on a page, which then holds about ten megabytes.
pub const MOST_PAGE_DESIGNS: usize = 50_000;

#[derive(Debug)]
enum Target {
    Nothing,
    Stream(Output),
    File(ResumableFile),
}

impl<'a> SweepWriter<'a> {
    /// Opens the target of part `part` of `parts`, counted from 1: none, `-` for standard output, or a file, resumed
    /// if an interrupted sweep left rows. Refused if a goal is no figure of the sweep, the file belongs to another sweep,
    /// or another process is writing it.
    pub fn new(
        path: Option<&Path>,
        sweep: &'a Sweep,
        [part, parts]: [usize; 2],
        asked: &SweepSummaryOptions,
    ) -> Result<SweepWriter<'a>, Error> {
        let names = header(sweep);
        let percentiles = asked.percentiles || sweep.options.sample.is_some();
        let mut writer = SweepWriter {
            sweep,
            tally: Tally::new(&names, percentiles, &asked.goals)?,
            range: sweep.part(part, parts)?,
            target: Target::Nothing,
            kept: 0,
            shown: asked.kept.map(Decimated::new),
        };
        let names: Vec<CsvCell> = names.iter().map(|name| CsvCell::from(&**name)).collect();
        let header = if part == 1 { line(&names) } else { Vec::new() };
        let Some(path) = path else {
            return Ok(writer);
        };
        if is_standard_output(path) || is_stream(path) {
            let mut output = Output::create(path)?;
            output.write(&header)?;
            writer.target = Target::Stream(output);
            return Ok(writer);
        }
        let Range { start, end } = writer.range;
        let mark = format!("sweep {:016x} {start}..{end}", sweep.identity());
        let mut last = String::new();
        let file = ResumableFile::open(path, &mark, &header, |row| {
            writer.take(csv::read(row)?);
            writer.kept += 1;
            row.clone_into(&mut last);
            Ok(())
        })?;
        // Tables named by the scene may have changed: the last row is computed again and compared.
        if writer.kept > 0 {
            let design = sweep.design(start + writer.kept - 1);
            if line(&cells_of(sweep, &design)) != last.as_bytes() {
                return Err(file.of_another());
            }
        }
        writer.target = Target::File(file);
        Ok(writer)
    }

    /// Counts a row, and keeps it for the table.
    fn take(&mut self, cells: Vec<CsvCell>) {
        self.tally.take(&cells);
        if let Some(shown) = &mut self.shown {
            shown.take(cells);
        }
    }

    /// Returns the designs still to be computed.
    pub fn missing(&self) -> Range<usize> {
        (self.range.start + self.kept).min(self.range.end)..self.range.end
    }

    /// Computes the missing designs on all cores and writes their rows; `progress` is told how many designs of the sweep
    /// are done. Rows of a file have been passed to the system before `progress` is called.
    pub fn compute(&mut self, mut progress: impl FnMut(usize)) -> Result<(), Error> {
        let (sweep, missing) = (self.sweep, self.missing());
        let is_written = !matches!(self.target, Target::Nothing);
        let row = |design: Design| {
            let cells = cells_of(sweep, &design);
            let line = if is_written { line(&cells) } else { Vec::new() };
            (cells, line)
        };
        let mut done = missing.start;
        sweep.map_designs(missing, row, |rows| {
            done += rows.len();
            let mut text = Vec::new();
            for (cells, line) in rows {
                text.extend(line);
                self.take(cells);
            }
            match &mut self.target {
                Target::Nothing => {}
                Target::Stream(output) => output.write(&text)?,
                Target::File(file) => file.append(&text)?,
            }
            progress(done);
            Ok(())
        })
    }

    /// Returns the kept rows; none if none were asked for.
    pub fn table(&self) -> Option<Table> {
        let shown = self.shown.as_ref()?;
        let mut table = Table::of_rows(&header(self.sweep), &shown.kept);
        table.stride = shown.stride;
        Some(table)
    }

    /// Completes the output and returns the summary, after `wall_s` seconds of computation.
    pub fn finish(self, wall_s: f64) -> Result<SweepSummary, Error> {
        match self.target {
            Target::Nothing => {}
            Target::Stream(output) => output.finish()?,
            Target::File(file) => file.finish()?,
        }
        let (sweep, kept) = (self.sweep, self.kept);
        Ok(self.tally.summary(sweep, &self.range, kept, wall_s))
    }
}

fn header(sweep: &Sweep) -> Vec<String> {
    let varied = sweep.varied.iter().map(|one| one.column());
    let figures = sweep.options.figures.iter().map(ToString::to_string);
    let all = ["design".to_owned()].into_iter().chain(varied);
    let all = all.chain(["status".to_owned()]).chain(figures);
    all.chain(["notes".to_owned()]).collect()
}

fn cells_of(sweep: &Sweep, design: &Design) -> Vec<CsvCell> {
    let mut cells = vec![CsvCell::from((design.index + 1) as f64)];
    for (varied, value) in sweep.varied.iter().zip(&design.values) {
        let number = value.number.filter(|_| varied.has_numbers);
        cells.push(number.map_or_else(|| CsvCell::from(&*printable(&value.text)), CsvCell::from));
    }
    cells.push(design.outcome.name().into());
    let figures = sweep.options.figures.iter();
    cells.extend(figures.map(|figure| match figure.value(design) {
        sweep::FigureValue::Number(number) => number.into(),
        sweep::FigureValue::Word(word) => word.into(),
        sweep::FigureValue::Empty => CsvCell::EMPTY,
    }));
    // One row is one line.
    let notes = design.notes.join("; ").replace(['\n', '\r'], " ");
    cells.push(CsvCell::from(&*printable(&notes)));
    cells
}

/// Returns cells as one line of CSV.
fn line(cells: &[CsvCell]) -> Vec<u8> {
    let mut text = Vec::with_capacity(16 * cells.len());
    csv::cells(cells, &mut text);
    text
}
