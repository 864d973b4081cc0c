//! Reproduction of four papers: recomputes every printed number and figure, and returns verdicts and data of figures.

mod duarte;
mod entry;
mod formulas;
mod gupta;
mod gupta_clearance;
mod ng;
mod obaseki_alfred;
mod paper;
mod quantities;

use crate::error::Error;
pub use entry::{Entry, Verdict};
pub use formulas::Drawing;
pub use paper::Paper;

/// Numbers and figures of papers.
#[derive(Clone, Debug)]
pub struct Reproduction {
    /// Comparisons of every number and formula, in the order of the papers.
    pub entries: Vec<Entry>,
    /// Data of every figure.
    pub drawings: Vec<Drawing>,
}

impl Reproduction {
    /// Returns the entries whose verdict differs from the one on record.
    pub fn surprises(&self) -> impl Iterator<Item = &Entry> {
        let unexpected = |entry: &&Entry| entry.verdict != entry.expected;
        self.entries.iter().filter(unexpected)
    }
}

/// Computes every number and figure of the papers.
///
/// # Errors
/// Errors of the computations involved; no case is known.
///
/// ```
/// use slider_crank::reproduce::{Paper, reproduce};
/// let ng = reproduce(&[Paper::Ng]).unwrap();
/// assert_eq!(ng.surprises().count(), 0);
/// ```
pub fn reproduce(papers: &[Paper]) -> Result<Reproduction, Error> {
    let mut result = Reproduction {
        entries: Vec::new(),
        drawings: Vec::new(),
    };
    for paper in papers {
        let formulas = match paper {
            Paper::ObasekiAlfred => obaseki_alfred::formulas(),
            Paper::Gupta => gupta::formulas(),
            Paper::Ng => ng::formulas(),
            Paper::Duarte => duarte::formulas(),
        }?;
        result.entries.extend(formulas.entries()?);
        result.drawings.extend(formulas.drawings()?);
    }
    Ok(result)
}
