//! Interpolation in a table: linear, or by the monotone cubic of Fritsch and Butland ("pchip").

use std::f64::consts::TAU;
use std::iter;

use super::angle::TAU_REST;
use super::enclosure::{Enclosed, Interval, Rectangle};
use super::exact::two_product;

named! {
    /// Method of interpolation between two rows.
    #[derive(Default)]
    pub enum Interpolation {
        /// Cubic Hermite pieces that keep the monotony of the data.
        #[default]
        Pchip = "pchip",
        /// Straight lines.
        Linear = "linear",
    }
}

/// Interpolating curve through given points.
#[derive(Clone, Debug, PartialEq)]
pub struct TableInterpolant {
    /// Arguments of the points, rising; of a periodic curve with the first point of the next period.
    pub x: Vec<f64>,
    /// Values at the points.
    pub y: Vec<f64>,
    slope: Option<Vec<f64>>,
    /// Period, if any.
    pub period: Option<f64>,
    /// Intended period minus the float of the period.
    period_remainder: f64,
    spacing: f64,
}

impl TableInterpolant {
    /// Builds the curve through the points (x, y); x must rise strictly and have at least two values. With a period the
    /// last point must lie less than one period after the first.
    pub fn new(
        mut x: Vec<f64>,
        mut y: Vec<f64>,
        kind: Interpolation,
        period: Option<f64>,
    ) -> TableInterpolant {
        if let Some(period) = period {
            x.push(x[0] + period);
            y.push(y[0]);
        }
        let slope = (kind == Interpolation::Pchip).then(|| slopes(&x, &y, period.is_some()));
        let spacing = (x[x.len() - 1] - x[0]) / (x.len() - 1) as f64;
        TableInterpolant {
            x,
            y,
            slope,
            period,
            period_remainder: period.map_or(0.0, period_remainder),
            spacing,
        }
    }

    /// Returns the smallest and the largest argument; a periodic curve takes any.
    pub fn range(&self) -> (f64, f64) {
        (self.x[0], self.x[self.x.len() - 1])
    }

    /// Returns the first point after `at`, where the curve is not smooth; infinite if there is none.
    pub fn next_point(&self, at: f64) -> f64 {
        self.points_after(at)
            .next()
            .map_or(f64::INFINITY, |[x, _]| x)
    }

    /// Iterates over the points after `at` with their values, in rising order.
    fn points_after(&self, at: f64) -> impl Iterator<Item = [f64; 2]> {
        let turns = match self.period {
            Some(period) => ((at - self.x[0]) / period).floor() * period,
            None => 0.0,
        };
        // A point that equals `at` but for rounding is not a next one.
        let after = at + 1e-12 * self.spacing + 2.0 * f64::EPSILON * at.abs();
        let next = self.x.partition_point(|x| x + turns <= after);
        // The last point of a period is the first one of the next.
        let periods = self.period.into_iter();
        let later =
            periods.flat_map(|period| (1..u32::MAX).map(move |k| (f64::from(k) * period, 1)));
        let starts = iter::once((0.0, next)).chain(later);
        starts.flat_map(move |(further, first)| {
            let points = self.x[first..].iter().zip(&self.y[first..]);
            points.map(move |(x, y)| [x + (turns + further), *y])
        })
    }

    /// Returns the points between two arguments, repeated with the period, in rising order.
    pub fn points_between(&self, low: f64, high: f64) -> Vec<f64> {
        let inside = |x: &f64| low < *x && *x < high;
        let Some(period) = self.period else {
            return self.x.iter().copied().filter(inside).collect();
        };
        let own = &self.x[..self.x.len() - 1];
        let [first, last] = [low, high].map(|at| ((at - self.x[0]) / period).floor() as i64);
        let again = |k: i64| own.iter().map(move |x| x + k as f64 * period);
        (first..=last).flat_map(again).filter(inside).collect()
    }

    /// True for an argument within the range, but for its rounding.
    fn covers(&self, at: f64) -> bool {
        let (low, high) = self.range();
        let rounding = 4.0 * f64::EPSILON * low.abs().max(high.abs());
        (low - rounding..=high + rounding).contains(&at)
    }

    /// Returns the value at `at`; NaN outside the range of a curve that is not periodic.
    pub fn value(&self, at: f64) -> f64 {
        let (low, high) = self.range();
        let at = match self.period {
            Some(period) => low + reduced(at - low, period, self.period_remainder),
            None if self.covers(at) => at.clamp(low, high),
            None => return f64::NAN,
        };
        let i = self.interval(at);
        let (x0, x1) = (self.x[i], self.x[i + 1]);
        let (y0, y1) = (self.y[i], self.y[i + 1]);
        let h = x1 - x0;
        let s = (at - x0) / h;
        match &self.slope {
            None => y0 + s * (y1 - y0),
            Some(slope) => {
                let (d0, d1) = (slope[i] * h, slope[i + 1] * h);
                let rise = y1 - y0;
                y0 + s * (d0 + s * (3.0 * rise - 2.0 * d0 - d1 + s * (d0 + d1 - 2.0 * rise)))
            }
        }
    }

    /// Encloses the values over an interval: between points the curve is monotone. Where no point lies inside, the
    /// values are a polynomial of third degree, hence analytic.
    pub fn enclose(&self, over: Interval) -> Enclosed {
        let (low, high) = self.range();
        let Interval {
            low: from,
            high: to,
        } = over;
        if to - from >= high - low {
            let all = self.y.iter().map(|y| Interval::point(*y));
            let inside = self.period.is_some() || self.covers(from) && self.covers(to);
            return match all.reduce(Interval::hull) {
                Some(all) if inside => Enclosed::not_analytic(all),
                _ => Enclosed::UNKNOWN,
            };
        }
        let ends = [from, to].map(|at| self.value(at));
        let mut real = Interval::between(ends[0], ends[1]);
        // A point that equals the end but for rounding is not inside.
        let before = to - 1e-12 * self.spacing - 2.0 * f64::EPSILON * to.abs();
        let mut smooth = true;
        for [_, y] in self.points_after(from).take_while(|[x, _]| *x < before) {
            real = real.hull(Interval::point(y));
            smooth = false;
        }
        if smooth && real != Interval::WHOLE {
            Enclosed {
                real,
                plane: Rectangle::point(real.middle()),
                deviation: 0.0,
            }
        } else {
            Enclosed::not_analytic(real)
        }
    }

    /// Returns the index of the piece that holds `at`: guessed from the mean spacing, searched only if the guess fails.
    fn interval(&self, at: f64) -> usize {
        let last = self.x.len() - 2;
        let guess = (((at - self.x[0]) / self.spacing) as usize).min(last);
        if self.x[guess] <= at && at <= self.x[guess + 1] {
            return guess;
        }
        self.x.partition_point(|x| *x <= at).clamp(1, last + 1) - 1
    }
}

/// Reduces `at` modulo period to [0, period]; `period_remainder`: [`period_remainder`] of the period.
fn reduced(at: f64, period: f64, period_remainder: f64) -> f64 {
    let count = (at / period).floor();
    if count == 0.0 {
        return at;
    }
    // Rounded once: a separate product would add one rounding error to all angles of a period.
    ((-count).mul_add(period, at) - count * period_remainder).clamp(0.0, period)
}

/// Returns the intended period minus its float: turns of 2π, or one of up to 720 equal parts of a turn; else zero.
pub fn period_remainder(period: f64) -> f64 {
    let most = 720.0;
    let turns = (period / TAU).round().max(1.0);
    let parts = (TAU / period).round().max(1.0);
    let whole = (turns * TAU - parts * period).abs() <= 4.0 * f64::EPSILON * turns * TAU;
    if !whole || turns > most || parts > most {
        return 0.0;
    }
    let (meant, rest) = two_product(turns, TAU);
    let (given, lost) = two_product(parts, period);
    ((meant - given) + (rest - lost) + turns * TAU_REST) / parts
}

/// Computes slopes of the monotone cubic: the weighted harmonic mean of Fritsch and Butland (SIAM J. Sci. Stat. Comput.
/// 5 (1984) 300, eq. (5)) inside, the three-point formula with limits at open ends.
fn slopes(x: &[f64], y: &[f64], periodic: bool) -> Vec<f64> {
    let n = x.len();
    let h: Vec<f64> = x.windows(2).map(|w| w[1] - w[0]).collect();
    let rise: Vec<f64> = (0..n - 1).map(|i| (y[i + 1] - y[i]) / h[i]).collect();
    let inner = |left: usize, right: usize| {
        if rise[left] * rise[right] <= 0.0 {
            return 0.0;
        }
        let (w1, w2) = (2.0 * h[right] + h[left], h[right] + 2.0 * h[left]);
        (w1 + w2) / (w1 / rise[left] + w2 / rise[right])
    };
    let inside = (1..n - 1).map(|i| inner(i - 1, i));
    let mut slope: Vec<f64> = iter::once(0.0).chain(inside).chain([0.0]).collect();
    if periodic {
        slope[0] = inner(n - 2, 0);
        slope[n - 1] = slope[0];
    } else if n == 2 {
        slope.fill(rise[0]);
    } else {
        slope[0] = end_slope(h[0], h[1], rise[0], rise[1]);
        slope[n - 1] = end_slope(h[n - 2], h[n - 3], rise[n - 2], rise[n - 3]);
    }
    slope
}

fn end_slope(h0: f64, h1: f64, rise0: f64, rise1: f64) -> f64 {
    let slope = ((2.0 * h0 + h1) * rise0 - h0 * rise1) / (h0 + h1);
    if slope * rise0 <= 0.0 {
        0.0
    } else if rise0 * rise1 <= 0.0 && slope.abs() > 3.0 * rise0.abs() {
        3.0 * rise0
    } else {
        slope
    }
}
