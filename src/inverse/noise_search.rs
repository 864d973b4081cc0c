//! The noise that makes samples likeliest: searches over one frequency after the other.

use super::likelihood::Linear;
use super::maximum::{better, climb};
use super::scales::{Autoregression, Noise};

impl Linear<'_> {
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

    /// The likeliest noise of g beside that of u: a loss that is not in proportion to the speed.
    pub fn with_drift(&self, mut noise: Noise) -> Noise {
        for _ in 0..2 {
            let drift = noise.drift.max(noise.corner);
            let first = self.evaluated(Noise { drift, ..noise });
            let by_drift = |drift| self.evaluated(Noise { drift, ..noise });
            noise = better(noise, self.over(drift, first, by_drift));
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
        for _ in 0..CORRELATION_ROUNDS {
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

/// Most rounds of the search over one parameter after the other.
const CORRELATION_ROUNDS: usize = 8;
