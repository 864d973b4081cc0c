//! Accumulates the rows of a sweep: counts by status, ranges and percentiles of the columns, Pareto front.

use std::collections::BTreeMap;
use std::ops::Range;

use super::ranges::{FrontDesign, Spread, SweepExtreme, SweepRange, SweepSummary, VariedKey};
use crate::error::Error;
use crate::report::csv::CsvCell;
use crate::sweep::{Goal, Member, ParetoFront, Sweep};

/// Accumulator of the rows of a sweep.
#[derive(Debug)]
pub(super) struct Tally {
    columns: Vec<ColumnTally>,
    /// Number of columns before the key figures: design, varied values and `status`.
    before: usize,
    status: BTreeMap<String, usize>,
    /// Indices of the columns of the goals.
    goals: Vec<usize>,
    front: ParetoFront,
    rows: usize,
}

#[derive(Debug)]
struct ColumnTally {
    name: String,
    extremes: Option<[SweepExtreme; 2]>,
    /// All values, kept for percentiles.
    values: Option<Vec<f64>>,
}

impl Tally {
    /// Starts an accumulator for rows with these columns; `is_sample` asks for percentiles. Refused if the columns lack
    /// `status` or a goal.
    pub fn new(header: &[String], is_sample: bool, goals: &[Goal]) -> Result<Tally, Error> {
        let place = |name: &str| header.iter().position(|column| column == name);
        let before = place("status").ok_or_else(|| {
            Error::refused(
                "the rows have no column `status`, so they are not those of a sweep",
                "give the first part of a sweep too, which has the header",
            )
        })? + 1;
        let column = |goal: &Goal| {
            let name = goal.figure.to_string();
            place(&name).ok_or_else(|| {
                Error::refused(
                    format!("`{name}` is not among the key figures of this sweep"),
                    format!("name all that are wanted, like --figures stroke,{name}"),
                )
            })
        };
        let columns = header.iter().map(|name| ColumnTally {
            name: name.clone(),
            extremes: None,
            values: is_sample.then(Vec::new),
        });
        Ok(Tally {
            columns: columns.collect(),
            before,
            status: BTreeMap::new(),
            goals: goals.iter().map(column).collect::<Result<_, _>>()?,
            front: ParetoFront::new(goals.iter().map(|goal| goal.maximise).collect()),
            rows: 0,
        })
    }

    /// Adds the cells of a row.
    pub fn take(&mut self, cells: &[CsvCell]) {
        let design = cells.first().and_then(CsvCell::number);
        let status = cells.get(self.before - 1).map(CsvCell::text);
        let (Some(design), Some(status)) = (design, status) else {
            return;
        };
        let design = design as usize;
        self.rows += 1;
        *self.status.entry(status.to_string()).or_default() += 1;
        let figures = cells.iter().zip(&mut self.columns).skip(self.before);
        for (cell, column) in figures {
            if let Some(value) = cell.number() {
                column.take(design, value);
            }
        }
        let goals = self.goals.iter().map(|place| cells.get(*place)?.number());
        if let Some(figures) = goals.collect::<Option<Vec<f64>>>()
            && status == "done"
            && !figures.is_empty()
        {
            self.front.take(design, &figures);
        }
    }

    /// Returns the summary of a range of the designs of a sweep.
    pub fn summary(
        self,
        sweep: &Sweep,
        range: &Range<usize>,
        taken_up: usize,
        wall_s: f64,
    ) -> SweepSummary {
        let varied = sweep.varied.iter().map(|one| VariedKey {
            key: one.key(),
            values: one.to_string(),
            count: one.len(),
            first: one.value(0).text,
            last: one.value(one.len() - 1).text,
        });
        SweepSummary {
            scene: sweep.title.clone(),
            designs: sweep.len(),
            part: [range.start + 1, range.end],
            taken_up,
            varied: varied.collect(),
            wall_s,
            ..self.found()
        }
    }

    /// Returns the summary of the rows of all parts of a sweep.
    pub fn found(self) -> SweepSummary {
        let names = self.goals.iter().map(|goal| &self.columns[*goal].name);
        let member = |one: &Member| FrontDesign {
            design: one.design,
            figures: names.clone().cloned().zip(one.figures.clone()).collect(),
        };
        SweepSummary {
            designs: self.rows,
            part: [1, self.rows],
            status: self.status,
            pareto_front: self.front.members.iter().map(member).collect(),
            figures: self
                .columns
                .into_iter()
                .filter_map(ColumnTally::range)
                .collect(),
            ..SweepSummary::default()
        }
    }
}

impl ColumnTally {
    fn take(&mut self, design: usize, value: f64) {
        let here = SweepExtreme { value, design };
        match &mut self.extremes {
            None => self.extremes = Some([here.clone(), here]),
            Some([min, _]) if value < min.value => *min = here,
            Some([_, max]) if value > max.value => *max = here,
            Some(_) => {}
        }
        if let Some(values) = &mut self.values {
            values.push(value);
        }
    }

    fn range(self) -> Option<SweepRange> {
        let [min, max] = self.extremes?;
        Some(SweepRange {
            column: self.name,
            min,
            max,
            spread: self.values.map(Spread::of),
        })
    }
}
