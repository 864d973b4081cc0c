//! Contact statistics of a step: time, impulse, force and penetration.

use super::contact_follower::ContactFollower;
use super::journal_record::Tally;
use super::motion::touch;
use crate::engine::contact::{AcceptedStep, Phase, Sample};
use crate::numeric::interpolate::quintic;
use crate::numeric::maximum;

/// Number of intervals at whose ends a step with a large force is sampled.
const PLACES: u32 = 32;

impl<const N: usize> ContactFollower<'_, N> {
    /// Adds time, impulse and peak of the contact force, by Simpson's rule along the quintic of the depth.
    pub(super) fn follow_contact(&mut self, accepted: &mut AcceptedStep<'_, N>) {
        let begin = accepted.start[0];
        let end = self.until(accepted);
        let h = end - begin;
        let tally = match accepted.phase {
            Phase::Flight => return,
            Phase::Release { .. } => Tally {
                touching: h,
                ..Tally::default()
            },
            Phase::Contact { approach } => self.pressed(accepted, approach, h),
            Phase::Link => self.linked(accepted, h),
        };
        self.seen.total.add(&tally);
        self.seen.record.spread(begin, end, &tally);
    }

    /// Returns the statistics of the first `h` seconds of a step in contact.
    fn pressed(&self, accepted: &mut AcceptedStep<'_, N>, approach: f64, h: f64) -> Tally {
        let (length, begin) = (accepted.length(), accepted.start[0]);
        let (before, after) = (&accepted.before, &accepted.after);
        let end = |s: &Sample<N>| {
            let bend = 0.5 * length * length * s.depth_acceleration;
            [length * s.depth_rate, bend]
        };
        let (from, to, deeper) = (end(before), end(after), after.depth - before.depth);
        let begun = before.depth;
        let law = self.model.mechanism.force();
        let at = |u: f64| {
            let [deeper, rate, _] = quintic(from, to, deeper, u);
            let (depth, rate) = (begun + deeper, rate / length);
            let force = law.elastic(depth.max(0.0)) * law.factor(rate, approach).max(0.0);
            (force, depth)
        };
        let part = h / length;
        let (first, middle, last) = (at(0.0), at(0.5 * part), at(part));
        let mut tally = simpson([first.0, middle.0, last.0], h);
        tally.deepest = first.1.max(middle.1).max(last.1);
        // A peak inside the step is sought only where it could be the largest.
        if 1.05 * tally.peak > self.seen.total.peak {
            let places = (0..=PLACES).map(|i| part * f64::from(i) / f64::from(PLACES));
            let top = |value: &dyn Fn(f64) -> f64| {
                let known: Vec<_> = places.clone().map(|u| (u, value(u))).collect();
                maximum::beside_best(value, &known)
            };
            let (u, force) = top(&|u| at(u).0);
            // The quintic gives the place, the motion the force there.
            let s = self.model.state(&accepted.at(begin + u * length));
            let phase = Phase::Contact { approach };
            let moved = self.model.mechanism.rates(&s, touch(phase, None)).normal;
            tally.peak = tally
                .peak
                .max(if moved.is_finite() { moved } else { force });
            tally.deepest = tally.deepest.max(top(&|u| at(u).1).1);
        }
        tally
    }

    fn linked(&self, accepted: &mut AcceptedStep<'_, N>, h: f64) -> Tally {
        let t = accepted.start[0];
        let force = [0.0, 0.5, 1.0].map(|u| {
            let s = self.model.state(&accepted.at(t + u * h));
            let rates = self.model.mechanism.rates(&s, touch(Phase::Link, None));
            rates.normal
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
