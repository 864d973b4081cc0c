//! A calibration in words.

use super::facts::Facts;
use crate::study::Calibration;

/// The line, its statistics, and the forces of the readings.
pub fn calibration(result: &Calibration) -> String {
    let mut facts = Facts::of("");
    let fit = &result.fit;
    let error = |se: Option<f64>| se.map_or(String::new(), |se| format!(" +- {se}"));
    facts.add("points", fit.points);
    let (slope, slope_error) = (fit.slope, error(fit.slope_se));
    facts.add("slope", format_args!("{slope}{slope_error} per N"));
    let intercept_error = error(fit.intercept_se);
    facts.add(
        "intercept",
        format_args!("{}{intercept_error}", fit.intercept),
    );
    if let Some(r_squared) = fit.r_squared {
        facts.add("R squared", r_squared);
    }
    for measured in &result.forces {
        let (force, error) = (measured.force_n, error(measured.force_se_n));
        facts.add(
            "force",
            format_args!("{force}{error} N for a reading of {}", measured.reading),
        );
    }
    facts.warnings(&result.warnings);
    facts.lines(12)
}
