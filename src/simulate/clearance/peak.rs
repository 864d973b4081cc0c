//! Largest joint forces of a run with a loose joint, step by step: impacts are too short for rows.

use super::super::joint_force_maxima::sizes;
use super::super::result::{FORCES, Peak};
use super::contact_follower::ContactFollower;
use super::motion::touch;
use crate::engine::PIECES;
use crate::engine::contact::{AcceptedStep, Phase};
use crate::numeric::maximum;

/// Part of the largest force up to now from which a force may exceed it between the samples of a step.
const NEAR_LARGEST: f64 = 0.9;

impl<const N: usize> ContactFollower<'_, N> {
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
            sizes(&reactor.loose(mechanism.joint(), &s, &rates))
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
        let mut peaks = self.seen.peaks.unwrap_or_default();
        for (k, peak) in peaks.iter_mut().enumerate() {
            let known = found.map(|(t, sizes)| (t, sizes[k]));
            let seen = known
                .iter()
                .fold(0.0, |seen: f64, (_, size)| seen.max(*size));
            if seen <= NEAR_LARGEST * peak.value_n {
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
        self.seen.peaks = Some(peaks);
    }
}
