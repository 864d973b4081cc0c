//! Loads between the stages of steps of a method that tells nothing about the force between its stages.

use super::{Hidden, Look, Way, hidden};
use crate::engine::step::Step;
use crate::engine::{Counted, Motion};
use crate::numeric::enclosure::{Detail, Interval, Reach};

/// What was proved of the steps ahead.
pub struct Proof<'a> {
    motion: &'a Counted<'a>,
    tolerance: f64,
    /// The order of the method: as many nodes it is worth.
    order: usize,
    /// Where no step hides anything, as long as it is not larger than the parts of this.
    known: Option<Reach>,
    /// Into how many parts it is divided.
    ahead: f64,
}

/// Most steps that are looked at together.
const MOST_AHEAD: f64 = 64.0;

impl<'a> Proof<'a> {
    /// Nothing so far, for a method of some order.
    pub fn new(motion: &'a Counted<'a>, tolerance: f64, order: usize) -> Proof<'a> {
        Proof {
            motion,
            tolerance,
            order,
            known: None,
            ahead: 8.0,
        }
    }

    /// The time at which a step has to end so that it shows the acceleration on it; none if it does, or cannot be shorter.
    pub fn hides(&mut self, step: &Step) -> Option<f64> {
        if !self.motion.has_detail() {
            return None;
        }
        let way = OnStep {
            motion: self.motion,
            step,
        };
        let reach = way.reach(0.0, 1.0);
        if self.known.is_some_and(|known| known.holds(&reach)) {
            return None;
        }
        let h = step.length();
        let allowed = self.tolerance * (1.0 + step.start.omega.abs()) / h;
        let times = [step.start.t, step.end.t];
        let look = Look::at_step(times, self.order, self.tolerance, allowed);
        let ahead = reach.ahead(self.ahead);
        if look.shows(|ellipse| self.motion.detail(&ahead, ellipse)) {
            self.known = Some(ahead);
            self.ahead = (2.0 * self.ahead).min(MOST_AHEAD);
            return None;
        }
        self.ahead = (0.5 * self.ahead).max(2.0);
        let Hidden { at, .. } = hidden(&way, look)?;
        Some(step.start.t + at * h)
    }
}

/// The first corner of the acceleration that is known to be in a part of a step.
pub fn corner_on_step(motion: &dyn Motion, step: &Step, from: f64, to: f64) -> Option<f64> {
    let [begin, end] = [from, to].map(|at| step.start.t + at * step.length());
    let [first, last] = [begin, end].map(|t| step.angle(step.at(t).0).radians());
    let corner = motion.corner_on_way(first, last)?;
    let t = step.time_of_angle(corner - step.angle(0.0).radians(), begin, end)?;
    Some((t - step.start.t) / step.length())
}

/// The motion on a step.
struct OnStep<'a> {
    motion: &'a Counted<'a>,
    step: &'a Step,
}

impl Way for OnStep<'_> {
    type Part = Reach;

    fn reach(&self, from: f64, to: f64) -> Reach {
        let step = self.step;
        let time = |at: f64| step.start.t + at * step.length();
        let [begin, end] = [from, to].map(time);
        let [first, last] = [begin, end].map(|t| step.at(t));
        // Between them the speed is off a straight line by less than the change of its slope makes.
        let bent = (step.end.alpha - step.start.alpha).abs() * 0.25 * (end - begin);
        let speed = Interval::between(first.1, last.1).widened(bent);
        let [start, stop] = [first.0, last.0].map(|theta| step.angle(theta).radians());
        let mut angle = Interval::between(start, stop);
        if speed.contains(0.0) {
            angle = angle.widened(0.5 * speed.largest() * (end - begin));
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

    fn missed(&self, _at: f64) -> f64 {
        0.0
    }

    fn detail(&self, reach: &Reach, ellipse: f64) -> Detail {
        self.motion.detail(reach, ellipse)
    }
}
