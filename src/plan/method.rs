//! Method of integration that the user requests.

use std::fmt;
use std::str::FromStr;

/// Requested method of integration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Engine selected by the plan.
    #[default]
    Auto,
    /// Prescribed motion, without integration.
    ClosedForm,
    /// Energy integral.
    Energy,
    /// Crank angle as the independent variable.
    Angle,
    /// Integration in time with the default stepper.
    Time,
    /// Integration in time with Dop853 of ode_solvers, of which only the states at the ends of steps are used.
    ///
    /// The dense output of ode_solvers 0.6 is unreliable: it returns states of another time than stated, extrapolates
    /// its last point, and fails for negative or decreasing time. Between the ends of steps this program interpolates
    /// itself, without control of that error.
    Dop853,
    /// Integration in time with Dopri5 of ode_solvers; dense output as for [`Method::Dop853`].
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

    /// Iterates over all methods, [`Method::Auto`] first.
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
