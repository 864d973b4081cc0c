//! Marginal likelihood of a prior (prediction error decomposition with a diffuse start, that is REML), maximised over the
//! intensity of its noise; the variance of a sample is profiled out.

use super::kalman::{self, Evidence};
use super::linearised::{Linearised, State};
use super::maximum::{better, climb};
use super::periodic::Increments;
use super::prior::Prior;
use super::regression::{Posterior, Regression, Spectrum};
use super::scales::{Autoregression, Noise, Scales};
use super::state_space::{Deviations, Observed};

/// Stretches of nodes with their linear models, and the scales of the search.
#[derive(Clone, Copy, Debug)]
pub(super) struct Linear<'a> {
    /// Steps and samples of each stretch.
    pub stretches: &'a [Stretch],
    pub prior: Prior,
    pub scales: Scales,
}

/// A stretch of nodes.
#[derive(Clone, Debug, Default)]
pub(super) struct Stretch {
    pub steps: Vec<Linearised>,
    /// What the harmonics of what repeats add in each step.
    pub increments: Increments,
    pub observed: Vec<Observed>,
}

impl Linear<'_> {
    /// Standard deviations of the state before the first sample, in σ.
    fn spread(&self) -> State {
        let mut spread = self.scales.spread();
        if self.prior.follows_speed {
            // Such a g makes as much of the speed as the spread of u has.
            spread[2 + self.prior.order] = spread[2] / self.scales.speed;
        }
        spread
    }

    /// The linear model of one stretch.
    pub fn deviations<'a>(&self, stretch: &'a Stretch, noise: &Noise) -> Deviations<'a> {
        let level = self.scales.density(noise.level, 1);
        let (level, drift) = match self.prior.follows_speed {
            true => (0.0, level / self.scales.speed.powi(2)),
            false => (level, 0.0),
        };
        Deviations {
            steps: &stretch.steps,
            increments: &stretch.increments,
            observed: &stretch.observed,
            prior: self.prior,
            noise: self.scales.density(noise.corner, self.prior.order),
            level,
            drift,
            correlated: noise.correlated,
            spread: self.spread(),
        }
    }

    fn evidence(&self, noise: &Noise) -> Evidence {
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            match model.dimension() {
                3 => kalman::evidence::<3>(&model),
                4 => kalman::evidence::<4>(&model),
                5 => kalman::evidence::<5>(&model),
                _ => kalman::evidence::<6>(&model),
            }
        };
        self.stretches.iter().map(of).sum()
    }

    /// The evidence without the part that repeats, and what the samples tell of that.
    fn regressed(&self, noise: &Noise) -> (Evidence, Regression) {
        let mut to = Regression::new(2 * self.prior.harmonics);
        let of = |stretch: &Stretch| {
            let model = self.deviations(stretch, noise);
            match model.dimension() {
                3 => kalman::regressed::<3>(&model, &mut to),
                4 => kalman::regressed::<4>(&model, &mut to),
                _ => kalman::regressed::<5>(&model, &mut to),
            }
        };
        let evidence = self.stretches.iter().map(of).sum();
        to.multiply();
        (evidence, to)
    }

    /// The part that repeats, given the samples.
    pub fn posterior(&self, noise: &Noise) -> Option<Posterior> {
        let spectrum = noise.spectrum?;
        self.regressed(noise).1.solved(spectrum)
    }

    /// The evidence with the part that repeats, of the spectrum that the noise has or else of the likeliest.
    fn repeated(&self, noise: &mut Noise, near: Option<Spectrum>) -> Evidence {
        let (mut evidence, regression) = self.regressed(noise);
        let starts = self.prior.states() * self.stretches.len();
        let free = (evidence.samples.saturating_sub(starts)).max(1) as f64;
        let score = |found: &Posterior| {
            let squares = evidence.squares - found.fall;
            let least = self.scales.known.unwrap_or(self.scales.floor).powi(2);
            let variance = match self.scales.known {
                Some(_) => least,
                None => (squares / free).max(least),
            };
            -0.5 * (free * variance.ln() + squares / variance + found.log_determinant)
        };
        noise.spectrum = noise.spectrum.or_else(|| regression.likeliest(near, score));
        if let Some(found) = noise
            .spectrum
            .and_then(|spectrum| regression.solved(spectrum))
        {
            evidence.squares -= found.fall;
            evidence.log_variances += found.log_determinant;
        }
        evidence
    }

    /// Noise with its likelihood and its σ.
    pub fn evaluated(&self, noise: Noise) -> Noise {
        self.evaluated_near(noise, None)
    }

    /// Noise with its likelihood, its σ, and the likeliest spectrum about the one it has.
    pub fn begun(&self, mut noise: Noise) -> Noise {
        let near = noise.spectrum.take();
        self.evaluated_near(noise, near)
    }

    fn evaluated_near(&self, mut noise: Noise, near: Option<Spectrum>) -> Noise {
        let evidence = match self.prior.cycle {
            0 => self.evidence(&noise),
            _ => self.repeated(&mut noise, near),
        };
        self.judged(noise, &evidence, self.stretches.len())
    }

    /// Noise with its likelihood and its σ by what samples tell in filters that began so many times.
    pub fn judged(&self, mut noise: Noise, evidence: &Evidence, begun: usize) -> Noise {
        let starts = (self.prior.states() * begun) as f64;
        let free = evidence.samples as f64 - starts;
        let profiled = (evidence.squares / free.max(1.0)).sqrt();
        noise.sigma = self.scales.known.unwrap_or(profiled).max(self.scales.floor);
        let spread = self.spread();
        let Scales {
            lever,
            motion: [alpha, jerk],
            speed,
            ..
        } = self.scales;
        // The spreads of θ and ω are the same for all priors.
        let mut start = (spread[0] * spread[1]).ln();
        let mut prior = alpha / lever;
        for spread in &spread[2..2 + self.prior.order] {
            start += (spread / prior).ln();
            prior *= jerk / alpha;
        }
        if self.prior.follows_speed {
            start += (spread[2 + self.prior.order] * speed * lever / alpha).ln();
        }
        let likelihood = start * begun as f64
            - free * noise.sigma.ln()
            - 0.5 * (evidence.log_variances + evidence.squares / (noise.sigma * noise.sigma));
        if likelihood.is_finite() {
            noise.likelihood = likelihood;
        }
        noise
    }

    /// The largest likelihood over the corner frequency, from a first guess.
    pub fn maximised(&self, guess: f64, correlated: Option<Autoregression>) -> Noise {
        self.renewed(Noise {
            correlated,
            ..Noise::white(guess)
        })
    }

    /// The likeliest corner frequency beside what else a noise has, from the one that it has.
    pub fn renewed(&self, noise: Noise) -> Noise {
        self.improved(self.evaluated(noise))
    }

    /// The likeliest corner frequency beside what else a noise has, whose likelihood is known.
    pub fn improved(&self, first: Noise) -> Noise {
        let by_corner = |corner| self.evaluated(Noise { corner, ..first });
        let best = self.over(first.corner, first, by_corner);
        match best.spectrum {
            None => best,
            Some(_) => self.begun(best),
        }
    }

    /// The largest likelihood over a frequency, from a first guess with its noise.
    fn over(&self, guess: f64, first: Noise, at: impl Fn(f64) -> Noise) -> Noise {
        let range = self.scales.corners().map(f64::ln);
        climb(|log| at(log.exp()), guess.ln(), first, range)
    }

    /// The largest likelihood over corner frequencies all over the range.
    pub fn anywhere(&self) -> Noise {
        let lowest = (0.5 / self.scales.duration).ln();
        let highest = (3.0 / self.scales.spacing).ln();
        let count = (highest - lowest).ceil().max(1.0);
        let best = (0..=count as usize)
            .map(|k| (lowest + (highest - lowest) * k as f64 / count).exp())
            .map(|corner| self.evaluated(Noise::white(corner)))
            .max_by(|a, b| a.likelihood.total_cmp(&b.likelihood));
        best.map_or_else(
            || self.maximised(highest.exp(), None),
            |best| self.improved(best),
        )
    }

    /// The strongest noise, over a frequency of at least `low`, by which ln of the likelihood falls no more than `allowed` below the
    /// largest: by n²/2 for n standard errors. A prior that is too smooth, or has a shape of its own, has a band that does not hold
    /// what is less smooth or of another shape.
    pub fn as_strong_as_allowed(
        &self,
        noise: &Noise,
        mut low: f64,
        allowed: f64,
        with: impl Fn(f64) -> Noise,
    ) -> Noise {
        let mut best = noise.likelihood;
        let (mut found, mut high) = (*noise, f64::INFINITY);
        let mut frequency = noise.corner.max(FIRST * low);
        for _ in 0..LEVELS {
            let next = self.evaluated(with(frequency));
            best = best.max(next.likelihood);
            let fall = best - next.likelihood;
            if fall > allowed {
                high = frequency;
            } else {
                (found, low) = (next, frequency);
                if fall >= 0.5 * allowed {
                    break;
                }
            }
            // The fall grows like the density of the noise, by the sixth power of the frequency.
            let next = frequency * (0.75 * allowed / fall.max(1e-3)).powf(1.0 / 6.0);
            frequency = match next > low && next < high {
                true => next.min(2.0 * frequency),
                false if low > 0.0 => (low * high).sqrt(),
                false => 0.5 * high,
            };
        }
        found
    }

    /// The likeliest noise of g beside that of u: a loss that is not in proportion to the speed.
    pub fn with_drift(&self, mut noise: Noise) -> Noise {
        for _ in 0..2 {
            let level = noise.level.max(noise.corner);
            let first = self.evaluated(Noise { level, ..noise });
            let by_level = |level| self.evaluated(Noise { level, ..noise });
            noise = better(noise, self.over(level, first, by_level));
            noise = better(noise, self.improved(noise));
        }
        noise
    }

    /// The largest likelihood over the corner frequency, the correlation of the noise and its white part.
    pub fn correlated(&self, from: &Noise, guesses: &[Autoregression]) -> Noise {
        let mut best = Noise {
            likelihood: f64::NEG_INFINITY,
            ..*from
        };
        for guess in guesses {
            let correlated = Some(*guess);
            let found = self.evaluated(Noise {
                correlated,
                ..*from
            });
            if found.likelihood > best.likelihood {
                best = found;
            }
        }
        for _ in 0..ROUNDS {
            let before = best.likelihood;
            let Some(now) = best.correlated else { break };
            let decay = now.decay.ln();
            let range = [
                (0.01 / self.scales.duration).ln(),
                (5.0 / self.scales.spacing).ln(),
            ];
            let by_decay = |log: f64| {
                let decay = log.exp();
                self.evaluated(Noise {
                    correlated: Some(Autoregression { decay, ..now }),
                    ..best
                })
            };
            best = better(best, climb(by_decay, decay, best, range));
            best = better(best, self.improved(best));
            if best.likelihood - before < 0.1 {
                break;
            }
        }
        best
    }
}

/// First factor of the frequency, and most evaluations, in the search for that noise.
const FIRST: f64 = 1.2;
const LEVELS: usize = 12;

/// Most rounds of the search over one parameter after the other.
const ROUNDS: usize = 8;
