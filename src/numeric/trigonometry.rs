//! Sine and cosine of many angles at once, without branches, in a form that the compiler vectorises.

use std::f64::consts::{FRAC_2_PI, PI};

/// π/2 in three parts (fdlibm, e_rem_pio2.c): the first two have few digits, and their products with small whole
/// numbers are exact.
const QUARTER: [f64; 3] = [
    f64::from_bits(0x3FF9_21FB_5440_0000),
    f64::from_bits(0x3DD0_B461_1A60_0000),
    f64::from_bits(0x3BA3_198A_2E03_7073),
];

/// Minimax coefficients on ±π/4 (fdlibm, k_sin.c and k_cos.c).
const SINE: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COSINE: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// Computes sines and cosines of angles (rad), accurate to about one unit in the last place.
#[inline(always)]
pub fn sin_cos<const N: usize>(angles: &[f64; N]) -> ([f64; N], [f64; N]) {
    let (mut sin, mut cos) = ([0.0; N], [0.0; N]);
    // The reduction to one quadrant leaves smaller angles with all digits.
    let is_near = |angle: f64| angle.abs() < 1e4 * PI;
    let mut near = true;
    for i in 0..N {
        near &= is_near(angles[i]);
        (sin[i], cos[i]) = near_zero(angles[i]);
    }
    if !near {
        for i in (0..N).filter(|i| !is_near(angles[*i])) {
            (sin[i], cos[i]) = angles[i].sin_cos();
        }
    }
    (sin, cos)
}

#[inline(always)]
fn near_zero(angle: f64) -> (f64, f64) {
    // 1.5·2⁵², added to a number of moderate size, leaves the nearest whole number in the last bits.
    let shift = 1.5 / f64::EPSILON;
    let shifted = angle * FRAC_2_PI + shift;
    let (quarters, bits) = (shifted - shift, shifted.to_bits());
    let r = ((angle - quarters * QUARTER[0]) - quarters * QUARTER[1]) - quarters * QUARTER[2];
    let z = r * r;
    let [s1, s2, s3, s4, s5, s6] = SINE;
    let [c1, c2, c3, c4, c5, c6] = COSINE;
    let s = r + (r * z) * (s1 + z * (s2 + z * (s3 + z * (s4 + z * (s5 + z * s6)))));
    let tail = z * z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6)))));
    // 1 − z/2 rounds; the tail returns the loss.
    let half = 0.5 * z;
    let head = 1.0 - half;
    let c = head + (((1.0 - head) - half) + tail);
    let odd = 0u64.wrapping_sub(bits & 1);
    let (s, c) = (s.to_bits(), c.to_bits());
    let sine = ((s & !odd) | (c & odd)) ^ ((bits & 2) << 62);
    let cosine = ((c & !odd) | (s & odd)) ^ ((bits.wrapping_add(1) & 2) << 62);
    (f64::from_bits(sine), f64::from_bits(cosine))
}
