//! Errors of the library as exceptions, with the messages of the program.

use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError, PyValueError};
use pyo3::prelude::*;
use slider_crank::scene::Problems;

pyo3::create_exception!(
    slider_crank,
    Error,
    PyValueError,
    "What cannot be computed as it is asked for: the message has the value, its place and what would be right."
);
pyo3::create_exception!(
    slider_crank,
    SceneError,
    Error,
    "A scene or data that cannot be; `problems` lists field, line, column, what is wrong and what would be right."
);
pyo3::create_exception!(
    slider_crank,
    Refused,
    Error,
    "What the scene cannot be computed for, with the reason and what to do instead."
);

/// The exception of an error.
pub fn raised(error: slider_crank::error::Error) -> PyErr {
    use slider_crank::error::Error as Of;
    match error {
        Of::Scene(problems) => of_scene(&problems),
        Of::Read { ref source, .. } | Of::Write { ref source, .. } => {
            // With its number the system's error becomes FileNotFoundError and the like.
            match source.raw_os_error() {
                Some(number) => PyOSError::new_err((number, error.to_string())),
                None => PyOSError::new_err(error.to_string()),
            }
        }
        Of::Interrupted => PyKeyboardInterrupt::new_err(()),
        other => Refused::new_err(other.to_string()),
    }
}

/// What is wrong with a scene, one by one.
pub fn of_scene(problems: &Problems) -> PyErr {
    let error = SceneError::new_err(problems.to_string());
    let list: Vec<_> = problems.list().iter().collect();
    let told = Python::attach(|py| {
        let list = list.iter().map(|problem| {
            let (line, column) = problems.place(problem).unzip();
            let told = pyo3::types::PyDict::new(py);
            told.set_item("field", &problem.field)?;
            told.set_item("line", line)?;
            told.set_item("column", column)?;
            told.set_item("what", &problem.what)?;
            told.set_item("help", &problem.help)?;
            Ok(told)
        });
        let list = list.collect::<PyResult<Vec<_>>>()?;
        error.value(py).setattr("problems", list)
    });
    match told {
        Ok(()) => error,
        Err(failed) => failed,
    }
}

/// An argument that cannot be read.
pub fn refused(what: impl std::fmt::Display, help: &str) -> PyErr {
    Refused::new_err(format!("{what}\nhelp: {help}"))
}
