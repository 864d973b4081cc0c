//! Scenes: the text of a scene file, and loads that are Python functions.

use std::path::PathBuf;
use std::sync::Arc;

use pyo3::prelude::*;
use slider_crank::error::Error;
use slider_crank::explain::explain;
use slider_crank::plan::Method;
use slider_crank::report::{Origin, explanation};
use slider_crank::scene::unit::{self, Quantity};
use slider_crank::scene::{Draft, Scene as Plain};

use crate::call::{self, Call};
use crate::errors::{of_scene, raised, refused};
use crate::load::{Called, Handed, with_loads};

/// A scene that was read.
#[pyclass(frozen)]
pub struct Scene {
    pub draft: Draft,
    pub loads: Vec<Arc<Called>>,
    plain: Plain,
}

#[pymethods]
impl Scene {
    /// Of the text of a scene file, whose name is for messages and tables beside it.
    #[new]
    fn new(file: PathBuf, text: String, loads: Vec<Handed>) -> PyResult<Scene> {
        let loads = loads
            .into_iter()
            .map(|load| Called::new(load).map(Arc::new));
        Scene::of(Draft::new(&file, text), loads.collect::<PyResult<_>>()?)
    }

    /// Of a scene file.
    #[staticmethod]
    fn load(file: PathBuf) -> PyResult<Scene> {
        Scene::of(Draft::load(&file).map_err(raised)?, Vec::new())
    }

    /// The engine of Duarte et al.
    #[staticmethod]
    fn duarte() -> PyResult<Scene> {
        Scene::of(Draft::duarte(), Vec::new())
    }

    #[getter]
    fn text(&self) -> &str {
        self.draft.text()
    }

    #[getter]
    fn title(&self) -> Option<&str> {
        self.plain.title.as_deref()
    }

    /// The equation, what is modelled and what computes it, in words; terms at an angle.
    #[pyo3(signature = (method, at))]
    fn explain(&self, py: Python<'_>, method: &str, at: Option<&str>) -> PyResult<String> {
        let method = method_of(method)?;
        let at = at.map(|text| quantity(text, Quantity::Angle)).transpose()?;
        call::run(py, |call| {
            Ok(explanation(&explain(&self.scene(call), method, at)?))
        })
    }
}

impl Scene {
    fn of(draft: Draft, loads: Vec<Arc<Called>>) -> PyResult<Scene> {
        let plain = draft.scene().map_err(|problems| of_scene(&problems))?;
        Ok(Scene {
            draft,
            loads,
            plain,
        })
    }

    /// The scene for a call.
    pub fn scene(&self, call: &Call) -> Plain {
        with_loads(self.plain.clone(), &self.loads, call)
    }

    /// Refuses functions where values of the text are varied.
    pub fn only_text(&self, what: &str) -> Result<(), Error> {
        match self.loads.is_empty() {
            true => Ok(()),
            false => Err(Error::refused(
                format!(
                    "{what} knows the text of a scene, and this one has loads that are Python functions"
                ),
                "give them as formulas or tables",
            )),
        }
    }

    /// Where a result comes from.
    pub fn origin(&self, function: &str) -> Origin {
        Origin {
            scene: Some(self.draft.text().to_owned()),
            command: format!("slider_crank.{function}(...)"),
        }
    }
}

/// A method by its name.
pub fn method_of(name: &str) -> PyResult<Method> {
    name.parse().map_err(|error| {
        refused(
            error,
            "give \"auto\", \"closed-form\", \"energy\", \"angle\", \"time\", \"dop853\" or \"dopri5\"",
        )
    })
}

/// A text with a unit, SI.
pub fn quantity(text: &str, quantity: Quantity) -> PyResult<f64> {
    unit::parse(text, quantity).map_err(|error| crate::errors::Refused::new_err(error.to_string()))
}
