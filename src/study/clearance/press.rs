//! What the contact does during a step.

use super::follow::Follow;
use super::motion::touch;
use super::record::{Tally, quintic};
use crate::engine::contact::{Phase, Sample, Stretch};

impl<const N: usize> Follow<'_, N> {
    /// Time, impulse and peak of the contact force, by Simpson's rule along the depth's quintic.
    pub(super) fn follow_contact(&mut self, stretch: &mut Stretch<'_, N>) {
        let h = stretch.length();
        let middle = stretch.start[0] + 0.5 * h;
        let tally = match stretch.phase {
            Phase::Flight => return,
            Phase::Release { .. } => Tally {
                touching: h,
                ..Tally::default()
            },
            Phase::Contact { approach } => self.pressed(stretch, approach),
            Phase::Link => self.linked(stretch),
        };
        self.seen.total.add(&tally);
        self.seen.record.tally(middle, &tally);
    }

    fn pressed(&self, stretch: &Stretch<'_, N>, approach: f64) -> Tally {
        let h = stretch.length();
        let end = |s: &Sample<N>| [s.depth, s.depth_rate, s.depth_acceleration];
        let (from, to) = (end(&stretch.before), end(&stretch.after));
        let law = self.model.mechanism.force();
        let at = |u: f64| {
            let (depth, rate) = quintic(from, to, h, u);
            let force = law.elastic(depth.max(0.0)) * law.factor(rate, approach).max(0.0);
            (force, depth)
        };
        let (first, middle, last) = (at(0.0), at(0.5), at(1.0));
        let mut tally = simpson([first.0, middle.0, last.0], h);
        tally.deepest = first.1.max(middle.1).max(last.1);
        // A peak between is looked for only where it would count.
        if 1.05 * tally.peak > self.seen.total.peak {
            for i in 1..32 {
                let (force, depth) = at(f64::from(i) / 32.0);
                tally.peak = tally.peak.max(force);
                tally.deepest = tally.deepest.max(depth);
            }
        }
        tally
    }

    fn linked(&self, stretch: &mut Stretch<'_, N>) -> Tally {
        let h = stretch.length();
        let t = stretch.start[0];
        let force = [0.0, 0.5, 1.0].map(|u| {
            let s = self.model.state(&stretch.at(t + u * h));
            self.model
                .mechanism
                .rates(&s, touch(Phase::Link, None))
                .normal
        });
        let mut tally = simpson(force.map(f64::abs), h);
        if force[1] < 0.0 {
            tally.drawn = h;
        }
        tally
    }
}

fn simpson([first, middle, last]: [f64; 3], h: f64) -> Tally {
    Tally {
        touching: h,
        impulse: h / 6.0 * (first + 4.0 * middle + last),
        squared: h / 6.0 * (first * first + 4.0 * middle * middle + last * last),
        peak: first.max(middle).max(last),
        ..Tally::default()
    }
}
