//! Likelihood by all samples of a long record, to refine a noise that was estimated from stretches: variations slower
//! than a stretch show only in the whole. Filters of several noises run side by side along the record.

use std::iter;

use super::candidates::Candidate;
use super::grid::Path;
use super::likelihood::Linear;
use super::linear_smoother::NODES_OF_A_THREAD;
use super::maximum::{ENOUGH_RISE, better, vertex};
use super::model::kalman::{self, Evidence, Gaussian};
use super::model::state_space::with_dimension;
use super::problem::Problem;
use super::scales::Noise;
use crate::numeric::parallel;

/// Maximum number of rounds that look beyond the corner frequencies already tried.
const CORNER_ROUNDS: usize = 6;

impl Problem<'_> {
    /// Returns the noise with the likeliest corner frequency by all samples about a whole path, from a first noise.
    pub fn by_all_samples(&self, path: &Path, first: &Candidate) -> Noise {
        let scales = first.scales;
        let linear = Linear::of(first.prior.beside_known(), scales);
        let first = first.noise;
        let states = linear.prior.states() + usize::from(first.correlated.is_some());
        let [lowest, highest] = scales.corners().map(f64::ln);
        let judged_at = |logs: &[f64]| -> Vec<Noise> {
            let noise = |log: &f64| Noise {
                corner: log.clamp(lowest, highest).exp(),
                ..first
            };
            let noises: Vec<Noise> = logs.iter().map(noise).collect();
            let evidences =
                with_dimension!(states, N => self.filtered::<N>(path, &linear, &noises));
            let pairs = noises.iter().zip(&evidences);
            pairs.map(|(n, e)| linear.judged(*n, e, 1)).collect()
        };
        // A stretch does not show at all what is slower than itself.
        let part = self.grid.len() as f64 / self.sampled()[0].len() as f64;
        let slow: Vec<f64> = iter::successors(Some(lowest), |log| Some(log + 1.0))
            .take_while(|log| *log <= (part / scales.duration).ln() + 2.0)
            .collect();
        let mut likeliest = match slow.last() {
            Some(last) if first.corner < last.exp() => {
                judged_at(&slow).into_iter().reduce(better).unwrap_or(first)
            }
            _ => first,
        };
        for _ in 0..CORNER_ROUNDS {
            let middle = likeliest.corner.ln();
            let judged = judged_at(&[-2.0, -1.0, 0.0, 1.0, 2.0].map(|off| middle + off));
            likeliest = judged.iter().copied().fold(judged[2], better);
            if likeliest.corner == lowest.exp() || likeliest.corner == highest.exp() {
                return likeliest;
            }
            let inner = judged.windows(3).find(|w| w[1].corner == likeliest.corner);
            if let Some([a, b, c]) = inner.and_then(|w| w.first_chunk()) {
                let point = |noise: &Noise| (noise.corner.ln(), noise.likelihood);
                let corner = vertex(point(a), point(b), point(c)).place.exp();
                return Noise { corner, ..*b };
            }
            // At the edge of what was tried: further out the likelihood gains nothing.
            if likeliest.likelihood < judged[1].likelihood.max(judged[3].likelihood) + ENOUGH_RISE {
                return likeliest;
            }
        }
        likeliest
    }

    /// Computes the likelihood terms of several noises.
    fn filtered<const N: usize>(
        &self,
        path: &Path,
        linear: &Linear,
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
                self.stretch(linear.prior, path, range, noises[0].sigma)
            });
            filters = parallel::map(
                filters.into_iter().zip(noises),
                |((now, mut evidence), noise)| {
                    let now = stretches.iter().fold(now, |now, stretch| {
                        let model = linear.deviations(stretch, noise);
                        Some(kalman::run::<N>(&model, now, |_, at| evidence.add(at)))
                    });
                    (now, evidence)
                },
            );
        }
        filters.into_iter().map(|(_, evidence)| evidence).collect()
    }
}
