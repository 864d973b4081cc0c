//! Choice between polynomial and smoother, and the uncertainty that the choice of a degree adds (Burnham and Anderson,
//! Model Selection and Multimodel Inference, 2nd ed. 2002, chapter 4): a term that is left out for its size may be as
//! large as its error.

use super::fitted::Fitted;
use super::model::prior::WITHOUT_MECHANICS;
use super::motion_estimate::MotionEstimate;
use super::problem::Problem;
use super::record::Record;
use super::scales::Noise;
use super::smoother::Smoothed;
use crate::numeric::parallel;
use crate::numeric::polynomial_fit::PolynomialFit;

/// Akaike's criterion AICc for few samples (Hurvich and Tsai, Biometrika 76 (1989) 297) by the root mean square of the
/// residuals and the number of parameters with that of the noise.
fn criterion(samples: usize, spread: f64, parameters: f64) -> f64 {
    let n = samples as f64;
    2.0 * n * spread.max(f64::MIN_POSITIVE).ln()
        + 2.0 * parameters * n / (n - parameters - 1.0).max(1.0)
}

/// Part of the weights that the confidence set of models has, as the band of a value has of its distribution.
const CONFIDENCE: f64 = 0.95;

/// True if the less probable of two models, with these odds of the other, is in the least set that has 95 % of the weights.
pub(super) fn counts(log_odds: f64) -> bool {
    1.0 / (1.0 + (-log_odds).exp()) < CONFIDENCE
}

/// Returns the weights of models by their criteria: 0 outside the least set that has 95 % of them.
fn akaike(criteria: Vec<f64>) -> Vec<f64> {
    let least = criteria.iter().copied().fold(f64::INFINITY, f64::min);
    let odds: Vec<f64> = criteria.iter().map(|c| (0.5 * (least - c)).exp()).collect();
    let mut order: Vec<usize> = (0..odds.len()).collect();
    order.sort_by(|a, b| odds[*b].total_cmp(&odds[*a]));
    let enough = CONFIDENCE * odds.iter().sum::<f64>();
    let (mut weights, mut sum) = (vec![0.0; odds.len()], 0.0);
    for model in order {
        if sum < enough {
            sum += odds[model];
            weights[model] = odds[model];
        }
    }
    weights.iter().map(|weight| weight / sum).collect()
}

impl Problem<'_> {
    /// Returns ln of the odds of a polynomial to a smoothed motion: it is the prior without mechanics of its degree that does
    /// without process noise, one parameter less (Schwarz, Ann. Statist. 6 (1978) 461). None for a degree above those of the
    /// priors.
    pub fn log_odds(
        &self,
        degree: usize,
        kinematic: &Smoothed,
        smoothed: &Smoothed,
    ) -> Option<f64> {
        let are_plain = self.record.codes.is_none() && self.single().outliers().next().is_none();
        let mut priors = WITHOUT_MECHANICS.iter().filter(|_| are_plain);
        let prior = priors.find(|prior| prior.order + 1 >= degree);
        prior.map(|prior| {
            let without = self.about(*prior, kinematic).linear;
            let without = without.evaluated(Noise::white(0.0)).likelihood;
            without + self.cost(1.0) - smoothed.noise.likelihood
        })
    }
}

impl Fitted {
    /// Returns a polynomial of a chosen degree with the covariance over all degrees, by Akaike weights.
    pub fn averaged(mut self, fit: &PolynomialFit, record: &Record<'_>) -> Fitted {
        let samples = self.residuals.len();
        let of_degree = |(degree, spread): (usize, f64)| {
            criterion(samples, spread.max(record.floor), degree as f64 + 2.0)
        };
        let weights = akaike(fit.residuals().enumerate().map(of_degree).collect());
        let covariances = parallel::list(samples, |i| fit.averaged(record.times[i], &weights));
        for (state, covariance) in self.motion.iter_mut().zip(covariances) {
            state.covariance = covariance;
        }
        self
    }

    /// Returns a motion with its band where another one is less probable by these odds.
    pub fn beside(mut self, other: Vec<MotionEstimate>, log_odds: f64) -> Fitted {
        let part = 1.0 / (1.0 + log_odds.exp());
        for (motion, other) in self.motion.iter_mut().zip(other) {
            *motion = motion.beside(other, part);
        }
        self
    }
}
