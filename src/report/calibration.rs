//! A calibration in words.

use super::key_values::{Facts, fact, given, six, with_error};
use crate::statics::Calibration;

/// The line, its statistics, and the forces of the readings.
pub fn calibration(result: &Calibration) -> String {
    let mut facts = Facts::of("");
    let fit = &result.fit;
    let shown = |value: f64, se: Option<f64>| match se {
        Some(se) => with_error(value, se, ""),
        None => six(value),
    };
    facts.add("points", fit.points);
    let slope = shown(fit.slope, fit.slope_se);
    fact!(facts, "slope", "{slope} per N");
    facts.add("intercept", shown(fit.intercept, fit.intercept_se));
    if let Some(r_squared) = fit.r_squared {
        facts.add("R squared", given(r_squared));
    }
    for measured in &result.forces {
        let force = shown(measured.force_n, measured.force_se_n);
        let reading = given(measured.reading);
        fact!(facts, "force", "{force} N for a reading of {reading}");
    }
    facts.warnings(&result.warnings);
    facts.lines(12)
}
