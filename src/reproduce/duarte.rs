//! Duarte, Valencia and Obregon 2018: Lagrange equation of a Diesel engine, equations (1)-(11).

use super::formulas::{PaperFormulas, files};
use super::paper::Paper;
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::scene::{Gravity, Scene};

/// Returns the paper with the complete equation of the engine: rod inertia about the crank pin, balanced crank.
pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(Paper::Duarte, files!("duarte"))?;
    let [acceleration] = symbols.numbers(["g"])?;
    let gravity = Gravity {
        acceleration,
        ..Gravity::standard()
    };
    let engine = MechanismQuantities::new(Scene::duarte().gravity(gravity));
    Ok(symbols.with(quantities::of(vec![("engine", engine)], |_, _| None)))
}
