//! Student's t distribution: half-width of a 95 % band.

use std::f64::consts::FRAC_PI_2;

use super::{gauss, root};

/// Returns the half-width of a 95 % band in standard errors: the 97.5 % point of Student's distribution with this many
/// degrees of freedom ν, at least 1 and not always whole. With t = √ν tan φ the density is proportional to cos^(ν−1) φ
/// and negligible nine standard deviations out.
pub fn half_band(freedom: f64) -> f64 {
    // The series is exact to rounding: its next term is below 8/freedom⁵.
    let asymptotic = 2000.0;
    if freedom > asymptotic {
        return expanded(freedom);
    }
    let end = FRAC_PI_2.min(9.0 / freedom.sqrt());
    let density = |angle: f64| angle.cos().powf(freedom - 1.0);
    // The power takes digits from the density: the tolerance is that of the digits left.
    let rounding = 0.005 * f64::EPSILON * freedom.sqrt();
    let beyond = |angle: f64| gauss::adaptive(&density, &[angle, end], rounding);
    let all = beyond(0.0);
    let angle = root::bracketed(|angle| beyond(angle) - 0.05 * all, 0.0, end);
    freedom.sqrt() * angle.unwrap_or(end).tan()
}

/// Returns the point from that of the normal distribution, by powers of 1/freedom (Abramowitz and Stegun, 26.7.5).
fn expanded(freedom: f64) -> f64 {
    let x: f64 = 1.959_963_984_540_054;
    let (x3, x5, x7, x9) = (x.powi(3), x.powi(5), x.powi(7), x.powi(9));
    let g1 = (x3 + x) / 4.0;
    let g2 = (5.0 * x5 + 16.0 * x3 + 3.0 * x) / 96.0;
    let g3 = (3.0 * x7 + 19.0 * x5 + 17.0 * x3 - 15.0 * x) / 384.0;
    let g4 = (79.0 * x9 + 776.0 * x7 + 1482.0 * x5 - 1920.0 * x3 - 945.0 * x) / 92160.0;
    let per = 1.0 / freedom;
    x + per * (g1 + per * (g2 + per * (g3 + per * g4)))
}
