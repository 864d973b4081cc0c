//! Search for the likeliest noise: maximisation of the likelihood over one frequency after the other.

use super::likelihood::Linear;
use super::maximum::{ENOUGH_RISE, better, climb};
use super::scales::Noise;

/// A frequency of a noise, rad/s; none if the noise is without it.
type Frequency = fn(&mut Noise) -> Option<&mut f64>;

impl Linear<'_> {
    /// Evaluates a noise, then maximises the likelihood over its corner frequency, and over its spectrum if it has one.
    pub fn renewed(&self, noise: Noise) -> Noise {
        self.improved(self.evaluated(noise))
    }

    /// Maximises the likelihood of an evaluated noise over its corner frequency, and over its spectrum if it has one.
    pub fn improved(&self, first: Noise) -> Noise {
        let best = self.along(first, |noise| Some(&mut noise.corner));
        match best.spectrum {
            None => best,
            Some(_) => self.begun(best),
        }
    }

    /// Maximises the likelihood of an evaluated noise over a frequency.
    fn along(&self, first: Noise, which: Frequency) -> Noise {
        let Some(guess) = which(&mut first.clone()).map(|frequency| frequency.ln()) else {
            return first;
        };
        let at = |log: f64| {
            let mut noise = first;
            which(&mut noise)
                .into_iter()
                .for_each(|frequency| *frequency = log.exp());
            self.evaluated(noise)
        };
        climb(at, guess, first, self.scales.corners().map(f64::ln))
    }

    /// Maximises the likelihood of an evaluated noise over a frequency and the corner frequency in turn.
    fn in_turn(&self, mut noise: Noise, which: Frequency) -> Noise {
        loop {
            let next = better(noise, self.improved(self.along(noise, which)));
            // A likelihood that is not finite does not rise.
            match next.likelihood > noise.likelihood + ENOUGH_RISE {
                true => noise = next,
                false => return noise,
            }
        }
    }

    /// Maximises the likelihood over the corner frequency, from the best of a grid from 0.5/duration to 3/spacing.
    pub fn anywhere(&self, correlated: Option<f64>) -> Noise {
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

    /// Maximises the likelihood over the noise of g₁ and that of u in turn, for a loss not proportional to the speed.
    pub fn with_speed_corner(&self, noise: Noise) -> Noise {
        let first = Noise {
            speed_corner: noise.speed_corner.max(noise.corner),
            ..noise
        };
        let found = self.in_turn(self.evaluated(first), |noise| Some(&mut noise.speed_corner));
        match found.likelihood < noise.likelihood + ENOUGH_RISE {
            true => noise,
            false => found,
        }
    }

    /// Maximises the likelihood over the corner frequency and the decay rate of the noise, from the best guess.
    pub fn correlated(&self, from: &Noise, guesses: &[f64]) -> Noise {
        let tried = guesses.iter().map(|guess| {
            self.evaluated(Noise {
                correlated: Some(*guess),
                likelihood: f64::NEG_INFINITY,
                ..*from
            })
        });
        let best = tried.reduce(better).unwrap_or(*from);
        self.in_turn(best, |noise| noise.correlated.as_mut())
    }
}
