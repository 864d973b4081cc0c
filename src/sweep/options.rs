//! Options of a sweep: computations of every design, and the figures read from them.

use super::{Figure, LatinHypercube, Source};
use crate::error::Error;
use crate::numeric::stop::Stop;
use crate::plan::Method;
use crate::simulate::{Options, SteadyOptions};

/// Computations asked of every design, beyond the scene.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// Key figures, which decide the computations; if empty, all figures of the turn and of the computations below.
    pub figures: Vec<Figure>,
    /// Latin hypercube sample of the varied keys, in place of all combinations.
    pub sample: Option<LatinHypercube>,
    /// Whether to compute the diagrams of a cycle.
    pub diagrams: bool,
    /// Whether to compute the forward motion, for scenes with a run.
    pub motion: bool,
    /// Whether to find the largest joint forces of the motion.
    pub reactions: bool,
    /// Settings of the search for the periodic steady state and its flywheel; none without search.
    pub steady: Option<SteadyOptions>,
    /// Method of the forward motion.
    pub method: Method,
    /// Whether to estimate the global error of the motion, by a second run.
    pub estimate: bool,
    /// Maximum number of evaluations of the equation in one motion.
    pub max_evaluations: u64,
    /// Request to stop; the batch in progress is then dropped.
    pub stop: Option<Stop>,
}

impl Default for SweepOptions {
    fn default() -> SweepOptions {
        let one = Options::default();
        SweepOptions {
            figures: Vec::new(),
            sample: None,
            diagrams: false,
            motion: true,
            reactions: false,
            steady: None,
            method: one.method,
            estimate: one.estimate,
            max_evaluations: one.max_evaluations,
            stop: None,
        }
    }
}

impl SweepOptions {
    /// Derives the computations from named figures, or the figures from the computations, for scenes with or without a
    /// run. Named figures override the other options.
    pub(super) fn derive_computations(&mut self, has_run: bool) -> Result<(), Error> {
        let named = !self.figures.is_empty();
        let takes = |source| self.figures.iter().any(|one| one.source() == source);
        if takes(Source::Flywheel) && !self.has(Source::Flywheel) {
            return Err(Error::refused(
                "the flywheel is one for a coefficient of speed fluctuation, and none is given",
                "say which, like --fluctuation 0.02",
            ));
        }
        self.steady.as_ref().map_or(Ok(()), SteadyOptions::check)?;
        if named {
            self.reactions = takes(Source::Peaks);
            self.motion = self.reactions || takes(Source::Motion);
            self.diagrams = takes(Source::Diagrams);
            let steady = takes(Source::Steady) || takes(Source::Flywheel);
            self.steady = steady.then(|| self.steady.take().unwrap_or_default());
        }
        let forces = self.reactions && !(self.motion && has_run);
        if forces || named && self.motion && !has_run {
            let help = match has_run {
                true => "do without --no-motion",
                false => "give the scene a [run]",
            };
            let figures = match forces {
                true => "the largest joint forces",
                false => "some of the figures",
            };
            let what = format!("{figures} are those of a motion, and none is computed");
            return Err(Error::refused(what, help));
        }
        self.motion &= has_run;
        if !named {
            let all = Figure::ALL.iter();
            let asked = all.filter(|figure| self.has(figure.source()));
            self.figures = asked.copied().collect();
        }
        Ok(())
    }

    /// Whether the options ask for the computation `source`.
    fn has(&self, source: Source) -> bool {
        match source {
            Source::Turn => true,
            Source::Diagrams => self.diagrams,
            Source::Motion => self.motion,
            Source::Peaks => self.reactions,
            Source::Steady => self.steady.is_some(),
            Source::Flywheel => {
                let asked = self.steady.as_ref();
                asked.is_some_and(|asked| asked.fluctuation.is_some())
            }
        }
    }
}
