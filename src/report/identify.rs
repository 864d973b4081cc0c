//! Reports of a parameter identification: text and CSV.

use super::Output;
use super::csv::{self, CsvCell};
use super::key_values::{Facts, digits, fact, rounded, six};
use crate::error::Error;
use crate::inverse::identify::Identification;

/// Size of correlation between two values above which the text names it.
const STRONG_CORRELATION: f64 = 0.9;

/// Returns the identified values with 95 % bands, strong correlations, noise and warnings, as text.
pub fn identification(result: &Identification) -> String {
    let mut facts = Facts::of(&result.scene);
    fact!(
        facts,
        "data",
        "{} samples of {}",
        result.samples,
        result.column
    );
    for one in &result.values {
        fact!(
            facts,
            &one.key,
            "{} +- {} {}",
            digits(one.value, one.half_band),
            rounded(one.half_band, 2),
            one.unit
        );
    }
    fact!(
        facts,
        "95 % band",
        "+- {:.4} standard errors",
        result.band_factor
    );
    for (i, row) in result.correlations.iter().enumerate() {
        for (j, value) in row.iter().enumerate().take(i) {
            if value.abs() > STRONG_CORRELATION {
                fact!(
                    facts,
                    "correlation",
                    "{value:.4} of {} and {}",
                    result.values[j].key,
                    result.values[i].key
                );
            }
        }
    }
    let unit = if result.column == "x" { "m" } else { "rad" };
    fact!(facts, "noise", "{} {unit} of a sample", six(result.sigma));
    fact!(
        facts,
        "torque missed",
        "{} N m, root mean square",
        six(result.missing_torque_rms_nm)
    );
    facts.warnings(&result.warnings);
    facts.lines(22)
}

/// Writes one CSV row per identified value.
pub fn identification_csv(result: &Identification, output: Output) -> Result<(), Error> {
    let header = [
        "key",
        "unit",
        "start",
        "value",
        "standard_error",
        "half_band",
    ];
    let rows = result.values.iter().map(|one| {
        let numbers = [one.start, one.value, one.standard_error, one.half_band].map(CsvCell::from);
        let words = [
            CsvCell::from(&*one.key),
            CsvCell::from(&*one.unit.to_string()),
        ];
        words.into_iter().chain(numbers).collect()
    });
    output.text(&csv::text(&header, rows))
}
