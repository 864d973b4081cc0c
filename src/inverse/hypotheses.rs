//! Multiple-hypothesis tracking (Reid 1979): paths through samples that may stand for several crank angles, each
//! followed by a Kalman filter whose angular acceleration is a Wiener process; the likelier ones are kept.

use std::f64::consts::TAU;

use super::kalman::{Gaussian, Sample, Step};
use super::links::{Link, Rival, Track, way};
use super::matrix::diagonal;
use super::measurement_model::Sensor;

/// Noise parameters of a tracker: sample noise and agility of the crank.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setting {
    /// Standard deviation of a sample, rad or m.
    pub sigma: f64,
    /// Spectral density of the jerk of the crank angle, rad²/s⁵.
    pub jerk: f64,
}

/// Hypothesis: a path up to the current sample.
#[derive(Clone, Copy, Debug)]
struct Hypothesis {
    state: Gaussian<3>,
    score: f64,
    /// Index of the last link in the list of all links.
    last: usize,
}

/// Tracker of hypotheses through samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tracker<'a, 's> {
    pub sensor: &'a Sensor<'s>,
    pub times: &'a [f64],
    pub values: &'a [f64],
    /// Typical speed of the crank, rad/s.
    pub speed: f64,
}

/// Standard deviations beyond which a sample shows another motion.
pub(super) const FAR: f64 = 5.0;

/// Maximum number of hypotheses, mirror images among them, and ln of the likelihood ratio to the best beyond which one is dropped.
const MOST_HYPOTHESES: usize = 12;
pub(super) const DROPPED_LOG_RATIO: f64 = 50.0;

impl Tracker<'_, '_> {
    /// Returns the settings that are tried: noise levels, at least the resolution (rad or m), by agilities.
    pub fn settings(&self, resolution: f64) -> Vec<Setting> {
        let size = self.sensor.size();
        let noises = [1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1].map(|part| (part * size).max(resolution));
        let agilities = [1e-2, 1e-1, 1.0, 10.0];
        let mut list = Vec::new();
        for sigma in noises {
            for agility in agilities {
                let jerk = agility * agility * self.speed.powi(5);
                list.push(Setting { sigma, jerk });
            }
        }
        list
    }

    /// Returns the crank angles, rad, of all hypotheses left at the end and of those that differ from one of them only before
    /// they came to the same state, the likeliest first.
    pub fn tracks(&self, setting: &Setting) -> impl Iterator<Item = Vec<f64>> {
        let mut links = Vec::with_capacity(2 * self.values.len());
        let ends = self.run(setting, self.values.len(), &mut links);
        let mut found = Vec::new();
        for Hypothesis { score, last, .. } in ends {
            let whole = Track {
                score,
                last,
                after: 0,
                before: last,
            };
            found.push(whole);
            for (after, link) in way(&links, last).enumerate() {
                let rival = links[link].rival.filter(|rival| {
                    let ways = [link, rival.last].map(|last| way(&links, last));
                    rival.loss < DROPPED_LOG_RATIO && self.part(setting.sigma, &links, ways)
                });
                found.extend(rival.map(|rival| Track {
                    score: score - rival.loss,
                    after,
                    before: rival.last,
                    ..whole
                }));
            }
        }
        found.sort_by(|a, b| b.score.total_cmp(&a.score));
        found.into_iter().map(move |track| {
            let after = way(&links, track.last).take(track.after);
            let mut list: Vec<usize> = after.chain(way(&links, track.before)).collect();
            list.reverse();
            list.into_iter().map(|link| links[link].theta).collect()
        })
    }

    /// True if two ways to one state show different motions before it.
    fn part(&self, sigma: f64, links: &[Link], [a, b]: [impl Iterator<Item = usize>; 2]) -> bool {
        let apart = a.zip(b).take_while(|(a, b)| a != b);
        let mut angles = apart.map(|(a, b)| [a, b].map(|link| links[link].theta));
        angles.any(|angles| self.differ(sigma, angles))
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

    /// Returns ln of the likelihood of the likeliest hypothesis after a number of samples.
    pub fn score(&self, setting: &Setting, samples: usize) -> f64 {
        let ends = self.run(setting, samples, &mut Vec::with_capacity(2 * samples));
        ends.first().map_or(f64::NEG_INFINITY, |end| end.score)
    }

    fn run(&self, setting: &Setting, samples: usize, links: &mut Vec<Link>) -> Vec<Hypothesis> {
        let mut now: Vec<Hypothesis> = Vec::new();
        let mut next: Vec<Hypothesis> = Vec::new();
        for i in 0..samples {
            next.clear();
            let sighted = self.sighted(i, setting.sigma);
            if i == 0 {
                next.extend(sighted.iter().map(|sight| self.begun(sight, links)));
            } else {
                let step = step(self.times[i] - self.times[i - 1], setting.jerk);
                for before in &now {
                    let predicted = Hypothesis {
                        state: before.state.predicted(&step),
                        ..*before
                    };
                    for sight in &sighted {
                        extend(&predicted, sight, links, &mut next);
                    }
                }
            }
            prune(&mut next, links);
            std::mem::swap(&mut now, &mut next);
        }
        now
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

    fn begun(&self, sight: &Sight, links: &mut Vec<Link>) -> Hypothesis {
        links.push(Link {
            theta: sight.theta,
            before: None,
            rival: None,
        });
        let speed = 2.0 * self.speed;
        Hypothesis {
            state: Gaussian {
                mean: [sight.theta, 0.0, 0.0],
                covariance: diagonal([sight.variance, speed * speed, speed.powi(4)]),
            },
            score: sight.score,
            last: links.len() - 1,
        }
    }
}

/// Crank angle, rad, that a sample may stand for.
#[derive(Clone, Copy, Debug)]
struct Sight {
    theta: f64,
    variance: f64,
    /// ln of the density of the measured value, per angle.
    score: f64,
}

/// Returns the transition over a time `dt`, s, in which the angular acceleration is a Wiener process.
fn step(dt: f64, jerk: f64) -> Step<3> {
    let q = |n: i32, divisor: f64| jerk * dt.powi(n) / divisor;
    let noise = [
        [q(5, 20.0), q(4, 8.0), q(3, 6.0)],
        [q(4, 8.0), q(3, 3.0), q(2, 2.0)],
        [q(3, 6.0), q(2, 2.0), q(1, 1.0)],
    ];
    Step {
        transition: [[1.0, dt, 0.5 * dt * dt], [0.0, 1.0, dt], [0.0, 0.0, 1.0]],
        offset: [0.0; 3],
        noise,
    }
}

/// Extends a hypothesis by a sample, in each turn of the crank that is possible.
fn extend(
    predicted: &Hypothesis,
    sight: &Sight,
    links: &mut Vec<Link>,
    list: &mut Vec<Hypothesis>,
) {
    let nearest = ((predicted.state.mean[0] - sight.theta) / TAU).round();
    let spread = predicted.state.covariance[0][0] + sight.variance;
    let reach = if spread.sqrt() > 0.1 * TAU { 1 } else { 0 };
    for turn in -reach..=reach {
        let theta = sight.theta + (nearest + f64::from(turn)) * TAU;
        let mut found = *predicted;
        let seen = found.state.update(&Sample {
            value: theta,
            is_second: false,
            slope: 1.0,
            is_correlated: false,
            variance: sight.variance,
        });
        // Outliers are scored by the tails of Student's distribution with four degrees of freedom.
        let spread = seen.variance;
        let off = seen.error * seen.error / spread;
        let tails = if off < 4.0 {
            0.5 * off
        } else {
            2.0 + 2.5 * (1.0 + (off - 4.0) / 4.0).ln()
        };
        found.score += sight.score - 0.5 * spread.ln() - tails;
        if off > FAR * FAR {
            // An outlier moves the path no further than a sample at this distance.
            let (before, there) = (predicted.state, found.state.mean);
            let part = FAR / off.sqrt();
            let between = |k: usize| before.mean[k] + part * (there[k] - before.mean[k]);
            found.state = Gaussian {
                mean: std::array::from_fn(between),
                ..before
            };
        }
        links.push(Link {
            theta: found.state.mean[0],
            before: Some(predicted.last),
            rival: None,
        });
        found.last = links.len() - 1;
        list.push(found);
    }
}

/// Keeps the likeliest hypotheses, and only the likeliest of those that agree, with its rival.
fn prune(list: &mut Vec<Hypothesis>, links: &mut [Link]) {
    list.sort_by(|a, b| b.score.total_cmp(&a.score));
    let mut kept: usize = 0;
    for k in 0..list.len() {
        let now = list[k];
        let agrees = |other: &&Hypothesis| {
            let off = |i: usize| other.state.mean[i] - now.state.mean[i];
            (0..2).all(|i| off(i).powi(2) < now.state.covariance[i][i])
        };
        if let Some(other) = list[..kept].iter().find(agrees) {
            links[other.last].rival.get_or_insert(Rival {
                last: now.last,
                loss: other.score - now.score,
            });
            continue;
        }
        let keep = now.score >= list[0].score - DROPPED_LOG_RATIO && kept < MOST_HYPOTHESES;
        if keep && now.score.is_finite() {
            list[kept] = now;
            kept += 1;
        }
    }
    list.truncate(kept);
}
