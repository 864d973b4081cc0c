//! Forward motion and its steady state.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::error::Error;
use slider_crank::report::{self, PlotRows, Report, RunReport, Table, View};
use slider_crank::scene::Scene as Plain;
use slider_crank::simulate::{
    Options, Row, RowSink, Simulation, simulate_rows, simulate_with_rows,
};

use crate::call::{self, Call};
use crate::columns::arrays;
use crate::errors::{raised, refused};
use crate::scene::{Scene, method_of};

/// A finished run.
#[pyclass(frozen)]
pub struct Run {
    run: Simulation,
    scene: Py<Scene>,
    /// What was asked for.
    options: Options,
    tolerance: Option<f64>,
    steady: bool,
}

/// A run: its columns, its summary as JSON, and its motion.
#[pyfunction]
#[pyo3(signature = (scene, method, tolerance, reactions, driving_torque, estimate, steady, limits))]
#[allow(
    clippy::too_many_arguments,
    reason = "the keywords of one function of Python"
)]
pub fn simulate<'py>(
    py: Python<'py>,
    scene: Py<Scene>,
    method: &str,
    tolerance: Option<f64>,
    reactions: bool,
    driving_torque: bool,
    estimate: bool,
    steady: bool,
    limits: (Option<u64>, Option<usize>),
) -> PyResult<(Bound<'py, PyDict>, String, Run)> {
    let default = Options::default();
    let options = Options {
        method: method_of(method)?,
        reactions,
        driving_torque,
        estimate,
        max_evaluations: limits.0.unwrap_or(default.max_evaluations),
        events_kept: limits.1.unwrap_or(default.events_kept),
        stop: None,
    };
    let asked = scene.get();
    let (run, rows, summary) = call::run(py, |call| {
        let (scene, found) = begun(asked, call, tolerance, steady, &options)?;
        let mut rows: Option<Table> = None;
        let mut run = simulate_with_rows(&scene, &with_stop(&options, call), &mut rows)?;
        run.summary.steady_state = found;
        let summary = report::json(&run.summary)?;
        Ok((run, rows, summary))
    })?;
    let columns = match rows {
        Some(table) => arrays(py, table)?,
        None => PyDict::new(py),
    };
    let run = Run {
        run,
        scene,
        options,
        tolerance,
        steady,
    };
    Ok((columns, summary, run))
}

/// The scene that is run, with another tolerance if one is asked for, and its steady state.
fn begun(
    asked: &Scene,
    call: &Call,
    tolerance: Option<f64>,
    steady: bool,
    options: &Options,
) -> Result<(Plain, Option<slider_crank::simulate::SteadyState>), Error> {
    let mut scene = asked.scene(call);
    if let Some(tolerance) = tolerance {
        // It has no place in the text.
        Plain::new(1.0, 2.0).tolerance(tolerance).check()?;
        scene.run.tolerance = tolerance;
    }
    if !steady {
        return Ok((scene, None));
    }
    let options = with_stop(options, call);
    let found = slider_crank::simulate::steady_state(&scene, None, &options)?;
    Ok((found.start(&scene), Some(found)))
}

fn with_stop(options: &Options, call: &Call) -> Options {
    Options {
        stop: Some(call.stop.clone()),
        ..options.clone()
    }
}

#[pymethods]
impl Run {
    /// Crank angle and speed at times inside the run; not a number outside.
    #[allow(clippy::type_complexity, reason = "two arrays")]
    fn at<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
    ) -> (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>) {
        let states = t
            .as_array()
            .iter()
            .map(|t| self.run.at(*t))
            .collect::<Vec<_>>();
        let state = |state: &Option<(f64, f64)>| state.unwrap_or((f64::NAN, f64::NAN));
        let (theta, omega): (Vec<f64>, Vec<f64>) = states.iter().map(state).unzip();
        (PyArray1::from_vec(py, theta), PyArray1::from_vec(py, omega))
    }

    /// Whole rows at times inside the run.
    fn rows_at<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let mut rows: Option<Table> = None;
        for t in t.as_array() {
            let row = self.run.row(*t).ok_or_else(|| {
                let last = self.run.summary.last.t_s;
                refused(
                    format!("there is no row at t = {t} s: the run goes from 0 to {last} s"),
                    "ask for times inside the run; of a loose joint there are the rows of the run alone",
                )
            })?;
            rows.row(&row).map_err(raised)?;
        }
        match rows {
            Some(table) => arrays(py, table),
            None => Ok(PyDict::new(py)),
        }
    }

    /// The report page; its rows are computed once more.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let asked = self.scene.get();
        call::run(py, |call| {
            let (scene, found) = begun(asked, call, self.tolerance, self.steady, &self.options)?;
            let options = Options {
                estimate: false,
                ..with_stop(&self.options, call)
            };
            let mut rows = OnPage {
                rows: PlotRows::new(View::default()),
                is_loose: scene.clearance.is_some(),
            };
            simulate_rows(&scene, &options, &mut rows)?;
            let mut summary = self.run.summary.clone();
            summary.steady_state = found;
            let report = RunReport {
                summary: &summary,
                scene: &scene,
                plot: &rows.rows,
                preview: &[],
            };
            report.page(&asked.origin("simulate"))
        })
    }
}

/// Rows for a page.
struct OnPage {
    rows: PlotRows,
    is_loose: bool,
}

impl RowSink for OnPage {
    fn row(&mut self, row: &Row) -> Result<(), Error> {
        self.rows.take(row)
    }

    fn wants_steps(&self) -> bool {
        self.is_loose
    }

    fn step(&mut self, row: &Row) -> Result<(), Error> {
        self.rows.take(row)
    }
}

/// The periodic steady state as JSON.
#[pyfunction]
#[pyo3(signature = (scene, fluctuation, max_evaluations))]
pub fn steady_state(
    py: Python<'_>,
    scene: Py<Scene>,
    fluctuation: Option<f64>,
    max_evaluations: Option<u64>,
) -> PyResult<String> {
    let default = Options::default();
    let asked = scene.get();
    call::run(py, |call| {
        let options = Options {
            max_evaluations: max_evaluations.unwrap_or(default.max_evaluations),
            stop: Some(call.stop.clone()),
            ..default
        };
        let scene = asked.scene(call);
        let found = slider_crank::simulate::steady_state(&scene, fluctuation, &options)?;
        report::json(&found)
    })
}
