//! Columns of rows as NumPy arrays, which take the memory of the columns over.

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::report::{Cells, Table};

/// Arrays by the names of the columns; lists where they hold words.
pub fn arrays(py: Python<'_>, table: Table) -> PyResult<Bound<'_, PyDict>> {
    let arrays = PyDict::new(py);
    for (name, cells) in table.into_columns() {
        match cells {
            Cells::Numbers(values, _) => arrays.set_item(name, PyArray1::from_vec(py, values))?,
            Cells::Words(words) => arrays.set_item(name, words)?,
        }
    }
    Ok(arrays)
}
