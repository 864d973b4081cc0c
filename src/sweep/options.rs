//! What is computed of every design.

use super::{Figure, LatinHypercube, Source};
use crate::error::Error;
use crate::numeric::stop::Stop;
use crate::plan::Method;
use crate::simulate::{Options, SteadyOptions};

/// What is asked of every design beside what the scene says.
#[derive(Clone, Debug)]
pub struct SweepOptions {
    /// Key figures, which say what is computed; if there are none, those of the turn and of what is asked for below.
    pub figures: Vec<Figure>,
    /// Random values of the varied keys in place of all combinations.
    pub sample: Option<LatinHypercube>,
    /// Whether the diagrams of a cycle are computed.
    pub diagrams: bool,
    /// Whether the forward motion is computed, if the scene has a run; else one turn in closed form only.
    pub motion: bool,
    /// Whether the largest joint forces of the motion are looked for.
    pub reactions: bool,
    /// Whether the periodic steady state is looked for, and with which flywheel.
    pub steady: Option<SteadyOptions>,
    /// The method of the forward motion.
    pub method: Method,
    /// Whether its global error is estimated, by a second run.
    pub estimate: bool,
    /// Most evaluations of the equation in one design.
    pub max_evaluations: u64,
    /// A request to stop; designs that are not complete by then are not handed on.
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
    /// Settles what is computed and which figures are shown, for scenes with or without a run. Figures that are named say
    /// what is computed, and nothing else is.
    pub(super) fn settle(&mut self, has_run: bool) -> Result<(), Error> {
        let named = !self.figures.is_empty();
        let takes = |source| self.figures.iter().any(|one| one.source() == source);
        if takes(Source::Flywheel) && !self.has(Source::Flywheel) {
            return Err(Error::refused(
                "the flywheel is one for a coefficient of speed fluctuation, and none is given",
                "say which, like --fluctuation 0.02",
            ));
        }
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

    /// Whether figures of this source are among those of what is asked for.
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
