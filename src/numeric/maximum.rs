//! Maxima of a function of one variable, by Brent's method.

use super::{difference, root};

/// (3 − √5)/2, the smaller part of the golden section.
const GOLDEN_PART: f64 = 0.381_966_011_250_105_1;
/// Final width of the interval, as a part of it: about where a smooth maximum differs by rounding alone.
const FINAL_WIDTH: f64 = 1.0 / (1u32 << 30) as f64;

/// Locates the maximum of a function with one maximum between a and b, and its value: by parabolas through three
/// points, and by the golden section where they do not serve (Brent, Algorithms for Minimization without Derivatives,
/// 1973, ch. 5).
pub fn largest(f: impl FnMut(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    largest_to(f, [a.min(b), a.max(b)], FINAL_WIDTH * (b - a).abs())
}

/// Locates the maximum as [`largest`], to about twice a width.
pub fn largest_to(mut f: impl FnMut(f64) -> f64, [a, b]: [f64; 2], width: f64) -> (f64, f64) {
    let first = a + GOLDEN_PART * (b - a);
    let first = (first, f(first));
    brent(f, [a, b], [first; 3], 0.0, width)
}

/// Locates the maximum as [`largest`], of a function known at three places in order and no smaller at the middle one.
pub fn between(f: impl FnMut(f64) -> f64, known: [(f64, f64); 3]) -> (f64, f64) {
    let [low, middle, high] = known;
    let (next, last) = if low.1 > high.1 {
        (low, high)
    } else {
        (high, low)
    };
    let width = high.0 - low.0;
    brent(
        f,
        [low.0, high.0],
        [middle, next, last],
        width,
        FINAL_WIDTH * width,
    )
}

/// Locates the maximum of a function next to a place, and its value: `known` at the place and its neighbours, of which
/// the place itself may be one.
pub fn beside(f: impl FnMut(f64) -> f64, known: [(f64, f64); 3]) -> (f64, f64) {
    let [(from, _), here, (to, _)] = known;
    let between = match from < here.0 && here.0 < to {
        true => between(f, known),
        false => largest(f, from, to),
    };
    if between.1 > here.1 { between } else { here }
}

/// Locates the maximum next to the best of the places in order at which a function is known, and its value.
pub fn beside_best(f: impl FnMut(f64) -> f64, known: &[(f64, f64)]) -> (f64, f64) {
    let best = (0..known.len()).max_by(|i, j| known[*i].1.total_cmp(&known[*j].1));
    let best = best.unwrap_or(0);
    let after = (best + 1).min(known.len() - 1);
    beside(f, [best.saturating_sub(1), best, after].map(|i| known[i]))
}

/// Locates the local maxima of a function that places in order resolve, except at the first and the last of them, and
/// their values. A maximum may be a corner; a plateau counts once.
pub fn peaks(f: impl Fn(f64) -> f64, places: &[f64]) -> Vec<(f64, f64)> {
    let mut known: Vec<(f64, f64)> = places.iter().map(|at| (*at, f(*at))).collect();
    known.dedup_by(|next, before| next.1 == before.1);
    let tops = known.windows(3);
    let tops = tops.filter(|w| w[1].1 > w[0].1 && w[1].1 > w[2].1);
    let refined = tops.map(|w| {
        let found = beside(&f, [w[0], w[1], w[2]]);
        // Values tell the place of a smooth maximum to the root of their rounding, slopes to their rounding.
        let (from, to) = (w[0].0, w[2].0);
        let slope = |at: f64| difference::slope(&f, at, (to - from) / 32.0);
        let by_slope = root::bracketed(slope, from, to).map(|at| (at, f(at)));
        let is_equal = |other: &(f64, f64)| found.1 - other.1 <= 4.0 * f64::EPSILON * found.1.abs();
        by_slope.filter(is_equal).unwrap_or(found)
    });
    refined.collect()
}

/// Runs Brent's iteration from the best three points, the best one first, and the size of the step before last.
fn brent(
    mut f: impl FnMut(f64) -> f64,
    [mut a, mut b]: [f64; 2],
    mut best: [(f64, f64); 3],
    mut last_step: f64,
    least_step: f64,
) -> (f64, f64) {
    let mut step = last_step;
    // Three times the steps of golden sections alone.
    for _ in 0..120 {
        let middle = 0.5 * (a + b);
        let [(x, at_x), (w, at_w), (v, at_v)] = best;
        if (x - middle).abs() + 0.5 * (b - a) <= 2.0 * least_step {
            break;
        }
        let rise = (x - w) * (at_v - at_x);
        let fall = (x - v) * (at_w - at_x);
        let slope = 2.0 * (fall - rise);
        let parabola = ((x - v) * fall - (x - w) * rise) / -slope;
        let serves = parabola.abs() < 0.5 * last_step.abs() && x + parabola > a && x + parabola < b;
        (last_step, step) = if serves {
            let near_end = (x + parabola - a).min(b - x - parabola) < 2.0 * least_step;
            let inwards = least_step.copysign(middle - x);
            (step, if near_end { inwards } else { parabola })
        } else {
            let rest = if x < middle { b - x } else { a - x };
            (rest, GOLDEN_PART * rest)
        };
        if step.abs() < least_step {
            step = least_step.copysign(step);
        }
        let u = x + step;
        let at_u = f(u);
        if at_u >= at_x {
            *(if u < x { &mut b } else { &mut a }) = x;
            best = [(u, at_u), (x, at_x), (w, at_w)];
        } else {
            *(if u < x { &mut a } else { &mut b }) = u;
            if at_u >= at_w || w == x {
                best = [(x, at_x), (u, at_u), (w, at_w)];
            } else if at_u >= at_v || v == x || v == w {
                best[2] = (u, at_u);
            }
        }
    }
    best[0]
}
