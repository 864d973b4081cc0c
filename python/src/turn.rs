//! One turn of the crank: kinematics and statics.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::kinematics::{Length, MOST_ROWS_OF_TURN, OneTurn, TurnOptions, one_turn};
use slider_crank::report::{self, Report, StaticsReport, TurnReport};
use slider_crank::scene::unit::Quantity;
use slider_crank::statics::{StaticAnalysis, StaticsOptions};

use crate::call::{self, Call};
use crate::columns::arrays;
use crate::errors::{raised, refused};
use crate::scene::{Scene, quantity};

/// One turn in closed form.
#[pyclass(frozen)]
pub struct Turn {
    turn: OneTurn,
    scene: Py<Scene>,
    every: f64,
}

fn spacing(text: &str) -> PyResult<f64> {
    let every = quantity(text, Quantity::Angle)?;
    match every > 0.0 && std::f64::consts::TAU / every <= MOST_ROWS_OF_TURN {
        true => Ok(every),
        false => Err(refused(
            format!("rows cannot be {text} apart"),
            "give an angle like \"1 deg\"",
        )),
    }
}

/// One turn: its columns, its summary as JSON, and what makes its page.
#[pyfunction]
#[pyo3(signature = (scene, every, forces, sensitivity, change))]
pub fn kinematics<'py>(
    py: Python<'py>,
    scene: Py<Scene>,
    every: &str,
    forces: bool,
    sensitivity: bool,
    change: Vec<(String, String)>,
) -> PyResult<(Bound<'py, PyDict>, String, Turn)> {
    let every = spacing(every)?;
    let change = change.iter().map(|(name, text)| {
        let length = Length::named(name);
        let length = length.ok_or_else(|| {
            refused(
                format!("`{name}` is no length"),
                "the lengths are crank, rod and offset",
            )
        })?;
        Ok((length, quantity(text, Quantity::Length)?))
    });
    let options = TurnOptions {
        forces,
        balance: Some(0.5),
        sensitivity,
        change: change.collect::<PyResult<_>>()?,
    };
    let asked = scene.get();
    let (turn, table, summary) = call::run(py, |call| {
        let scene = asked.scene(call);
        let turn = one_turn(&scene, &options)?;
        let table = turn_report(&turn, &scene, every).table();
        let summary = report::json(&turn)?;
        Ok((turn, table, summary))
    })?;
    Ok((arrays(py, table)?, summary, Turn { turn, scene, every }))
}

fn turn_report<'a>(
    result: &'a OneTurn,
    scene: &'a slider_crank::scene::Scene,
    every: f64,
) -> TurnReport<'a> {
    TurnReport {
        result,
        scene,
        every,
        diagram: None,
    }
}

fn statics_report<'a>(
    result: &'a StaticAnalysis,
    scene: &'a slider_crank::scene::Scene,
    every: f64,
) -> StaticsReport<'a> {
    StaticsReport {
        result,
        scene,
        every,
        details: true,
    }
}

#[pymethods]
impl Turn {
    /// The report page.
    fn page(&self) -> PyResult<String> {
        let asked = self.scene.get();
        let scene = asked.scene(&Call::default());
        let report = turn_report(&self.turn, &scene, self.every);
        report.page(&asked.origin("kinematics")).map_err(raised)
    }
}

/// Static equilibrium over a turn.
#[pyclass(frozen)]
pub struct Balanced {
    analysis: StaticAnalysis,
    scene: Py<Scene>,
    every: f64,
}

/// Static equilibrium: its columns, its summary as JSON, and what makes its page.
#[pyfunction]
#[pyo3(signature = (scene, every, torque, force, friction))]
pub fn statics<'py>(
    py: Python<'py>,
    scene: Py<Scene>,
    every: &str,
    torque: Option<&str>,
    force: Option<&str>,
    friction: Option<f64>,
) -> PyResult<(Bound<'py, PyDict>, String, Balanced)> {
    let every = spacing(every)?;
    let options = StaticsOptions {
        torque: torque
            .map(|text| quantity(text, Quantity::Torque))
            .transpose()?,
        force: force
            .map(|text| quantity(text, Quantity::Force))
            .transpose()?,
        friction,
    };
    let asked = scene.get();
    let (analysis, table, summary) = call::run(py, |call| {
        let scene = asked.scene(call);
        let analysis = slider_crank::statics::statics(&scene, &options)?;
        let table = statics_report(&analysis, &scene, every).table();
        let summary = report::json(&analysis)?;
        Ok((analysis, table, summary))
    })?;
    let balanced = Balanced {
        analysis,
        scene,
        every,
    };
    Ok((arrays(py, table)?, summary, balanced))
}

#[pymethods]
impl Balanced {
    /// The report page.
    fn page(&self) -> PyResult<String> {
        let asked = self.scene.get();
        let scene = asked.scene(&Call::default());
        let report = statics_report(&self.analysis, &scene, self.every);
        report.page(&asked.origin("statics")).map_err(raised)
    }
}
