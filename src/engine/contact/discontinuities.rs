//! Changes of the law of motion and kinks of its rates inside a phase: steps end there, and where they miss a load.

use super::run::{Halt, Runner};
use super::{AcceptedStep, Contact};
use crate::engine::PIECES;
use crate::engine::resolution::{ForceAlong, NodeCriterion, unresolved};
use crate::engine::run_in_time::Finish;
use crate::engine::runge_kutta::RungeKutta;
use crate::numeric::enclosure::{Interval, Variation};
use crate::numeric::root;

/// Changes of law in a run.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Breaks<const N: usize> {
    /// Change or kink at the end of the present piece.
    due: Option<Break<N>>,
    /// Time of the last change, s, and number of changes at that time before it.
    last: Option<(f64, u32)>,
}

/// Change or kink that ends the present piece.
#[derive(Clone, Copy, Debug)]
struct Break<const N: usize> {
    /// Time, s.
    t: f64,
    /// State after the change under the law before; none at a kink, where the law stays.
    beyond: Option<[f64; N]>,
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Rejects a step that goes beyond a change or kink: the next one ends there.
    pub(super) fn stop_at_break(&mut self, step: &mut AcceptedStep<'_, N>) -> Halt {
        if self.breaks.due.is_some() {
            return Ok(());
        }
        let Some(found) = self.first_break(step) else {
            return Ok(());
        };
        self.until = found.t;
        self.breaks.due = Some(found);
        Err(None)
    }

    fn first_break(&self, step: &mut AcceptedStep<'_, N>) -> Option<Break<N>> {
        let (model, near, phase) = (self.model, self.near, self.phase);
        let breaks = |y: &[f64; N]| model.breaks(&near, phase, y);
        let (start, h) = (step.start[0], step.length());
        // A kink nearer to the start, as a fraction of the step, is the one at which the step begins.
        let nearest = 1e-6;
        let (mut from, mut before) = (start, breaks(&step.start)?);
        for i in 1..=PIECES {
            let to = match i {
                PIECES => step.end[0],
                _ => start + h * i as f64 / PIECES as f64,
            };
            let y = step.at(to);
            let after = breaks(&y)?;
            let mut value = |index: usize, t: f64| breaks(&step.at(t)).map_or(0.0, |b| b[index]);
            let kink = (before[1] * after[1] < 0.0)
                .then(|| root::bracketed(|t| value(1, t), from, to))
                .flatten()
                .filter(|t| t - start > nearest * h);
            let end = (after[0] < 0.0).then(|| match before[0] > 0.0 {
                true => root::bracketed(|t| value(0, t), from, to).unwrap_or(from),
                false => from,
            });
            let found = match end.filter(|end| kink.is_none_or(|kink| *end <= kink)) {
                Some(t) => Some(Break { t, beyond: Some(y) }),
                None => kink.map(|t| Break { t, beyond: None }),
            };
            if found.is_some() {
                return found;
            }
            (from, before) = (to, after);
        }
        None
    }

    /// Changes to the law that holds from here on, if a change is due.
    pub(super) fn change(&mut self) -> Halt {
        let Some(beyond) = self.breaks.due.take().and_then(|due| due.beyond) else {
            return Ok(());
        };
        let here = match self.breaks.last {
            Some((t, before)) if t == self.y[0] => before + 1,
            _ => 0,
        };
        self.breaks.last = Some((self.y[0], here));
        // Beyond so many changes at one time no law persists.
        let most_at_once = 4;
        if here > most_at_once {
            return Err(Some(Finish::StepTooSmall));
        }
        self.near = self
            .model
            .change(&self.near, self.phase, &mut self.y, &beyond);
        Ok(())
    }
}

/// Parabola of the state over a step in time: from the start, with its rates, to the end.
struct StepParabola<'a, M: Contact<N>, const N: usize> {
    model: &'a M,
    start: &'a [f64; N],
    end: &'a [f64; N],
    /// Rates at the start.
    first: &'a [f64; N],
}

impl<M: Contact<N>, const N: usize> ForceAlong for StepParabola<'_, M, N> {
    /// Encloses the parabola, widened by its bend.
    fn variation(&self, from: f64, to: f64, ellipse: f64) -> Variation {
        let h = self.end[0] - self.start[0];
        let reach = std::array::from_fn(|i| {
            let straight = h * self.first[i];
            let bend = self.end[i] - self.start[i] - straight;
            let at = |u: f64| self.start[i] + u * (straight + u * bend);
            let width = to - from;
            Interval::between(at(from), at(to)).widened(bend.abs() * width * width)
        });
        self.model.variation(&reach, ellipse)
    }
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Returns the length (s) a step to this state may have for its stages to resolve the loads; none if they do.
    pub(super) fn unresolved_after(&self, end: &[f64; N]) -> Option<f64> {
        if !self.model.varies_between_nodes() {
            return None;
        }
        let h = end[0] - self.y[0];
        let tolerance = self.settings.tolerance;
        // A method of order n counts as n nodes.
        let nodes = RungeKutta::Dop853.order();
        let criterion =
            NodeCriterion::at_step([self.y[0], end[0]], nodes, tolerance, tolerance / h);
        let way = StepParabola {
            model: self.model,
            start: &self.y,
            end,
            first: &self.now.rates,
        };
        unresolved(&way, criterion).map(|unresolved| unresolved.at * h)
    }
}
