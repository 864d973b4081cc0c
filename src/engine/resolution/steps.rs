//! Resolution test for loads on a step in time.

use super::{ForceAlong, NodeCriterion, Unresolved, unresolved};
use crate::engine::step::Step;
use crate::engine::{Batch, Counted, NODES};
use crate::numeric::enclosure::{Interval, MotionPiece, Variation};
use crate::numeric::gauss::{legendre_change, legendre_series};
use crate::numeric::root;

/// Motion on a step.
struct OnStep<'a> {
    motion: &'a Counted<'a>,
    step: &'a Step,
    /// Legendre coefficients of the acceleration, for a collocation step.
    nodes: Option<&'a [f64; NODES]>,
}

/// Returns the fraction of a step that the roundings of time and angle cannot divide.
fn finest(step: &Step) -> f64 {
    let [first, last] = [step.start.theta, step.end.theta].map(|theta| step.angle(theta).radians());
    let of_angle = first.abs().max(last.abs()) / (last - first).abs();
    // A step across a turning point goes further than its ends are apart.
    let most = 1e-3;
    4.0 * f64::EPSILON * (step.end.t.abs() / step.length()).max(of_angle.min(most / f64::EPSILON))
}

/// Returns the position at which a step has to end to resolve the acceleration; none if it does, or cannot be shorter.
/// `order`: number of nodes, or the order of a method without nodes; `nodes`: Legendre coefficients of the acceleration
/// on a collocation step; `part`: fraction to which terms decay; `allowed`: largest error of the acceleration, rad/s².
pub fn unresolved_on(
    motion: &Counted<'_>,
    step: &Step,
    (order, nodes): (usize, Option<&[f64; NODES]>),
    part: f64,
    allowed: f64,
) -> Option<Unresolved> {
    let criterion = NodeCriterion {
        has_interpolant: nodes.is_some(),
        finest: finest(step),
        ..NodeCriterion::at_step([step.start.t, step.end.t], order, part, allowed)
    };
    let way = OnStep {
        motion,
        step,
        nodes,
    };
    unresolved(&way, criterion)
}

impl OnStep<'_> {
    fn time(&self, at: f64) -> f64 {
        self.step.start.t + at * self.step.length()
    }
}

impl ForceAlong for OnStep<'_> {
    fn variation(&self, from: f64, to: f64, ellipse: f64) -> Variation {
        let step = self.step;
        let [begin, end] = [from, to].map(|at| self.time(at));
        let [first, last] = [begin, end].map(|t| step.at(t));
        let aside = 0.5 * (end - begin);
        let ends = Interval::between(first.1, last.1);
        // Between the ends the speed deviates from a straight line by less than the change of its slope allows.
        let speed = match self.nodes {
            Some(coefficients) => {
                let bend = legendre_change(coefficients, to - from);
                let [slope] = legendre_series(coefficients, [from + to - 1.0]);
                let is_monotone = slope.abs() > bend;
                ends.widened(if is_monotone { 0.0 } else { 0.5 * bend * aside })
            }
            None => ends.widened(0.5 * (step.end.alpha - step.start.alpha).abs() * aside),
        };
        let [start, stop] = [first.0, last.0].map(|theta| step.angle(theta).radians());
        let mut angle = Interval::between(start, stop);
        if speed.contains(0.0) {
            angle = angle.widened(speed.largest() * aside);
        }
        let t = Interval::new(begin, end);
        self.motion
            .variation(&MotionPiece { t, angle, speed }, ellipse)
    }

    fn corner(&self, from: f64, to: f64) -> Option<f64> {
        let step = self.step;
        let [begin, end] = [from, to].map(|at| self.time(at));
        let [first, last] = [begin, end].map(|t| step.angle(step.at(t).0).radians());
        let corner = self.motion.corner_on_way(first, last)?;
        let t = step.time_of_angle(corner - step.angle(0.0).radians(), begin, end)?;
        Some((t - step.start.t) / step.length())
    }

    fn turn(&self, from: f64, to: f64) -> Option<f64> {
        root::bracketed(|at| self.step.at(self.time(at)).1, from, to)
    }

    fn force(&self, at: f64) -> f64 {
        let t = self.time(at);
        let (theta, omega) = self.step.at(t);
        self.motion.acceleration(t, self.step.angle(theta), omega)
    }

    fn missed(&self, at: &mut [f64]) {
        let Some(coefficients) = self.nodes else {
            return at.fill(0.0);
        };
        // A batch takes the time of about half as many single evaluations.
        if 2 * at.len() < NODES {
            for at in at {
                let [shown] = legendre_series(coefficients, [2.0 * *at - 1.0]);
                *at = self.force(*at) - shown;
            }
            return;
        }
        for some in at.chunks_mut(NODES) {
            let places: [f64; NODES] = std::array::from_fn(|i| some[i.min(some.len() - 1)]);
            let mut batch = Batch {
                turns: self.step.turns,
                t: places.map(|at| self.time(at)),
                ..Batch::default()
            };
            for i in 0..NODES {
                (batch.theta[i], batch.omega[i]) = self.step.at(batch.t[i]);
            }
            batch.of_time = self.motion.of_times(&batch.t);
            self.motion.fill(&mut batch);
            let shown = legendre_series(coefficients, places.map(|at| 2.0 * at - 1.0));
            for (i, missed) in some.iter_mut().enumerate() {
                *missed = batch.alpha[i] - shown[i];
            }
        }
    }
}
