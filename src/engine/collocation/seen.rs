//! Whether the nodes of a step show the acceleration on it.

use super::super::sight::{Way, corner_on_step};
use super::super::step::Step;
use super::super::{Counted, Motion, NODES};
use super::series::legendre;
use super::state::State;
use crate::numeric::enclosure::{Detail, Interval, Reach};

/// The motion on a step.
pub(super) struct OnStep<'a> {
    pub motion: &'a Counted<'a>,
    pub state: &'a State,
    pub step: &'a Step,
    /// Legendre coefficients of the acceleration at the nodes.
    pub coefficients: &'a [f64; NODES],
}

impl OnStep<'_> {
    fn time(&self, at: f64) -> f64 {
        self.state.t + at * self.step.length()
    }
}

impl Way for OnStep<'_> {
    type Part = Reach;

    fn reach(&self, from: f64, to: f64) -> Reach {
        let [begin, middle, end] = [from, 0.5 * (from + to), to].map(|at| self.time(at));
        let most: f64 = self.coefficients.iter().map(|c| c.abs()).sum();
        let aside = 0.5 * (end - begin);
        let speed = Interval::point(self.step.at(middle).1).widened(most * aside);
        let angle = |t: f64| self.step.angle(self.step.at(t).0).radians();
        let mut angle = Interval::between(angle(begin), angle(end));
        if speed.contains(0.0) {
            angle = angle.widened(speed.largest() * aside);
        }
        Reach {
            t: Interval::new(begin, end),
            angle,
            speed,
            parts: 1.0,
        }
    }

    fn corner(&self, from: f64, to: f64) -> Option<f64> {
        corner_on_step(self.motion, self.step, from, to)
    }

    fn missed(&self, at: f64) -> f64 {
        let t = self.time(at);
        let (theta, omega) = self.step.at(t);
        let [shown] = legendre(self.coefficients, [2.0 * at - 1.0]);
        self.motion.acceleration(t, self.step.angle(theta), omega) - shown
    }

    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail {
        self.motion.detail(reach, ellipse)
    }
}
