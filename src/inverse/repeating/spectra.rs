//! All spectra of what repeats: few turns of noisy samples hardly tell how its harmonics decay, and the likeliest spectrum may
//! leave no room for one that is there. In its place come the means of the variances.
//!
//! They are sums over a grid in units of the standard errors of ln s and m (Rue, Martino and Chopin, J. R. Statist. Soc. B 71
//! (2009) 319). The standard deviation s has a uniform prior (Gelman, Bayesian Analysis 1 (2006) 515), and so has the order m.

use super::super::weighed::{Weighed, counting, most, on_both_sides};
use super::regression::{Regression, Rest};
use super::spectrum::{ORDERS, Spectrum};

/// A grid about the likeliest spectrum, in lines of one order each.
struct Grid<'a> {
    of: &'a Regression,
    rest: &'a Rest,
    /// Steps of ln s and of m.
    steps: [f64; 2],
    /// Change of the likeliest ln s with m.
    slope: f64,
    /// ln of the odds to the most probable spectrum below which another one does not count.
    least: f64,
}

/// Standard deviations of the coefficients before the samples, in units of σ.
#[derive(Debug)]
pub(in crate::inverse) struct OverSpectra {
    /// Those by which the coefficients are estimated.
    pub told: Vec<f64>,
    /// Those with what the noise may hide beside, for the covariance.
    pub all: Vec<f64>,
}

/// A spectrum with the standard deviations by it and by what stands out of it.
struct Tried {
    spectrum: Spectrum,
    deviations: OverSpectra,
}

impl Regression {
    /// Returns the standard deviations of the coefficients: roots of the means of their variances over all spectra, of which one is
    /// the likeliest.
    pub fn over_spectra(&self, likeliest: Spectrum, rest: &Rest) -> Option<OverSpectra> {
        let found = self.solved(likeliest, rest)?;
        let scoring = self.scoring(&found, rest.variance(found.fall), likeliest);
        let list = Grid::new(self, rest, scoring.information).spectra(likeliest);
        let total: f64 = list.iter().map(|one| one.log.exp()).sum();
        let mean = |of: fn(&OverSpectra) -> &Vec<f64>| {
            let mut sums = vec![0.0; self.prior.coefficients()];
            for one in &list {
                let share = one.log.exp() / total;
                let pairs = sums.iter_mut().zip(of(&one.value.deviations));
                pairs.for_each(|(sum, deviation)| *sum += share * deviation * deviation);
            }
            sums.into_iter().map(f64::sqrt).collect()
        };
        (total > 0.0).then(|| OverSpectra {
            told: mean(|deviations| &deviations.told),
            all: mean(|deviations| &deviations.all),
        })
    }
}

impl<'a> Grid<'a> {
    /// A grid, from Fisher's information of ln s, of both, and of m.
    fn new(of: &'a Regression, rest: &'a Rest, [a, b, c]: [f64; 3]) -> Grid<'a> {
        // The sum over a normal density in such steps errs by 3e-4. Where the samples tell little, a step is a factor of e at
        // most, and a quarter of all orders.
        let step = |information: f64| 1.5 / information.max(0.0).sqrt();
        Grid {
            of,
            rest,
            steps: [step(a).min(1.0), step(c - b * b / a).clamp(0.01, 0.5)],
            slope: -b / a,
            // Three standard deviations of a normal density.
            least: -4.5,
        }
    }

    /// Returns the spectra that count.
    fn spectra(&self, likeliest: Spectrum) -> Vec<Weighed<Tried>> {
        let mut list = self.line(likeliest);
        for step in [self.steps[1], -self.steps[1]] {
            let mut last = likeliest;
            while (ORDERS[0]..=ORDERS[1]).contains(&(last.order + step)) {
                let line = self.line(self.with_order(last, last.order + step));
                let Some(best) = line.iter().max_by(|a, b| a.log.total_cmp(&b.log)) else {
                    break;
                };
                let counts = best.log > most(&list) + self.least;
                last = best.value.spectrum;
                list.extend(line);
                if !counts {
                    break;
                }
            }
        }
        counting(list, self.least)
    }

    /// The spectrum of another order on the ridge of the likelihood through one.
    fn with_order(&self, from: Spectrum, order: f64) -> Spectrum {
        Spectrum {
            log_size: from.log_size + self.slope * (order - from.order),
            order,
        }
    }

    /// Returns the spectra of the order of one that count among them.
    fn line(&self, first: Spectrum) -> Vec<Weighed<Tried>> {
        let at = |way: f64| {
            self.at(Spectrum {
                log_size: first.log_size + way,
                ..first
            })
        };
        let first = at(0.0).map(|first| on_both_sides(first, self.steps[0], self.least, at));
        first.unwrap_or_default()
    }

    /// Returns a spectrum with its probability.
    fn at(&self, spectrum: Spectrum) -> Option<Weighed<Tried>> {
        let found = self.of.solved(spectrum, self.rest)?;
        let log = self.rest.likelihood_of(&found) + spectrum.log_size;
        let all = self.of.with_hidden(&found, spectrum, self.rest);
        let told = found.deviations;
        let deviations = OverSpectra { told, all };
        let value = Tried {
            spectrum,
            deviations,
        };
        log.is_finite().then_some(Weighed { value, log })
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::regression::{Regression, Rest};
    use super::super::spectrum::ORDERS;
    use crate::inverse::model::prior::{Prior, TORQUE};

    /// Means of the variances by sums over a fine grid, of determinants and inverses.
    fn by_brute_force(rows: &DMatrix<f64>, errors: &DVector<f64>, free: f64) -> DVector<f64> {
        let information = rows.transpose() * rows;
        let score = rows.transpose() * errors;
        let (mut total, mut sum) = (0.0, DVector::zeros(score.len()));
        let parts = 60;
        for k in 0..parts * 200 {
            let order = ORDERS[0]
                + (f64::from(k % parts) + 0.5) * (ORDERS[1] - ORDERS[0]) / f64::from(parts);
            let log_size = 0.05 * f64::from(k / parts) - 4.0;
            let variance = |j: usize| (2.0 * (log_size - order * ((j / 2 + 1) as f64).ln())).exp();
            let before = DVector::from_fn(score.len(), |j, _| variance(j));
            let inverse = DMatrix::from_diagonal(&before.map(f64::recip));
            let covariance = (&information + &inverse).try_inverse().expect("an inverse");
            let variance = (errors.norm_squared() - score.dot(&(&covariance * &score))) / free;
            let determinants = covariance.determinant() * inverse.determinant();
            let weight = determinants.sqrt() * variance.powf(-0.5 * free) * log_size.exp();
            total += weight;
            sum += before * weight;
        }
        sum / total
    }

    #[test]
    fn the_variances_are_means_over_all_spectra() {
        let of = Prior {
            cycle: 1,
            harmonics: 3,
            ..TORQUE
        };
        let rows = DMatrix::from_fn(60, of.coefficients(), |i, j| {
            let angle = 0.33 * (i * (j / 2 + 1)) as f64;
            if j % 2 == 0 { angle.cos() } else { angle.sin() }
        });
        let truth = DVector::from_vec(vec![2.0, -1.0, 0.1, 0.0, 0.3, 0.2]);
        let errors = DVector::from_fn(60, |i, _| ((i * i * 37 + 11) as f64).sin()) + &rows * truth;
        let mut regression = Regression::new(of, of.coefficients());
        for (row, error) in rows.row_iter().zip(&errors) {
            let row = Vec::from_iter(row.iter().copied());
            regression.take([&row, &[]], *error, 1.0);
        }
        regression.multiply();
        let rest = Rest {
            squares: errors.norm_squared(),
            free: 57.0,
            variances: [1e-6, f64::INFINITY],
            waves: 3,
            cost: 4.0,
        };
        let (likeliest, _) = regression.likeliest(None, &rest).expect("a spectrum");
        let over = regression
            .over_spectra(likeliest, &rest)
            .expect("deviations");
        let means = by_brute_force(&rows, &errors, rest.free);
        // Where the orders end, the coarse grid may have a line of one on their bound.
        let close = |deviation: f64, j: usize| (deviation / means[j].sqrt() - 1.0).abs() < 0.15;
        let alone = likeliest.deviations(of);
        assert!((0..of.coefficients()).all(|j| close(over.told[j], j)));
        assert!((0..of.coefficients()).any(|j| !close(alone[j], j)));
    }
}
