//! Results on paper: CSV rows, text, figures, JSON. Knows neither mechanics nor integrators.

mod explain;
mod figure;
mod inverse;
mod output;
mod rows;
mod text;

pub use explain::explanation;
pub use figure::{Axis, Figure, ScaleKind, panels};
pub use inverse::{inverse, inverse_figure, inverse_rows, residuals};
pub use output::Output;
pub use rows::{KinematicsWriter, Preview, RowWriter};
pub use text::{kinematics, summary};

use crate::error::Error;

/// A value as one JSON object, with a line break at its end.
///
/// # Errors
/// [`Error::Write`] if it cannot be made.
pub fn json(value: &impl serde::Serialize) -> Result<String, Error> {
    let mut text = serde_json::to_string_pretty(value).map_err(|error| Error::Write {
        target: "JSON".to_owned(),
        source: error.into(),
    })?;
    text.push('\n');
    Ok(text)
}
