//! Options of a sweep: computations of every design, and the figures read from them.

use super::{Figure, LatinHypercube, Source};
use crate::error::Error;
use crate::simulate::{Options, check_fluctuation};

/// Computations asked of every design, beyond the scene.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// Key figures, which decide the computations; if empty, all figures of the turn and of the computations below,
    /// without those of the diagrams of a cycle.
    pub figures: Vec<Figure>,
    /// Latin hypercube sample of the varied keys, in place of all combinations.
    pub sample: Option<LatinHypercube>,
    /// Whether to compute the forward motion, for scenes with a run.
    pub motion: bool,
    /// Whether to search for the periodic steady state.
    pub steady: bool,
    /// Coefficient of fluctuation of the flywheel of the steady state, which is then searched for.
    pub fluctuation: Option<f64>,
    /// Options of each motion and search; its events are only counted. A request to stop drops the batch in progress.
    pub run: Options,
}

impl Default for SweepOptions {
    fn default() -> SweepOptions {
        SweepOptions {
            figures: Vec::new(),
            sample: None,
            motion: true,
            steady: false,
            fluctuation: None,
            run: Options::default(),
        }
    }
}

impl SweepOptions {
    /// Derives the computations from named figures, or the figures from the computations, for scenes with or without a
    /// run. Named figures override the other options.
    pub(super) fn derive_computations(&mut self, has_run: bool) -> Result<(), Error> {
        let named = !self.figures.is_empty();
        let takes = |source| self.figures.iter().any(|one| one.source == source);
        if takes(Source::Flywheel) && !self.has(Source::Flywheel) {
            return Err(Error::refused(
                "the flywheel is one for a coefficient of speed fluctuation, and none is given",
                "say which, like --fluctuation 0.02",
            ));
        }
        check_fluctuation(self.fluctuation)?;
        if named {
            self.run.reactions = takes(Source::Peaks);
            self.motion = self.run.reactions || takes(Source::Motion);
            self.steady = takes(Source::Steady) || takes(Source::Flywheel);
        } else {
            self.steady |= self.fluctuation.is_some();
        }
        let forces = self.run.reactions && !(self.motion && has_run);
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
            let asked = all.filter(|figure| self.has(figure.source));
            self.figures = asked.copied().collect();
        }
        Ok(())
    }

    /// Whether the options ask for the computation `source`.
    pub(super) fn has(&self, source: Source) -> bool {
        let is_named = self.figures.iter().any(|one| one.source == source);
        match source {
            Source::Turn => self.figures.is_empty() || is_named,
            Source::Diagrams => is_named,
            Source::Motion => self.motion,
            Source::Peaks => self.run.reactions,
            Source::Steady => self.steady,
            Source::Flywheel => self.fluctuation.is_some(),
        }
    }
}
