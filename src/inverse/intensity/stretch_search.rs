//! Search for a stretch of another intensity of the process noise: factor and ends with the largest likelihood.

use std::ops::Range;

use super::super::likelihood::Linear;
use super::super::maximum::{ENOUGH_RISE, SIGNIFICANT_RISE};
use super::super::model::state_space::Stretch;
use super::super::scales::Noise;
use super::parted::Parted;
use crate::numeric::maximum::largest_to;
use crate::numeric::parallel;

/// ln of the largest factor, and tolerance of its search.
const LARGEST: f64 = 25.0;
const WIDTH: f64 = 0.3;

/// Steps whose intensity is `factor` times what it was, or part of it.
#[derive(Clone, Debug)]
pub(in crate::inverse) struct Guess {
    pub steps: Range<usize>,
    /// ln of the factor of an intensity that is higher, or of its inverse.
    pub log: f64,
    /// 1 of an intensity that is higher, −1 of one that is lower.
    pub sense: f64,
    pub likelihood: f64,
}

/// Returns the likelier of two guesses.
fn likelier(a: Guess, b: Guess) -> Guess {
    match b.likelihood > a.likelihood {
        true => b,
        false => a,
    }
}

/// A stretch of the linear model, in which steps may have another intensity.
pub(in crate::inverse) struct Trial<'a, const N: usize> {
    pub linear: &'a Linear,
    pub stretch: &'a Stretch,
    pub noise: Noise,
    /// The stretch as it is.
    pub parted: Parted<N>,
}

impl<const N: usize> Trial<'_, N> {
    /// Returns the likeliest of some guesses, with its likeliest factor and ends; those of which a coarse search finds the likeliest
    /// factors are searched on, as the likelihood has several maxima.
    pub fn likeliest(&self, guesses: Vec<Guess>) -> Option<Guess> {
        let mut tried = parallel::map(guesses.into_iter(), |guess| self.with_factor(guess));
        tried.sort_by(|a, b| b.likelihood.total_cmp(&a.likelihood));
        let searched_on = 3;
        tried.truncate(searched_on);
        let found = parallel::map(tried.into_iter(), |guess| self.with_ends(guess));
        let best = found.into_iter().reduce(likelier)?;
        Some(self.no_lower_than_told(best))
    }

    /// Returns a guess of a lower intensity with one that is hardly less likely and higher: the likelihood tells whether there is
    /// any, and no more below that.
    fn no_lower_than_told(&self, best: Guess) -> Guess {
        let mut found = best.clone();
        while best.sense < 0.0 && found.log > WIDTH {
            let half = self.evaluated(Guess {
                log: 0.5 * found.log,
                ..found.clone()
            });
            if half.likelihood < best.likelihood - SIGNIFICANT_RISE {
                break;
            }
            found = half;
        }
        found
    }

    /// Returns a guess with its likelihood.
    fn evaluated(&self, mut guess: Guess) -> Guess {
        let stretch = guess.taken(self.stretch);
        let model = self.linear.deviations(&stretch, &self.noise);
        let evidence = self.parted.with_other_steps(&model, &guess.steps);
        guess.likelihood = self.linear.judged(self.noise, &evidence, 1).likelihood;
        guess
    }

    /// Returns a guess with its likeliest factor, whose ln is found to about twice `WIDTH`.
    fn with_factor(&self, guess: Guess) -> Guess {
        let at = |log: f64| {
            let guess = guess.clone();
            self.evaluated(Guess { log, ..guess }).likelihood
        };
        let (log, likelihood) = largest_to(at, [0.0, LARGEST], WIDTH);
        let found = Guess {
            log,
            likelihood,
            ..guess.clone()
        };
        likelier(guess, found)
    }

    /// Returns a guess with likelier ends: each moves by parts of the length, a half at first, while the likelihood rises.
    fn with_ends(&self, mut guess: Guess) -> Guess {
        let mut by = guess.steps.len() / 2 + 1;
        while by > 0 {
            let Range { start, end } = guess.steps;
            let count = self.stretch.steps.len();
            let moved = [
                start.saturating_sub(by)..end,
                (start + by).min(end - 1)..end,
                start..(end + by).min(count),
                start..end.saturating_sub(by).max(start + 1),
            ];
            let tried = parallel::map(moved.into_iter(), |steps| {
                self.evaluated(Guess {
                    steps,
                    ..guess.clone()
                })
            });
            match tried
                .into_iter()
                .reduce(likelier)
                .filter(|next| next.likelihood > guess.likelihood + ENOUGH_RISE)
            {
                Some(next) => guess = self.with_factor(next),
                None => by /= 2,
            }
        }
        guess
    }
}

impl Guess {
    /// Returns a stretch with its intensity.
    pub fn taken(&self, stretch: &Stretch) -> Stretch {
        let mut other = stretch.clone();
        let among = other.intensities[self.steps.clone()].iter_mut();
        among.for_each(|intensity| *intensity *= self.factor());
        other
    }

    /// Returns the factor of the intensity.
    pub fn factor(&self) -> f64 {
        (self.sense * self.log).exp()
    }
}
