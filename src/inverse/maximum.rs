//! Maximum of the likelihood along a frequency of the noise.
//!
//! By Whittle (J. R. Stat. Soc. B 15 (1953) 125) ln of the likelihood of samples with the spectral density 1 + (ω_c/ω)ⁿ is
//! a + b ω_c + c ω_c¹⁻ⁿ: three points tell its maximum, two with the Fisher information −n b at the maximum.

use super::scales::Noise;

/// Rise of ln of the likelihood below which another evaluation does not pay.
pub(super) const ENOUGH_RISE: f64 = 0.05;

/// Returns the likelier of two noises.
pub(super) fn better(a: Noise, b: Noise) -> Noise {
    if b.likelihood > a.likelihood { b } else { a }
}

/// The likelihood along ln of a frequency.
pub(super) struct Along<F> {
    pub at: F,
    /// Exponent n of the spectral density.
    pub exponent: f64,
    /// Least and largest ln of the frequency.
    pub bounds: [f64; 2],
}

/// Point of the likelihood along a frequency: ln of the frequency and ln of the likelihood.
type Point = (f64, f64);

/// Expected maximum.
pub(super) struct Top {
    pub place: f64,
    /// Place twice as far from the best known point: after steps that fell short.
    beyond: f64,
    /// Rise above the best known point.
    rise: f64,
}

impl<F: Fn(f64) -> Noise> Along<F> {
    /// Maximises the likelihood from a guess, at which the Fisher information on ln of the frequency is expected to be this.
    pub fn maximum(&self, guess: f64, first: Noise, information: f64) -> Noise {
        const EVALUATIONS: usize = 12;
        let [lowest, highest] = self.bounds;
        let mut points = vec![(guess, first.likelihood)];
        let (mut best, mut place) = (first, guess);
        // Steps up in the same direction, one after the other: the samples are not of this spectral density.
        let (mut steps, mut direction) = (0, 0.0);
        // Where the samples tell next to nothing, a point on each side shows the way.
        let error = information.sqrt().recip().min(0.5 * REACH);
        let is_known = error < 0.5 * REACH;
        let mut next = match guess + error < highest {
            true => guess + error,
            false => guess - error,
        };
        for _ in 0..EVALUATIONS {
            next = next.clamp(lowest, highest);
            if points.iter().any(|(place, _)| *place == next) {
                break;
            }
            let found = (self.at)(next);
            points.push((next, found.likelihood));
            if found.likelihood > best.likelihood {
                let way = (next - place).signum();
                steps = if way == direction { steps + 1 } else { 1 };
                (best, place, direction) = (found, next, way);
            } else {
                steps = 0;
            }
            let top = self.top(&mut points, (error * error).recip());
            let is_outermost = [points[0].0, points[points.len() - 1].0].contains(&place);
            next = match steps {
                _ if points.len() == 2 && !is_known => 2.0 * guess - next,
                // The likelihood may level off slowly.
                1.. if is_outermost && !is_known => place + direction * REACH,
                2.. if is_outermost => place + direction * REACH,
                _ if top.rise < ENOUGH_RISE => break,
                2.. if (top.place - place).signum() == direction => top.beyond,
                _ => top.place,
            };
        }
        best
    }

    /// Returns the expected maximum by two points or more, which it sorts.
    fn top(&self, points: &mut [Point], information: f64) -> Top {
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let last = points.len() - 1;
        let best = (1..=last).fold(0, |best, k| match points[k].1 > points[best].1 {
            true => k,
            false => best,
        });
        let middle = best.clamp(1, last.max(2) - 1);
        match points.get(middle - 1..=middle + 1) {
            Some(three) => expected(self.exponent, three, best + 1 - middle),
            None => {
                let (here, other) = (points[best], points[last - best]);
                let b = -information / self.exponent;
                let [linear, power] = basis(self.exponent, other.0 - here.0);
                let c = (other.1 - here.1 - b * linear) / power;
                let reach = [here.0 - REACH, here.0 + REACH];
                maximum(self.exponent, [b, c], here.0, reach)
            }
        }
    }
}

/// Largest step beyond the known points, in ln of the frequency; the second point lies half of it from the guess at most.
const REACH: f64 = 1.0;

/// Returns the expected maximum by three sorted points, of which one is the best of all.
pub(super) fn expected(exponent: f64, three: &[Point], best: usize) -> Top {
    let here = three[best];
    let others = [(best + 1) % 3, (best + 2) % 3].map(|k| {
        let (place, value) = three[k];
        (basis(exponent, place - here.0), value - here.1)
    });
    let [(p, dp), (q, dq)] = others;
    let determinant = p[0] * q[1] - p[1] * q[0];
    let factors = [
        (dp * q[1] - dq * p[1]) / determinant,
        (p[0] * dq - q[0] * dp) / determinant,
    ];
    // Between the neighbours, not at them; an outer point may be passed.
    let beside = |k: usize| here.0 + 0.9 * (three[k].0 - here.0);
    let low = if best == 0 {
        here.0 - REACH
    } else {
        beside(best - 1)
    };
    let high = if best == 2 {
        here.0 + REACH
    } else {
        beside(best + 1)
    };
    maximum(exponent, factors, here.0, [low, high])
}

/// Returns ω − 1 and ω¹⁻ⁿ − 1 at ln ω.
fn basis(exponent: f64, log: f64) -> [f64; 2] {
    [log.exp_m1(), ((1.0 - exponent) * log).exp_m1()]
}

/// Returns the maximum of b ω + c ω¹⁻ⁿ over ω from `here`, between two places.
fn maximum(exponent: f64, [b, c]: [f64; 2], here: f64, [low, high]: [f64; 2]) -> Top {
    let off = match (b < 0.0, c < 0.0) {
        (true, true) => ((exponent - 1.0) * c / b).ln() / exponent,
        (true, false) => f64::NEG_INFINITY,
        (false, _) => f64::INFINITY,
    };
    let within = |place: f64| place.max(low).min(high);
    let place = within(here + off);
    let [linear, power] = basis(exponent, place - here);
    let rise = b * linear + c * power;
    Top {
        place,
        beyond: within(here + 2.0 * off),
        // Where a likelihood is not finite, nothing is known.
        rise: if rise.is_nan() { f64::INFINITY } else { rise },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    /// The spectral density itself is found from three e-folds off, within its standard error, by few evaluations.
    #[test]
    fn whittles_likelihood_is_maximised_from_afar() {
        for exponent in [2.0, 6.0, 10.0] {
            for guess in [-3.0f64, -0.2, 0.0, 0.01, 1.0, 3.0] {
                let count = Cell::new(0);
                let size = 300.0;
                let at = |log: f64| {
                    count.set(count.get() + 1);
                    let noise = Noise::white(log.exp());
                    let power = ((1.0 - exponent) * log).exp();
                    Noise {
                        likelihood: -size * ((exponent - 1.0) * log.exp() + power),
                        ..noise
                    }
                };
                let along = Along {
                    at,
                    exponent,
                    bounds: [-10.0, 10.0],
                };
                // The information at the guess, not at the maximum.
                let information = size * exponent * (exponent - 1.0) * guess.exp();
                let found = along.maximum(guess, at(guess), information);
                let off = found.corner.ln() * (size * exponent * (exponent - 1.0)).sqrt();
                assert!(off.abs() < 0.5, "{exponent} {guess}: {off}");
                assert!(count.get() < 8, "{exponent} {guess}: {}", count.get());
            }
        }
    }
}
