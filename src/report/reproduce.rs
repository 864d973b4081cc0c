//! The papers' numbers as a table, CSV and JSON; their figures as CSV and SVG.

use std::fmt::Write;

use serde::Serialize;

use super::csv::{quoted, shortest};
use super::key_values::rounded;
use super::{Axis, Figure, Sheet};
use crate::error::Error;
use crate::reproduce::{Drawing, Entry, Plot, Reproduction, Style, Verdict};

/// A summary of the verdicts for JSON.
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
    /// Counts the verdicts.
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

/// Name of the files of a figure, without ending.
pub fn file_name(drawing: &Drawing) -> String {
    format!("{}-{}", drawing.paper, drawing.name)
}

fn short(value: f64) -> String {
    rounded(value, 7)
}

fn cell(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), short)
}

/// Every entry on a line or two, and the count of the verdicts.
pub fn reproduction(result: &Reproduction) -> String {
    let mut text = String::new();
    let mut paper = "";
    for entry in &result.entries {
        if entry.paper != paper {
            paper = entry.paper;
            let _ = writeln!(text, "{}{paper}", if text.is_empty() { "" } else { "\n" });
            let _ = writeln!(
                text,
                "  {:<20} {:>14} {:>14} {:<7} {:<21} what",
                "place", "printed", "ours", "unit", "verdict"
            );
        }
        let printed = entry
            .printed
            .parse()
            .map_or(entry.printed.clone(), |value: f64| {
                if entry.printed.len() > 12 {
                    short(value)
                } else {
                    entry.printed.clone()
                }
            });
        let _ = writeln!(
            text,
            "  {:<20} {:>14} {:>14} {:<7} {:<21} {}",
            entry.place,
            printed,
            cell(entry.ours),
            entry.unit,
            entry.verdict.name(),
            entry.what
        );
        if !entry.condition.is_empty() {
            let value = entry
                .conditional
                .map_or(String::new(), |v| format!(": {}", short(v)));
            let _ = writeln!(text, "{:<60} {}{value}", "", entry.condition);
        }
        if entry.verdict != entry.expected {
            let _ = writeln!(
                text,
                "{:<60} UNEXPECTED: known as \"{}\"",
                "",
                entry.expected.name()
            );
        }
    }
    let summary = ReproductionSummary::new(result);
    let _ = writeln!(
        text,
        "\n{} reproduce, {} only if, {} cannot be reproduced; {} unexpected",
        summary.reproduces,
        summary.reproduces_only_if,
        summary.cannot_be_reproduced,
        summary.unexpected
    );
    text
}

fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), shortest)
}

/// Every entry as CSV.
pub fn reproduction_csv(result: &Reproduction) -> Result<String, Error> {
    let header = [
        "paper",
        "place",
        "what",
        "unit",
        "printed",
        "ours",
        "conditional",
        "condition",
        "verdict",
        "expected",
    ];
    let row = |entry: &Entry| {
        vec![
            entry.paper.to_owned(),
            entry.place.clone(),
            entry.what.clone(),
            entry.unit.to_owned(),
            entry.printed.clone(),
            number(entry.ours),
            number(entry.conditional),
            entry.condition.clone(),
            entry.verdict.name().to_owned(),
            entry.expected.name().to_owned(),
        ]
    };
    quoted(header, result.entries.iter().map(row))
}

/// The data of a figure as CSV, one row for each point.
pub fn drawing_csv(drawing: &Drawing) -> Result<String, Error> {
    let rows = drawing.plots.iter().flat_map(|plot| {
        plot.series.iter().flat_map(move |series| {
            series.points.iter().map(move |(x, y)| {
                vec![
                    plot.x.to_owned(),
                    plot.y.to_owned(),
                    series.label.clone(),
                    number(Some(*x)),
                    number(Some(*y)),
                ]
            })
        })
    });
    quoted(["x_axis", "y_axis", "series", "x", "y"], rows)
}

/// A figure as SVG.
pub fn drawing_svg(drawing: &Drawing) -> Result<String, Error> {
    let figures: Vec<Figure> = drawing.plots.iter().map(figure).collect();
    let sheet = Sheet {
        title: &drawing.title,
        columns: 2,
        size: None,
    };
    sheet.svg(&figures)
}

fn figure(plot: &Plot) -> Figure {
    let start = Figure::new("", Axis::linear(&plot.x), Axis::linear(&plot.y));
    plot.series.iter().fold(start, |figure, series| {
        let (label, points) = (series.label.as_str(), series.points.clone());
        match series.style {
            Style::Line => figure.line(label, points),
            Style::Dashed => figure.dashed(label, points),
            Style::Points => figure.points(label, points),
        }
    })
}
