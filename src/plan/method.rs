//! Method of integration that the user requests.

use std::str::FromStr;

named! {
    /// Requested method of integration.
    #[derive(Default)]
    pub enum Method {
        /// Engine selected by the plan.
        #[default]
        Auto = "auto",
        /// Prescribed motion, without integration.
        ClosedForm = "closed-form",
        /// Energy integral.
        Energy = "energy",
        /// Crank angle as the independent variable.
        Angle = "angle",
        /// Integration in time with the default stepper.
        Time = "time",
        /// Integration in time with Dop853 of ode_solvers, of which only the states at the ends of steps are used.
        ///
        /// The dense output of ode_solvers 0.6 is unreliable: it returns states of another time than stated,
        /// extrapolates its last point, and fails for negative or decreasing time. Between the ends of steps this
        /// program interpolates itself, without control of that error.
        Dop853 = "dop853",
        /// Integration in time with Dopri5 of ode_solvers; dense output as for [`Method::Dop853`].
        Dopri5 = "dopri5",
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(text: &str) -> Result<Method, String> {
        Method::named(text).ok_or_else(|| format!("use one of {}", Method::NAMES.join(", ")))
    }
}
