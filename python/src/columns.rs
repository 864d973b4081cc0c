//! Columns of rows as NumPy arrays, which take the memory of the columns over.

use std::collections::HashMap;

use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::report::{Cells, Table};

/// Arrays by the names of the columns; where they hold words, a list of these and the place of each row's in it.
pub fn arrays(py: Python<'_>, table: Table) -> PyResult<Bound<'_, PyDict>> {
    let arrays = PyDict::new(py);
    for (name, cells) in table.into_columns() {
        match cells {
            Cells::Numbers(values) => arrays.set_item(name, PyArray1::from_vec(py, values))?,
            Cells::Words(words) => {
                let (list, places) = told_apart(&words);
                arrays.set_item(name, (list, PyArray1::from_vec(py, places)))?;
            }
        }
    }
    Ok(arrays)
}

/// The different words, and which of them stands in each row.
fn told_apart(words: &[String]) -> (Vec<&str>, Vec<i64>) {
    let (mut list, mut known) = (Vec::new(), HashMap::new());
    let mut place = |word| {
        *known.entry(word).or_insert_with(|| {
            list.push(word);
            list.len() as i64 - 1
        })
    };
    let places = words.iter().map(|word| place(word.as_str())).collect();
    (list, places)
}
