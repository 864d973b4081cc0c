//! What the numbers of tones beside a linear model do to its steps and samples: regression effects of the augmented Kalman filter (de
//! Jong, Ann. Statist. 19 (1991) 1073).

use std::ops::Range;

use super::super::model::prior::{Prior, State, Unknown};
use super::super::model::regressors::Regressors;
use super::super::model::tone::{Carrier, Tone};
use super::super::problem::Problem;
use crate::numeric::gauss::LOBATTO;
use crate::numeric::hermite::cubic;

/// A node of Lobatto's rule in a step.
struct Place {
    /// Time, s.
    t: f64,
    /// What a torque of 1 N m there adds to θ, rad, and to ω, rad/s, at the end of the step.
    added: [f64; 2],
}

impl Problem<'_> {
    /// Returns the regressors of tones along states at some nodes.
    pub fn regressors(
        &self,
        tones: &[Tone],
        prior: Prior,
        nodes: Range<usize>,
        states: &[State],
    ) -> Regressors {
        let tones = Vec::from_iter(tones.iter().filter(|tone| tone.is_beside(prior)));
        let mut found = Regressors {
            count: 3 * tones.len(),
            log_unit: tones.iter().map(|tone| tone.log_unit).sum(),
            ..Regressors::default()
        };
        if tones.is_empty() {
            return found;
        }
        let times = self.grid.times[nodes.clone()].windows(2);
        for (times, ends) in times.zip(states.windows(2)) {
            let places = self.places([times[0], times[1]], [ends[0], ends[1]]);
            let of = |tone: &&Tone| match tone.carrier {
                Carrier::Torque => tone.added(&places),
                Carrier::Sensor => [[0.0; 2]; 3],
            };
            found.steps.extend(tones.iter().flat_map(of));
        }
        for sample in &self.grid.first[nodes] {
            let of = |tone: &&Tone| match tone.carrier {
                Carrier::Sensor if *sample < self.record.times.len() => {
                    let [a, b] = self.record.times_of(*sample).map(|t| tone.slopes(t));
                    [0, 1, 2].map(|k| 0.5 * (a[k] + b[k]))
                }
                _ => [0.0; 3],
            };
            found.samples.extend(tones.iter().flat_map(of));
        }
        found
    }

    /// The places of Lobatto's rule between two times.
    fn places(&self, times: [f64; 2], states: [State; 2]) -> [Place; 4] {
        let h = times[1] - times[0];
        let ends = states.map(|[theta, omega, ..]| [theta, omega]);
        let rule = [(0.0, 1.0), (LOBATTO[0], 5.0), (LOBATTO[1], 5.0), (1.0, 1.0)];
        rule.map(|(part, weight)| {
            let [theta, _] = cubic([0.0, h], ends, part * h);
            let speed = weight * h / 12.0 / self.equation.terms(theta).m;
            Place {
                t: times[0] + part * h,
                added: [speed * h * (1.0 - part), speed],
            }
        })
    }
}

impl Tone {
    /// Whether it is beside a prior: the motion without mechanics has the torques in it.
    pub fn is_beside(&self, prior: Prior) -> bool {
        self.carrier == Carrier::Sensor || prior.unknown != Unknown::Acceleration
    }

    /// Returns what its a, b and ω add to θ and ω of the crank in a step.
    fn added(&self, places: &[Place]) -> [[f64; 2]; 3] {
        let mut sums = [[0.0; 2]; 3];
        for Place { t, added } in places {
            for (sum, slope) in sums.iter_mut().zip(self.slopes(*t)) {
                *sum = [0, 1].map(|k| sum[k] + added[k] * slope);
            }
        }
        sums
    }
}
