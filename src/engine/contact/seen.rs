//! Whether the stages of a step show the loads on it.

use super::Contact;
use super::run::Runner;
use crate::engine::runge_kutta::Method;
use crate::engine::sight::{Look, Way, hidden};
use crate::numeric::enclosure::{Detail, Interval};

/// A step in time.
struct OnStep<'a, M: Contact<N>, const N: usize> {
    model: &'a M,
    start: &'a [f64; N],
    end: &'a [f64; N],
    /// Rates at the start.
    first: &'a [f64; N],
}

impl<M: Contact<N>, const N: usize> Way for OnStep<'_, M, N> {
    /// The parabola from the start with its rates to the end; off it is less than its own bend.
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
    /// How long the step to a state may be (s) so that its stages show the loads; none if they do.
    pub(super) fn hides(&self, end: &[f64; N]) -> Option<f64> {
        if !self.model.has_detail() {
            return None;
        }
        let h = end[0] - self.y[0];
        let tolerance = self.settings.tolerance;
        // A method of some order is worth as many nodes.
        let nodes = Method::Dop853.order();
        let look = Look::at_step([self.y[0], end[0]], nodes, tolerance, tolerance / h);
        let way = OnStep {
            model: self.model,
            start: &self.y,
            end,
            first: &self.now.rates,
        };
        hidden(&way, look).map(|hidden| hidden.at * h)
    }
}
