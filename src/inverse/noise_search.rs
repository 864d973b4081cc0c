//! Search for the likeliest noise: maximisation of the likelihood over one frequency after the other.

use super::likelihood::Linear;
use super::maximum::{ENOUGH_RISE, better, climb};
use super::scales::{Autoregression, Noise};

impl Linear<'_> {
    /// Evaluates a noise, then maximises the likelihood over its corner frequency, and over its spectrum if it has one.
    pub fn renewed(&self, noise: Noise) -> Noise {
        self.improved(self.evaluated(noise))
    }

    /// Maximises the likelihood of an evaluated noise over its corner frequency, and over its spectrum if it has one.
    pub fn improved(&self, first: Noise) -> Noise {
        let by_corner = |corner| self.evaluated(Noise { corner, ..first });
        let best = self.over(first.corner, first, by_corner, 0.0);
        match best.spectrum {
            None => best,
            Some(_) => self.begun(best),
        }
    }

    /// Maximises the likelihood over a frequency, rad/s, from a first guess with its noise.
    fn over(&self, guess: f64, first: Noise, at: impl Fn(f64) -> Noise, least_rise: f64) -> Noise {
        let range = self.scales.corners().map(f64::ln);
        climb(|log| at(log.exp()), guess.ln(), first, range, least_rise)
    }

    /// Maximises the likelihood over the corner frequency, from the best of a grid from 0.5/duration to 3/spacing.
    pub fn anywhere(&self, correlated: Option<Autoregression>) -> Noise {
        let lowest = (0.5 / self.scales.duration).ln();
        let highest = (3.0 / self.scales.spacing).ln();
        let count = (highest - lowest).ceil().max(1.0);
        let at = |k: usize| Noise {
            correlated,
            ..Noise::white((lowest + (highest - lowest) * k as f64 / count).exp())
        };
        let tried = (0..=count as usize).map(|k| self.evaluated(at(k)));
        let best = tried.reduce(better).unwrap_or_else(|| at(0));
        self.improved(best)
    }

    /// Maximises the likelihood over the noise of g and that of u in turn, for a loss not proportional to the speed.
    pub fn with_speed_corner(&self, mut noise: Noise) -> Noise {
        loop {
            let speed_corner = noise.speed_corner.max(noise.corner);
            let by_speed_corner = |speed_corner| {
                self.evaluated(Noise {
                    speed_corner,
                    ..noise
                })
            };
            let found = self.over(
                speed_corner,
                by_speed_corner(speed_corner),
                by_speed_corner,
                ENOUGH_RISE,
            );
            if found.likelihood < noise.likelihood + ENOUGH_RISE {
                return noise;
            }
            noise = better(found, self.improved(found));
        }
    }

    /// Maximises the likelihood over the corner frequency and the decay rate of the noise, from the best guess.
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
            best = better(best, climb(by_decay, decay, best, range, 0.0));
            best = better(best, self.improved(best));
            if best.likelihood - before < 0.1 {
                break;
            }
        }
        best
    }
}

/// Maximum number of rounds of the search over one parameter after the other.
const CORRELATION_ROUNDS: usize = 8;
