//! Text report of inverse dynamics: data, fit, force and torque ranges, error budget, and some rows.

use crate::inverse::{AsPrinted, DataSummary, DeadCentreBand, FitSummary, ForceRange, Inverse};
use crate::report::key_values::{Facts, fact, six, text_table};

/// Returns the facts and some rows, with the forces printed by Duarte et al. if given.
pub(super) fn text(result: &Inverse, printed: Option<&AsPrinted>) -> String {
    let text = facts(result).lines(22);
    let (screen_lines, most_rows) = (40usize, 16);
    let room = screen_lines.saturating_sub(text.lines().count() + 2);
    text + &table(result, printed, room.clamp(1, most_rows))
}

/// Returns the facts of an inverse.
pub(super) fn facts(result: &Inverse) -> Facts {
    let summary = &result.summary;
    let mut facts = Facts::of(&summary.scene);
    let data = &summary.data;
    fact!(facts, "data" => "{} samples of {} from {} to {} s, {:.4} turns",
        data.rows, data.column, data.from_s, data.to_s, data.revolutions);
    fit(&mut facts, &summary.fit, data);
    match &summary.slider_force {
        Some(force) => facts.add("slider force", range(force, "N")),
        None => facts.add("slider force", "not determined at any sample"),
    }
    facts.add("crank torque", range(&summary.crank_torque, "N m"));
    let factor = summary.band_factor;
    fact!(facts, "95 % band" => "+- {factor:.4} standard errors");
    let budget = summary.error_budget.iter().map(|part| {
        let percent = 100.0 * part.share;
        format!("{} {:.2e} N ({percent:.0} %)", part.source, part.force_se_n)
    });
    let budget: Vec<String> = budget.collect();
    if !budget.is_empty() {
        facts.add("error of force", budget.join(", "));
    }
    without_force(&mut facts, &summary.dead_centre_bands, data.rows);
    // These and the coefficients leave room for a table of six rows.
    let most_warnings = 6;
    let listed = summary.warnings.len().min(most_warnings);
    let (shown, more) = summary.warnings.split_at(listed);
    facts.warnings(shown);
    if !more.is_empty() {
        fact!(facts, "warning" => "{} more: --json has all", more.len());
    }
    facts
}

/// Adds the intervals without a force, one line per reason.
fn without_force(facts: &mut Facts, bands: &[DeadCentreBand], rows: usize) {
    let mut rest: Vec<&DeadCentreBand> = bands.iter().collect();
    while let Some(reason) = rest.first().map(|band| band.reason) {
        let (alike, others): (Vec<_>, Vec<_>) =
            rest.into_iter().partition(|band| band.reason == reason);
        let count: usize = alike.iter().map(|band| band.rows).sum();
        if let Some(longest) = alike.iter().max_by_key(|band| band.rows) {
            let (stretches, the) = match alike.len() {
                1 => ("1 stretch".to_owned(), ""),
                more => (format!("{more} stretches"), "the longest "),
            };
            let percent = 100.0 * count as f64 / rows as f64;
            let (from, to) = (longest.from_s, longest.to_s);
            let angles = [longest.from_theta_rad, longest.to_theta_rad];
            let [first, last] = angles.map(f64::to_degrees);
            fact!(facts, "no slider force" => "{stretches}, {percent:.1} % of the rows, \
                {the}from t = {from} to {to} s, theta = {first:.2} to {last:.2} deg: {reason}");
        }
        rest = others;
    }
}

fn fit(facts: &mut Facts, fit: &FitSummary, data: &DataSummary) {
    let unit = data.unit;
    let (kind, reason) = (fit.kind, &fit.reason);
    match kind {
        "polynomial" => fact!(facts, "fit" => "{kind}, degree {}: {reason}", fit.degree),
        _ => fact!(facts, "fit" => "{kind}, {}: {reason}; worth {:.1} parameters",
            fit.prior, fit.parameters),
    }
    let errors = fit.standard_errors.iter();
    let coefficients = fit.coefficients.iter().zip(errors).enumerate();
    let most_coefficients = 13;
    for (power, (c, e)) in coefficients.take(most_coefficients) {
        let value = match (c, e) {
            (Some(c), Some(e)) => format!("{c:.15e} +- {e:.2e}"),
            _ => "no digits in plain time".to_owned(),
        };
        facts.add(format_args!("  coefficient {power}"), value);
    }
    let more = fit.coefficients.len().saturating_sub(most_coefficients);
    if more > 0 {
        fact!(facts, "  coefficients" => "{more} more: --json has all");
    }
    fact!(facts, "  R^2" => "{:.9}", fit.r_squared);
    fact!(facts, "  residuals" => "rms {:.6e} {unit}, noise {:.4e} +- {:.1e} {unit}",
        fit.rms, fit.sigma, fit.sigma_error);
    if let Some(condition) = fit.condition {
        fact!(facts, "  condition" => "{condition:.3e}");
    }
    if let [first, more @ ..] = &fit.intensities[..] {
        let [from, to, factor] = [first.from_s, first.to_s, first.factor].map(six);
        let more = match more.len() {
            0 => String::new(),
            more => format!(", and {more} more stretches with others"),
        };
        fact!(facts, "  intensity" =>
            "of the noise of the process from {from} to {to} s {factor} times the usual{more}");
    }
    if let Some(time) = fit.noise_correlation_s {
        fact!(facts, "  noise" => "correlated over {time:.3e} s");
    }
}

/// Returns the least and largest value with standard errors and times, and the median standard error.
fn range(range: &ForceRange, unit: &str) -> String {
    let [least, most] = [(range.min, range.min_se), (range.max, range.max_se)]
        .map(|(value, se)| format!("{value:.6} +- {se:.1e} {unit}"));
    format!(
        "{least} at {} s to {most} at {} s, median error {:.1e}",
        range.min_t_s, range.max_t_s, range.median_se
    )
}

fn table(result: &Inverse, printed: Option<&AsPrinted>, rows: usize) -> String {
    let mut header = "t [s],theta [deg],omega [rad/s],alpha [1/s2],force [N],std error [N],torque [N m],std error".to_owned();
    if printed.is_some() {
        header += ",spin-only [N],their (9) [N]";
    }
    let or_none = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
    let cell = |value: Option<f64>, places| or_none(value.map(|v| format!("{v:.places$}")));
    let error = |value: Option<f64>| or_none(value.map(|v| format!("{v:.2e}")));
    let stride = result.rows.len().div_ceil(rows);
    let rows = result.rows.iter().step_by(stride).map(|row| {
        let mut cells = vec![
            format!("{:.6}", row.t),
            format!("{:.4}", row.theta.to_degrees()),
            format!("{:.6}", row.omega),
            format!("{:.6}", row.alpha),
            cell(row.slider_force, 5),
            error(row.slider_force_se),
            cell(row.crank_torque, 6),
            error(row.crank_torque_se),
        ];
        if let Some(printed) = printed {
            let forces = printed.forces(row);
            cells.extend([0, 1].map(|which| cell(forces.map(|f| f[which]), 5)));
        }
        cells
    });
    let widths = [12, 12, 13, 13, 13, 13, 13, 10, 13, 13];
    "\n".to_owned() + &text_table(&widths, &header, rows)
}
