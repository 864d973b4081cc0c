//! Reports of a parameter identification: text and CSV.

use super::csv;
use super::key_values::{Facts, digits, fact, rounded, six};
use crate::inverse::identify::Identification;
use crate::scene::Measured;

/// Returns the identified values with 95 % bands, strong correlations, noise and warnings, as text.
pub fn identification(result: &Identification) -> String {
    let mut facts = Facts::of(&result.scene);
    let (samples, column) = (result.samples, &result.column);
    fact!(facts, "data" => "{samples} samples of {column}");
    for one in &result.values {
        let (value, half) = (digits(one.value, one.half_band), rounded(one.half_band, 2));
        fact!(facts, &one.key => "{value} +- {half} {}", one.unit);
    }
    let factor = result.band_factor;
    fact!(facts, "95 % band" => "+- {factor:.4} standard errors");
    let is_strong = |correlation: f64| correlation.abs() > 0.9;
    for (i, row) in result.correlations.iter().enumerate() {
        for (j, value) in row.iter().enumerate().take(i) {
            if is_strong(*value) {
                let [one, other] = [j, i].map(|k| &result.values[k].key);
                fact!(facts, "correlation" => "{value:.4} of {one} and {other}");
            }
        }
    }
    let unit = Measured::named(&result.column).map_or("", Measured::unit);
    fact!(facts, "noise" => "{} {unit} of a sample", six(result.sigma));
    let missed = six(result.missing_torque_rms_nm);
    fact!(facts, "torque missed" => "{missed} N m, root mean square");
    facts.warnings(&result.warnings);
    facts.lines(22)
}

/// Returns one CSV row per identified value.
pub fn identification_csv(result: &Identification) -> String {
    let header = "key,unit,start,value,standard_error,half_band";
    let rows = result.values.iter().map(|one| csv::fields(header, one));
    csv::text(header, rows)
}
