//! What the key figures of a sweep range over.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::Range;

use serde::Serialize;

use super::super::key_values::{Facts, fact, six};
use super::super::page::{Origin, Page, Scatter};
use super::super::table::Table;
use super::columns::{before_figures, header};
use crate::error::Error;
use crate::sweep::Sweep;

/// What a sweep found.
#[derive(Clone, Debug, Serialize)]
pub struct SweepSummary {
    /// Title of the scene.
    pub scene: String,
    /// Number of designs of the whole sweep.
    pub designs: usize,
    /// First and last design of the part that was computed, from 1; the same as the whole without parts.
    pub part: [usize; 2],
    /// How many designs have each status.
    pub status: BTreeMap<String, usize>,
    /// How many rows an earlier sweep, which was cut off, had left.
    pub taken_up: usize,
    /// The varied keys, with their first and last values.
    pub varied: Vec<VariedKey>,
    /// Range of every key figure.
    pub figures: Vec<SweepRange>,
    /// Wall time of the designs, s.
    pub wall_s: f64,
}

/// A varied key.
#[derive(Clone, Debug, Serialize)]
pub struct VariedKey {
    /// As in scene files.
    pub key: String,
    /// Number of values.
    pub count: usize,
    /// First value, as in scene files.
    pub first: String,
    /// Last value.
    pub last: String,
}

/// Range of a key figure.
#[derive(Clone, Debug, Serialize)]
pub struct SweepRange {
    /// Name of the column.
    pub column: String,
    /// Least value.
    pub min: SweepExtreme,
    /// Largest value.
    pub max: SweepExtreme,
}

/// A value of a key figure and the first design that has it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepExtreme {
    /// In the unit of the column.
    pub value: f64,
    /// From 1.
    pub design: usize,
}

/// Rows counted, and the extremes of their columns.
#[derive(Debug)]
pub(super) struct Tally {
    columns: Vec<String>,
    before: usize,
    status: BTreeMap<String, usize>,
    extremes: Vec<Option<[SweepExtreme; 2]>>,
}

impl Tally {
    pub fn new(sweep: &Sweep) -> Tally {
        let columns = header(sweep);
        Tally {
            before: before_figures(sweep),
            status: BTreeMap::new(),
            extremes: vec![None; columns.len()],
            columns,
        }
    }

    /// Takes the cells of a row.
    pub fn take(&mut self, cells: &[String]) {
        let design = cells.first().and_then(|cell| cell.parse().ok());
        let status = cells.get(self.before - 1);
        let (Some(design), Some(status)) = (design, status) else {
            return;
        };
        *self.status.entry(status.clone()).or_default() += 1;
        let figures = cells.iter().zip(&mut self.extremes).skip(self.before);
        for (cell, extremes) in figures {
            let Ok(value) = cell.parse::<f64>() else {
                continue;
            };
            let here = SweepExtreme { value, design };
            match extremes {
                None => *extremes = Some([here.clone(), here]),
                Some([min, _]) if value < min.value => *min = here,
                Some([_, max]) if value > max.value => *max = here,
                Some(_) => {}
            }
        }
    }

    pub fn summary(
        self,
        sweep: &Sweep,
        range: &Range<usize>,
        taken_up: usize,
        wall_s: f64,
    ) -> SweepSummary {
        let figures = self.columns.into_iter().zip(self.extremes);
        let varied = sweep.varied().iter().map(|one| VariedKey {
            key: one.key(),
            count: one.len(),
            first: one.text(0).to_owned(),
            last: one.text(one.len() - 1).to_owned(),
        });
        SweepSummary {
            scene: sweep.title().to_owned(),
            designs: sweep.len(),
            part: [range.start + 1, range.end],
            status: self.status,
            taken_up,
            varied: varied.collect(),
            figures: figures
                .filter_map(|(column, extremes)| {
                    let [min, max] = extremes?;
                    Some(SweepRange { column, min, max })
                })
                .collect(),
            wall_s,
        }
    }
}

impl SweepSummary {
    /// How many designs are `done`.
    pub fn done(&self) -> usize {
        self.status.get("done").copied().unwrap_or(0)
    }
}

/// What a sweep found, as one page: any key figure over any other.
///
/// # Errors
/// [`Error::Write`].
pub fn sweep_page(summary: &SweepSummary, table: &Table, origin: &Origin) -> Result<String, Error> {
    let mut facts = facts(summary);
    for SweepRange { column, min, max } in &summary.figures {
        let (low, high) = (six(min.value), six(max.value));
        fact!(
            facts,
            column,
            "{low} (design {}) to {high} (design {})",
            min.design,
            max.design
        );
    }
    let varied = table.names().nth(1).map(str::to_owned);
    Page::new(origin, &facts)
        .table(table)
        .scatter(Scatter {
            x: varied.unwrap_or_default(),
            y: "stroke_m",
            log: false,
            lines: false,
            kind: "status",
            within: "",
        })
        .html()
}

fn facts(summary: &SweepSummary) -> Facts {
    let mut facts = Facts::of(&summary.scene);
    for one in &summary.varied {
        let VariedKey {
            key,
            count,
            first,
            last,
        } = one;
        fact!(facts, "varied", "{key}: {first} to {last}, {count} values");
    }
    let [from, to] = summary.part;
    let part = match to - (from - 1) {
        0 => ", none of these".to_owned(),
        count if count == summary.designs => String::new(),
        _ => format!(", of these {from} to {to}"),
    };
    fact!(facts, "designs", "{}{part}", summary.designs);
    for (status, count) in &summary.status {
        facts.add(format_args!("  {status}"), count);
    }
    if summary.taken_up > 0 {
        facts.add("  there already", summary.taken_up);
    }
    fact!(facts, "time", "{:.3} s", summary.wall_s);
    facts
}

/// What a sweep found, in words and a table of the ranges.
pub fn sweep_text(summary: &SweepSummary) -> String {
    let mut text = facts(summary).lines(17);
    let _ = writeln!(
        text,
        "\n{:<26} {:>12} {:>10} {:>12} {:>10}",
        "", "least", "in design", "largest", "in design"
    );
    for SweepRange { column, min, max } in &summary.figures {
        let _ = writeln!(
            text,
            "{column:<26} {:>12} {:>10} {:>12} {:>10}",
            six(min.value),
            min.design,
            six(max.value),
            max.design
        );
    }
    text
}
