//! Motion from samples without mechanics: Kalman smoother with white snap and the likeliest noise.

use super::grid::Path;
use super::harmonics::StateTorque;
use super::likelihood::Linear;
use super::prior::KINEMATIC;
use super::problem::Problem;
use super::scales::Scales;
use super::smoother::{ITERATIONS, PATH_AT_REST, Smoothed};

/// First standard deviation of a sample over the distance between two, and the factor by which it is lowered: the prior
/// of the start spans that distance at first.
const FIRST_SIGMA_PART: f64 = 1e-3;

impl Problem<'_> {
    /// Smooths the motion without mechanics, from a first path and the sample noise σ, rad or m.
    pub fn kinematic(&self, first: Path, sigma: f64) -> Smoothed {
        let motion = self.motion(KINEMATIC);
        let slope = self.slope(&first);
        let mut path = first.along(self.sampled());
        // The start of this prior is compared with others only once the motion is known.
        let mut shape = [1.0, 1.0];
        let mut best: Option<Smoothed> = None;
        let is_linear = self.record.is_linear();
        let mut sigma = sigma;
        // The width of the initial prior is proportional to σ: a large σ, lowered step by step, makes it wide enough.
        let mut floor = FIRST_SIGMA_PART * slope * self.way();
        for iteration in 0..ITERATIONS {
            floor = floor.max(self.record.floor);
            let scales = Scales {
                floor,
                ..self.scales(&motion, &path, slope, shape)
            };
            let noise = match &best {
                Some(last) if iteration > 6 => last.noise,
                last => {
                    let stretches = self.stretches(&motion, &path, sigma);
                    let linear = Linear {
                        stretches: &stretches,
                        prior: KINEMATIC,
                        scales,
                    };
                    match last {
                        Some(last) => linear.renewed(last.noise),
                        None => linear.anywhere(None),
                    }
                }
            };
            let estimates = self.smoothed(&motion, &mut path, scales, &noise);
            let change = path.moved(&estimates);
            sigma = noise.sigma;
            let rms = |k: usize| {
                (estimates.iter().map(|e| e.state[k].powi(2)).sum::<f64>() / estimates.len() as f64)
                    .sqrt()
            };
            shape = [rms(2).max(f64::MIN_POSITIVE), rms(3).max(f64::MIN_POSITIVE)];
            let lowered = floor <= self.record.floor || noise.sigma > 3.0 * floor;
            let converged = lowered && (change < PATH_AT_REST || is_linear);
            best = Some(Smoothed {
                prior: KINEMATIC,
                noise,
                scales,
                estimates,
                torque: StateTorque::default(),
                converged,
            });
            // A second pass recovers digits lost to rounding about a straight line.
            if converged && (!is_linear || iteration > 0) {
                break;
            }
            if !lowered {
                floor *= FIRST_SIGMA_PART;
            }
        }
        let Some(mut found) = best else {
            unreachable!("at least one iteration")
        };
        found.scales.motion = shape;
        found.scales.floor = self.record.floor;
        self.completed(found, first)
    }
}
