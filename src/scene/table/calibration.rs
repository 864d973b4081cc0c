//! Calibrations of instruments from CSV files.

use std::path::Path;

use super::pairs::Pairs;
use crate::error::Error;
use crate::scene::csv::header;
use crate::scene::text;
use crate::scene::unit::Quantity;

/// Reads a calibration: loads with a unit of force in the first column, N, readings of any kind in the
/// second. The rows may stand in any order.
///
/// # Errors
/// [`Error::Read`] if the file cannot be read, [`Error::Refused`] with line and column for what is no
/// calibration.
pub fn calibration_points(file: &Path) -> Result<Vec<(f64, f64)>, Error> {
    let name = file.display().to_string();
    let wrong = |what: String| {
        Error::refused(
            what,
            "the file has two columns, as `load [N],reading`, and a row for each load",
        )
    };
    let text =
        text::decoded(text::bytes(file)?).map_err(|what| wrong(format!("{name}: {what}")))?;
    let pairs = Pairs::new(&name, &text);
    let [load, _] = pairs.header("load [N],reading").map_err(wrong)?;
    let unit = header::split(load).column(Quantity::Force);
    let unit = unit.map_err(|what| wrong(pairs.at(load, &what)))?;
    let points = pairs.numbers().map_err(wrong)?;
    Ok(points
        .iter()
        .map(|pair| (pair.x * unit.factor, pair.y))
        .collect())
}
