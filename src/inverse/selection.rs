//! Choice between polynomial and smoother, and the uncertainty that the choice adds (Burnham and Anderson, Model
//! Selection and Multimodel Inference, 2nd ed. 2002, chapter 4): the degree and the kind are estimated, too, and a term
//! that is left out for its size may be as large as its error.

use super::fitted::Fitted;
use super::record::Record;
use crate::numeric::parallel;
use crate::numeric::polynomial_fit::PolynomialFit;

/// Akaike's criterion AICc for few samples (Hurvich and Tsai, Biometrika 76 (1989) 297) by the root mean square of the
/// residuals and the number of parameters with those of the noise; of a smoother by its effective parameters (Hurvich,
/// Simonoff and Tsai, J. R. Statist. Soc. B 60 (1998) 271).
pub(super) fn criterion(samples: usize, spread: f64, parameters: f64) -> f64 {
    let n = samples as f64;
    2.0 * n * spread.max(f64::MIN_POSITIVE).ln()
        + 2.0 * parameters * n / (n - parameters - 1.0).max(1.0)
}

/// Part of the weights that the confidence set of models has, as the band of a value has of its distribution.
const CONFIDENCE: f64 = 0.95;

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

impl Fitted {
    /// Returns the criterion of the fit.
    fn information(&self) -> f64 {
        let parameters = self.summary.parameters + self.of_noise;
        let spread = self.summary.rms.max(self.floor);
        criterion(self.residuals.len(), spread, parameters)
    }

    /// True if a polynomial has the lower criterion.
    pub fn is_preferred_to(&self, smoothed: &Fitted) -> bool {
        self.information() <= smoothed.information()
    }

    /// Returns a polynomial of a chosen degree with the covariance over all degrees, and over a smoothed motion if it was
    /// compared with one, by Akaike weights.
    pub fn averaged(
        mut self,
        fit: &PolynomialFit,
        record: &Record<'_>,
        smoothed: Option<&Fitted>,
    ) -> Fitted {
        let samples = self.residuals.len();
        let of_degree = |(degree, spread): (usize, f64)| {
            criterion(samples, spread.max(self.floor), degree as f64 + 2.0)
        };
        let degrees = fit.residuals().enumerate().map(of_degree);
        let mut weights = akaike(degrees.chain(smoothed.map(Fitted::information)).collect());
        let of_smoothed = smoothed.and_then(|_| weights.pop()).unwrap_or(0.0);
        let covariances = parallel::list(samples, |i| {
            let mut covariance = fit.averaged(record.times[i], &weights);
            if let Some(smoothed) = smoothed {
                let other = smoothed.motion[i].about(&self.motion[i].value);
                for (sum, other) in covariance.iter_mut().zip(other) {
                    *sum += of_smoothed * other;
                }
            }
            covariance
        });
        for (state, covariance) in self.motion.iter_mut().zip(covariances) {
            state.covariance = covariance;
        }
        self
    }
}
