//! Measured motion: the force behind it, and values of the scene from it.

use std::path::PathBuf;

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::inverse::identify::{FreeKey, identify_keys};
use slider_crank::inverse::{FitKind, Inverse, InverseOptions, inverse_of_uncertain};
use slider_crank::report::{self, InverseReport, Report};
use slider_crank::scene::unit::Quantity;
use slider_crank::scene::{Beside, Measured, Measurement as Samples, Reading};

use crate::call::{self, Call};
use crate::columns::arrays;
use crate::errors::{Refused, of_scene, raised, refused};
use crate::load::with_loads;
use crate::scene::{Scene, quantity};

/// A record of a motion.
#[pyclass(frozen)]
pub struct Measurement {
    samples: Samples,
}

fn copied(array: &PyReadonlyArray1<'_, f64>) -> Vec<f64> {
    array.as_array().to_vec()
}

fn measured(name: &str) -> PyResult<Measured> {
    name.parse::<Measured>().map_err(Refused::new_err)
}

#[pymethods]
impl Measurement {
    /// Of samples: times (s), and columns by name, SI: sensors, and torques and forces that are known.
    #[new]
    fn new(
        t: PyReadonlyArray1<'_, f64>,
        columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
    ) -> PyResult<Measurement> {
        let mut columns = columns.into_iter();
        let Some((name, values)) = columns.next() else {
            return Err(refused(
                "no motion is given",
                "give theta, gamma, x or omega",
            ));
        };
        let samples = Samples::new(measured(&name)?, copied(&t), copied(&values));
        let mut samples = samples.map_err(|problems| of_scene(&problems))?;
        for (name, values) in columns {
            let beside = match name.as_str() {
                "torque" => Beside::Torque,
                "force" => Beside::Force,
                sensor => Beside::Sensor(measured(sensor)?),
            };
            let with = samples.with(beside, copied(&values));
            samples = with.map_err(|problems| of_scene(&problems))?;
        }
        Ok(Measurement { samples })
    }

    /// Of a CSV file.
    #[staticmethod]
    #[pyo3(signature = (file, column, columns, time, motion, known, counts_per_turn, x_zero, skip, decimal_comma, missing))]
    #[allow(
        clippy::too_many_arguments,
        reason = "the keywords of one function of Python"
    )]
    fn load(
        file: PathBuf,
        column: Option<&str>,
        columns: Option<String>,
        time: Option<String>,
        motion: Option<String>,
        known: Vec<String>,
        counts_per_turn: Option<u32>,
        x_zero: Option<&str>,
        skip: usize,
        decimal_comma: bool,
        missing: Vec<String>,
    ) -> PyResult<Measurement> {
        let zero = x_zero.map(|text| quantity(text, Quantity::Length));
        let reading = Reading {
            columns,
            column: column.map(measured).transpose()?,
            time,
            motion,
            known,
            counts_per_turn,
            x_zero: zero.transpose()?.unwrap_or(0.0),
            skip,
            decimal_comma,
            missing,
        };
        let samples = Samples::load(file, &reading).map_err(raised)?;
        Ok(Measurement { samples })
    }

    #[getter]
    fn measured(&self) -> &'static str {
        self.samples.measured().name()
    }

    #[getter]
    fn t<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.samples.times())
    }

    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.samples.values())
    }

    #[getter]
    fn notes(&self) -> Vec<String> {
        self.samples.notes().to_vec()
    }
}

/// Force and torque behind a motion.
#[pyclass(frozen)]
pub struct Recovered {
    found: Inverse,
    scene: Py<Scene>,
}

/// Force and torque behind a motion: columns, residuals, summary as JSON, and what makes the page.
#[pyfunction]
#[pyo3(signature = (scene, measurement, fit, degree, reactions, beside_forces))]
pub fn inverse<'py>(
    py: Python<'py>,
    scene: Py<Scene>,
    measurement: Py<Measurement>,
    fit: &str,
    degree: Option<usize>,
    reactions: bool,
    beside_forces: bool,
) -> PyResult<(Bound<'py, PyDict>, Bound<'py, PyDict>, String, Recovered)> {
    let fit = FitKind::named(fit).ok_or_else(|| {
        refused(
            "there is no such fit",
            "the fit is \"auto\", \"polynomial\" or \"smoother\"",
        )
    })?;
    let default = InverseOptions::default();
    let options = InverseOptions {
        fit,
        degree,
        reactions,
        beside_forces,
        ..default
    };
    let (asked, samples) = (scene.get(), &measurement.get().samples);
    let (found, rows, residuals, summary) = call::run(py, |call| {
        let uncertain = asked.draft.uncertain()?;
        let options = InverseOptions {
            stop: Some(call.stop.clone()),
            ..options
        };
        let found = inverse_of_uncertain(&asked.scene(call), &uncertain, samples, &options)
            .map_err(|error| error.with_notes(samples.notes()))?;
        let rows = report::inverse_table(&found);
        let residuals = report::residual_table(&found);
        let summary = report::json(&found.summary)?;
        Ok((found, rows, residuals, summary))
    })?;
    let recovered = Recovered { found, scene };
    Ok((
        arrays(py, rows)?,
        arrays(py, residuals)?,
        summary,
        recovered,
    ))
}

#[pymethods]
impl Recovered {
    /// The report page.
    fn page(&self) -> PyResult<String> {
        let asked = self.scene.get();
        let report = InverseReport {
            result: &self.found,
            scene: &asked.scene(&Call::default()),
            printed: None,
        };
        report.page(&asked.origin("inverse")).map_err(raised)
    }
}

/// Values of a scene from a motion, as JSON.
#[pyfunction]
pub fn identify(
    py: Python<'_>,
    scene: Py<Scene>,
    measurement: Py<Measurement>,
    free: Vec<String>,
) -> PyResult<String> {
    let keys = free.iter().map(|key| key.parse::<FreeKey>());
    let keys = keys.collect::<Result<Vec<_>, _>>();
    let keys = keys.map_err(|error| Refused::new_err(error.to_string()))?;
    let (asked, samples) = (scene.get(), &measurement.get().samples);
    call::run(py, |call| {
        let complete = |scene| with_loads(scene, &asked.loads, call);
        let found = identify_keys(&asked.draft, &complete, &keys, samples, Some(&call.stop))?;
        report::json(&found)
    })
}
