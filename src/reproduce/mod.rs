//! Reproduction of four papers: recomputes every printed number and figure, and returns verdicts and data of figures.

mod drawing;
mod duarte;
mod entry;
mod formulas;
mod gupta;
mod gupta_clearance;
mod ng;
mod obaseki_alfred;
mod quantities;

use crate::error::Error;
pub use drawing::{Drawing, Plot, Series, Style};
pub use entry::{Entry, Verdict};
use formulas::PaperFormulas;

named! {
    /// Paper on the slider-crank.
    pub enum Paper {
        /// Obaseki and Alfred 2020, Modeling and investigating the effect of offset distance on slider-crank mechanism.
        ObasekiAlfred = "obaseki-alfred",
        /// Gupta, Offset slider-crank mechanism.
        Gupta = "gupta",
        /// Ng, A slider-crank experiment to determine the action of static forces.
        Ng = "ng",
        /// Duarte, Valencia and Obregon 2018, Application of Lagrange equations in the analysis of slider-crank
        /// mechanisms.
        Duarte = "duarte",
    }
}

impl Paper {
    /// Returns the authors.
    pub fn authors(self) -> &'static str {
        match self {
            Paper::ObasekiAlfred => "Obaseki and Alfred",
            Paper::Gupta => "Gupta",
            Paper::Ng => "Ng",
            Paper::Duarte => "Duarte et al.",
        }
    }
}

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
        let (entries, drawings) = match paper {
            Paper::ObasekiAlfred => both(&obaseki_alfred::formulas()?)?,
            Paper::Gupta => {
                let (entries, drawings) = both(&gupta::formulas()?)?;
                let (simulated, drawn) = gupta_clearance::results()?;
                ([entries, simulated].concat(), [drawings, drawn].concat())
            }
            Paper::Ng => {
                let formulas = ng::formulas()?;
                (formulas.entries()?, ng::drawings(&formulas)?)
            }
            Paper::Duarte => both(&duarte::formulas()?)?,
        };
        for mut entry in entries {
            entry.paper = paper.name();
            result.entries.push(entry);
        }
        for mut drawing in drawings {
            drawing.paper = paper.name();
            let name = drawing.name.replace("figure-0", "figure ");
            let (authors, name) = (paper.authors(), name.replace('-', " "));
            drawing.title = format!("{authors}, {name}: {}", drawing.title);
            result.drawings.push(drawing);
        }
    }
    Ok(result)
}

fn both(formulas: &PaperFormulas) -> Result<(Vec<Entry>, Vec<Drawing>), Error> {
    Ok((formulas.entries()?, formulas.drawings()?))
}
