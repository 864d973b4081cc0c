//! Duration of many turns, by the Euler-Maclaurin sum of a smooth function of the energy.
//!
//! Turn n takes the time T(K₀ + nW). T is expanded in a Chebyshev series over a cell of the energy.

use super::interpolated_turns::TurnStart;
use super::one_turn::OneTurn;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Series};
use crate::numeric::exact::{SUM_ROUNDING, two_sum};
use crate::numeric::gauss;

/// Turns over a range of the kinetic energy at their start, x in [−1, 1].
#[derive(Clone, Debug)]
pub(in crate::engine) struct EulerMaclaurinCell {
    pub first: TurnStart,
    /// Number of turns to the next cell.
    pub count: f64,
    /// Change of x per turn.
    step: f64,
    /// Half the width of the cell, J.
    half: f64,
    /// Kinetic energy gained per turn, J.
    gain: f64,
    /// Duration T at the middle of the cell, s.
    middle_duration: f64,
    /// Series of T minus its middle value, s: a small variation of T keeps all its digits.
    difference: Series,
    /// Tail of the series, relative to T.
    tail: f64,
    /// Derivative of the series with respect to x, s.
    slope: Series,
    /// End terms of the Euler-Maclaurin sum, s.
    correction: Series,
    pub turn: OneTurn,
}

/// Returns the end terms of the Euler-Maclaurin sum: −T/2 + h T'/12 − h³ T'''/720 + h⁵ T⁽⁵⁾/30240; constants cancel.
fn correction(difference: &Series, h: f64) -> Series {
    let first = difference.derivative();
    let third = first.derivative().derivative();
    let fifth = third.derivative().derivative();
    let terms = [
        (difference, -0.5),
        (&first, h / 12.0),
        (&third, -h.powi(3) / 720.0),
        (&fifth, h.powi(5) / 30240.0),
    ];
    Series::blend(terms.into_iter())
}

impl EulerMaclaurinCell {
    /// Returns the width of the widest cell over the least kinetic energy at its lower end.
    pub fn widest_share() -> f64 {
        2.0 / ((-f64::EPSILON.ln() / MAX_DEGREE as f64).cosh() - 1.0)
    }

    /// Makes the cell of this width, J, from its first turn on, in which the least kinetic energy is `least`, J; `turn` is
    /// fine enough for all its energies. None if the series of T does not resolve it to rounding, or it holds no turn.
    pub(super) fn new(
        first: TurnStart,
        least: f64,
        width: f64,
        gain: f64,
        turn: OneTurn,
    ) -> Option<EulerMaclaurinCell> {
        let down = if gain >= 0.0 { 0.0 } else { width };
        // T is singular where the least energy in the turn vanishes: the coefficients of its series decay like the powers
        // of the sum of the half-axes of the ellipse through there (Trefethen, Approximation Theory and Approximation
        // Practice, theorem 8.1).
        let singularity = 1.0 + 2.0 * (least - down) / width;
        let degree = (-f64::EPSILON.ln() / singularity.acosh()).round();
        let resolves = |of_rule: &usize| *of_rule as f64 >= degree;
        let degree = Rule::DEGREES.into_iter().find(resolves);
        let (half, rule) = (0.5 * width, Rule::of(degree.unwrap_or(MAX_DEGREE)));
        let middle = (first.kinetic - down) + half;
        let middle_duration = turn.duration(middle);
        let differences = rule.values(|x| turn.duration(middle + half * x) - middle_duration);
        let difference = rule.series(&differences);
        let tail = difference.tail() * (difference.largest() / middle_duration);
        let step = gain / half;
        let count = (2.0 / step.abs()).floor();
        (tail <= SUM_ROUNDING && count >= 1.0).then(|| EulerMaclaurinCell {
            first,
            count,
            step,
            half,
            gain,
            correction: correction(&difference, step),
            slope: difference.derivative(),
            middle_duration,
            difference,
            tail,
            turn,
        })
    }

    fn x(&self, turns: f64) -> f64 {
        let begin = if self.step < 0.0 { 1.0 } else { -1.0 };
        turns.mul_add(self.step, begin)
    }

    /// True if the durations of turns vary too much for the Euler-Maclaurin sum: the first omitted term is below
    /// rounding for smaller changes of x per turn. They are then added one by one.
    fn varies_much(&self) -> bool {
        self.step.abs() > 1.0 / 64.0
    }

    /// Returns the duration of the turn after the first `turns`, s.
    fn duration(&self, turns: f64) -> f64 {
        self.middle_duration + self.difference.value(self.x(turns))
    }

    /// Returns the total duration of the first `turns` turns, s.
    pub fn time(&self, turns: f64) -> f64 {
        let of_difference = if self.varies_much() {
            let each = (0..turns as u32).map(|i| self.difference.value(self.x(f64::from(i))));
            each.sum()
        } else {
            let (from, to) = (self.x(0.0), self.x(turns));
            // Exact to degree 35.
            let mean: f64 = gauss::RULE_18
                .iter()
                .map(|(u, weight)| weight * self.difference.value(from + u * (to - from)))
                .sum();
            turns * mean + (self.correction.value(to) - self.correction.value(from))
        };
        turns.mul_add(self.middle_duration, of_difference)
    }

    /// Returns the number of turns completed at a time `after` the start of the first one, s.
    pub fn turn_at(&self, after: f64) -> f64 {
        let last = (self.count - 1.0).max(0.0);
        let mut turns = 0.0;
        if self.varies_much() {
            let mut left = after;
            while turns < last {
                let duration = self.duration(turns);
                if left < duration {
                    break;
                }
                left -= duration;
                turns += 1.0;
            }
            return turns;
        }
        // Newton's method on the sum, which is smooth in the number of turns.
        turns = (after / self.duration(0.0)).clamp(0.0, last);
        for _ in 0..60 {
            let late = after - self.time(turns);
            let next = (turns + late / self.duration(turns)).clamp(0.0, last);
            let change = (next - turns).abs();
            turns = next;
            if change <= 0.01 {
                break;
            }
        }
        turns = turns.floor();
        let left = after - self.time(turns);
        if left < 0.0 && turns > 0.0 {
            turns - 1.0
        } else if turns < last && left >= self.duration(turns) {
            turns + 1.0
        } else {
            turns
        }
    }

    /// Returns the start of the turn after the first `turns` of the cell.
    pub fn mark(&self, turns: f64) -> TurnStart {
        let (sum, lost) = two_sum(self.first.t.0, self.time(turns));
        TurnStart {
            turns: self.first.turns + turns,
            t: two_sum(sum, lost + self.first.t.1),
            kinetic: turns.mul_add(self.gain, self.first.kinetic),
            ..TurnStart::default()
        }
    }

    /// Returns the error bound of the duration of `turns` turns, s, for an error of the energies, J.
    pub fn error(&self, turns: f64, energy_error: f64) -> f64 {
        let energy_error = energy_error + f64::EPSILON * self.turn.largest_work();
        let steepest = [0.0, turns].map(|turns| self.slope.value(self.x(turns)).abs() / self.half);
        let steepest = steepest[0].max(steepest[1]);
        let truncation = self.tail / self.difference.degree() as f64;
        turns * steepest * energy_error + (truncation + self.turn.error) * self.time(turns)
    }
}
