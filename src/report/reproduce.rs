//! Reports of the reproduction of papers: numbers as table, CSV and JSON, figures as CSV and SVG.

use serde::Serialize;

use super::csv::{self, CsvCell};
use super::key_values::{aligned, rounded};
use crate::reproduce::{Drawing, Entry, Reproduction, Verdict};

/// Counts of the verdicts, entries and file names of figures, for JSON.
#[derive(Clone, Debug, Serialize)]
pub struct ReproductionSummary<'a> {
    reproduces: usize,
    reproduces_only_if: usize,
    cannot_be_reproduced: usize,
    unexpected: usize,
    entries: &'a [Entry],
    figures: Vec<String>,
}

impl<'a> ReproductionSummary<'a> {
    /// Counts the verdicts of a reproduction.
    pub fn new(result: &'a Reproduction) -> ReproductionSummary<'a> {
        let count = |verdict: Verdict| {
            let same = |entry: &&Entry| entry.verdict == verdict;
            result.entries.iter().filter(same).count()
        };
        ReproductionSummary {
            reproduces: count(Verdict::Reproduces),
            reproduces_only_if: count(Verdict::OnlyIf),
            cannot_be_reproduced: count(Verdict::Cannot),
            unexpected: result.surprises().count(),
            entries: &result.entries,
            figures: result.drawings.iter().map(file_name).collect(),
        }
    }
}

/// Returns the file name of a figure, without extension.
pub fn file_name(drawing: &Drawing) -> String {
    format!("{}-{}", drawing.paper, drawing.name)
}

fn short(value: f64) -> String {
    rounded(value, 7)
}

/// Returns a table of all entries, and the counts of the verdicts.
pub fn reproduction(result: &Reproduction) -> String {
    const COLUMN_WIDTHS: [isize; 6] = [-22, 14, 14, -7, -21, 0];
    let mut text = String::new();
    let mut paper = "";
    for entry in &result.entries {
        if entry.paper != paper {
            paper = entry.paper;
            let gap = if text.is_empty() { "" } else { "\n" };
            let header = ["  place", "printed", "ours", "unit", "verdict", "what"];
            text += &format!("{gap}{paper}\n{}", aligned(&COLUMN_WIDTHS, header));
        }
        let printed = match entry.printed.parse() {
            Ok(value) if entry.printed.len() > 12 => short(value),
            _ => entry.printed.clone(),
        };
        let cells = [
            &*format!("  {}", entry.place),
            &*printed,
            &*entry.ours.map_or("-".to_owned(), short),
            &*entry.unit,
            entry.verdict.name(),
            &*entry.what,
        ];
        text += &aligned(&COLUMN_WIDTHS, cells);
        let more = " ".repeat(60);
        if !entry.condition.is_empty() {
            let value = entry.conditional.map(|value| format!(": {}", short(value)));
            let (condition, value) = (&entry.condition, value.unwrap_or_default());
            text += &format!("{more} {condition}{value}\n");
        }
        if entry.verdict != entry.expected {
            let known = entry.expected.name();
            text += &format!("{more} UNEXPECTED: known as \"{known}\"\n");
        }
    }
    let summary = ReproductionSummary::new(result);
    text + &format!(
        "\n{} reproduce, {} only if, {} cannot be reproduced; {} unexpected\n",
        summary.reproduces,
        summary.reproduces_only_if,
        summary.cannot_be_reproduced,
        summary.unexpected
    )
}

/// Returns all entries as CSV.
pub fn reproduction_csv(result: &Reproduction) -> String {
    let header = "paper,place,what,unit,printed,ours,conditional,condition,verdict,expected";
    let rows = result.entries.iter();
    csv::text(header, rows.map(|entry| csv::fields(header, entry)))
}

/// Returns the data of a figure as CSV, one row per point.
pub fn drawing_csv(drawing: &Drawing) -> String {
    let series = drawing.plots.iter();
    let series = series.flat_map(|plot| plot.series.iter().map(move |series| (plot, series)));
    let rows = series.flat_map(|(plot, series)| {
        let names = [&*plot.x.label, &*plot.y.label, &*series.label];
        series.points.iter().map(move |(x, y, _)| {
            let cells = names.map(CsvCell::from).into_iter();
            cells.chain([*x, *y].map(CsvCell::from)).collect()
        })
    });
    csv::text("x_axis,y_axis,series,x,y", rows)
}
