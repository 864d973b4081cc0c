//! Calibrations of instruments from CSV files.

use std::path::Path;

use super::header;
use super::pairs::Pairs;
use crate::error::Error;
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
    let mut pairs = Pairs::new(&name, &text).map_err(wrong)?;
    let place = pairs.place(pairs.end());
    let header = pairs.header();
    if header.len() != 2 || header.iter().any(|h| h.parse::<f64>().is_ok()) {
        return Err(wrong(format!(
            "{place}: the first line must name two columns"
        )));
    }
    let load = header::split(&header[0])
        .column(Quantity::Force)
        .map_err(|what| wrong(format!("{place}: {what}")))?;
    let mut points = Vec::new();
    while let Some((x, y)) = pairs.next().map_err(wrong)? {
        if !(x.is_finite() && y.is_finite()) {
            let place = pairs.place(pairs.end());
            return Err(wrong(format!("{place}: a value is not finite")));
        }
        points.push((x * load.factor, y));
    }
    Ok(points)
}
