//! Interpolation and double-double arithmetic compared with published values and with integers.

use std::f64::consts::TAU;

use crate::support::exact::SinCos;
use slider_crank::numeric::angle::TAU_REST;
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::numeric::interpolate::{Interpolation, TableInterpolant, period_remainder};

/// Reference values of an independent implementation (scipy.interpolate.PchipInterpolator).
#[test]
fn pchip_matches_published_implementation() {
    let curve = TableInterpolant::new(
        vec![0.0, 1.0, 2.0, 4.0, 5.0],
        vec![0.0, 1.0, 4.0, 3.0, 3.5],
        Interpolation::Pchip,
        None,
    );
    for (at, expected) in PCHIP_REFERENCE {
        let value = curve.value(*at);
        assert!((value - expected).abs() < 1e-14, "{at}: {value} {expected}");
    }
    assert!(curve.value(5.1).is_nan() && curve.value(-0.1).is_nan());
}

const PCHIP_REFERENCE: &[(f64, f64)] = &[
    (0.25, 0.0859375),
    (0.9, 0.8505),
    (1.5, 2.6875),
    (2.5, 3.84375),
    (3.75, 3.04296875),
    (4.2, 3.0253333333333337),
    (5.0, 3.5),
];

/// 2π/3 minus its float, from 40 digits of π; a period that is not a fraction of a turn is kept as it is.
#[test]
fn what_the_float_of_a_period_lacks() {
    assert_eq!(period_remainder(TAU), TAU_REST);
    assert_eq!(period_remainder(2.0 * TAU), 2.0 * TAU_REST);
    assert_eq!(period_remainder(0.5 * TAU), 0.5 * TAU_REST);
    let third = period_remainder(2.0943951023931953);
    assert!(
        (third - 2.296_728_565_598_444e-16).abs() < 1e-30,
        "{third:e}"
    );
    assert_eq!(
        (period_remainder(4.269881), period_remainder(0.1)),
        (0.0, 0.0)
    );
}

/// Triangle wave, compared with integer multiples of 2⁻⁵⁰.
#[test]
fn periods_are_taken_off_without_rounding() {
    let unit = 2f64.powi(-50);
    let period = 4807406341574107u64;
    let curve = TableInterpolant::new(
        vec![0.0, period as f64 * unit * 0.5],
        vec![0.0, period as f64 * unit * 0.5],
        Interpolation::Linear,
        Some(period as f64 * unit),
    );
    for at in [33.7, 17.3, 4.5, -0.1, -29.9, 9.0] {
        let rest = ((at / unit) as i64).rem_euclid(period as i64);
        let expected = rest as f64 / period as f64;
        let expected = expected.min(1.0 - expected);
        let value = curve.value(at) / (period as f64 * unit);
        assert!(
            (value - expected).abs() <= 2.5e-16,
            "{at}: {value:e} {expected:e}"
        );
    }
}

#[test]
fn a_periodic_curve_closes_smoothly() {
    let n = 24;
    let x: Vec<f64> = (0..n).map(|i| TAU * f64::from(i) / f64::from(n)).collect();
    let y: Vec<f64> = x.iter().map(|x| x.sin()).collect();
    let curve = TableInterpolant::new(x, y, Interpolation::Pchip, Some(TAU));
    let slope = |at: f64| (curve.value(at + 1e-7) - curve.value(at - 1e-7)) / 2e-7;
    assert!((curve.value(1.0) - curve.value(1.0 + 40.0 * TAU)).abs() < 1e-13);
    assert!((curve.value(1.0) - curve.value(1.0 - 3.0 * TAU)).abs() < 1e-14);
    assert!((slope(0.0) - slope(TAU - 1e-9)).abs() < 1e-6);
}

/// Returns the difference of a number from its nearest float.
fn low(a: DoubleDouble) -> f64 {
    (a - a.value()).value()
}

fn close(a: DoubleDouble, b: DoubleDouble) -> bool {
    (a - b).value().abs() <= 1e-30 * b.value().abs().max(1.0)
}

#[test]
fn the_rules_of_arithmetic_hold() {
    let mut a = DoubleDouble::from(0.3);
    for k in 1..500 {
        let b = DoubleDouble::from(1.7 * f64::from(k)).sqrt() / 3.0;
        assert!(close(a / b * b, a) && close((a - b) + b, a));
        assert!(close(
            b * b * 9.0,
            DoubleDouble::from(1.7 * f64::from(k)) * (b / b)
        ));
        assert!(close((a + b) * (a - b), a * a - b * b));
        a = (a * b + 0.1) / (b + 1.0);
    }
    // 1/3 is 0.333…: the second half holds the remainder of the first.
    let third = DoubleDouble::ONE / 3.0;
    assert_eq!((third * 3.0 - 1.0).value().abs() < 1e-31, low(third) != 0.0);
    assert!(DoubleDouble::from(-1.0).sqrt().value().is_nan());
}

#[test]
fn sine_and_cosine_are_right_to_the_last_digits() {
    for k in -400..400 {
        let a = DoubleDouble::from(0.37 * f64::from(k)) + 1e-17;
        let b = DoubleDouble::from(1.1 - 5000.0 * f64::from(k));
        let ((sin_a, cos_a), (sin_b, cos_b)) = (a.sin_cos(), b.sin_cos());
        let (sin, cos) = (a + b).sin_cos();
        assert!(close(sin_a * sin_a + cos_a * cos_a, DoubleDouble::ONE));
        // The sum of the angles is rounded as well.
        let close = |x: DoubleDouble, y| (x - y).value().abs() < 1e-25;
        assert!(close(sin, sin_a * cos_b + cos_a * sin_b), "{k}");
        assert!(close(cos, cos_a * cos_b - sin_a * sin_b), "{k}");
    }
    // Digits 17 to 32 of the sine and cosine of one half.
    let (sin, cos) = DoubleDouble::from(0.5).sin_cos();
    assert_eq!((sin.value(), cos.value()), 0.5f64.sin_cos());
    assert!((low(sin) - -5.103969860556013e-18).abs() < 1e-31);
    assert!((low(cos) - -4.2623149864279997e-17).abs() < 1e-31);
}
