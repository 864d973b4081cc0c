//! Priors about a smoothed path with the noise that makes the samples likeliest.

use super::likelihood::Linear;
use super::prior::{Candidate, LADDERS, Prior, TORQUE};
use super::problem::Problem;
use super::scales::Noise;
use super::smoother::Smoothed;
use super::state_space::Autoregression;
use crate::numeric::parallel;

/// No instrument tells an angle to the root of the rounding of doubles, rad: a record so exact was computed, and errs smoothly,
/// which a prior of order three would take for force.
const COMPUTED: f64 = 1.5e-8;

impl Problem<'_> {
    /// A prior about a smoothed path with its likeliest noise, from a first one; none where `least` says that it is not worth that.
    fn candidate_from(
        &self,
        prior: Prior,
        from: &Smoothed,
        first: Noise,
        least: f64,
        correlated: &[Autoregression],
    ) -> Option<Candidate> {
        let motion = self.motion(prior);
        let path = self.path_of(prior, from, self.sampled());
        let scales = self.scales(&motion, &path, from.scales.slope, from.scales.motion);
        let stretches = self.stretches(&motion, &path, from.noise.sigma);
        let linear = Linear {
            stretches: &stretches,
            prior,
            scales,
        };
        let first = linear.evaluated(first);
        if first.likelihood < least {
            return None;
        }
        let mut noise = linear.improved(first);
        if !correlated.is_empty() {
            let found = linear.correlated(&noise, correlated);
            // Noise that leaves the path rougher than white noise does is motion.
            let rougher = found.corner > noise.corner;
            noise = if rougher { noise } else { found };
        }
        Some(Candidate {
            prior,
            noise,
            scales,
        })
    }

    /// A prior about a smoothed path.
    pub fn candidate(
        &self,
        prior: Prior,
        from: &Smoothed,
        correlated: &[Autoregression],
    ) -> Candidate {
        let first = Noise::white(from.noise.corner);
        let found = self.candidate_from(prior, from, first, f64::NEG_INFINITY, correlated);
        found.unwrap_or_else(|| unreachable!("any likelihood will do"))
    }

    /// Priors about a path, the likeliest first. The order of each unknown rises as long as its likelihood does.
    pub fn tried(&self, kinematic: &Smoothed, correlated: &[Autoregression]) -> Vec<Candidate> {
        let size = self.record.sensor.size();
        let is_computed = |noise: &Noise| noise.sigma < COMPUTED * size;
        // What repeats is noise that comes down: of what was computed there is none.
        let turns = match is_computed(&kinematic.noise) {
            true => 0.0,
            false => self.turns(kinematic),
        };
        let tried = parallel::map(LADDERS.iter(), |ladder| {
            let mut tried: Vec<Candidate> = Vec::new();
            for prior in *ladder {
                let next = self.candidate(*prior, kinematic, correlated);
                let before = tried
                    .last()
                    .map_or(f64::NEG_INFINITY, |c| c.noise.likelihood);
                let rises = next.noise.likelihood > before;
                let is_computed = is_computed(&next.noise);
                tried.push(next);
                if !rises || is_computed && prior.order == 2 {
                    break;
                }
            }
            tried
        });
        let mut tried: Vec<_> = tried.into_iter().flatten().collect();
        let repeating = self.repeating(turns, &tried, kinematic, correlated);
        tried.extend(repeating);
        tried.sort_by(|a, b| b.noise.likelihood.total_cmp(&a.noise.likelihood));
        tried
    }

    /// Priors with a part that repeats, where that makes the samples likelier than its two parameters cost (Schwarz 1978) beside
    /// the torque as it is without. Not of records so long that stretches stand for them: the columns of each node would take fifty
    /// times the time.
    fn repeating(
        &self,
        turns: f64,
        tried: &[Candidate],
        kinematic: &Smoothed,
        correlated: &[Autoregression],
    ) -> Vec<Candidate> {
        let torque = tried.iter().find(|one| one.prior == TORQUE);
        let Some(Candidate { noise, .. }) = torque.filter(|_| self.sampled() == self.all()) else {
            return Vec::new();
        };
        let least = noise.likelihood + (self.record.times.len() as f64).ln();
        let of_cycle = |cycle: u8| {
            let prior = Prior { cycle, ..TORQUE };
            let first = self.candidate_from(prior, kinematic, *noise, least, correlated)?;
            let prior = Prior { order: 2, ..prior };
            let next = self.candidate_from(prior, kinematic, first.noise, least, correlated);
            Some(std::iter::once(first).chain(next))
        };
        let cycles = [1, 2]
            .into_iter()
            .filter(|cycle| turns >= 2.0 * f64::from(*cycle));
        let found = parallel::map(cycles, of_cycle);
        found.into_iter().flatten().flatten().collect()
    }
}
