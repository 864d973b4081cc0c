//! The method the user asks for.

use std::fmt;
use std::str::FromStr;

/// What the user asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Whatever the plan finds best.
    #[default]
    Auto,
    /// Prescribed motion, no integration.
    ClosedForm,
    /// Energy integral.
    Energy,
    /// Crank angle as the independent variable.
    Angle,
    /// Integration in time with the default method.
    Time,
    /// Integration in time with Dop853 of ode_solvers, from which only the ends of steps are taken.
    ///
    /// The dense output of ode_solvers 0.6 is not to be trusted: it hands out states that belong to another time than it
    /// says, extrapolates its last point, and fails where time runs backwards or is negative. Between the ends of steps
    /// this program interpolates itself, and nothing controls that error.
    Dop853,
    /// Integration in time with Dopri5 of ode_solvers, as [`Method::Dop853`].
    Dopri5,
}

impl Method {
    const ALL: [(&'static str, Method); 7] = [
        ("auto", Method::Auto),
        ("closed-form", Method::ClosedForm),
        ("energy", Method::Energy),
        ("angle", Method::Angle),
        ("time", Method::Time),
        ("dop853", Method::Dop853),
        ("dopri5", Method::Dopri5),
    ];

    /// Every method, [`Method::Auto`] first.
    pub fn each() -> impl Iterator<Item = Method> {
        Method::ALL.into_iter().map(|(_, method)| method)
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        Method::ALL
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, method)| *method)
            .ok_or_else(|| {
                let names: Vec<_> = Method::ALL.iter().map(|(name, _)| *name).collect();
                format!("use one of {}", names.join(", "))
            })
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = Method::ALL.iter().find(|(_, method)| method == self);
        f.write_str(name.map_or("", |(name, _)| name))
    }
}
