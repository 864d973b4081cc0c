//! Gauss-Legendre quadrature: nodes and weights, composite and adaptive rules.

use std::f64::consts::PI;

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
        x -= p / slope;
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

/// Returns nodes and weights of the rule with 14 points on [0, 1].
pub fn rule_14() -> &'static [(f64, f64); 14] {
    static RULE: std::sync::OnceLock<[(f64, f64); 14]> = std::sync::OnceLock::new();
    RULE.get_or_init(|| std::array::from_fn(|i| legendre(14, i)))
}

/// Returns nodes and weights of the rule with 18 points on [0, 1].
pub fn rule_18() -> &'static [(f64, f64); 18] {
    static RULE: std::sync::OnceLock<[(f64, f64); 18]> = std::sync::OnceLock::new();
    RULE.get_or_init(|| std::array::from_fn(|i| legendre(18, i)))
}

/// Integrates f over [from, to], bisecting where the halves together differ from the whole by more than `tolerance` and
/// by more than rounding of f and of its argument; the worst part first, at most a thousand times.
pub fn adaptive(f: &dyn Fn(f64) -> f64, from: f64, to: f64, tolerance: f64) -> f64 {
    let part = |a: f64, b: f64, whole: f64| {
        let middle = 0.5 * (a + b);
        let halves = [Sum::over(f, a, middle), Sum::over(f, middle, b)];
        let [left, right] = [halves[0].value, halves[1].value];
        let rounding = halves[0].rounding + halves[1].rounding;
        Part {
            ends: [a, middle, b],
            halves: [left, right],
            excess: (left + right - whole).abs() - tolerance.max(rounding),
        }
    };
    let mut parts = vec![part(from, to, Sum::over(f, from, to).value)];
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

/// Integral by one application of the rule, and its rounding error.
struct Sum {
    value: f64,
    rounding: f64,
}

impl Sum {
    fn over(f: &dyn Fn(f64) -> f64, a: f64, b: f64) -> Sum {
        let (mut value, mut size) = (0.0, 0.0);
        let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
        for (x, w) in rule_14() {
            let y = f(a + x * (b - a));
            value += w * y;
            size += w * y.abs();
            (least, most) = (least.min(y), most.max(y));
        }
        let length = b - a;
        // Rounding of the argument moves f along its slope, about (most − least)/length.
        let of_argument = 2.0 * a.abs().max(b.abs()) * (most - least);
        Sum {
            value: length * value,
            rounding: f64::EPSILON * (8.0 * size * length.abs() + of_argument),
        }
    }
}
