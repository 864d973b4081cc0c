//! Search for the likeliest noise: maximisation of the likelihood over its frequencies.

use super::likelihood::Linear;
use super::maximum::{ENOUGH_RISE, FIRST_STEP, better, climb};
use super::scales::Noise;
use crate::numeric::parallel;

/// A frequency of a noise that has it, rad/s.
type Frequency = fn(&mut Noise) -> &mut f64;

/// The corner frequency.
const CORNER: Frequency = |noise| &mut noise.corner;

impl Linear {
    /// Evaluates a noise that was the likeliest of another model, then maximises the likelihood over its corner frequency.
    pub fn renewed(&self, noise: Noise) -> Noise {
        self.improved(self.begun(noise))
    }

    /// Maximises the likelihood of an evaluated noise, the likeliest of another model, over its corner frequency.
    pub fn improved(&self, first: Noise) -> Noise {
        // So near to the maximum a parabola is right to `ENOUGH_RISE`.
        self.along(first, &[(CORNER, 1.0)], 0.3 * FIRST_STEP)
    }

    /// Maximises the likelihood of an evaluated noise over its corner frequency.
    pub fn with_corner(&self, first: Noise) -> Noise {
        self.along(first, &[(CORNER, 1.0)], FIRST_STEP)
    }

    /// Maximises the likelihood of an evaluated noise along a line of ln of frequencies, at each place with the likeliest spectrum
    /// if it has one: over one of both at a time it would stop at the ridge where less of the one makes up for more of the other.
    fn along(&self, first: Noise, line: &[(Frequency, f64)], step: f64) -> Noise {
        let at = |place: f64| {
            let mut noise = first;
            for (which, share) in line {
                *which(&mut noise) *= (share * place).exp();
            }
            self.begun(noise)
        };
        let mut bounds = [f64::NEG_INFINITY, f64::INFINITY];
        for (which, share) in line.iter().filter(|(_, share)| *share != 0.0) {
            let frequency = *which(&mut first.clone());
            let ends = self
                .scales
                .corners()
                .map(|end| (end / frequency).ln() / share);
            bounds[0] = f64::max(bounds[0], ends[0].min(ends[1]));
            bounds[1] = f64::min(bounds[1], ends[0].max(ends[1]));
        }
        climb(at, 0.0, first, step, bounds)
    }

    /// Maximises the likelihood of an evaluated noise over two frequencies, of which `left` may have a likelier value: over one
    /// after the other, and along the line through two maxima over the same one, on which that of both lies if the likelihood is
    /// quadratic (conjugate directions; Powell, Computer J. 7 (1964) 155).
    fn in_turn(&self, mut noise: Noise, which: [Frequency; 2], mut left: usize) -> Noise {
        let rises = |next: &Noise, noise: &Noise| next.likelihood > noise.likelihood + ENOUGH_RISE;
        let mut maxima: [Option<Noise>; 2] = [None; 2];
        let mut one = 0;
        while left > 0 {
            let next = better(noise, self.along(noise, &[(which[one], 1.0)], FIRST_STEP));
            // A likelihood that is not finite does not rise.
            let is_likelier = rises(&next, &noise);
            left = if is_likelier { 1 } else { left - 1 };
            noise = next;
            if let Some(before) = maxima[one].replace(noise).filter(|_| is_likelier) {
                let line = which.map(|which| {
                    let [from, to] = [before, noise].map(|mut noise| *which(&mut noise));
                    (which, (to / from).ln())
                });
                let next = better(noise, self.along(noise, &line, 1.0));
                left = if rises(&next, &noise) { 2 } else { left };
                noise = next;
            }
            one = 1 - one;
        }
        noise
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
        let tried = parallel::map(0..=count as usize, |k| self.evaluated(at(k)));
        let best = tried.into_iter().reduce(better).unwrap_or_else(|| at(0));
        self.with_corner(best)
    }

    /// Maximises the likelihood over the noise of g₁, if there is any, and that of u in turn, for a loss not proportional to the
    /// speed; that of u is the likeliest before.
    pub fn with_speed_corner(&self, noise: Noise) -> Noise {
        if noise.speed_corner > 0.0 {
            let without = self.begun(Noise {
                speed_corner: 0.0,
                ..noise
            });
            if without.likelihood > noise.likelihood {
                return self.with_corner(without);
            }
        }
        let which: [Frequency; 2] = [|noise| &mut noise.speed_corner, CORNER];
        if noise.speed_corner >= noise.corner {
            return self.in_turn(noise, which, 1);
        }
        let first = Noise {
            speed_corner: noise.corner,
            ..noise
        };
        let found = self.in_turn(self.evaluated(first), which, 2);
        match found.likelihood < noise.likelihood + ENOUGH_RISE {
            true => noise,
            false => found,
        }
    }

    /// Maximises the likelihood over the corner frequency and the decay rate of the noise, from the best of 1/(0.2, 1 and 5 samples);
    /// none of them is likelier where the noise is white.
    pub fn correlated(&self, from: &Noise) -> Noise {
        let tried = parallel::map([0.2, 1.0, 5.0].into_iter(), |steps| {
            self.evaluated(Noise {
                correlated: Some(1.0 / (steps * self.scales.spacing)),
                ..*from
            })
        });
        let best = tried.into_iter().reduce(better).unwrap_or(*from);
        if best.likelihood < from.likelihood + ENOUGH_RISE {
            return *from;
        }
        let decay: Frequency = |noise| noise.correlated.get_or_insert(f64::NAN);
        self.in_turn(best, [decay, CORNER], 2)
    }
}
