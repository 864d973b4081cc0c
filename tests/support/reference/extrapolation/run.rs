//! Integration of the pieces, step by step.

use super::{Fineness, Pieces, State};
use slider_crank::numeric::double_double::DoubleDouble;

/// Number of columns of the extrapolation: the order of a step is twice this.
const COLUMNS: usize = 10;
/// Accuracy of the location of an event, relative to its step.
const LOCATED: f64 = 1e-26;
/// Shortest step relative to the run; shorter ones count as failure.
const SHORTEST: f64 = 1e-25;

pub(super) struct Run<'a, const N: usize, const M: usize, P> {
    pub pieces: &'a P,
    pub fineness: Fineness,
    pub evaluations: u64,
}

impl<const N: usize, const M: usize, P: Pieces<N, M>> Run<'_, N, M, P> {
    /// Integrates to the end of a mode, and returns the margin that ended it, or to the last time; none if neither is
    /// reached.
    pub fn piece(
        &mut self,
        mode: P::Mode,
        y: &mut State<N>,
        h: &mut f64,
        t_end: f64,
    ) -> Option<Option<usize>> {
        let mut at_corner = false;
        while y[0].value() < t_end {
            let stop = self.pieces.next_time(y[0].value()).min(t_end);
            if at_corner {
                // A margin may jump there.
                let mut margins = self.pieces.margins(mode, y).into_iter();
                if let Some(which) = margins.position(|margin| margin.value() < 0.0) {
                    return Some(Some(which));
                }
            }
            let left = DoubleDouble::from(stop) - y[0];
            let last = *h >= left.value() * (1.0 - 1e-9);
            let step = if last { left } else { DoubleDouble::from(*h) };
            if self.evaluations > self.fineness.evaluations {
                return None;
            }
            let (mut end, error) = self.step(mode, y, step);
            if error.is_nan() || error > 1.0 {
                *h = step.value() * growth(error).min(0.5);
                if *h < SHORTEST * t_end {
                    return None;
                }
                continue;
            }
            if let Some((which, part)) = self.ended(mode, y, &end, step) {
                *y = self.step(mode, y, part).0;
                return Some(Some(which));
            }
            if last {
                end[0] = DoubleDouble::from(stop);
            }
            let grown = step.value() * growth(error);
            *h = if last { grown.max(*h) } else { grown };
            *y = end;
            at_corner = last;
        }
        Some(None)
    }

    /// Returns the first margin to vanish in a step, and the time within the step, s.
    fn ended(
        &mut self,
        mode: P::Mode,
        y: &State<N>,
        end: &State<N>,
        step: DoubleDouble,
    ) -> Option<(usize, DoubleDouble)> {
        let after = self.pieces.margins(mode, end);
        let mut first: Option<(usize, DoubleDouble)> = None;
        for (which, margin) in after.iter().enumerate() {
            let until = if margin.value() < 0.0 {
                Some(step)
            } else {
                self.least(mode, y, end, step, which)
            };
            let Some(until) = until else {
                continue;
            };
            let part = self.when(mode, y, until, which);
            if first.is_none_or(|(_, before)| part.value() < before.value()) {
                first = Some((which, part));
            }
        }
        first
    }

    /// Returns the place of the minimum of a margin inside a step, if it is negative there: by cubic Hermite
    /// interpolation.
    fn least(
        &mut self,
        mode: P::Mode,
        y: &State<N>,
        end: &State<N>,
        step: DoubleDouble,
        which: usize,
    ) -> Option<DoubleDouble> {
        let h = step.value();
        let slope = |y: &State<N>| {
            let rates = self.pieces.rates(mode, y);
            let ahead = std::array::from_fn(|i| y[i] + rates[i] * (1e-8 * h));
            let [here, there] = [y, &ahead].map(|y| self.pieces.margins(mode, y)[which]);
            (here.value(), 1e8 * (there - here).value())
        };
        let ((a, from), (b, to)) = (slope(y), slope(end));
        if !(from < 0.0 && to > 0.0) {
            return None;
        }
        // The derivative of the cubic: from + 2 (p) u + 3 (q) u².
        let (q, p) = (from + to - 2.0 * (b - a), 3.0 * (b - a) - 2.0 * from - to);
        let root = (p * p - 3.0 * q * from).sqrt();
        let u = -from / (p + root);
        let part = step * u.clamp(0.01, 0.99);
        let there = self.step(mode, y, part).0;
        let margin = self.pieces.margins(mode, &there)[which];
        (margin.value() < 0.0).then_some(part)
    }

    /// Returns the time within a step (s) at which a margin vanishes that is negative at the end of the step.
    fn when(
        &mut self,
        mode: P::Mode,
        y: &State<N>,
        step: DoubleDouble,
        which: usize,
    ) -> DoubleDouble {
        let mut value = |h: DoubleDouble| {
            let end = self.step(mode, y, h).0;
            self.pieces.margins(mode, &end)[which]
        };
        let (mut to, mut from) = ((step, value(step)), (step, DoubleDouble::ZERO));
        // A margin that is zero at the start, up to rounding, is positive somewhere before it vanishes.
        for _ in 0..60 {
            from.0 = from.0 * 0.25;
            from.1 = value(from.0);
            if from.1.value() > 0.0 {
                break;
            }
            to = from;
        }
        if from.1.value() <= 0.0 {
            return DoubleDouble::ZERO;
        }
        // Regula falsi (Illinois): the weight of a retained end is halved.
        for _ in 0..60 {
            let width = to.0 - from.0;
            if width.value().abs() <= LOCATED * step.value() {
                break;
            }
            let next = from.0 + width * (from.1 / (from.1 - to.1));
            let there = value(next);
            if there.value() == 0.0 {
                return next;
            }
            if (there.value() < 0.0) == (to.1.value() < 0.0) {
                from.1 = from.1 * 0.5;
            } else {
                from = to;
            }
            to = (next, there);
        }
        to.0
    }

    /// Makes a step; returns its error relative to the allowed error as well.
    fn step(&mut self, mode: P::Mode, y: &State<N>, h: DoubleDouble) -> (State<N>, f64) {
        let first = self.pieces.rates(mode, y);
        let sizes = self.pieces.sizes(y);
        let mut table: Vec<State<N>> = Vec::with_capacity(COLUMNS);
        let mut error = f64::NAN;
        for row in 0..COLUMNS {
            let parts = 2 * (row + 1);
            let mut last = self.midpoint(mode, y, &first, h, parts);
            // Aitken-Neville scheme in powers of the square of the small step.
            for (column, entry) in table.iter_mut().enumerate() {
                let ratio = parts as f64 / (2 * (row - column)) as f64;
                let weight = DoubleDouble::ONE / (DoubleDouble::from(ratio) * ratio - 1.0);
                let before = *entry;
                let better = std::array::from_fn(|i| last[i] + (last[i] - before[i]) * weight);
                *entry = last;
                error = (1..N).fold(0.0, |most: f64, i| {
                    let change = (better[i] - last[i]).value().abs();
                    let part = change / (self.fineness.tolerance * sizes[i]);
                    if part.is_finite() {
                        most.max(part)
                    } else {
                        f64::INFINITY
                    }
                });
                last = better;
            }
            table.push(last);
            self.evaluations += parts as u64 + 1;
        }
        (table[COLUMNS - 1], error)
    }

    /// Applies the modified midpoint rule with this number of parts.
    fn midpoint(
        &self,
        mode: P::Mode,
        y: &State<N>,
        first: &State<N>,
        h: DoubleDouble,
        parts: usize,
    ) -> State<N> {
        let small = h / parts as f64;
        let double = small * 2.0;
        let mut before = *y;
        let mut now: State<N> = std::array::from_fn(|i| y[i] + first[i] * small);
        for _ in 1..parts {
            let rates = self.pieces.rates(mode, &now);
            let next = std::array::from_fn(|i| before[i] + rates[i] * double);
            (before, now) = (now, next);
        }
        // Gragg's smoothing: without it the rates at the end of the step, and a jump next to it, would be unseen.
        let rates = self.pieces.rates(mode, &now);
        std::array::from_fn(|i| (now[i] + before[i] + rates[i] * small) * 0.5)
    }
}

/// Returns the factor by which the step may change.
fn growth(error: f64) -> f64 {
    if !error.is_finite() {
        return 0.2;
    }
    let order = 2.0 * COLUMNS as f64 - 1.0;
    (0.8 * error.max(1e-40).powf(-1.0 / order)).clamp(0.1, 4.0)
}
