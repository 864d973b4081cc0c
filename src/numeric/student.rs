//! Student's distribution.

use std::f64::consts::PI;

/// Degrees of freedom from which the series is exact to rounding: its next term is below 8/freedom^5.
const MANY: f64 = 2000.0;

/// Half of a 95 % band in standard errors: the 97.5 % point of Student's distribution with this many degrees of
/// freedom, at least 1 and not always whole.
pub fn half_band(freedom: f64) -> f64 {
    let start = expanded(freedom);
    if freedom > MANY {
        return start;
    }
    // Newton for the logarithm of both tails over that of t: concave and falling, so that it converges from either side.
    let mut t = start;
    for _ in 0..60 {
        let outside = both_tails(t, freedom);
        let slope = -2.0 * t * density(t, freedom) / outside;
        let step = (0.05 / outside).ln() / slope;
        t *= step.exp();
        if step.abs() < 4.0 * f64::EPSILON {
            break;
        }
    }
    t
}

/// The point from that of the normal distribution, by powers of 1/freedom (Abramowitz and Stegun, 26.7.5).
fn expanded(freedom: f64) -> f64 {
    const NORMAL: f64 = 1.959_963_984_540_054;
    let x = NORMAL;
    let (x3, x5, x7, x9) = (x.powi(3), x.powi(5), x.powi(7), x.powi(9));
    let g1 = (x3 + x) / 4.0;
    let g2 = (5.0 * x5 + 16.0 * x3 + 3.0 * x) / 96.0;
    let g3 = (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / 384.0;
    let g4 = (79.0 * x9 + 776.0 * x7 + 1482.0 * x5 - 1920.0 * x3 - 945.0 * x) / 92160.0;
    let per = 1.0 / freedom;
    x + per * (g1 + per * (g2 + per * (g3 + per * g4)))
}

/// Probability density at t.
fn density(t: f64, freedom: f64) -> f64 {
    let power = -0.5 * (freedom + 1.0) * (t * t / freedom).ln_1p();
    half_step(0.5 * freedom) / (PI * freedom).sqrt() * power.exp()
}

/// Probability beyond -t and t: the incomplete beta function I_x(freedom/2, 1/2) at x = freedom/(freedom + t²), by
/// its continued fraction (NIST Digital Library of Mathematical Functions, 8.17.22), evaluated by Lentz's method.
fn both_tails(t: f64, freedom: f64) -> f64 {
    let (a, b) = (0.5 * freedom, 0.5);
    let x = freedom / (freedom + t * t);
    let (mut c, mut d, mut fraction) = (f64::INFINITY, 1.0, 1.0);
    for i in 1..10_000 {
        let m = f64::from(i / 2);
        let coefficient = match i % 2 {
            0 => m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
            _ => -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0)),
        };
        c = 1.0 + coefficient / c;
        d = 1.0 / (1.0 + coefficient * d);
        fraction *= c * d;
        if (c * d - 1.0).abs() < f64::EPSILON {
            break;
        }
    }
    // 1 - x without cancellation, and 1/B(a, 1/2) as a ratio of gamma functions.
    let rest = t * t / (freedom + t * t);
    let front = (-a * (t * t / freedom).ln_1p()).exp() * rest.sqrt() * half_step(a) / PI.sqrt();
    front * fraction / a
}

/// Γ(x + 1/2)/Γ(x): stepped up to where the asymptotic series (Abramowitz and Stegun, from 6.1.47) is exact.
fn half_step(x: f64) -> f64 {
    let (mut x, mut factor) = (x, 1.0);
    while x < 60.0 {
        factor *= x / (x + 0.5);
        x += 1.0;
    }
    let y = 1.0 / x;
    let series = [
        -399.0 / 262_144.0,
        -21.0 / 32_768.0,
        5.0 / 1024.0,
        1.0 / 128.0,
        -1.0 / 8.0,
        1.0,
    ];
    factor
        * x.sqrt()
        * series
            .into_iter()
            .fold(869.0 / 4_194_304.0, |sum, c| sum * y + c)
}
