//! Maxima of a function of one variable, by Brent's method.

use std::cmp::Ordering;

use super::{difference, root};

/// (3 − √5)/2, the smaller part of the golden section.
const GOLDEN_PART: f64 = 0.381_966_011_250_105_1;
/// Final width of the interval, as a part of it: about where a smooth maximum differs by rounding alone.
const FINAL_WIDTH: f64 = 1.0 / (1u32 << 30) as f64;

/// Locates the maximum of a function with one maximum between a and b, and its value: by parabolas through three
/// points, else by the golden section (Brent, Algorithms for Minimization without Derivatives, 1973, ch. 5).
pub fn largest(f: impl FnMut(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    largest_to(f, [a.min(b), a.max(b)], FINAL_WIDTH * (b - a).abs())
}

/// Locates the maximum as [`largest`], to about twice a width.
pub fn largest_to(mut f: impl FnMut(f64) -> f64, [a, b]: [f64; 2], width: f64) -> (f64, f64) {
    let first = a + GOLDEN_PART * (b - a);
    let first = (first, f(first));
    brent(&mut f, [a, b], [first; 3], 0.0, width)
}

/// Locates the maximum of a function next to a place, and its value: `known` at the place and its neighbours, of which
/// the place itself may be one.
pub fn beside(mut f: impl FnMut(f64) -> f64, known: [(f64, f64); 3]) -> (f64, f64) {
    let [from, here, to] = known;
    let width = to.0 - from.0;
    let found = if from.0 < here.0 && here.0 < to.0 {
        let (next, last) = if from.1 > to.1 {
            (from, to)
        } else {
            (to, from)
        };
        let (ends, best) = ([from.0, to.0], [here, next, last]);
        brent(&mut f, ends, best, width, FINAL_WIDTH * width)
    } else {
        largest(f, from.0, to.0)
    };
    if found.1 > here.1 { found } else { here }
}

/// Locates the maximum next to the best of the places in order at which a function is known, and its value.
pub fn beside_best(f: impl FnMut(f64) -> f64, known: &[(f64, f64)]) -> (f64, f64) {
    let best = (0..known.len()).max_by(|i, j| known[*i].1.total_cmp(&known[*j].1));
    let best = best.unwrap_or(0);
    let after = (best + 1).min(known.len() - 1);
    beside(f, [best.saturating_sub(1), best, after].map(|i| known[i]))
}

/// Locates the local maxima of a function that places in order resolve, except at the first and the last of them, and
/// their values. A maximum may be a corner; a plateau counts once, at its first place.
pub fn peaks(f: impl Fn(f64) -> f64, places: &[f64]) -> Vec<(f64, f64)> {
    let known: Vec<(f64, f64)> = places.iter().map(|at| (*at, f(*at))).collect();
    let levels: Vec<&[(f64, f64)]> = known.chunk_by(|a, b| a.1 == b.1).collect();
    let tops = levels.windows(3);
    let tops = tops.filter(|w| w[1][0].1 > w[0][0].1 && w[1][0].1 > w[2][0].1);
    let refined = tops.map(|w| {
        let around = [w[0][w[0].len() - 1], w[1][0], w[2][0]];
        // A smooth maximum has the same value at two places at most.
        if w[1].len() > 2 {
            return around[1];
        }
        let found = beside(&f, around);
        // Values tell the place of a smooth maximum to the root of their rounding, slopes to their rounding.
        let (from, to) = (around[0].0, around[2].0);
        let slope = |at: f64| difference::slope(&f, at, (to - from) / 32.0);
        let by_slope = root::bracketed(slope, from, to).map(|at| (at, f(at)));
        let is_equal = |other: &(f64, f64)| found.1 - other.1 <= 4.0 * f64::EPSILON * found.1.abs();
        by_slope.filter(is_equal).unwrap_or(found)
    });
    refined.collect()
}

/// Finds the largest maximum, and its place, of a function known at rows in rising order. `refine` locates the maximum
/// beside the middle one of three rows; `None` without rows.
///
/// Every row that is no smaller than its neighbours is refined, unless the function, if it is concave over the two
/// cells beside the row, stays below the best maximum found: it lies below the chord of either cell extended over the
/// other one. The most promising rows, by the parabola through three, come first.
pub fn among_rows(
    rows: &[(f64, f64)],
    mut refine: impl FnMut([(f64, f64); 3]) -> (f64, f64),
) -> Option<(f64, f64)> {
    let larger = |best: (f64, f64), row: (f64, f64)| match row.1.total_cmp(&best.1) {
        Ordering::Greater => row,
        _ => best,
    };
    let mut best = rows.iter().copied().reduce(larger)?;
    let top = |rows: &[(f64, f64)], row: usize| {
        let after = (row + 1).min(rows.len() - 1);
        let beside = [row.saturating_sub(1), row, after].map(|row| rows[row]);
        let is_top = beside[1].1 >= beside[0].1.max(beside[2].1);
        is_top.then(|| (beside, reach(rows, row, beside)))
    };
    let sides = between_jumps(rows);
    let tops = sides.flat_map(|rows| (0..rows.len()).filter_map(move |row| top(rows, row)));
    let mut tops: Vec<_> = tops.collect();
    tops.sort_by(|(_, a), (_, b)| b.likely.total_cmp(&a.likely));
    // Bounds the work of a function that repeats or stays constant, as every row of it may be a top, to that of the rows.
    let evaluations = 32;
    let mut most_refined = (rows.len() / evaluations).max(8);
    for (beside, reach) in tops {
        // Rounding does not tell another maximum from an equal one.
        let rounding = 4.0 * f64::EPSILON * best.1.abs();
        let is_own = beside[1].0 == best.0;
        let beats = |value: f64| value - best.1 > if is_own { 0.0 } else { rounding };
        if most_refined > 0 && beats(reach.most) {
            most_refined -= 1;
            let found = refine(beside);
            if beats(found.1) {
                best = found;
            }
        }
    }
    Some(best)
}

/// Maximum beside a row.
struct Reach {
    /// Maximum of the parabola through three rows.
    likely: f64,
    /// Largest value of a concave function.
    most: f64,
}

/// Splits rows at cells shorter than √ε of a neighbouring one, as the two sides of a jump make them.
fn between_jumps(rows: &[(f64, f64)]) -> impl Iterator<Item = &[(f64, f64)]> {
    let cell = |i: usize| rows.get(i + 1).map_or(0.0, |next| next.0 - rows[i].0);
    let is_jump = move |i: &usize| {
        let beside = cell(i.saturating_sub(1)).max(cell(i + 1));
        cell(*i) <= f64::EPSILON.sqrt() * beside
    };
    let ends = (0..rows.len() - 1).filter(is_jump).map(|i| i + 1);
    let mut from = 0;
    ends.chain([rows.len()]).map(move |to| {
        let side = &rows[from..to];
        from = to;
        side
    })
}

/// Returns what the maximum beside a row that is no smaller than its neighbours may reach.
fn reach(rows: &[(f64, f64)], row: usize, [before, here, after]: [(f64, f64); 3]) -> Reach {
    let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    let (left, right) = (here.0 - before.0, after.0 - here.0);
    if left > 0.0 && right > 0.0 {
        let (rise, fall) = (slope(before, here), -slope(here, after));
        let along = rise * right - fall * left;
        let bend = ((rise + fall) * (left + right)).max(f64::MIN_POSITIVE);
        return Reach {
            likely: here.1 + 0.25 * along * along / bend,
            most: here.1 + (rise * right).max(fall * left),
        };
    }
    let (inner, next) = match left < right {
        true => (after, rows.get(row + 2)),
        false => (before, row.checked_sub(2).map(|next| &rows[next])),
    };
    // The chord of the next cell, extended.
    let reached = |next: &(f64, f64)| inner.1 + slope(*next, inner) * (here.0 - inner.0);
    let most = next.map_or(f64::INFINITY, reached);
    Reach { likely: most, most }
}

/// Runs Brent's iteration from the best three points, the best one first, and the size of the step before last.
fn brent(
    f: &mut dyn FnMut(f64) -> f64,
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
