//! Gauss-Legendre quadrature: nodes and weights, composite and adaptive rules.

use std::f64::consts::PI;
use std::sync::LazyLock;

/// Inner nodes (1 ∓ 1/√5)/2 of Lobatto's rule with four points on [0, 1], whose weights are 1/12 at the ends and 5/12 inside
/// (Abramowitz and Stegun, 25.4.32).
pub const LOBATTO: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];

/// Returns node and weight number `i` (from 0) of the rule with `n` points on [0, 1], by Newton's method on the
/// Legendre polynomial (Abramowitz and Stegun, 25.4.29 and 22.16.6).
pub fn legendre(n: u32, i: usize) -> (f64, f64) {
    let mut x = (PI * (i as f64 + 0.75) / (f64::from(n) + 0.5)).cos();
    let mut slope = 1.0;
    for _ in 0..20 {
        let (mut p, mut before) = (x, 1.0);
        for k in 2..=n {
            let k = f64::from(k);
            (p, before) = (((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k, p);
        }
        slope = f64::from(n) * (x * p - before) / (x * x - 1.0);
        let next = x - p / slope;
        if next == x {
            break;
        }
        x = next;
    }
    (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
}

/// Evaluates a Legendre series at many places, by its recurrence.
pub fn legendre_series<const K: usize, const N: usize>(
    coefficients: &[f64; K],
    x: [f64; N],
) -> [f64; N] {
    let (mut p, mut before) = ([1.0; N], [0.0; N]);
    let mut sum = [0.0; N];
    for (k, coefficient) in coefficients.iter().enumerate() {
        let n = k as f64;
        let (by_last, by_before) = ((2.0 * n + 1.0) / (n + 1.0), n / (n + 1.0));
        for i in 0..N {
            sum[i] += coefficient * p[i];
            (p[i], before[i]) = (by_last * x[i] * p[i] - by_before * before[i], p[i]);
        }
    }
    sum
}

/// Bounds the change of a Legendre series over a fraction of [−1, 1] by Markov's inequality: |P_k'| ≤ k(k + 1)/2.
pub fn legendre_change(coefficients: &[f64], part: f64) -> f64 {
    let changes = coefficients.iter().enumerate().map(|(k, c)| {
        let steepest = (k * (k + 1)) as f64;
        c.abs() * (steepest * part).min(2.0)
    });
    changes.sum()
}

/// Integrates f over [from, to] by the rule with three points on each of `panels` equal panels.
pub fn composite(f: impl Fn(f64) -> f64, from: f64, to: f64, panels: u32) -> f64 {
    let h = (to - from) / f64::from(panels);
    let node = 0.5 * h * 0.6f64.sqrt();
    let panel = |i: u32| {
        let middle = from + (f64::from(i) + 0.5) * h;
        5.0 * (f(middle - node) + f(middle + node)) + 8.0 * f(middle)
    };
    (0..panels).map(panel).sum::<f64>() * h / 18.0
}

/// Nodes and weights of the rule with 6 points on [0, 1].
pub static RULE_6: LazyLock<[(f64, f64); 6]> = LazyLock::new(rule);
/// Nodes and weights of the rule with 14 points on [0, 1].
pub static RULE_14: LazyLock<[(f64, f64); 14]> = LazyLock::new(rule);
/// Nodes and weights of the rule with 18 points on [0, 1].
pub static RULE_18: LazyLock<[(f64, f64); 18]> = LazyLock::new(rule);

fn rule<const N: usize>() -> [(f64, f64); N] {
    std::array::from_fn(|i| legendre(N as u32, i))
}

/// Integrates f over the pieces between ends in rising or falling order, bisecting where the halves together differ from
/// the whole by more than `tolerance` and by more than rounding of f, at its mean size over all pieces, and of its
/// argument; in each piece the worst part first, at most a thousand times.
pub fn adaptive(f: &dyn Fn(f64) -> f64, ends: &[f64], tolerance: f64) -> f64 {
    let pieces = ends.windows(2).map(|ends| by_rule(f, ends[0], ends[1]));
    let pieces: Vec<(f64, f64)> = pieces.collect();
    let rounding: f64 = pieces.iter().map(|(_, rounding)| rounding).sum();
    let length: f64 = ends.windows(2).map(|ends| (ends[1] - ends[0]).abs()).sum();
    let integral = |(ends, (whole, _)): (&[f64], (f64, f64))| {
        bisected(f, [ends[0], ends[1]], whole, tolerance, rounding / length)
    };
    ends.windows(2).zip(pieces).map(integral).sum()
}

/// Integrates f over [from, to] from its integral by one rule; `rounding` is that of the integral over a unit of length.
fn bisected(
    f: &dyn Fn(f64) -> f64,
    [from, to]: [f64; 2],
    first: f64,
    tolerance: f64,
    rounding: f64,
) -> f64 {
    let part = |a: f64, b: f64, whole: f64| {
        let middle = 0.5 * (a + b);
        let (left, left_rounding) = by_rule(f, a, middle);
        let (right, right_rounding) = by_rule(f, middle, b);
        let rounding = (left_rounding + right_rounding).max(rounding * (b - a).abs());
        Part {
            ends: [a, middle, b],
            halves: [left, right],
            excess: (left + right - whole).abs() - tolerance.max(rounding),
        }
    };
    let mut parts = vec![part(from, to, first)];
    for _ in 0..1000 {
        let open = parts.iter().enumerate();
        let open = open.filter(|(_, part)| part.excess > 0.0 && part.excess.is_finite());
        let Some((worst, _)) = open.max_by(|a, b| a.1.excess.total_cmp(&b.1.excess)) else {
            break;
        };
        let ([a, middle, b], [left, right]) = (parts[worst].ends, parts[worst].halves);
        parts[worst] = part(a, middle, left);
        parts.push(part(middle, b, right));
    }
    parts
        .iter()
        .map(|part| part.halves[0] + part.halves[1])
        .sum()
}

/// Part of an interval of integration.
struct Part {
    /// Ends and middle of the part.
    ends: [f64; 3],
    /// Integrals over the halves.
    halves: [f64; 2],
    /// Difference of the halves from the whole, less the allowed difference.
    excess: f64,
}

/// Integrates f over [a, b] by the rule with 14 points; returns the integral and its rounding error.
fn by_rule(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> (f64, f64) {
    let (mut value, mut size) = (0.0, 0.0);
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for (x, w) in RULE_14.iter() {
        let y = f(a + x * (b - a));
        value += w * y;
        size += w * y.abs();
        (least, most) = (least.min(y), most.max(y));
    }
    let length = b - a;
    // Rounding of the argument moves f along its slope, about (most − least)/length.
    let of_argument = 2.0 * a.abs().max(b.abs()) * (most - least);
    let rounding = f64::EPSILON * (8.0 * size * length.abs() + of_argument);
    (length * value, rounding)
}
