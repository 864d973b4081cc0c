//! The likeliest motion beside the tones that the samples show. A tone has three parameters, and is accepted where the likelihood
//! gains more than they cost (Schwarz, Ann. Statist. 6 (1978) 461). Whether the sensor or the torque has it is compared about one motion,
//! as the likelihoods of two differ by what else was found for each: about that without the tone, and about that beside it. The motion of
//! the other carrier is in the band if the likelier one alone has less than 95 % of the probability.

use super::super::mean_length::by_means;
use super::super::model::prior::Prior;
use super::super::model::tone::{Carrier, Tone};
use super::super::motion_estimate::MotionEstimate;
use super::super::problem::Problem;
use super::super::samples::Given;
use super::super::selection;
use super::super::smoother::Smoothed;
use super::search::{Corrected, Rival};

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

    /// Takes the motion of the rival at times, s.
    pub fn take_rival(&mut self, times: &[f64]) -> Option<Vec<MotionEstimate>> {
        let Less { motion, .. } = self.rival.take()?;
        let smoothed = motion.problem.averaged(motion.smoothed);
        Some(motion.problem.motion_at(&smoothed, times))
    }
}

impl<'a> Given<'a> {
    /// The likeliest motion, beside the tones that gain what they cost; the noise is `suspected` to be correlated or not.
    pub fn likeliest(&self, suspected: bool) -> BesideTones<'a> {
        let finer =
            |found: &BesideTones<'_>| found.problem.finer(&found.smoothed, &found.kinematic);
        let of = |most| self.beside(&[], most, None, suspected);
        let (mut best, most) = by_means(self.measurement.len(), of, finer);
        // A bound of the work, for a record of many lines.
        while best.problem.record.tones.len() < 4 {
            let Some(next) = self.with_another_tone(&mut best, most, suspected) else {
                break;
            };
            best = next;
        }
        best
    }

    /// The likeliest motion beside another tone; none if the samples do not tell one that gains what it costs.
    fn with_another_tone(
        &self,
        best: &mut BesideTones<'a>,
        most: usize,
        suspected: bool,
    ) -> Option<BesideTones<'a>> {
        // An encoder errs by no more than a count.
        let carriers = match self.measurement.is_counted() {
            true => &[Carrier::Torque][..],
            false => &[Carrier::Sensor, Carrier::Torque],
        };
        let mut found = best.problem.another_tone(&best.smoothed)?;
        found.retain(|one| carriers.contains(&one.tone.carrier));
        found.sort_by(|a, b| b.log_probability.total_cmp(&a.log_probability));
        let first = found.first()?;
        let other = found.get(1);
        let mut log_odds = other.map_or(f64::INFINITY, |other| first.log_odds_to(other));
        let known = &best.problem.record.tones;
        let near = &best.smoothed;
        let with = |tone| {
            let tones = known.iter().copied().chain([tone]).collect();
            let found = self.refined(tones, most, near, suspected);
            let rival = found.problem.rival(&found.smoothed);
            let rival = rival.filter(|rival| carriers.contains(&rival.tone.carrier));
            (found, rival)
        };
        let (mut next, mut rival) = with(first.tone);
        if let Some(other) = rival.as_ref().filter(|rival| rival.log_odds < 0.0) {
            let swapped = with(other.tone);
            // About its own motion the other has to be likelier, too.
            if swapped.1.as_ref().is_none_or(|back| back.log_odds > 0.0) {
                log_odds = -other.log_odds;
                (next, rival) = swapped;
            }
        }
        if next.likelihood() <= best.likelihood() + best.problem.cost_of_tone() {
            return None;
        }
        // The odds are no larger than each of two comparisons finds.
        let rival = rival.map(|rival| Rival {
            log_odds: rival.log_odds.min(log_odds).max(0.0),
            ..rival
        });
        if let Some(tone) = next.problem.record.tones.last_mut() {
            tone.log_odds = rival.as_ref().map(|rival| rival.log_odds);
        }
        let counting = rival.filter(|rival| selection::counts(rival.log_odds));
        let other = counting.map(|Rival { tone, log_odds }| Less {
            motion: Box::new(with(tone).0),
            log_odds,
        });
        let other = other.filter(|other| other.motion.likelihood().is_finite());
        let rivals = best.rival.take().into_iter().chain(other);
        next.rival = rivals.min_by(|a, b| a.log_odds.total_cmp(&b.log_odds));
        Some(next)
    }

    /// The likeliest motion beside tones that are corrected about it until they come to rest.
    fn refined(
        &self,
        tones: Vec<Tone>,
        most: usize,
        near: &Smoothed,
        suspected: bool,
    ) -> BesideTones<'a> {
        let mut found = self.beside(&tones, most, Some(near), suspected);
        let mut before: Vec<(Prior, f64)> = Vec::new();
        while let Some(Corrected { tones, square, .. }) =
            found.problem.corrected_tones(&found.smoothed)
        {
            // The corrections beside a prior fall (natural monotonicity test); a third of a standard error is little.
            let prior = found.smoothed.prior;
            let falls = before
                .iter()
                .all(|(other, last)| *other != prior || square < *last);
            if square < 1.0 / 9.0 || !falls {
                break;
            }
            before.push((prior, square));
            found = self.beside(&tones, most, Some(&found.smoothed), suspected);
        }
        found
    }

    /// The likeliest motion beside tones, by means of up to so many samples; it is near one beside others.
    fn beside(
        &self,
        tones: &[Tone],
        most: usize,
        near: Option<&Smoothed>,
        suspected: bool,
    ) -> BesideTones<'a> {
        let (mut problem, kinematic) = self.kinematic(tones, most);
        let near = near.filter(|near| near.estimates.len() == problem.grid.len());
        let near = near.map(|near| kinematic.along(near));
        let first = near.as_ref().unwrap_or(&kinematic);
        let smoothed = problem.likeliest_with_intensities(&kinematic, first, suspected);
        BesideTones {
            problem,
            kinematic,
            smoothed,
            rival: None,
        }
    }
}
