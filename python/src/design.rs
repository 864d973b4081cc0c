//! A design that is looked for: the best one between bounds, and lengths for a stroke and a time ratio.

use std::fmt::Display;
use std::str::FromStr;

use pyo3::prelude::*;
use slider_crank::kinematics::{Choice, synthesis as lengths};
use slider_crank::optimise::{Problem, optimise as search};
use slider_crank::report;
use slider_crank::scene::Varied;
use slider_crank::scene::unit::Quantity;
use slider_crank::simulate::Options;
use slider_crank::sweep::{Goal, SweepOptions};

use crate::call;
use crate::errors::{Refused, of_scene, raised, refused};
use crate::scene::{Scene, method_of, quantity};

/// Each text as what it says.
pub fn parsed<T: FromStr<Err: Display>>(texts: &[String]) -> PyResult<Vec<T>> {
    let each = texts.iter().map(|text| text.parse());
    each.collect::<Result<_, _>>()
        .map_err(|error: T::Err| Refused::new_err(error.to_string()))
}

/// What is looked for.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Wanted {
    vary: Vec<String>,
    least: Vec<String>,
    most: Vec<String>,
    subject: Vec<String>,
    seed: u64,
    fluctuation: Option<f64>,
    method: String,
    max_evaluations: Option<u64>,
}

impl Wanted {
    fn goal(&self) -> PyResult<Goal> {
        let (least, most) = (parsed(&self.least)?, parsed(&self.most)?);
        match (&least[..], &most[..]) {
            (&[figure], []) => Ok(Goal::least(figure)),
            ([], &[figure]) => Ok(Goal::most(figure)),
            _ => Err(refused(
                "there is one goal",
                "give least or most, the name of a key figure",
            )),
        }
    }

    /// But for the request to stop.
    fn options(&self) -> PyResult<SweepOptions> {
        let default = Options::default();
        Ok(SweepOptions {
            fluctuation: self.fluctuation,
            run: Options {
                method: method_of(&self.method)?,
                max_evaluations: self.max_evaluations.unwrap_or(default.max_evaluations),
                ..default
            },
            ..SweepOptions::default()
        })
    }
}

/// The best design between bounds: the scene with its values, and the search as JSON.
#[pyfunction]
pub fn optimise(py: Python<'_>, scene: Py<Scene>, wanted: Wanted) -> PyResult<(String, String)> {
    let this = scene.get();
    this.only_text("optimise").map_err(raised)?;
    let varied: Vec<Varied> = parsed(&wanted.vary)?;
    let problem = Problem {
        goal: wanted.goal()?,
        constraints: parsed(&wanted.subject)?,
        seed: wanted.seed,
    };
    let options = wanted.options()?;
    let found = call::run(py, |call| {
        let mut options = options;
        options.run.stop = Some(call.stop.clone());
        search(this.draft.clone(), varied.clone(), &problem, options)
    })?;
    let values = varied.iter().zip(&found.values);
    let values = values.map(|(varied, value)| (varied, value.text.as_str()));
    let best = this.draft.text_with(values);
    let best = best.map_err(|problems| of_scene(&problems))?;
    Ok((best, report::json(&found).map_err(raised)?))
}

/// Lengths for a stroke and a time ratio: the scene of them, and one turn as JSON.
#[pyfunction]
#[pyo3(signature = (stroke, time_ratio, named))]
pub fn synthesis(
    stroke: &str,
    time_ratio: f64,
    named: Option<(String, String)>,
) -> PyResult<(String, String)> {
    let length = |text: &str| quantity(text, Quantity::Length);
    let choice = match &named {
        None => Choice::BestTransmission,
        Some((name, text)) => match name.as_str() {
            "crank" => Choice::Crank(length(text)?),
            "rod" => Choice::Rod(length(text)?),
            "offset" => Choice::Offset(length(text)?),
            _ => Choice::RodRatio(quantity(text, Quantity::Number)?),
        },
    };
    let found = lengths(length(stroke)?, time_ratio, choice).map_err(raised)?;
    let json = report::json(&found).map_err(raised)?;
    Ok((report::synthesis_scene(&found), json))
}
