//! Reports of an optimisation: best design as text, local searches as CSV.

use super::csv::{self, CsvCell};
use super::key_values::{Facts, fact, rounded, six};
use super::quantity::Quantity;
use crate::optimise::{AGREEMENT, EvaluatedConstraint, Optimum, OptimumValue};

/// Returns the best design, its limits, agreement of the searches and final sweeps, as text.
pub fn optimum(found: &Optimum) -> String {
    let mut facts = Facts::of(&found.scene);
    facts.add(found.sense, shown(&found.figure, found.value));
    for one in &found.values {
        facts.add(&one.key, varied(one));
    }
    for one in &found.subjects {
        facts.add("subject", subject(one));
    }
    let agreeing = found.starts.iter().filter(|start| start.agrees).count();
    fact!(facts, "local searches" => "{agreeing} of {} end there, to {AGREEMENT:.0e} of the figure's spread",
        found.starts.len());
    facts.add("proof", proof(found));
    fact!(facts, "cost" => "{} designs", found.designs);
    facts.warnings(&found.notes);
    facts.lines(22)
}

/// Returns name and value of a figure, in the displayed unit.
fn shown(column: &str, value: Option<f64>) -> String {
    let of = Quantity::of(column);
    match value {
        Some(value) => {
            let text = format!("{} {} {}", of.label, six(value * of.factor), of.unit);
            text.trim_end().to_owned()
        }
        None => format!("{}: none", of.label),
    }
}

fn varied(one: &OptimumValue) -> String {
    let [low, high] = one.bounds.map(six);
    // CSV and JSON have all digits.
    let value = format!("{} {}", rounded(one.value, 9), one.unit);
    let value = value.trim_end();
    match one.at_bound {
        Some(bound) => format!("{value}, the {bound} bound ({low} to {high})"),
        None => format!("{value} ({low} to {high})"),
    }
}

fn subject(one: &EvaluatedConstraint) -> String {
    let of = Quantity::of(&one.figure);
    let limit = format!("{} {} {}", one.sense, six(one.limit * of.factor), of.unit);
    let how = match (one.is_met, one.is_active) {
        (false, _) => ", missed",
        (true, true) => ", reached",
        (true, false) => "",
    };
    let figure = shown(&one.figure, one.value);
    format!("{figure} {}{how}", limit.trim_end())
}

fn proof(found: &Optimum) -> String {
    if found.interrupted {
        return "none: the search was interrupted".to_owned();
    }
    let (sweeps, of) = (&found.proof, Quantity::of(&found.figure));
    let widths = sweeps.half_widths.iter().map(|width| six(width * 100.0));
    let widths = widths.collect::<Vec<_>>().join(", ");
    let (each, improvements) = (sweeps.designs_each, sweeps.improvements);
    let boxes = format!("of {each} designs each within {widths} % of the ranges");
    let resolution = format!("{:.1e} {}", found.resolution * of.factor, of.unit);
    match sweeps.is_complete {
        true => format!("{boxes} none is better by {}", resolution.trim_end()),
        false => format!("none: {boxes} some are still better after {improvements} improvements"),
    }
}

/// Returns one CSV row per local search.
pub fn starts_csv(found: &Optimum) -> String {
    let columns = |prefix: &str| -> String {
        let values = found.values.iter();
        values
            .map(|one| format!("{prefix}{},", one.column))
            .collect()
    };
    let (starts, ends, figure) = (columns("start_"), columns(""), &found.figure);
    let header = format!("search,{starts}{ends}{figure},meets_subjects,agrees,designs");
    let rows = found.starts.iter().zip(1u32..).map(|(start, number)| {
        let [meets, agrees] =
            [start.meets_subjects, start.agrees].map(|is| f64::from(u8::from(is)));
        let values = start.from.iter().chain(&start.to).copied();
        let values = [f64::from(number)].into_iter().chain(values);
        let mut cells: Vec<CsvCell> = values.map(CsvCell::from).collect();
        cells.push(start.value.into());
        cells.extend([meets, agrees, start.designs as f64].map(CsvCell::from));
        cells
    });
    csv::text(&header, rows)
}
