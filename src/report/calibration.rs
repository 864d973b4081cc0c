//! A calibration in words.

use std::fmt::Write;

use crate::study::Calibration;

/// The line, its statistics, and the forces of the readings.
pub fn calibration(result: &Calibration) -> String {
    let mut text = String::new();
    let mut put = |name: &str, value: String| {
        let _ = writeln!(text, "{name:<12} {value}");
    };
    let fit = &result.fit;
    let error = |se: Option<f64>| se.map_or(String::new(), |se| format!(" +- {se}"));
    put("points", format!("{}", fit.points));
    put(
        "slope",
        format!("{}{} per N", fit.slope, error(fit.slope_se)),
    );
    put(
        "intercept",
        format!("{}{}", fit.intercept, error(fit.intercept_se)),
    );
    if let Some(r_squared) = fit.r_squared {
        put("R squared", format!("{r_squared}"));
    }
    for measured in &result.forces {
        let force = format!("{}{} N", measured.force_n, error(measured.force_se_n));
        put(
            "force",
            format!("{force} for a reading of {}", measured.reading),
        );
    }
    for warning in &result.warnings {
        put("warning", warning.clone());
    }
    text
}
