//! Band over all intensities of the process noise: few samples hardly tell whether a torque is steady or varies below their noise,
//! and the likeliest intensity may be none at all. The motion stays the likeliest one; its covariance is the mean over the
//! intensities by their posterior probability, with the squares of what they make of the motion. The standard deviation of
//! the process noise has a uniform prior (Gelman, Bayesian Analysis 1 (2006) 515), under which none is no likelier than little.

use super::estimate::Estimate;
use super::maximum::FIRST_STEP;
use super::problem::Problem;
use super::scales::Noise;
use super::smoother::Smoothed;
use crate::numeric::parallel;

/// ln of the odds to the most probable intensity below which another one does not count.
const LEAST_LOG_ODDS: f64 = -6.0;

/// Noise with ln of its posterior probability, up to a constant.
#[derive(Clone, Copy, Debug)]
struct Weighed {
    noise: Noise,
    log: f64,
}

impl Problem<'_> {
    /// Returns a smoothed motion with its band over all intensities of the process noise. A long record tells its own.
    pub fn averaged(&self, mut smoothed: Smoothed) -> Smoothed {
        if self.sampled() != self.all() {
            return smoothed;
        }
        let weighed = self.posterior(&smoothed);
        if weighed.len() < 2 {
            return smoothed;
        }
        let motion = self.motion(smoothed.prior);
        let squares = parallel::map(weighed.iter(), |one| {
            let mut path = smoothed.path();
            let found = self.smoothed(&motion, &mut path, smoothed.scales, &one.noise);
            let pairs = found.iter().zip(&smoothed.estimates);
            pairs
                .map(|(found, likeliest)| found.about(likeliest))
                .collect::<Vec<_>>()
        });
        let total: f64 = weighed.iter().map(|one| one.log.exp()).sum();
        for (node, estimate) in smoothed.estimates.iter_mut().enumerate() {
            estimate.covariance = [0.0; 6];
            for (one, squares) in weighed.iter().zip(&squares) {
                let weight = one.log.exp() / total;
                let pairs = estimate.covariance.iter_mut().zip(squares[node]);
                pairs.for_each(|(sum, square)| *sum += weight * square);
            }
        }
        smoothed
    }

    /// Returns the noises whose corner frequencies count, in steps from the likeliest one.
    fn posterior(&self, smoothed: &Smoothed) -> Vec<Weighed> {
        let motion = self.motion(smoothed.prior);
        let stretches = self.stretches(&motion, &smoothed.path(), smoothed.noise.sigma);
        let linear = smoothed.linear(&stretches);
        let [lowest, highest] = smoothed.scales.corners().map(f64::ln);
        let likeliest = smoothed.noise.corner.ln();
        // The standard deviation of the process noise goes with this power of the corner frequency.
        let power = (smoothed.prior.order + 2) as f64;
        let at = |corner: f64| {
            let noise = linear.evaluated(Noise {
                corner: corner.exp(),
                ..smoothed.noise
            });
            let log = noise.likelihood - smoothed.noise.likelihood + power * (corner - likeliest);
            Weighed { noise, log }
        };
        let mut list = vec![at(likeliest)];
        for step in [FIRST_STEP, -FIRST_STEP] {
            let corners = (1..).map(|k| likeliest + step * f64::from(k));
            for corner in corners.take_while(|corner| (lowest..=highest).contains(corner)) {
                let next = at(corner);
                let counts = |most: &Weighed| next.log > most.log + LEAST_LOG_ODDS;
                if !list.iter().all(counts) {
                    break;
                }
                list.push(next);
            }
        }
        let most = list
            .iter()
            .map(|one| one.log)
            .fold(f64::NEG_INFINITY, f64::max);
        list.iter_mut().for_each(|one| one.log -= most);
        list.retain(|one| one.log > LEAST_LOG_ODDS);
        list
    }
}

impl Estimate {
    /// Returns the mean squares of the deviations from another motion: the covariance with the squares of the difference.
    fn about(&self, other: &Estimate) -> [f64; 6] {
        let [a, b] = [self.motion(), other.motion()];
        let off: [f64; 3] = std::array::from_fn(|k| a[k] - b[k]);
        let mut squares = self.covariance;
        let entries = (0..3).flat_map(|row| (0..=row).map(move |column| off[row] * off[column]));
        squares
            .iter_mut()
            .zip(entries)
            .for_each(|(sum, square)| *sum += square);
        squares
    }
}
