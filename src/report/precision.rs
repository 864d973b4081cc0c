//! The comparison of methods: CSV, text and figure.

use std::fmt::Write;

use super::csv::{quoted, shortest};
use super::figure::{Axis, Figure, Shape, Sheet};
use super::key_values::{Facts, six};
use super::page::{Origin, Page, Scatter};
use super::table::Table;
use crate::error::Error;
use crate::precision::{Precision, PrecisionRow};
use crate::scene::printable;

const COLUMNS: [&str; 9] = [
    "scene",
    "method",
    "tolerance",
    "error_theta_rad",
    "error_omega_rad_per_s",
    "estimate_theta_rad",
    "wall_s",
    "evaluations",
    "steps",
];

/// The comparison of several scenes as CSV: one row for each method and tolerance, times the least; cells of
/// what does not exist are empty.
pub fn precision_csv(scenes: &[Precision]) -> Result<String, Error> {
    quoted(COLUMNS, cells(scenes))
}

fn cells(scenes: &[Precision]) -> impl Iterator<Item = Vec<String>> {
    let number = |value: Option<f64>| value.map_or(String::new(), shortest);
    let count = |value: Option<u64>| value.map_or(String::new(), |value| value.to_string());
    scenes.iter().flat_map(move |scene| {
        scene.rows.iter().map(move |row| {
            vec![
                printable(&scene.scene).into_owned(),
                row.method.clone(),
                shortest(row.tolerance),
                number(row.error_theta_rad),
                number(row.error_omega_rad_per_s),
                number(row.estimate_theta_rad),
                number(row.wall_s),
                count(row.evaluations),
                count(row.steps),
            ]
        })
    })
}

/// The comparison as one page: error against time, of one scene at a time.
///
/// # Errors
/// [`Error::Write`].
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
    let rows: Vec<Vec<String>> = cells(scenes).collect();
    let table = Table::of_cells(&COLUMNS.map(str::to_owned), &rows);
    Page::new(origin, &facts)
        .table(&table)
        .scatter(Scatter {
            x: "wall_s".to_owned(),
            y: "error_theta_rad".to_owned(),
            colour: String::new(),
            log: true,
            lines: true,
            kind: "method",
            within: "scene",
        })
        .html()
}

/// The comparison of one scene as a table.
pub fn precision(scene: &Precision) -> String {
    let mut text = String::new();
    let mut put = |line: std::fmt::Arguments<'_>| {
        let _ = writeln!(text, "{line}");
    };
    if !scene.scene.is_empty() {
        put(format_args!("scene      {}", scene.scene));
    }
    put(format_args!("end        t = {} s", six(scene.t_s)));
    put(format_args!("reference  {}", scene.reference));
    if let (Some(theta), Some(omega)) = (
        scene.reference_error_theta_rad,
        scene.reference_error_omega_rad_per_s,
    ) {
        let own = format!("{theta:.1e} rad, {omega:.1e} rad/s or less");
        put(format_args!("its error  {own}"));
    }
    put(format_args!(
        "\n{:<12} {:>9} {:>12} {:>14} {:>13} {:>10} {:>10} {:>11} {:>8}",
        "method",
        "tolerance",
        "error [rad]",
        "error [rad/s]",
        "stated [rad]",
        "least [us]",
        "median",
        "evaluations",
        "steps"
    ));
    for row in &scene.rows {
        put(format_args!("{}", line(row)));
    }
    for note in precision_notes(scene) {
        put(format_args!("note: {note}"));
    }
    text
}

fn line(row: &PrecisionRow) -> String {
    let name = format!("{:<12} {:>9}", row.method, format!("{:.0e}", row.tolerance));
    if row.failure.is_some() && row.error_theta_rad.is_none() {
        return format!("{name} {:>12}", "failed");
    }
    let bound = if row.error_is_bound { "<= " } else { "" };
    let error = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{bound}{v:.1e}"));
    let plain = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.1e}"));
    let micro = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{:.1}", 1e6 * v));
    let count = |value: Option<u64>| value.map_or("-".to_owned(), |v| v.to_string());
    format!(
        "{name} {:>12} {:>14} {:>13} {:>10} {:>10} {:>11} {:>8}",
        error(row.error_theta_rad),
        error(row.error_omega_rad_per_s),
        plain(row.estimate_theta_rad),
        micro(row.wall_s),
        micro(row.wall_median_s),
        count(row.evaluations),
        count(row.steps)
    )
}

/// What the reader of the rows has to know.
pub fn precision_notes(scene: &Precision) -> Vec<String> {
    let mut notes: Vec<String> = scene.left_out.clone();
    if scene.rows.iter().any(|row| row.error_is_bound) {
        notes.push(
            "<= is an upper bound: the reference is less than 100 times better than this row"
                .to_owned(),
        );
    }
    // Tolerances that share a note are named together.
    let mut said: Vec<(String, Vec<String>)> = Vec::new();
    for row in &scene.rows {
        // Where a run stopped, and with what numbers, differs from row to row; the JSON object has it.
        let reason = |why: &String| {
            let why = why.split(": stopped at").next().unwrap_or(why);
            why.split(", as the coefficient")
                .next()
                .unwrap_or(why)
                .to_owned()
        };
        let word = match row.error_theta_rad {
            None => "failed",
            Some(_) => "measured where the motion ends",
        };
        let failure = row
            .failure
            .iter()
            .map(|why| format!("{word}: {}", reason(why)));
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
    for row in &scene.rows {
        if let Some(error) = row.error_slider_x_m {
            let stated = row.estimate_slider_x_m.map_or(
                "none stated: beyond the horizon of what is reproducible".to_owned(),
                |stated| format!("{stated:.1e} m stated"),
            );
            notes.push(format!(
                "tolerance {:.0e}: error of the slider's position {error:.1e} m, {stated}",
                row.tolerance
            ));
        }
    }
    let say = |(text, tolerances): (String, Vec<String>)| {
        format!("{text} (tolerance {})", tolerances.join(", "))
    };
    notes.extend(said.into_iter().map(say));
    notes
}

/// Error of the crank angle against time, one panel for each scene with measured errors; a method has one colour in all.
///
/// # Errors
/// [`Error::Refused`] if there is no room for all scenes.
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
    let sheet = Sheet {
        title: "Speed against error",
        columns: 2,
        size,
    };
    sheet.svg(&figures)
}

/// Time and error of a row that has both.
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
