//! Linear smoother about a path, by the models of its stretches or of pieces of a long record side by side.

use std::ops::Range;

use super::estimate::Estimate;
use super::fixed_interval;
use super::grid::Path;
use super::likelihood::Linear;
use super::linearised::Motion;
use super::problem::Problem;
use super::scales::{Noise, Scales};
use super::state_space::{Deviations, Stretch, with_dimension};
use crate::numeric::parallel;

/// Nodes that one thread smooths at a time, at least, beside those at both ends that are shared with its neighbours.
pub(super) const NODES_OF_A_THREAD: usize = 8192;

/// Time constants of the smoother after which nothing is left of what was before.
const MEMORY_TIME_CONSTANTS: f64 = 60.0;

impl Problem<'_> {
    /// Returns the smoothed motion about a path.
    pub fn smoothed(
        &self,
        motion: &Motion<'_>,
        path: &mut Path,
        scales: Scales,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let is_sampled = path.ranges == self.sampled();
        let stretches = match is_sampled {
            true => self.stretches(motion, path, noise.sigma),
            false => Vec::new(),
        };
        let linear = Linear {
            stretches: &stretches,
            prior: motion.prior,
            scales,
        };
        self.smoothed_along(motion, path, &linear, noise)
    }

    /// Returns the smoothed motion about a path, by its linear model if it is one along the sampled stretches. What repeats is
    /// found there, and left in the path; along all nodes of a longer record it is known.
    pub fn smoothed_along(
        &self,
        motion: &Motion<'_>,
        path: &mut Path,
        linear: &Linear<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        if self.is_stopped() {
            return vec![Estimate::default(); path.states.len()];
        }
        if path.ranges != self.sampled() {
            return self.smoothed_in_pieces(motion, path, linear.scales, noise);
        }
        let states = motion.prior.states() + usize::from(noise.correlated.is_some());
        if motion.prior.cycle > 0 {
            return with_dimension!(states, N => self.smoothed_together::<N>(motion, path, linear, noise));
        }
        let pairs = path.ranges.iter().zip(linear.stretches);
        let of = |(range, stretch): (&Range<usize>, &Stretch)| {
            let model = linear.deviations(stretch, noise);
            self.smoothed_by(motion, path, range.start, &model, noise)
        };
        parallel::map(pairs, of).concat()
    }

    /// Returns the smoothed motion from a node on by the linear model of a stretch.
    fn smoothed_by(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        from: usize,
        model: &Deviations<'_>,
        noise: &Noise,
    ) -> Vec<Estimate> {
        with_dimension!(model.dimension(), N => {
            let (deviations, innovations) = fixed_interval::smooth::<N>(model, &mut ());
            self.estimated(motion, path, from, &deviations, &innovations, noise)
        })
    }

    /// Returns the smoothed motion about a path along all nodes, computed in pieces side by side.
    fn smoothed_in_pieces(
        &self,
        motion: &Motion<'_>,
        path: &Path,
        scales: Scales,
        noise: &Noise,
    ) -> Vec<Estimate> {
        let linear = Linear {
            stretches: &[],
            prior: motion.prior.beside_known(),
            scales,
        };
        let motion = &self.motion(linear.prior);
        let (times, nodes) = (&self.grid.times, self.grid.len());
        let shared = MEMORY_TIME_CONSTANTS / noise.corner;
        let density = nodes as f64 / scales.duration;
        let length = NODES_OF_A_THREAD.max((4.0 * shared * density).min(nodes as f64) as usize);
        let mut found = vec![Estimate::default(); nodes];
        let pieces = (0..nodes).step_by(length).zip(found.chunks_mut(length));
        parallel::map(pieces, |(first, piece)| {
            if self.is_stopped() {
                return;
            }
            let last = first + piece.len() - 1;
            let from = times.partition_point(|t| *t < times[first] - shared);
            let to = times.partition_point(|t| *t <= times[last] + shared);
            let stretch = self.stretch(motion, path, from..to, noise.sigma);
            let model = linear.deviations(&stretch, noise);
            let all = self.smoothed_by(motion, path, from, &model, noise);
            piece.copy_from_slice(&all[first - from..=last - from]);
        });
        found
    }
}
