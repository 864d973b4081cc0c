//! Contact statistics and largest joint forces of a step: impacts are too short for rows.

use super::super::joint_force_maxima::sizes;
use super::super::result::{FORCES, Peak};
use super::contact_follower::ContactFollower;
use super::journal_record::Tally;
use super::motion::touch;
use crate::engine::PIECES;
use crate::engine::contact::{AcceptedStep, Phase, Sample};
use crate::numeric::hermite::Quintic;
use crate::numeric::{gauss, maximum, root};

impl<const N: usize> ContactFollower<'_, N> {
    /// Adds time, impulse and peak of the contact force.
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
        self.total.add(&tally);
        self.journal.spread(begin, end, &tally);
    }

    /// Returns the statistics of the first `h` seconds of a step in contact: by Gauss's rule along the quintic of the
    /// depth, over the square root of a depth that changes evenly, in which the force is smooth.
    fn pressed(&self, accepted: &mut AcceptedStep<'_, N>, approach: f64, h: f64) -> Tally {
        let (length, begin) = (accepted.length(), accepted.start[0]);
        let (before, after) = (accepted.before, accepted.after);
        let end = |s: &Sample<N>| {
            let bend = 0.5 * length * length * s.depth_acceleration;
            [length * s.depth_rate, bend]
        };
        let along = Quintic::new(end(&before), end(&after), after.depth - before.depth);
        let law = self.model.mechanism.force;
        let depth = |u: f64| {
            let [deeper, rate, bend] = along.at(u);
            let (rate, bend) = (rate / length, bend / (length * length));
            [(before.depth + deeper).max(0.0), rate, bend]
        };
        let at = |u: f64| {
            let [depth, rate, _] = depth(u);
            (
                law.elastic(depth) * law.factor(rate, approach).max(0.0),
                depth,
            )
        };
        let part = h / length;
        let [first, last] = [at(0.0), at(part)];
        let mut tally = Tally {
            touching: h,
            peak: first.0.max(last.0),
            deepest: first.1.max(last.1),
            ..Tally::default()
        };
        let [from, to] = [first.1, last.1].map(f64::sqrt);
        for (w, weight) in *gauss::RULE_6 {
            let root = from + (to - from) * w;
            let (u, rate) = match from + to > 0.0 {
                true => (w * (from + root) / (from + to), 2.0 * root / (from + to)),
                false => (w, 1.0),
            };
            let (force, _) = at(part * u);
            tally.impulse += h * weight * rate * force;
            tally.squared += h * weight * rate * force * force;
        }
        // A maximum inside the step lies where the derivative falls through zero.
        let top = |derivative: &dyn Fn(f64) -> f64| {
            let falls = derivative(0.0) > 0.0 && derivative(part) < 0.0;
            falls
                .then(|| root::bracketed(derivative, 0.0, part))
                .flatten()
        };
        // The quintic gives the place, the motion a value that may be the largest, 5 % above that of the quintic.
        let peak_over_quintic = 1.05;
        if let Some(u) = top(&|u| depth(u)[1]) {
            let mut deepest = at(u).1;
            if peak_over_quintic * deepest > self.total.deepest {
                let s = self.model.state(&accepted.at(begin + u * length));
                deepest = self.model.mechanism.depth(&s).0;
            }
            tally.deepest = tally.deepest.max(deepest);
        }
        if let Some(u) = top(&|u| law.growth(depth(u), approach)) {
            let mut force = at(u).0;
            if peak_over_quintic * force > self.total.peak {
                let s = self.model.state(&accepted.at(begin + u * length));
                let touch = touch(Phase::Contact { approach }, None);
                force = self.model.mechanism.rates(&s, touch).normal;
            }
            tally.peak = tally.peak.max(force);
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
        let [first, middle, last] = force.map(f64::abs);
        Tally {
            touching: h,
            drawn: if force[1] < 0.0 { h } else { 0.0 },
            impulse: h / 6.0 * (first + 4.0 * middle + last),
            squared: h / 6.0 * (first * first + 4.0 * middle * middle + last * last),
            peak: first.max(middle).max(last),
            ..Tally::default()
        }
    }

    /// Returns the sizes of the joint forces in a state of a step, N.
    fn sizes(&self, y: &[f64; N], phase: Phase) -> [f64; FORCES] {
        let mechanism = self.model.mechanism;
        let s = match phase {
            Phase::Link => mechanism.relinked(&self.model.state(y)),
            _ => self.model.state(y),
        };
        let rates = mechanism.rates(&s, touch(phase, None));
        let reactor = self.model.task.maker.reactor.as_ref();
        reactor.map_or([0.0; FORCES], |reactor| {
            sizes(&reactor.loose(mechanism.clearance.joint, &s, &rates))
        })
    }

    /// Updates the largest sizes: over samples of the step, then by Brent's method where one may be exceeded.
    pub(super) fn follow_forces(&mut self, accepted: &mut AcceptedStep<'_, N>) {
        if !self.model.task.options.reactions || self.recorder.is_none() {
            return;
        }
        let phase = accepted.phase;
        let start = accepted.start[0];
        let end = self.until(accepted);
        let places: [f64; PIECES + 1] = std::array::from_fn(|i| match i {
            PIECES => end,
            _ => start + (end - start) * i as f64 / PIECES as f64,
        });
        let found = places.map(|t| (t, self.sizes(&accepted.at(t), phase)));
        let mut peaks = self.peaks.unwrap_or_default();
        for (k, peak) in peaks.iter_mut().enumerate() {
            let known = found.map(|(t, sizes)| (t, sizes[k]));
            let seen = known
                .iter()
                .fold(0.0, |seen: f64, (_, size)| seen.max(*size));
            // Between the samples a force may be about a tenth larger.
            let near_largest = 0.9;
            if seen <= near_largest * peak.value_n {
                continue;
            }
            let size = |t: f64| self.sizes(&accepted.at(t), phase)[k];
            let (t, value) = maximum::beside_best(size, &known);
            if value > peak.value_n {
                let theta = self.model.state(&accepted.at(t)).theta;
                *peak = Peak {
                    value_n: value,
                    t_s: t,
                    theta_rad: self.model.task.angle(theta).radians(),
                    added_n: value - seen,
                };
            }
        }
        self.peaks = Some(peaks);
    }
}
