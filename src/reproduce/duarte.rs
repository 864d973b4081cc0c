//! Duarte, Valencia and Obregon 2018: Lagrange equation of a Diesel engine, equations (1)-(11).

use super::formulas::{Files, PaperFormulas};
use super::quantities::{self, MechanismQuantities};
use crate::error::Error;
use crate::scene::{Gravity, Scene};

const FILES: Files = Files {
    symbols: include_str!("../../data/papers/duarte-symbols.csv"),
    claims: include_str!("../../data/papers/duarte.csv"),
    figures: include_str!("../../data/papers/duarte-figures.csv"),
};

/// Returns the paper with the complete equation of the engine: rod inertia about the crank pin, balanced crank.
pub(super) fn formulas() -> Result<PaperFormulas, Error> {
    let symbols = PaperFormulas::new(FILES)?;
    let [acceleration] = symbols.numbers(["g"])?;
    let gravity = Gravity {
        acceleration,
        ..Gravity::standard()
    };
    let engine = MechanismQuantities::new(Scene::duarte().gravity(gravity));
    Ok(symbols.with(quantities::of(vec![("engine", engine)], |_, _| None)))
}
