//! Multiple-hypothesis tracking (Reid 1979): paths through samples that may stand for several crank angles, each
//! followed by an extended Kalman filter whose angular acceleration, or torque in the equation of motion, is a Wiener process; the
//! likelier ones are kept.

use std::f64::consts::{LN_2, TAU};
use std::ops::Range;

use super::super::grid::NODE_ROTATION;
use super::super::measurement_model::Sensor;
use super::super::model::kalman::{Gaussian, Step};
use super::super::model::linearised::Motion;
use super::super::model::matrix::diagonal;
use super::super::model::prior::{KINEMATIC, Prior, TORQUE, plain_state};
use super::super::model::transition::transition;
use super::super::residual_tests::repeats;
use super::hypothesis::{
    DROPPED_LOG_RATIO, FAR, Hypothesis, Link, Sight, Track, is_resolved, prune, way,
};
use super::mirror_image::DISTINCT_ROTATION;
use crate::mechanism::Equation;

/// Noise parameters of a tracker: sample noise and agility of the crank.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Setting {
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// Spectral density of the jerk of the crank angle by what is unknown, rad²/s⁵.
    pub jerk: f64,
    /// Prior of what is unknown.
    pub prior: Prior,
}

/// Tracker of hypotheses through samples.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Tracker<'a, 's> {
    pub sensor: &'a Sensor<'s>,
    pub times: &'a [f64],
    pub values: &'a [f64],
    /// Typical speed of the crank, rad/s.
    pub speed: f64,
    pub equation: &'a Equation,
    /// Mean inertia over a turn, kg m².
    pub inertia: f64,
    /// Time of the scene at time 0 of the samples, s.
    pub origin: f64,
}

impl Tracker<'_, '_> {
    /// Returns the settings that are tried: noise levels, at least the resolution (rad or m), by agilities.
    pub fn settings(&self, resolution: f64) -> Vec<Setting> {
        let size = self.sensor.size();
        let noises = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1].map(|part| (part * size).max(resolution));
        let agilities = [1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0];
        let mut list = Vec::new();
        for prior in [KINEMATIC, TORQUE] {
            for sigma in noises {
                list.extend(agilities.map(|agility| Setting {
                    sigma,
                    jerk: agility * agility * self.speed.powi(5),
                    prior,
                }));
            }
        }
        list
    }

    /// Returns the links of all hypotheses, and the tracks of those left at the end and of those that differ from one of them only
    /// before they came to the same state, the likeliest first.
    pub fn tracks(&self, setting: &Setting) -> (Vec<Link>, Vec<Track>) {
        let mut links = Vec::with_capacity(2 * self.values.len());
        let ends = self.run(setting, &mut links);
        let mut found = Vec::new();
        for Hypothesis { score, last, .. } in ends {
            let whole = Track {
                score,
                is_far: true,
                last,
                after: 0,
                before: last,
            };
            found.push(whole);
            for (after, link) in way(&links, last).enumerate() {
                let near = links[link]
                    .rival
                    .filter(|rival| rival.loss < DROPPED_LOG_RATIO);
                let rival = near.and_then(|rival| {
                    let ways = [link, rival.last].map(|last| way(&links, last));
                    Some(Track {
                        score: score - rival.loss,
                        is_far: self.are_far(setting.sigma, &links, ways)?,
                        after,
                        before: rival.last,
                        ..whole
                    })
                });
                found.extend(rival);
            }
        }
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        (links, found)
    }

    /// Returns whether two ways to one state are far apart before it; none if they do not show different motions.
    fn are_far(
        &self,
        sigma: f64,
        links: &[Link],
        [a, b]: [impl Iterator<Item = usize>; 2],
    ) -> Option<bool> {
        let apart = a.zip(b).take_while(|(a, b)| a != b);
        let angles = apart.map(|(a, b)| [a, b].map(|link| links[link].theta));
        let mut told = angles
            .filter(|angles| self.differ(sigma, *angles))
            .peekable();
        told.peek()?;
        Some(told.any(|[a, b]| (a - b).abs() > DISTINCT_ROTATION))
    }

    /// True if a sample with this noise, rad or m, tells two crank angles apart, rad.
    fn differ(&self, sigma: f64, angles: [f64; 2]) -> bool {
        let off = (angles[0] - angles[1]).powi(2);
        let variance = |theta: f64| self.sight(theta, 0.0, sigma).variance;
        off > 0.0 && off > FAR * FAR * (variance(angles[0]) + variance(angles[1]))
    }

    /// True if two paths show the same motion by samples with this noise, rad or m, whatever the turn in which it begins.
    pub fn agree(&self, sigma: f64, a: &[f64], b: &[f64]) -> bool {
        let turns = ((a[0] - b[0]) / TAU).round() * TAU;
        let mut pairs = a.iter().zip(b);
        !pairs.any(|(a, b)| self.differ(sigma, [*a, b + turns]))
    }

    /// Returns the tracker of a part of the samples.
    pub fn part(&self, samples: Range<usize>) -> Self {
        Tracker {
            times: &self.times[samples.clone()],
            values: &self.values[samples],
            ..*self
        }
    }

    /// Returns ln of the likelihood of the likeliest hypothesis that the samples resolve.
    pub fn score(&self, setting: &Setting) -> f64 {
        let mut links = Vec::with_capacity(2 * self.values.len());
        let ends = self.run(setting, &mut links);
        let angles = |last| Vec::from_iter(way(&links, last).map(|link| links[link].theta));
        let told = ends.iter().find(|end| is_resolved(&angles(end.last)));
        told.map_or(f64::NEG_INFINITY, |end| end.score)
    }

    fn run(&self, setting: &Setting, links: &mut Vec<Link>) -> Vec<Hypothesis> {
        let mut now: Vec<Hypothesis> = Vec::new();
        let mut next: Vec<Hypothesis> = Vec::new();
        for i in 0..self.values.len() {
            next.clear();
            let sighted = self.sighted(i, setting.sigma);
            let repeated = repeats(self.values, i);
            let begins = repeated && !repeats(self.values, i - 1);
            if i == 0 {
                let begin = |sight| self.begun(sight).push(None, links, &mut next);
                sighted.iter().for_each(begin);
            } else {
                for before in &now {
                    let predicted = self.predicted(i, before, setting);
                    let goes_on = repeated && before.held;
                    // The sensor may hold the value while the crank goes on, as likely as not.
                    if begins || goes_on {
                        predicted.held(if begins { LN_2 } else { 0.0 }, links, &mut next);
                    }
                    let seen = sighted.iter().filter(|_| !goes_on);
                    seen.for_each(|sight| predicted.extend(sight, repeated, links, &mut next));
                }
            }
            prune(&mut next, links);
            std::mem::swap(&mut now, &mut next);
        }
        now
    }

    /// Returns a hypothesis at a sample, before that is seen: by the equation of motion in steps that are short enough, or without
    /// where θ is not known well enough for a linear one, or passes half a turn.
    fn predicted(&self, sample: usize, before: &Hypothesis, setting: &Setting) -> Hypothesis {
        let [t, end] = [sample - 1, sample].map(|i| self.times[i]);
        let way = ((end - t) * before.state.mean[1]).abs();
        let is_known = before.state.covariance[0][0] < DISTINCT_ROTATION * DISTINCT_ROTATION;
        let follows = setting.prior != KINEMATIC && is_known && way < 0.5 * TAU;
        let parts = match follows {
            true => (way / NODE_ROTATION[0]).ceil().max(1.0) as usize,
            false => 1,
        };
        let h = (end - t) / parts as f64;
        let state = (0..parts).fold(before.state, |now, part| {
            let mean = follows.then_some(&now.mean);
            let by_equation =
                mean.and_then(|mean| self.step([t + h * part as f64, h], mean, setting.jerk));
            now.predicted(&by_equation.unwrap_or_else(|| step(h, setting.jerk, 1.0)))
        });
        Hypothesis { state, ..*before }
    }

    /// Returns the transition from a time by another, s, by the equation of motion, from a state of θ, rad, ω, rad/s, and the
    /// acceleration of the mean inertia by the torque, rad/s²; none where that has no acceleration.
    fn step(&self, [t, h]: [f64; 2], from: &[f64; 3], jerk: f64) -> Option<Step<3>> {
        let motion = Motion {
            equation: self.equation,
            prior: TORQUE,
            origin: self.origin,
            tones: &[],
        };
        let [theta, omega, share] = *from;
        let torque = self.inertia * share;
        let rates = motion.rates(t, &plain_state([theta, omega, torque]));
        let at = |part: f64, alpha: f64| {
            let h = part * h;
            let [turned, faster] = [theta + h * (omega + 0.5 * h * alpha), omega + h * alpha];
            motion.acceleration(t + h, turned, faster, torque)[0]
        };
        // Simpson's rule.
        let middle = at(0.5, rates.alpha);
        let last = at(1.0, middle);
        let after = [
            theta + h * (omega + h * (rates.alpha + 2.0 * middle) / 6.0),
            omega + h * (rates.alpha + 4.0 * middle + last) / 6.0,
            share,
        ];
        let lever = self.inertia * rates.by_unknown;
        let slopes = [rates.by_theta, rates.by_omega, lever];
        let [first, second] = transition(h, slopes, [0.0; 3]);
        let mut found = step(h, jerk, lever);
        found.transition = [
            [first[0], first[1], first[2]],
            [second[0], second[1], second[2]],
            [0.0, 0.0, 1.0],
        ];
        let linear = |row: &[f64; 3]| (0..3).map(|k| row[k] * from[k]).sum::<f64>();
        found.offset = std::array::from_fn(|i| after[i] - linear(&found.transition[i]));
        let entries = found.transition.iter().chain([&found.offset]).flatten();
        entries
            .chain(found.noise.iter().flatten())
            .all(|entry| entry.is_finite())
            .then_some(found)
    }

    /// Returns the crank angles that a sample may stand for.
    fn sighted(&self, sample: usize, sigma: f64) -> Vec<Sight> {
        let value = self.values[sample];
        let (candidates, excess) = self.sensor.angles(value);
        let angles = candidates.angles().iter();
        let sights = angles.map(|theta| self.sight(*theta, excess, sigma));
        sights.filter(|sight| sight.variance.is_finite()).collect()
    }

    /// Returns a crank angle, rad, as the place of a value that exceeds what the mechanism can take.
    fn sight(&self, theta: f64, excess: f64, sigma: f64) -> Sight {
        let shown = self.sensor.shown([theta, 0.0]);
        // At a dead centre the curvature sets the width.
        let steep = shown.slope * shown.slope + shown.curvature.abs() * (sigma + excess);
        Sight {
            theta,
            variance: sigma * sigma / steep,
            score: -0.5 * steep.ln() - 0.5 * (excess / sigma).powi(2).min(50.0),
        }
    }

    fn begun(&self, sight: &Sight) -> Hypothesis {
        let speed = 2.0 * self.speed;
        Hypothesis {
            state: Gaussian {
                mean: [sight.theta, 0.0, 0.0],
                covariance: diagonal([sight.variance, speed * speed, speed.powi(4)]),
            },
            score: sight.score,
            held: false,
            last: 0,
        }
    }
}

/// Returns the transition over a time `dt`, s, in which the angular acceleration is a Wiener process times a lever.
fn step(dt: f64, jerk: f64, lever: f64) -> Step<3> {
    let q = |n: i32, divisor: f64| jerk * dt.powi(n) / divisor;
    let of = |n: i32, divisor: f64| lever * q(n, divisor);
    let both = |n: i32, divisor: f64| lever * of(n, divisor);
    let noise = [
        [both(5, 20.0), both(4, 8.0), of(3, 6.0)],
        [both(4, 8.0), both(3, 3.0), of(2, 2.0)],
        [of(3, 6.0), of(2, 2.0), q(1, 1.0)],
    ];
    Step {
        transition: [[1.0, dt, 0.5 * dt * dt], [0.0, 1.0, dt], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        noise,
    }
}
