//! Motion from samples without mechanics: Kalman smoother with white snap and the likeliest noise.

use super::candidates::Candidate;
use super::grid::Path;
use super::likelihood::Linear;
use super::prior::KINEMATIC;
use super::problem::Problem;
use super::smoother::Smoothed;

impl Problem<'_> {
    /// Smooths the motion without mechanics, from a first path and the sample noise σ, rad or m.
    pub fn kinematic(&self, first: Path, sigma: f64) -> Smoothed {
        let motion = self.motion(KINEMATIC);
        let path = first.along(self.sampled());
        let scales = self.scales(&motion, &path, self.slope(&first), sigma);
        let linear = Linear {
            stretches: &self.stretches(&motion, &path, sigma),
            prior: KINEMATIC,
            scales,
        };
        let candidate = Candidate {
            prior: KINEMATIC,
            noise: linear.anywhere(None),
            scales,
        };
        let mut found = self.iterated(&candidate, path);
        let count = found.estimates.len() as f64;
        found.scales.motion = [2, 3].map(|k| {
            let squares = found.estimates.iter().map(|e| e.state[k].powi(2));
            (squares.sum::<f64>() / count).sqrt().max(f64::MIN_POSITIVE)
        });
        self.completed(found, first, false)
    }
}
