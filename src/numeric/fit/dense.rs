//! Smooth functions at many rising arguments: where these are dense, Chebyshev series through values at few places stand for
//! them.
//!
//! Values at the places between that tell a series off by more than rounding make it one over half as many arguments.

use std::array;

use super::State;
use crate::numeric::chebyshev::{Rule, Series, largest};

/// Degree of the series.
const DEGREE: usize = 16;

/// Gaps between the points of the series in whose middle it is looked at.
const GAPS: [f64; 3] = [2.5, 7.5, 12.5];

/// Arguments for each value that is taken, below which a series does not pay.
const PAYS: usize = 3;

/// Series over as many arguments after which longer ones are tried again.
const PATIENCE: usize = 4;

/// Arguments for which a series is evaluated at a time.
const LANES: usize = 8;

/// Units of rounding of its largest value to which a function is known in any case.
const KNOWN: f64 = 4.0;

/// What a function gives at an argument, and how far off each entry may be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entries<const N: usize> {
    pub values: [f64; N],
    pub slack: [f64; N],
}

/// Takes what a function gives for each of rising arguments, one after the other. `smooth` tells how many of some arguments,
/// from the first on, it is smooth between.
pub(super) fn along<const N: usize>(
    t: &[f64],
    smooth: impl Fn(&[f64]) -> usize,
    exact: impl Fn(f64) -> Entries<N>,
    mut take: impl FnMut([f64; N]),
) {
    let least = PAYS * (DEGREE + 1 + GAPS.len());
    let (mut from, mut length, mut passed) = (0, t.len(), 0);
    while from < t.len() {
        let rest = &t[from..];
        let some = &rest[..length.min(smooth(rest)).clamp(1, rest.len())];
        if some.len() < least {
            some.iter().for_each(|t| take(exact(*t).values));
        } else if let Some(block) = Block::of(some, &exact) {
            block.along(some, &mut take);
            passed += 1;
            if passed == PATIENCE {
                (length, passed) = (2 * length, 0);
            }
        } else {
            (length, passed) = (some.len() / 2, 0);
            continue;
        }
        from += some.len();
    }
}

/// Part of its largest value to which a mean product is followed.
const PRODUCTS: f64 = 1e-10;

/// Times what rounding does to a sum to which a derivative is followed: arguments are rounded as well.
const ROUNDED: f64 = 8.0;

/// Takes the states of a curve for each of rising arguments, one after the other.
pub(super) fn states(
    t: &[f64],
    smooth: impl Fn(&[f64]) -> usize,
    state: impl Fn(f64) -> State,
    mut take: impl FnMut(State),
) {
    let exact = |t: f64| {
        let State {
            value,
            rounding,
            covariance,
            bias,
        } = state(t);
        let mut entries = Entries {
            values: [0.0; 18],
            slack: [f64::INFINITY; 18],
        };
        entries.values[..3].copy_from_slice(&value);
        entries.values[3..6].copy_from_slice(&rounding);
        entries.values[6..12].copy_from_slice(&covariance);
        entries.values[12..].copy_from_slice(&bias);
        entries.slack[..3].copy_from_slice(&rounding.map(|rounding| ROUNDED * rounding));
        for (slack, product) in entries.slack[6..].iter_mut().zip(&entries.values[6..]) {
            *slack = PRODUCTS * product.abs();
        }
        entries
    };
    along(t, smooth, exact, |entries: [f64; 18]| {
        let part = |from: usize| array::from_fn(|k| entries[from + k]);
        take(State {
            value: array::from_fn(|k| entries[k]),
            rounding: array::from_fn(|k| entries[3 + k].max(0.0)),
            covariance: part(6),
            bias: part(12),
        });
    });
}

/// Series for the entries of a function over some arguments.
struct Block<const N: usize> {
    middle: f64,
    half: f64,
    series: [Series; N],
}

impl<const N: usize> Block<N> {
    /// None where series do not follow the function.
    fn of(t: &[f64], exact: &impl Fn(f64) -> Entries<N>) -> Option<Block<N>> {
        let [first, last] = [t[0], t[t.len() - 1]];
        let (middle, half) = (0.5 * first + 0.5 * last, 0.5 * last - 0.5 * first);
        let rule = Rule::of(DEGREE);
        let mut slack = [0.0f64; N];
        let at = rule.points().iter().map(|x| exact(middle + half * x));
        let at: Vec<Entries<N>> = at.collect();
        let series = array::from_fn(|entry| {
            let mut of_points = at.iter().map(|at| at.values[entry]);
            let values = rule.values(|_| of_points.next().unwrap_or(0.0));
            let allowed = at.iter().map(|at| at.slack[entry]);
            slack[entry] = allowed.fold(KNOWN * f64::EPSILON * largest(&values), f64::max);
            if values[..=DEGREE].iter().all(|value| *value == values[0]) {
                let mut constant = array::from_fn(|_| 0.0);
                constant[0] = values[0];
                Series::new(0, constant)
            } else {
                rule.series(&values)
            }
        });
        let block = Block {
            middle,
            half,
            series,
        };
        let angle = |gap: f64| std::f64::consts::PI * (gap / DEGREE as f64 - 0.5);
        let follows = GAPS.into_iter().all(|gap| {
            let x = angle(gap).sin();
            let wanted = exact(middle + half * x).values;
            let off = |entry: usize| (block.series[entry].value(x) - wanted[entry]).abs();
            // Not-a-number is not followed.
            (0..N).all(|entry| off(entry) <= slack[entry])
        });
        follows.then_some(block)
    }

    fn along(&self, t: &[f64], take: &mut impl FnMut([f64; N])) {
        let per = 1.0 / self.half;
        for some in t.chunks(LANES) {
            let last = some.len() - 1;
            let x = array::from_fn(|lane| per * (some[lane.min(last)] - self.middle));
            let values: [[f64; LANES]; N] = array::from_fn(|entry| self.series[entry].values(&x));
            let of_lane = |lane: usize| array::from_fn(|entry| values[entry][lane]);
            (0..some.len()).for_each(|lane| take(of_lane(lane)));
        }
    }
}
