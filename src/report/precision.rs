//! Reports of the work-precision comparison of methods: CSV, text, page and figure.

use super::csv::{self, CsvCell};
use super::default_view::{DefaultView, Scatter};
use super::key_values::{Facts, fact, six, text_table};
use super::page::{self, Origin};
use super::table::Table;
use crate::error::Error;
use crate::figure::{Axis, Figure, Shape, sheet};
use crate::precision::{Precision, PrecisionRow};
use crate::scene::printable;

const COLUMNS: &str = "scene,method,tolerance,error_theta_rad,error_omega_rad_per_s,estimate_theta_rad,wall_s,evaluations,steps";

/// Returns the comparison of several scenes as CSV: one row per method and tolerance, with the shortest wall time;
/// missing values are empty cells.
pub fn precision_csv(scenes: &[Precision]) -> String {
    csv::text(COLUMNS, cells(scenes))
}

fn cells(scenes: &[Precision]) -> impl Iterator<Item = Vec<CsvCell>> {
    scenes.iter().flat_map(|scene| {
        scene.rows.iter().map(|row| {
            let mut cells = csv::fields(COLUMNS, row);
            cells[0] = CsvCell::from(&*printable(&scene.scene));
            cells
        })
    })
}

/// Returns the comparison as one page: error against time, one scene at a time.
pub fn precision_page(scenes: &[Precision], origin: &Origin) -> Result<String, Error> {
    let mut facts = Facts::of(match scenes {
        [only] => &only.scene,
        _ => "Speed against error",
    });
    for scene in scenes {
        let name = match scenes.len() {
            1 => "reference",
            _ => &scene.scene,
        };
        facts.add(name, &scene.reference);
        for note in precision_notes(scene) {
            facts.add("  note", note);
        }
    }
    let table = Table::of_rows(
        &COLUMNS.split(',').collect::<Vec<_>>(),
        &cells(scenes).collect::<Vec<_>>(),
    );
    let default = DefaultView {
        scatter: Some(Scatter {
            x: "wall_s".to_owned(),
            y: "error_theta_rad".to_owned(),
            log: true,
            lines: true,
            kind: "method",
            within: "scene",
            ..Scatter::default()
        }),
        ..DefaultView::default()
    };
    page::html(origin, &facts, &table, &default)
}

/// Returns the comparison of one scene as text.
pub fn precision(scene: &Precision) -> String {
    let mut facts = Facts::of(&scene.scene);
    fact!(facts, "end" => "t = {} s", six(scene.t_s));
    facts.add("reference", &scene.reference);
    if let (Some(theta), Some(omega)) = (
        scene.reference_error_theta_rad,
        scene.reference_error_omega_rad_per_s,
    ) {
        fact!(facts, "its error" => "{theta:.1e} rad, {omega:.1e} rad/s or less");
    }
    let header = "method,tolerance,error [rad],error [rad/s],stated [rad],least [us],median,evaluations,steps";
    let widths = [-12, 9, 12, 14, 13, 10, 10, 11, 8];
    let table = text_table(&widths, header, scene.rows.iter().map(shown));
    let notes = precision_notes(scene).into_iter();
    let notes = notes.map(|note| format!("note: {note}\n"));
    facts.lines(10) + "\n" + &table + &notes.collect::<String>()
}

/// Returns the cells of a row of the text; those of a failure end early.
fn shown(row: &PrecisionRow) -> Vec<String> {
    let mut cells = vec![row.method.clone(), format!("{:.0e}", row.tolerance)];
    if row.failure.is_some() && row.error_theta_rad.is_none() {
        cells.push("failed".to_owned());
        return cells;
    }
    let bound = if row.error_is_bound { "<= " } else { "" };
    let or_none = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
    let error = |value: Option<f64>, bound| or_none(value.map(|v| format!("{bound}{v:.1e}")));
    let micro = |value: Option<f64>| or_none(value.map(|v| format!("{:.1}", 1e6 * v)));
    let count = |value: Option<u64>| or_none(value.map(|v| v.to_string()));
    cells.extend([
        error(row.error_theta_rad, bound),
        error(row.error_omega_rad_per_s, bound),
        error(row.estimate_theta_rad, ""),
        micro(row.wall_s),
        micro(row.wall_median_s),
        count(row.evaluations),
        count(row.steps),
    ]);
    cells
}

/// Returns notes on the rows: methods left out, bounds, failures, other references.
pub fn precision_notes(scene: &Precision) -> Vec<String> {
    let mut notes: Vec<String> = scene.left_out.clone();
    if scene.rows.iter().any(|row| row.error_is_bound) {
        notes.push(
            "<= is an upper bound: the reference is less than 100 times better than this row"
                .to_owned(),
        );
    }
    // Notes with their tolerances: equal notes are merged.
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for row in &scene.rows {
        // Numbers that differ from row to row would prevent merging; the JSON object has them.
        let reason = |why: &String| {
            let why = why.split(": stopped at").next().unwrap_or(why);
            let why = why.split(", as the coefficient").next();
            why.unwrap_or_default().to_owned()
        };
        let word = match row.error_theta_rad {
            None => "failed",
            Some(_) => "measured where the motion ends",
        };
        let failure = row.failure.iter();
        let failure = failure.map(|why| format!("{word}: {}", reason(why)));
        let against = row.measured_against.iter();
        let against = against.map(|what| format!("measured against {what}"));
        for what in failure.chain(against) {
            let text = format!("{}: {what}", row.method);
            let tolerance = format!("{:.0e}", row.tolerance);
            match said.iter_mut().find(|(known, _)| *known == text) {
                Some((_, tolerances)) => tolerances.push(tolerance),
                None => said.push((text, vec![tolerance])),
            }
        }
    }
    let say = |(text, tolerances): (String, Vec<String>)| {
        format!("{text} (tolerance {})", tolerances.join(", "))
    };
    notes.extend(said.into_iter().map(say));
    notes
}

/// Returns angle error against wall time as SVG, one panel per scene with measured errors, one colour per method. Refused
/// if there is no room for all scenes.
pub fn precision_figure(scenes: &[Precision], size: Option<Shape>) -> Result<String, Error> {
    let mut methods: Vec<&str> = Vec::new();
    for row in scenes.iter().flat_map(|scene| &scene.rows) {
        if measured(row).is_some() && !methods.contains(&row.method.as_str()) {
            methods.push(&row.method);
        }
    }
    let any = |scene: &&Precision| scene.rows.iter().any(|row| measured(row).is_some());
    let told = scenes.iter().filter(any);
    let figures: Vec<_> = told.map(|scene| panel(scene, &methods)).collect();
    sheet("Speed against error", 2, size, &figures)
}

/// Returns wall time (s) and angle error (rad) of a row that has both.
fn measured(row: &PrecisionRow) -> Option<(f64, f64)> {
    row.wall_s.zip(row.error_theta_rad)
}

fn panel(scene: &Precision, methods: &[&str]) -> Figure {
    let figure = Figure::new(
        scene.scene.clone(),
        Axis::log("wall time, least of repeated runs [s]"),
        Axis::log("error of the crank angle at the end [rad]"),
    );
    methods.iter().fold(figure, |figure, method| {
        let rows = scene.rows.iter().filter(|row| row.method == *method);
        figure.line_with_points(*method, rows.filter_map(measured).collect())
    })
}
