//! The terms of the equation of motion at arrays of states.

use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use slider_crank::mechanism;
use slider_crank::scene::Scene as Plain;

use crate::call::Call;
use crate::errors::{of_scene, refused};
use crate::scene::Scene;

/// The equation of a scene: M alpha + M'/2 omega² + V' = Q.
#[pyclass(frozen)]
pub struct Equation {
    scene: Py<Scene>,
}

type Array<'py> = Bound<'py, PyArray1<f64>>;

#[pymethods]
impl Equation {
    #[new]
    fn new(scene: Py<Scene>) -> PyResult<Equation> {
        let plain = scene.get().scene(&Call::default());
        plain.check().map_err(|problems| of_scene(&problems))?;
        modelled(&plain.reduced())?;
        Ok(Equation { scene })
    }

    /// What depends on the crank angle alone, by name.
    fn terms<'py>(
        &self,
        py: Python<'py>,
        theta: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let (equation, _) = self.of_call();
        let terms: Vec<_> = theta
            .as_array()
            .iter()
            .map(|theta| equation.terms(*theta))
            .collect();
        let found = PyDict::new(py);
        let set = |name: &str, value: fn(&mechanism::Terms) -> f64| {
            found.set_item(name, PyArray1::from_iter(py, terms.iter().map(value)))
        };
        set("M", |terms| terms.m)?;
        set("half_dM", |terms| terms.half_dm)?;
        set("dV", |terms| terms.dv)?;
        set("x", |terms| terms.pose.x)?;
        set("dx", |terms| terms.pose.dx)?;
        set("d2x", |terms| terms.pose.d2x)?;
        set("phi", |terms| terms.pose.phi())?;
        Ok(found)
    }

    /// Generalized force Q of the loads, N m, at states of the same number.
    fn force<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
        theta: PyReadonlyArray1<'py, f64>,
        omega: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Array<'py>> {
        self.at_states(py, [t, theta, omega], |equation, [t, theta, omega]| {
            let pose = equation.linkage().pose(theta);
            equation.load(t, theta, omega).generalized(pose.dx)
        })
    }

    /// Acceleration of the crank, rad/s², at states of the same number.
    fn acceleration<'py>(
        &self,
        py: Python<'py>,
        t: PyReadonlyArray1<'py, f64>,
        theta: PyReadonlyArray1<'py, f64>,
        omega: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Array<'py>> {
        self.at_states(py, [t, theta, omega], |equation, [t, theta, omega]| {
            equation.acceleration(t, theta, omega)
        })
    }
}

impl Equation {
    fn of_call(&self) -> (mechanism::Equation, Call) {
        let call = Call::default();
        (
            mechanism::Equation::new(&self.scene.get().scene(&call)),
            call,
        )
    }

    fn at_states<'py>(
        &self,
        py: Python<'py>,
        [t, theta, omega]: [PyReadonlyArray1<'py, f64>; 3],
        value: impl Fn(&mechanism::Equation, [f64; 3]) -> f64,
    ) -> PyResult<Array<'py>> {
        let (equation, call) = self.of_call();
        let [t, theta, omega] = [&t, &theta, &omega].map(|array| array.as_array());
        let states = t.iter().zip(theta).zip(omega);
        let states = states.map(|((t, theta), omega)| value(&equation, [*t, *theta, *omega]));
        let values: Vec<f64> = states.collect();
        call.result(Ok(PyArray1::from_vec(py, values)))
    }
}

/// Refuses what is no equation in the crank angle alone.
fn modelled(scene: &Plain) -> PyResult<()> {
    let what = match (&scene.clearance, &scene.friction) {
        (Some(_), _) => "with clearance in a joint the crank angle is not the only coordinate",
        (_, Some(_)) => {
            "friction at the guide depends on the acceleration, and is no term of the equation"
        }
        _ => return Ok(()),
    };
    Err(refused(what, "take it out of the scene, or use simulate"))
}
