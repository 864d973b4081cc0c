//! Likelihood by all samples of a long record, to refine a noise that was estimated from stretches: variations slower
//! than a stretch show only in the whole. Filters of several noises run side by side along the record.

use super::grid::Path;
use super::kalman::{self, Evidence, Gaussian};
use super::likelihood::Linear;
use super::linearised::Motion;
use super::maximum::{better, vertex};
use super::problem::{NODES_OF_A_THREAD, Problem};
use super::scales::{Noise, Scales};
use super::state_space::with_dimension;
use crate::numeric::parallel;

/// Maximum number of rounds that look beyond the corner frequencies already tried.
const CORNER_ROUNDS: usize = 6;

impl Problem<'_> {
    /// Returns the noise with the likeliest corner frequency by all samples about a whole path, from a first noise.
    pub fn by_all_samples(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        scales: Scales,
        first: &Noise,
    ) -> Noise {
        let linear = Linear {
            stretches: &[],
            prior: motion.prior,
            scales,
        };
        let [lowest, highest] = scales.corners().map(f64::ln);
        let (mut middle, mut step) = (first.corner.ln(), 1.0);
        let mut likeliest = *first;
        for _ in 0..CORNER_ROUNDS {
            let logs = [-step, 0.0, step].map(|off| (middle + off).clamp(lowest, highest));
            let noises = logs.map(|log| Noise {
                corner: log.exp(),
                likelihood: f64::NEG_INFINITY,
                ..*first
            });
            let evidences = self.evidences(motion, path, &linear, &noises);
            let [a, b, c] = [0, 1, 2].map(|k| linear.judged(noises[k], &evidences[k], 1));
            let best = better(better(b, a), c);
            likeliest = best;
            if best.corner == lowest.exp() || best.corner == highest.exp() {
                return best;
            }
            if best.corner == b.corner && step == 1.0 {
                let point = |noise: Noise| (noise.corner.ln(), noise.likelihood);
                let corner = vertex(point(a), point(b), point(c)).place.exp();
                return Noise { corner, ..b };
            }
            step = if best.corner == b.corner {
                1.0
            } else {
                2.0 * step
            };
            middle = best.corner.ln();
        }
        likeliest
    }

    /// Computes the likelihood terms of several noises.
    fn evidences(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        linear: &Linear<'_>,
        noises: &[Noise],
    ) -> Vec<Evidence> {
        let correlated = noises.iter().any(|noise| noise.correlated.is_some());
        let states = motion.prior.states() + usize::from(correlated);
        with_dimension!(states, N => self.filtered::<N>(motion, path, linear, noises))
    }

    fn filtered<const N: usize>(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        linear: &Linear<'_>,
        noises: &[Noise],
    ) -> Vec<Evidence> {
        let last = self.grid.len() - 1;
        let firsts: Vec<usize> = (0..last).step_by(NODES_OF_A_THREAD).collect();
        let mut filters: Vec<(Option<Gaussian<N>>, Evidence)> =
            vec![Default::default(); noises.len()];
        for some in firsts.chunks(noises.len()) {
            // Each stretch begins at the node where the preceding one ends.
            let stretches = parallel::map(some.iter(), |first| {
                let range = *first..last.min(first + NODES_OF_A_THREAD) + 1;
                self.stretch(motion, path, range, noises[0].sigma)
            });
            filters = parallel::map(
                filters.into_iter().zip(noises),
                |((now, mut evidence), noise)| {
                    let now = stretches.iter().fold(now, |now, stretch| {
                        let model = linear.deviations(stretch, noise);
                        Some(kalman::run::<N>(&model, now, &mut evidence))
                    });
                    (now, evidence)
                },
            );
        }
        filters.into_iter().map(|(_, evidence)| evidence).collect()
    }
}
