//! Exponential function of many numbers at once, in a form that the compiler vectorises.

use std::f64::consts::LOG2_E;

use multiversion::multiversion;

/// Minimax coefficients of r (eʳ + 1)/(eʳ − 1) − 2 in r² on ±½ ln 2 (fdlibm, e_exp.c).
const SLOPE: [f64; 5] = [
    1.666_666_666_666_660_2e-1,
    -2.777_777_777_701_559_3e-3,
    6.613_756_321_437_934e-5,
    -1.653_390_220_546_525_2e-6,
    4.138_136_797_057_238_5e-8,
];

/// Computes exponentials, accurate to about one unit in the last place.
#[multiversion(targets("x86_64+avx2"))]
pub fn of<const N: usize>(exponents: &[f64; N]) -> [f64; N] {
    let mut values = [0.0; N];
    // Within this range all results are normal numbers.
    let range = 700.0;
    let mut near = true;
    for i in 0..N {
        near &= exponents[i].abs() < range;
        values[i] = near_one(exponents[i]);
    }
    if !near {
        values = exponents.map(f64::exp);
    }
    values
}

#[inline(always)]
fn near_one(exponent: f64) -> f64 {
    // 1.5·2⁵², added to a number of moderate size, leaves the nearest whole number in the last bits.
    let shift = 1.5 / f64::EPSILON;
    let shifted = exponent * LOG2_E + shift;
    let (twos, bits) = (shifted - shift, shifted.to_bits());
    // ln 2 in two parts (fdlibm, e_exp.c): products of the first with small whole numbers are exact.
    let ln_2 = [
        f64::from_bits(0x3FE6_2E42_FEE0_0000),
        f64::from_bits(0x3DEA_39EF_3579_3C76),
    ];
    let (high, low) = (exponent - twos * ln_2[0], twos * ln_2[1]);
    let r = high - low;
    let z = r * r;
    let [p1, p2, p3, p4, p5] = SLOPE;
    let c = r - z * (p1 + z * (p2 + z * (p3 + z * (p4 + z * p5))));
    let value = 1.0 - ((low - r * c / (2.0 - c)) - high);
    value * f64::from_bits(bits.wrapping_add(1023) << 52)
}

#[cfg(test)]
mod tests {
    #[test]
    fn exponentials_are_those_of_the_standard_library() {
        for i in -1000..1000 {
            let exponents = [0.001, 0.03, 0.69].map(|step| step * f64::from(i));
            for (value, exponent) in super::of(&exponents).into_iter().zip(exponents) {
                let off = value / exponent.exp() - 1.0;
                assert!(off.abs() < 2.0 * f64::EPSILON, "{exponent}: {off}");
            }
        }
        assert_eq!(super::of(&[0.0, 800.0, -800.0]), [1.0, f64::INFINITY, 0.0]);
    }
}
