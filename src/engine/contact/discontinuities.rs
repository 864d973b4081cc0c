//! Changes of the law of motion and kinks of its rates inside a phase: steps end there, and where their stages miss a
//! load.

use super::run::{Halt, Runner};
use super::{AcceptedStep, Contact, Finish};
use crate::engine::PIECES;
use crate::engine::runge_kutta::RungeKutta;
use crate::engine::sight::{Interpolant, NodeCriterion, hidden};
use crate::numeric::enclosure::{Detail, Interval};
use crate::numeric::root;

/// Distance from the start of a step, as a fraction, within which a kink is the one at which the step begins.
const SAME_BREAK: f64 = 1e-6;
/// Most changes of law at one time: beyond that no law persists, and the run ends.
const MOST_AT_ONCE: u32 = 4;

/// Changes of law in a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Breaks<const N: usize> {
    /// Change or kink at the end of the present piece.
    due: Option<Break<N>>,
    /// Time of the last change, s, and number of changes at that time before it.
    last: (f64, u32),
}

impl<const N: usize> Default for Breaks<N> {
    fn default() -> Breaks<N> {
        Breaks {
            due: None,
            last: (f64::NEG_INFINITY, 0),
        }
    }
}

/// Change or kink that ends the present piece.
#[derive(Clone, Copy, Debug)]
struct Break<const N: usize> {
    /// Time, s.
    t: f64,
    /// State after the change under the law before; none at a kink, where the law stays.
    soon: Option<[f64; N]>,
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Rejects a step that goes beyond a change or kink: the next one ends there.
    pub(super) fn stop_at_break(&mut self, stretch: &mut AcceptedStep<'_, N>) -> Halt {
        if self.breaks.due.is_some() {
            return Ok(());
        }
        let Some(found) = self.first_break(stretch) else {
            return Ok(());
        };
        self.until = found.t;
        self.breaks.due = Some(found);
        Err(Finish::Broken)
    }

    fn first_break(&self, stretch: &mut AcceptedStep<'_, N>) -> Option<Break<N>> {
        let (model, near, phase) = (self.model, self.near, self.phase);
        let breaks = |y: &[f64; N]| model.breaks(&near, phase, y);
        let (start, h) = (stretch.start[0], stretch.length());
        let (mut from, mut before) = (start, breaks(&stretch.start)?);
        for i in 1..=PIECES {
            let to = match i {
                PIECES => stretch.end[0],
                _ => start + h * i as f64 / PIECES as f64,
            };
            let y = stretch.at(to);
            let after = breaks(&y)?;
            let mut value = |index: usize, t: f64| breaks(&stretch.at(t)).map_or(0.0, |b| b[index]);
            let kink = (before[1] * after[1] < 0.0)
                .then(|| root::bracketed(|t| value(1, t), from, to))
                .flatten()
                .filter(|t| t - start > SAME_BREAK * h);
            let end = (after[0] < 0.0).then(|| match before[0] > 0.0 {
                true => root::bracketed(|t| value(0, t), from, to).unwrap_or(from),
                false => from,
            });
            match (end, kink) {
                (None, None) => (from, before) = (to, after),
                (Some(t), kink) if kink.is_none_or(|kink| t <= kink) => {
                    return Some(Break { t, soon: Some(y) });
                }
                (_, Some(t)) | (Some(t), None) => return Some(Break { t, soon: None }),
            }
        }
        None
    }

    /// Changes to the law that holds from here on, if a change is due.
    pub(super) fn change(&mut self) -> Halt {
        let Some(soon) = self.breaks.due.take().and_then(|due| due.soon) else {
            return Ok(());
        };
        let (t, before) = self.breaks.last;
        let here = if t == self.y[0] { before + 1 } else { 0 };
        self.breaks.last = (self.y[0], here);
        if here > MOST_AT_ONCE {
            return Err(Finish::StepTooSmall);
        }
        self.near = self
            .model
            .change(&self.near, self.phase, &mut self.y, &soon);
        Ok(())
    }
}

/// Step in time.
struct OnStep<'a, M: Contact<N>, const N: usize> {
    model: &'a M,
    start: &'a [f64; N],
    end: &'a [f64; N],
    /// Rates at the start.
    first: &'a [f64; N],
}

impl<M: Contact<N>, const N: usize> Interpolant for OnStep<'_, M, N> {
    /// Encloses the parabola from the start, with its rates, to the end, widened by its bend.
    fn detail(&self, from: f64, to: f64, ellipse: f64) -> Detail {
        let h = self.end[0] - self.start[0];
        let reach = std::array::from_fn(|i| {
            let straight = h * self.first[i];
            let bend = self.end[i] - self.start[i] - straight;
            let at = |u: f64| self.start[i] + u * (straight + u * bend);
            let width = to - from;
            Interval::between(at(from), at(to)).widened(bend.abs() * width * width)
        });
        self.model.detail(&reach, ellipse)
    }
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    /// Returns the length (s) a step to this state may have for its stages to resolve the loads; none if they do.
    pub(super) fn hides(&self, end: &[f64; N]) -> Option<f64> {
        if !self.model.has_detail() {
            return None;
        }
        let h = end[0] - self.y[0];
        let tolerance = self.settings.tolerance;
        // A method of order n counts as n nodes.
        let nodes = RungeKutta::Dop853.order();
        let look = NodeCriterion::at_step([self.y[0], end[0]], nodes, tolerance, tolerance / h);
        let way = OnStep {
            model: self.model,
            start: &self.y,
            end,
            first: &self.now.rates,
        };
        hidden(&way, look).map(|hidden| hidden.at * h)
    }
}
