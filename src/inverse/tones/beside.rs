//! A motion beside tones, and the one that it has if a tone is of the other carrier.

use super::super::model::tone::{Carrier, Tone};
use super::super::motion_estimate::MotionEstimate;
use super::super::problem::Problem;
use super::super::selection;
use super::super::smoother::Smoothed;
use crate::numeric::student;

/// A record beside its tones, with its motion without mechanics and the likeliest one.
pub(in crate::inverse) struct BesideTones<'a> {
    pub problem: Problem<'a>,
    pub kinematic: Smoothed,
    pub smoothed: Smoothed,
    /// The likeliest motion if a tone is of the other carrier: that of the tone with the least odds.
    pub rival: Option<Less<'a>>,
}

/// A less probable motion.
pub(in crate::inverse) struct Less<'a> {
    pub motion: Box<BesideTones<'a>>,
    /// ln of the odds of the likelier one to it.
    pub log_odds: f64,
}

impl BesideTones<'_> {
    pub fn likelihood(&self) -> f64 {
        self.smoothed.noise.likelihood
    }

    /// Returns ln of its probability up to a constant: a tone of the sensor has the scale of the noise, one of the torque that of
    /// the torque of the motion.
    pub fn log_probability(&self) -> f64 {
        let prior = |tone: &Tone| match tone.carrier {
            Carrier::Sensor => tone.log_prior(self.smoothed.noise.sigma),
            Carrier::Torque => tone.log_prior(self.problem.accelerating_torque(&self.smoothed)),
        };
        let last = self.problem.record.tones.last();
        // A motion that is not finite has none.
        f64::NEG_INFINITY.max(self.likelihood() + last.map_or(0.0, prior))
    }

    /// Takes the motion of the rival at times, s, if this one alone has less than 95 % of the probability, with ln of the odds to it,
    /// at most those of a motion at the end of a 95 % band: a band of both reaches it.
    pub fn take_rival(&mut self, times: &[f64]) -> Option<(Vec<MotionEstimate>, f64)> {
        let Less { motion, log_odds } = self.rival.take()?;
        selection::counts(log_odds).then(|| {
            let smoothed = motion.problem.averaged(motion.smoothed);
            let reach = student::half_band(f64::INFINITY);
            let log_odds = log_odds.min((reach * reach - 1.0).ln());
            (motion.problem.motion_at(&smoothed, times), log_odds)
        })
    }
}
