//! The native part of the Python package `slider_crank`: scenes and NumPy arrays in, columns as NumPy arrays out. What users
//! see is written in Python, beside it; each of its functions calls one here, and one here asks one question of the library.

mod call;
mod columns;
mod design;
mod dynamics;
mod equation;
mod errors;
mod load;
mod measured;
mod scene;
mod sweep;
mod turn;

/// What the package calls.
#[pyo3::pymodule]
mod _native {
    #[pymodule_export]
    use crate::design::{optimise, synthesis};
    #[pymodule_export]
    use crate::dynamics::{Run, simulate, steady_state};
    #[pymodule_export]
    use crate::equation::Equation;
    #[pymodule_export]
    use crate::errors::{Error, Refused, SceneError};
    #[pymodule_export]
    use crate::measured::{Measurement, Recovered, identify, inverse};
    #[pymodule_export]
    use crate::scene::Scene;
    #[pymodule_export]
    use crate::sweep::{Designs, sweep};
    #[pymodule_export]
    use crate::turn::{Balanced, Turn, kinematics, statics};
}
