//! The smoothed motion: Gauss-Newton iterations of the linear smoother about the last path (iterated extended smoother).

use super::candidates::Candidate;
use super::estimate::Estimate;
use super::grid::{Course, Grid, Path};
use super::likelihood::Linear;
use super::maximum::ENOUGH_RISE;
use super::model::prior::{KINEMATIC, Prior, plain_state};
use super::model::repeating::Repeating;
use super::problem::Problem;
use super::scales::{Noise, Scales};

/// A smoothed motion with its prior and noise.
#[derive(Clone, Debug)]
pub(super) struct Smoothed {
    pub prior: Prior,
    pub noise: Noise,
    pub scales: Scales,
    pub estimates: Vec<Estimate>,
    /// Torque that repeats.
    pub repeating: Option<Repeating>,
    /// Whether the iterations came to rest.
    pub converged: bool,
    /// The priors among which its prior was chosen, the likeliest first.
    pub compared: Vec<Candidate>,
}

impl Smoothed {
    /// Its prior with its noise.
    pub fn candidate(&self) -> Candidate {
        Candidate {
            prior: self.prior,
            noise: self.noise,
            scales: self.scales,
        }
    }

    /// The same prior, without mechanics, along the motion of another one at the same nodes.
    pub fn along(&self, other: &Smoothed) -> Smoothed {
        let motion = other.estimates.iter().map(|estimate| Estimate {
            state: plain_state(estimate.motion()),
            ..*estimate
        });
        Smoothed {
            estimates: motion.collect(),
            ..self.clone()
        }
    }

    /// The crank angles at its nodes, rad.
    pub fn angles(&self) -> impl Iterator<Item = f64> + Clone {
        self.estimates.iter().map(|estimate| estimate.state[0])
    }

    /// The motion along its nodes.
    pub fn course<'a>(&self, grid: &'a Grid) -> Course<'a> {
        Course {
            grid,
            first: 0,
            motion: self.estimates.iter().map(Estimate::motion).collect(),
        }
    }

    /// The path of the states that were smoothed at all nodes.
    pub fn path(&self) -> Path {
        let states = self.estimates.iter().map(|e| e.state);
        Path {
            repeating: self.repeating.clone(),
            ..Path::whole(states.collect())
        }
    }
}

/// Most iterations of Gauss and Newton.
const ITERATIONS: usize = 30;

/// Change of the path, in its standard errors, at which the iterations have come to rest.
pub(super) const PATH_AT_REST: f64 = 0.05;

impl Problem<'_> {
    /// A motion that was smoothed at some of the nodes, smoothed at all with its noise, about paths from this first one. If it is
    /// the result, its noise is estimated again by all samples: about a path that has moved, if the model is not linear.
    pub fn completed(&self, found: Smoothed, mut path: Path, is_result: bool) -> Smoothed {
        if found.estimates.len() == self.grid.len() {
            return found;
        }
        path.repeating = found.repeating.clone();
        let is_linear = found.prior == KINEMATIC && self.record.is_linear();
        let mut whole = Smoothed {
            converged: false,
            ..found
        };
        let mut correction = Correction::default();
        // The iteration before which the noise is estimated: about the second path, and about the one at rest if that is a later one.
        let mut judged = usize::from(!is_linear);
        for iteration in 0..ITERATIONS {
            if is_result && iteration == judged {
                let noise = self.by_all_samples(&path, &whole.candidate());
                let is_first = iteration <= usize::from(!is_linear);
                if !is_first && noise.likelihood < whole.noise.likelihood + ENOUGH_RISE {
                    whole.converged = found.converged;
                    break;
                }
                whole.noise = noise;
                correction = Correction::default();
            }
            // Frees the memory of the former estimates first.
            whole.estimates = Vec::new();
            whole.estimates = self.smoothed(&mut path, &whole.candidate());
            let change = correction.taken(&mut path, &whole.estimates);
            let is_at_rest = is_linear || iteration > 0 && change < PATH_AT_REST;
            if is_at_rest && is_result && iteration > judged {
                judged = iteration + 1;
                continue;
            }
            whole.converged = found.converged && is_at_rest;
            if whole.converged || !change.is_finite() {
                break;
            }
        }
        whole
    }

    /// The linear model of a smoothed motion about its own path, with all spectra of what repeats.
    pub fn about_itself(&self, smoothed: &Smoothed) -> Linear {
        let Smoothed { prior, noise, .. } = smoothed;
        let linear = self.linear(*prior, smoothed.scales, &smoothed.path(), noise.sigma);
        linear.with_all_spectra(noise)
    }

    /// The smoothed motion with a prior, about paths that approach it.
    pub fn iterated(&self, candidate: &Candidate, mut path: Path) -> Smoothed {
        let (prior, mut noise) = (candidate.prior, candidate.noise);
        let mut result = Smoothed {
            converged: false,
            ..candidate.unsmoothed()
        };
        let mut is_at_rest = false;
        let mut correction = Correction::default();
        for iteration in 0..ITERATIONS {
            let linear = self.linear(prior, candidate.scales, &path, noise.sigma);
            // The noise is estimated again about the second path, and about those at rest until its likelihood rests, too.
            if iteration == 1 || is_at_rest || iteration == 0 && prior.powers > 0 {
                let mut known = noise;
                if iteration > 0 {
                    known = linear.begun(noise);
                    noise = linear.improved(known);
                }
                // What varied with the speed about neither of the first paths does not about the next.
                if prior.powers > 0 && (iteration < 2 || noise.speed_corner > 0.0) {
                    noise = linear.with_speed_corner(noise);
                }
                // Where the path came to rest by chance, far from the samples, it has no likelihood.
                result.converged &= known.likelihood.is_finite();
                if is_at_rest && noise.likelihood < known.likelihood + ENOUGH_RISE {
                    result.noise = known;
                    return match result.converged && prior.cycle > 0 {
                        true => self.with_twice_the_harmonics(result, path),
                        false => result,
                    };
                }
                correction = Correction::default();
            }
            let estimates = self.smoothed_along(&mut path, &linear, &noise);
            let change = correction.taken(&mut path, &estimates);
            is_at_rest = change < PATH_AT_REST && iteration > 0;
            // What came to rest with a former noise stands until this one's does.
            if is_at_rest || !result.converged {
                result = Smoothed {
                    noise,
                    estimates,
                    repeating: path.repeating.clone(),
                    converged: is_at_rest,
                    ..result
                };
            }
            if !change.is_finite() {
                break;
            }
        }
        result
    }

    /// A smoothed motion with twice the harmonics by which its prior was chosen: what they might add belongs to the band, and the
    /// process noise, beside which it is little, is left as it is.
    fn with_twice_the_harmonics(&self, found: Smoothed, mut path: Path) -> Smoothed {
        let mut wider = found.candidate();
        // High ones stay in their place even where they are among those now.
        wider.prior.harmonics *= 2;
        let mut correction = Correction::default();
        for _ in 0..ITERATIONS {
            let linear = self.linear(wider.prior, wider.scales, &path, wider.noise.sigma);
            wider.noise = linear.begun(wider.noise);
            let estimates = self.smoothed_along(&mut path, &linear, &wider.noise);
            let change = correction.taken(&mut path, &estimates);
            if change < PATH_AT_REST && wider.noise.likelihood.is_finite() {
                return Smoothed {
                    prior: wider.prior,
                    noise: wider.noise,
                    estimates,
                    repeating: path.repeating,
                    ..found
                };
            }
            if !change.is_finite() {
                break;
            }
        }
        found
    }
}

/// Corrections of a path by one noise. They fall, or they are damped (natural monotonicity test; Deuflhard, Newton Methods
/// for Nonlinear Problems, 2004).
#[derive(Default)]
pub(super) struct Correction {
    /// Part of a correction that is left out.
    left: f64,
    last: Option<f64>,
}

impl Correction {
    /// Moves a path towards the smoothed states; returns their rms change of the crank angles in standard errors.
    pub fn taken(&mut self, path: &mut Path, estimates: &[Estimate]) -> f64 {
        let change = change(estimates, path);
        if self.last.replace(change).is_some_and(|last| change > last) {
            self.left = 0.5 + 0.5 * self.left;
        }
        for (state, estimate) in path.states.iter_mut().zip(estimates) {
            for (value, next) in state.iter_mut().zip(estimate.state) {
                *value = next + self.left * (*value - next);
            }
        }
        change
    }
}

/// Returns the root mean square change of the crank angles in their standard errors, or the rounding of the largest.
pub(super) fn change(estimates: &[Estimate], path: &Path) -> f64 {
    let sizes = estimates.iter().map(|e| e.state[0].abs());
    let rounding = (1e-14 * sizes.fold(0.0, f64::max)).powi(2);
    let pairs = estimates.iter().zip(&path.states);
    let changes = pairs.map(|(estimate, before)| {
        (estimate.state[0] - before[0]).powi(2) / estimate.covariance[0].max(rounding)
    });
    (changes.sum::<f64>() / estimates.len() as f64).sqrt()
}
