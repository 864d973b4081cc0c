//! The summary of `inverse` as text.

use std::fmt::Write;

use crate::inverse::{AsPrinted, FitSummary, ForceRange, Inverse};
use crate::report::facts::Facts;

/// Rows of the table.
const ROWS: usize = 16;

/// Most times without a force that are listed.
const MOST_BANDS: usize = 24;

/// Summary and some rows, with the forces as Duarte et al. print them if given.
pub fn inverse(result: &Inverse, printed: Option<&AsPrinted>) -> String {
    let summary = &result.summary;
    let mut facts = Facts::of(&summary.scene);
    let data = &summary.data;
    facts.add(
        "data",
        format_args!(
            "{} samples of {} from {} to {} s, {:.4} turns",
            data.rows, data.column, data.from_s, data.to_s, data.revolutions
        ),
    );
    fit(&mut facts, &summary.fit, data.unit);
    match &summary.slider_force {
        Some(force) => facts.add("slider force", range(force, "N")),
        None => facts.add("slider force", "not determined at any sample"),
    }
    facts.add("crank torque", range(&summary.crank_torque, "N m"));
    facts.add(
        "95 % band",
        format_args!("+- {:.4} standard errors", summary.band_factor),
    );
    for band in summary.dead_centre_bands.iter().take(MOST_BANDS) {
        facts.add(
            "no slider force",
            format_args!(
                "t = {} to {} s, theta = {:.4} to {:.4} deg, {} row{}: {}",
                band.from_s,
                band.to_s,
                band.from_theta_rad.to_degrees(),
                band.to_theta_rad.to_degrees(),
                band.rows,
                if band.rows == 1 { "" } else { "s" },
                band.reason
            ),
        );
    }
    let more = summary.dead_centre_bands.len().saturating_sub(MOST_BANDS);
    if more > 0 {
        facts.add(
            "no slider force",
            format_args!("{more} more times; --json and near_dead_centre of the rows have all"),
        );
    }
    facts.warnings(&summary.warnings);
    let mut text = facts.lines(22);
    table(&mut text, result, printed);
    text
}

fn fit(facts: &mut Facts, fit: &FitSummary, unit: &str) {
    let (kind, degree, parameters) = (fit.kind, fit.degree, fit.parameters);
    match fit.kind {
        "polynomial" => facts.add(
            "fit",
            format_args!("{kind}, degree {degree}, {parameters:.4} parameters"),
        ),
        _ => facts.add(
            "fit",
            format_args!("{kind}, {}, worth {parameters:.4} parameters", fit.prior),
        ),
    }
    let errors = fit.standard_errors.iter();
    for (power, (c, e)) in fit.coefficients.iter().zip(errors).enumerate() {
        let value = match (c, e) {
            (Some(c), Some(e)) => format!("{c:.15e} +- {e:.2e}"),
            _ => "no digits in plain time".to_owned(),
        };
        facts.add(format_args!("  coefficient {power}"), value);
    }
    facts.add("  R^2", format_args!("{:.9}", fit.r_squared));
    facts.add("  residual rms", format_args!("{:.6e} {unit}", fit.rms));
    if let Some(condition) = fit.condition {
        facts.add("  condition", format_args!("{condition:.3e}"));
    }
}

fn range(range: &ForceRange, unit: &str) -> String {
    format!(
        "{:.6} {unit} at {} s to {:.6} {unit} at {} s, median standard error {:.2e} {unit}",
        range.min, range.min_t_s, range.max, range.max_t_s, range.median_se
    )
}

fn table(text: &mut String, result: &Inverse, printed: Option<&AsPrinted>) {
    let _ = write!(
        text,
        "\n{:>12} {:>12} {:>13} {:>13} {:>13} {:>13} {:>13}",
        "t [s]",
        "theta [deg]",
        "omega [rad/s]",
        "alpha [1/s2]",
        "force [N]",
        "std error [N]",
        "torque [N m]"
    );
    if printed.is_some() {
        let _ = write!(text, " {:>13} {:>13}", "spin-only [N]", "their (9) [N]");
    }
    text.push('\n');
    let stride = result.rows.len().div_ceil(ROWS);
    let cell = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.5}"));
    let error = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.2e}"));
    for row in result.rows.iter().step_by(stride) {
        let _ = write!(
            text,
            "{:>12.6} {:>12.4} {:>13.6} {:>13.6} {:>13} {:>13} {:>13}",
            row.t,
            row.theta.to_degrees(),
            row.omega,
            row.alpha,
            cell(row.slider_force),
            error(row.slider_force_se),
            row.crank_torque
                .map_or_else(|| "-".to_owned(), |torque| format!("{torque:.6}"))
        );
        if let Some(printed) = printed {
            let forces = printed.forces(row);
            for which in 0..2 {
                let _ = write!(text, " {:>13}", cell(forces.map(|f| f[which])));
            }
        }
        text.push('\n');
    }
}
