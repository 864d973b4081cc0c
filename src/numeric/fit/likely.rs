//! The penalty of the largest restricted likelihood.

use std::array;

use super::condensed::Rows;
use super::penalized::{Normal, WEAKEST};
use super::pieces::{Grid, basis};
use super::roughness::ORDER;
use crate::numeric::banded::DIAGONALS;
use crate::numeric::parallel;

/// Logarithm of the strongest penalty, relative to the mean pivot: next to it a spline is a polynomial.
pub(super) const STRONGEST: f64 = 26.0;

/// Costs that differ by this are of penalties about as likely: one standard deviation of the likely penalty.
const ALIKE: f64 = 1.0;

/// Distances of the penalties that are tried next to a guess.
const DISTANCES: [f64; 2] = [1.0, 0.1];

/// Way from a guess to the likely penalty for which a solution for the one is near that for the other.
const REACH: f64 = 2.0;

/// Most times that a guess is moved on.
const MOST: usize = 64;

/// A grid with its most likely penalty.
pub(super) struct Choice {
    pub grid: Grid,
    /// Minus twice the logarithm of the restricted likelihood.
    pub cost: f64,
    /// Strength of the penalty.
    pub strength: f64,
    /// Logarithm of the same, relative to the mean pivot.
    pub relative: f64,
    pub coefficients: Vec<f64>,
}

/// What a spline leaves of rows.
pub(super) struct Left {
    squares: f64,
    /// Sum of the products of each residual with the next.
    products: f64,
}

impl Choice {
    /// What it leaves of rows.
    pub fn left(&self, rows: &Rows<'_>) -> Left {
        Left::of(&self.grid, &self.coefficients, rows)
    }
}

impl Left {
    /// What the spline of these coefficients leaves of rows.
    pub fn of(grid: &Grid, coefficients: &[f64], rows: &Rows<'_>) -> Left {
        let residual = |(t, weight, target): (f64, f64, f64)| {
            let (piece, u) = grid.place(t);
            let part = &coefficients[piece..piece + DIAGONALS];
            let value: f64 = basis(u).iter().zip(part).map(|(b, c)| b * c).sum();
            target - weight * value
        };
        let parts = rows.parts(|range| {
            let before = range.start.checked_sub(1);
            let mut before = before.map_or(0.0, |i| rows.some(i..i + 1).map(residual).sum());
            let [mut squares, mut products] = [0.0; 2];
            for residual in rows.some(range).map(residual) {
                squares += residual * residual;
                products += residual * before;
                before = residual;
            }
            [squares, products]
        });
        let sum = |k: usize| parts.iter().map(|part| part[k]).sum();
        Left {
            squares: sum(0),
            products: sum(1),
        }
    }
    /// Whether it looks like noise, hardly correlated, each with the next, or is that of the digits.
    pub fn is_noise(&self, rows: &Rows<'_>) -> bool {
        self.products <= 3.0 * self.squares / (rows.number() as f64).sqrt()
            || rows.are_digits(self.squares + rows.left, 0.0)
    }

    /// Whether its correlated part is less than half of that of another one.
    pub fn is_much_less_than(&self, other: &Left) -> bool {
        self.products < 0.5 * other.products
    }

    /// Whether it is no more than computed samples are off that were not rounded to steps.
    pub fn is_computed(&self, rows: &Rows<'_>) -> bool {
        rows.floor <= rows.computed && rows.are_digits(self.squares + rows.left, rows.computed)
    }
}

impl Normal<'_> {
    /// The strength of the penalty with the largest restricted likelihood.
    pub fn choose(&self) -> Option<Choice> {
        let pivot = self.mean_pivot();
        let weak = 1e-7 * pivot;
        let near = self.solve(weak, &self.factor(weak)?);
        let about = self.about(near);
        let cost = |log_strength: f64| {
            let strength = pivot * log_strength.exp();
            let Some(factor) = self.factor(strength) else {
                return f64::INFINITY;
            };
            let penalized = about.penalized(strength, &factor);
            self.cost(strength, penalized, factor.log_determinant())
        };
        let best = minimum(&cost, WEAKEST, STRONGEST);
        let least = cost(best);
        // Samples that allow any strong penalty tell but the weakest one that goes with them.
        let relative = if cost(STRONGEST) <= least + ALIKE {
            crossing(&cost, least + ALIKE, WEAKEST, best)
        } else {
            best
        };
        let strength = pivot * relative.exp();
        Some(Choice {
            grid: self.grid,
            cost: least,
            strength,
            relative,
            coefficients: self.solve_from(strength, &self.factor(strength)?, about.near),
        })
    }

    /// The same next to a guess, the logarithm of a strength relative to the mean pivot.
    ///
    /// What is least goes with the strength as gᵀ (A + sP)⁻¹ g, of the slope g of what is penalized at a solution that is
    /// near: that needs no solution for each strength, and hardly anything cancels.
    pub fn choose_near(&self, guess: f64) -> Option<Choice> {
        let pivot = self.mean_pivot();
        let mut guess = guess.clamp(WEAKEST, STRONGEST);
        let mut near = None;
        for _ in 0..MOST {
            let strength = pivot * guess.exp();
            let factor = self.factor(strength)?;
            let solution = match near.take() {
                Some(near) => self.solve_from(strength, &factor, near),
                None => self.solve(strength, &factor),
            };
            let about = self.about(solution);
            let costs = |places: [f64; 4]| {
                let strengths = places.map(|place| pivot * place.exp());
                let found = about.alike(&strengths);
                array::from_fn(|i| {
                    let [penalized, log_determinant] = found[i];
                    self.cost(strengths[i], penalized, log_determinant)
                })
            };
            let relative = minimum_near(&costs, guess, [WEAKEST, STRONGEST]);
            let done = (relative - guess).abs() <= REACH;
            if done {
                let [cost, ..] = costs([relative; 4]);
                return Some(Choice {
                    grid: self.grid,
                    cost,
                    strength: pivot * relative.exp(),
                    relative,
                    coefficients: about.near,
                });
            }
            (guess, near) = (relative, Some(about.near));
        }
        None
    }

    /// Minus twice the logarithm of the restricted likelihood.
    fn cost(&self, strength: f64, penalized: f64, log_determinant: f64) -> f64 {
        let (rows, size, free) = (self.rows(), self.grid.size(), self.free());
        let least = rows.count as f64 * rows.floor * rows.floor;
        // What the penalty leaves free has a volume that goes with the number of coefficients.
        let of_size = ORDER as f64 * (size as f64).ln() - self.log_penalty;
        let cost = free * (penalized.max(least) / free).ln() + log_determinant
            - (size - ORDER) as f64 * strength.ln()
            + of_size;
        if cost.is_nan() { f64::INFINITY } else { cost }
    }
}

/// The last place before `to` at which a function that falls comes down to a value.
fn crossing(f: &dyn Fn(f64) -> f64, value: f64, mut from: f64, mut to: f64) -> f64 {
    for _ in 0..8 {
        let middle = 0.5 * (from + to);
        if f(middle) > value {
            from = middle;
        } else {
            to = middle;
        }
    }
    to
}

/// Place of the least value: a grid of 2, then golden section.
fn minimum(f: &(dyn Fn(f64) -> f64 + Sync), from: f64, to: f64) -> f64 {
    let steps = ((to - from) / 2.0).ceil() as usize;
    let place = |i: usize| from + 2.0 * i as f64;
    let values = parallel::map(0..steps + 1, |i| f(place(i)));
    let best = (0..=steps).fold(0, |best, i| if values[i] < values[best] { i } else { best });
    let (mut a, mut b) = (place(best.saturating_sub(1)), place((best + 1).min(steps)));
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let (mut c, mut d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
    let (mut at_c, mut at_d) = (f(c), f(d));
    for _ in 0..14 {
        if at_c < at_d {
            (b, d, at_d) = (d, c, at_c);
            c = b - GOLDEN * (b - a);
            at_c = f(c);
        } else {
            (a, c, at_c) = (c, d, at_d);
            d = a + GOLDEN * (b - a);
            at_d = f(d);
        }
    }
    0.5 * (a + b)
}

/// Place of the least value next to a guess, between limits: the vertex of a parabola, through values ever closer to it.
fn minimum_near(f: &dyn Fn([f64; 4]) -> [f64; 4], guess: f64, [from, to]: [f64; 2]) -> f64 {
    let mut middle = guess;
    for distance in DISTANCES {
        for _ in 0..MOST {
            middle = middle.clamp(from + 1.5 * distance, to - 1.5 * distance);
            let places = array::from_fn(|i| middle + distance * (i as f64 - 1.5));
            let values = f(places);
            let best = (0..4).fold(0, |best, i| if values[i] < values[best] { i } else { best });
            let to_limit = (places[best] - from).min(to - places[best]);
            if to_limit > 0.5 * distance && (best == 0 || best == 3) {
                middle = places[best];
                continue;
            }
            let beside = best.clamp(1, 2);
            let [left, here, right] = [values[beside - 1], values[beside], values[beside + 1]];
            let bend = left - 2.0 * here + right;
            let on = 0.5 * (left - right) / bend;
            middle = match bend > 0.0 && on.is_finite() {
                true => places[beside] + distance * on.clamp(-1.0, 1.0),
                false => places[best],
            };
            break;
        }
    }
    middle.clamp(from, to)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Minima inside, far off the guess, and at a limit.
    #[test]
    fn a_guess_leads_to_the_minimum() {
        let bowl = |at: f64| move |x: [f64; 4]| x.map(|x| (0.3 * (x - at)).cosh());
        for at in [-3.0, 0.25, 7.5] {
            for guess in [-9.0, 0.0, 9.0] {
                let found = minimum_near(&bowl(at), guess, [-10.0, 10.0]);
                assert!((found - at).abs() < 1e-4, "{found} for {at} from {guess}");
            }
        }
        for (at, limit) in [(-14.0, -10.0), (14.0, 10.0)] {
            let found = minimum_near(&bowl(at), 0.0, [-10.0, 10.0]);
            assert!((found - limit).abs() < 1e-12, "{found}");
        }
    }
}
