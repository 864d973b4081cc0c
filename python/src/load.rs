//! Loads that are Python functions.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use slider_crank::scene::{Instant, Load, Period, Scene, Variable, Variables};

use crate::call::Call;
use crate::errors::refused;

/// A Python function as a load.
pub struct Called {
    function: Py<PyAny>,
    /// What it is called with, in this order.
    arguments: Vec<Variable>,
    on_crank: bool,
    period: Option<Period>,
    scales: Vec<(Variable, f64)>,
}

/// A load as the package hands it on: function, names of its arguments, whether it acts on the crank, turns and parts of its
/// period, and finest scales.
pub type Handed = (
    Py<PyAny>,
    Vec<String>,
    bool,
    Option<(u32, u32)>,
    Vec<(String, f64)>,
);

impl Called {
    /// Takes a function over.
    pub fn new(handed: Handed) -> PyResult<Called> {
        let (function, arguments, on_crank, period, scales) = handed;
        let scale = |(name, scale): (String, f64)| Ok((variable(&name)?, scale));
        Ok(Called {
            function,
            arguments: arguments
                .iter()
                .map(|name| variable(name))
                .collect::<PyResult<_>>()?,
            on_crank,
            period: period
                .map(|(turns, parts)| {
                    Period::fraction(turns, parts).ok_or_else(|| {
                        refused(
                            format!("a load cannot repeat after {turns}/{parts} of a turn"),
                            "give turns of the crank, like 2 or Fraction(1, 3)",
                        )
                    })
                })
                .transpose()?,
            scales: scales.into_iter().map(scale).collect::<PyResult<_>>()?,
        })
    }

    fn value(&self, py: Python<'_>, now: &Instant) -> PyResult<f64> {
        let arguments = self.arguments.iter().map(|variable| match variable {
            Variable::T => now.t,
            Variable::Theta => now.theta,
            Variable::Omega => now.omega,
            Variable::X => now.x,
            Variable::V => now.v,
        });
        let arguments = PyTuple::new(py, arguments.collect::<Vec<f64>>())?;
        self.function.call1(py, arguments)?.extract(py)
    }
}

fn variable(name: &str) -> PyResult<Variable> {
    Variable::named(name).ok_or_else(|| {
        refused(
            format!("a load cannot depend on `{name}`"),
            "name the parameters of the function t, theta, omega, x, v",
        )
    })
}

/// A scene with its functions among its loads; the first exception of one ends the call.
pub fn with_loads(scene: Scene, loads: &[Arc<Called>], call: &Call) -> Scene {
    loads.iter().fold(scene, |scene, called| {
        let load = load(called.clone(), call.clone());
        match called.on_crank {
            true => scene.torque(load),
            false => scene.force(load),
        }
    })
}

fn load(called: Arc<Called>, call: Call) -> Load {
    let reads = called.arguments.iter();
    let reads = reads.fold(Variables::NONE, |all, variable| all.with(*variable));
    let (period, scales) = (called.period, called.scales.clone());
    let mut load = Load::function(reads, move |now| {
        if call.has_failed() {
            return f64::NAN;
        }
        let value = Python::try_attach(|py| called.value(py, now));
        value
            .transpose()
            .unwrap_or_else(|error| {
                call.fail(error);
                None
            })
            .unwrap_or(f64::NAN)
    });
    if let Some(period) = period {
        load = load.with_period(period);
    }
    for (variable, scale) in scales {
        load = load.with_finest_scale(variable, scale);
    }
    load
}
