//! Reports of an optimisation: best design as text, local searches as CSV.

use super::csv::{self, CsvCell};
use super::key_values::{Facts, fact, rounded, six};
use super::quantity::Quantity;
use crate::optimise::{AGREEMENT, EvaluatedConstraint, FinalSweeps, Optimum, OptimumValue};

/// Returns the best design, its limits, agreement of the searches and final sweeps, as text.
pub fn optimum(found: &Optimum) -> String {
    let mut facts = Facts::of(&found.scene);
    let value = shown(&found.figure, found.value);
    fact!(facts, found.sense, "{value}");
    for one in &found.values {
        facts.add(&one.key, varied(one));
    }
    for one in &found.subjects {
        facts.add("subject", subject(one));
    }
    let agreeing = found.starts.iter().filter(|start| start.agrees).count();
    fact!(
        facts,
        "local searches",
        "{agreeing} of {} end there, to {AGREEMENT:.0e} of the figure's spread",
        found.starts.len()
    );
    facts.add("proof", proof(found));
    fact!(facts, "cost", "{} designs", found.designs);
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
    format!(
        "{} {}{how}",
        shown(&one.figure, one.value),
        limit.trim_end()
    )
}

fn proof(found: &Optimum) -> String {
    let FinalSweeps {
        is_complete,
        half_widths,
        designs_each,
        improvements,
    } = &found.proof;
    if found.interrupted {
        return "none: the search was interrupted".to_owned();
    }
    let widths = half_widths.iter().map(|width| six(width * 100.0));
    let widths = widths.collect::<Vec<_>>().join(", ");
    let sweeps = format!("of {designs_each} designs each within {widths} % of the ranges");
    let resolution = Quantity::of(&found.figure);
    let resolution = format!(
        "{:.1e} {}",
        found.resolution * resolution.factor,
        resolution.unit
    );
    match is_complete {
        true => format!("{sweeps} none is better by {}", resolution.trim_end()),
        false => format!("none: {sweeps} some are still better after {improvements} improvements"),
    }
}

/// Returns one CSV row per local search.
pub fn starts_csv(found: &Optimum) -> String {
    let of = |prefix: &'static str| {
        let values = found.values.iter();
        values.map(move |one| format!("{prefix}{}", one.column))
    };
    let last = [&found.figure, "meets_subjects", "agrees", "designs"].map(str::to_owned);
    let header = ["search".to_owned()].into_iter().chain(of("start_"));
    let header: Vec<String> = header.chain(of("")).chain(last).collect();
    let rows = found.starts.iter().zip(1u32..).map(|(start, number)| {
        let [meets, agrees] = [start.meets_subjects, start.agrees].map(u8::from);
        let values = start.from.iter().chain(&start.to);
        let mut cells = vec![CsvCell::from(f64::from(number))];
        cells.extend(values.map(|value| CsvCell::from(*value)));
        cells.push(start.value.into());
        cells.extend([meets, agrees].map(|flag| CsvCell::from(f64::from(flag))));
        cells.push(CsvCell::from(start.designs as f64));
        cells
    });
    let header: Vec<&str> = header.iter().map(String::as_str).collect();
    csv::text(&header, rows)
}
