//! Fitted curves against exactly known answers.

use slider_crank::numeric::fit::{Curve, Fourier, Kind, Polynomial, Rows, Samples, Size, Spline};

fn samples<'a>(t: &'a [f64], target: &'a [f64]) -> Samples<'a> {
    Samples {
        t,
        target,
        weight: None,
        floor: 0.0,
    }
}

/// Correct digits.
fn digits(found: f64, exact: f64) -> f64 {
    if found == exact {
        17.0
    } else {
        -((found - exact) / exact).abs().log10()
    }
}

/// Square roots of the diagonal of (XᵀX)⁻¹ for the powers 0 to 5 of 0, 1, ..., 20, inverted in fractions.
const UNIT_ERRORS: [f64; 6] = [
    0.911_946_607_129_666_3,
    1.001_443_432_869_499_8,
    0.330_210_015_263_894,
    0.042_995_454_316_312_22,
    0.002_392_083_988_396_236_4,
    4.759_235_282_025_574e-5,
];

/// The five problems of Wampler (J. Am. Statist. Assoc. 65 (1970) 549): polynomials of degree 5 over 0, 1, ..., 20, three of
/// them with deviations of growing size that are orthogonal to all polynomials of degree 5.
#[test]
fn wampler() {
    let t: Vec<f64> = (0..21).map(f64::from).collect();
    let deviations = [
        759.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 1838.0, -2048.0, 2048.0,
        -2048.0, 1838.0, -2048.0, 2048.0, -2048.0, 2523.0, -2048.0, 2048.0, -2048.0, 759.0,
    ];
    let ones = |t: f64| (0..6).map(|k| t.powi(k)).sum::<f64>();
    let tenths = |t: f64| (0..6).map(|k| (t / 10.0).powi(k)).sum::<f64>();
    let fit = |y: &[f64]| Polynomial::fit(&samples(&t, y), Size::Fixed(5));
    let worst = |fit: &Polynomial, exact: &dyn Fn(usize) -> f64| {
        let found = fit.powers().coefficients.iter().enumerate();
        found
            .map(|(k, c)| digits(*c, exact(k)))
            .fold(17.0, f64::min)
    };
    let first: Vec<f64> = t.iter().map(|t| ones(*t)).collect();
    assert!(worst(&fit(&first), &|_| 1.0) > 15.0);
    let second: Vec<f64> = t.iter().map(|t| tenths(*t)).collect();
    // The samples themselves are rounded: 13 digits of the smallest coefficient are what they hold.
    assert!(worst(&fit(&second), &|k| 0.1f64.powi(k as i32)) > 12.5);
    let squares: f64 = deviations.iter().map(|d| d * d).sum();
    for factor in [1.0, 100.0, 10_000.0] {
        let y: Vec<f64> = t
            .iter()
            .zip(deviations)
            .map(|(t, d)| ones(*t) + factor * d)
            .collect();
        let found = fit(&y);
        assert!(worst(&found, &|_| 1.0) > 14.0, "{factor}");
        let sigma = factor * (squares / 15.0).sqrt();
        assert!(digits(found.quality().sigma, sigma) > 14.5, "{factor}");
        for (error, exact) in found.powers().errors.iter().zip(UNIT_ERRORS) {
            assert!(digits(*error, exact) > 15.0, "{error} for {exact}");
        }
    }
}

/// Standard errors of a straight line over −n..n: σ/√(2n+1) for the constant, σ/√(Σ t²) for the slope; shifted by a million,
/// where the constant has lost six digits to the slope.
#[test]
fn standard_errors_of_a_line() {
    for shift in [0.0, 1e6] {
        let t: Vec<f64> = (-50..=50).map(|i| f64::from(i) + shift).collect();
        let y: Vec<f64> = t.iter().map(|t| 3.0 - 2.0 * t).collect();
        let powers = Polynomial::fit(&samples(&t, &y), Size::Fixed(1))
            .powers()
            .clone();
        let square = 50.0 * 51.0 * 101.0 / 3.0;
        assert!(digits(powers.errors[1], (1.0f64 / square).sqrt()) > 14.5);
        let constant: f64 = 1.0 / 101.0 + shift * shift / square;
        assert!(digits(powers.errors[0], constant.sqrt()) > 14.5);
        assert!(digits(powers.coefficients[0], 3.0) > 9.0);
        assert!(digits(powers.coefficients[1], -2.0) > 15.0);
        // ‖A‖ ‖A⁻¹‖ of the matrix of 1 and t, from its normal matrix with determinant 101·Σ(t − mean)².
        let trace = 101.0 + (square + 101.0 * shift * shift);
        let expected = trace / (101.0 * square).sqrt();
        assert!(
            digits(powers.condition, expected) > 12.0,
            "{}",
            powers.condition
        );
    }
}

/// A polynomial of degree 10 whose powers are ill-conditioned (10^14): (t + 5)^10 over −8.5 to −3, known to all its
/// binomial coefficients, as all samples are exact in 53 bits.
#[test]
fn ten_binomial_coefficients_and_derivatives() {
    let t: Vec<f64> = (0..23).map(|i| -8.5 + 0.25 * f64::from(i)).collect();
    let scale = 2f64.powi(20);
    let y: Vec<f64> = t
        .iter()
        .map(|t| (4.0 * (t + 5.0)).powi(10) / scale)
        .collect();
    let fit = Polynomial::fit(&samples(&t, &y), Size::Fixed(10));
    assert!(fit.powers().condition > 1e13);
    let mut binomial = 1.0;
    for k in (0..=10usize).rev() {
        let exact = binomial * 5f64.powi(10 - k as i32);
        assert!(
            digits(fit.powers().coefficients[k], exact) > 14.0,
            "{k}: {}",
            fit.powers().coefficients[k]
        );
        binomial = binomial * k as f64 / (11 - k) as f64;
    }
    let size = 3.5f64.powi(8) * 90.0;
    for t in t {
        let state = fit.state(t);
        let u = t + 5.0;
        for (found, exact, size) in [
            (state.value[1], 10.0 * u.powi(9), size),
            (state.value[2], 90.0 * u.powi(8), size),
        ] {
            assert!(
                (found - exact).abs() < 1e-11 * size,
                "{t}: {found} for {exact}"
            );
        }
        assert!((state.value[2] - 90.0 * u.powi(8)).abs() <= state.rounding[2] + 1e-12 * size);
    }
}

/// (3 (t − t₀))^10/2^30 over ±1 s about 1.7e9 s of the Unix clock, at times that are exact: both derivatives are right to
/// 1e-11 of their largest values, and at each time to what is stated beside them.
#[test]
fn derivatives_on_the_unix_clock() {
    let middle = 1_700_000_000.0;
    let t: Vec<f64> = (-64..=64).map(|i| middle + f64::from(i) / 64.0).collect();
    let scale = 2f64.powi(-30);
    let y: Vec<f64> = t
        .iter()
        .map(|t| (3.0 * (t - middle)).powi(10) * scale)
        .collect();
    let fit = Polynomial::fit(&samples(&t, &y), Size::Fixed(10));
    for t in t {
        let u = 3.0 * (t - middle);
        let exact = [u.powi(10), 30.0 * u.powi(9), 810.0 * u.powi(8)].map(|v| v * scale);
        let largest = [3f64.powi(10), 30.0 * 3f64.powi(9), 810.0 * 3f64.powi(8)];
        let state = fit.state(t);
        for k in 0..3 {
            let apart = (state.value[k] - exact[k]).abs();
            assert!(apart < 1e-11 * largest[k] * scale, "{k}, {u}: {apart:e}");
            let stated = 4.0 * state.rounding[k] + 1e-25 * largest[k] * scale;
            assert!(apart <= stated, "{k}, {u}: {apart:e} {stated:e}");
        }
    }
}

/// Derivatives of every kind of curve are those of its values.
#[test]
fn derivatives_are_consistent() {
    let t: Vec<f64> = (0..300).map(|i| 0.01 * f64::from(i)).collect();
    let y: Vec<f64> = t
        .iter()
        .map(|t| 1.0 + 9.0 * t + 0.3 * (9.0 * t).sin() + 0.01 * (77.7 * t).sin())
        .collect();
    for kind in Kind::ALL {
        let size = if kind == Kind::Spline {
            Size::Fixed(30)
        } else {
            Size::Fixed(6)
        };
        let curve = Curve::fit(&samples(&t, &y), kind, size).expect("a fit");
        for at in [0.503, 1.4, 2.71] {
            let h = 1e-4;
            let (a, b, c) = (curve.state(at - h), curve.state(at), curve.state(at + h));
            let first = (c.value[0] - a.value[0]) / (2.0 * h);
            let second = (c.value[1] - a.value[1]) / (2.0 * h);
            assert!(
                (b.value[1] - first).abs() < 1e-5 * first.abs().max(1.0),
                "{kind:?}"
            );
            assert!(
                (b.value[2] - second).abs() < 1e-4 * second.abs().max(10.0),
                "{kind:?}"
            );
        }
    }
}

/// The rotation and harmonics that a signal is made of are found.
/// Of a polynomial without noise the degree is the one it has, and terms that are not there widen nothing.
#[test]
fn a_polynomial_that_ends() {
    let t: Vec<f64> = (0..126).map(|i| 0.02 * f64::from(i)).collect();
    let exact = [0.0649, 0.522, 2.166, -2.129, 0.472];
    let target: Vec<f64> = t
        .iter()
        .map(|t| exact.iter().rev().fold(0.0, |sum, c| sum * t + c))
        .collect();
    for size in [Size::Auto, Size::Fixed(4), Size::Fixed(6)] {
        let fit = Polynomial::fit(&samples(&t, &target), size);
        if size != Size::Fixed(6) {
            assert_eq!(fit.degree(), 4);
        }
        for t in [0.0, 1.0, 2.5] {
            let state = fit.state(t);
            let second = 2.0 * exact[2] + t * (6.0 * exact[3] + t * 12.0 * exact[4]);
            assert!(
                (state.value[2] - second).abs() < 1e-10,
                "{}",
                state.value[2] - second
            );
            // The samples are rounded to a unit of 2e-16 or less.
            let deviation = (state.covariance[5].sqrt() * 1e-15, state.bias[5].sqrt());
            assert!(deviation.0 < 1e-10 && deviation.1 < 1e-10, "{deviation:?}");
        }
    }
}

#[test]
fn harmonics_that_are_there() {
    let t: Vec<f64> = (0..400).map(|i| 1.0 + 0.005 * f64::from(i)).collect();
    let (omega, middle) = (21.7, 0.5 * (t[0] + t[399]));
    let y: Vec<f64> = t
        .iter()
        .map(|t| {
            let psi = omega * (t - middle);
            0.4 + psi + 0.2 * psi.cos() - 0.1 * psi.sin() + 0.03 * (2.0 * psi).sin()
        })
        .collect();
    let fit = Fourier::fit(&samples(&t, &y), Size::Fixed(3)).expect("a fit");
    let exact = [0.4, omega, 0.2, -0.1, 0.0, 0.03, 0.0, 0.0];
    for (found, exact) in fit.coefficients().0.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-13, "{found} for {exact}");
    }
}

/// Ten samples in each turn, always at the same angles, tell four harmonics; further ones are those four again.
#[test]
fn harmonics_at_the_same_angles_of_each_turn() {
    let motion = |turns: f64| {
        let phi = std::f64::consts::TAU * turns;
        0.3 + phi + 0.02 * (phi + 0.4).sin() + 0.006 * (2.0 * phi + 1.0).sin()
    };
    let noise = |i: i64| 1e-4 * ((i * i % 100_003 * 7919 % 1009) as f64 / 1009.0 - 0.5);
    for rows in [4000, 60_000] {
        let t: Vec<f64> = (0..rows).map(|i| i as f64 / 10.0).collect();
        let y: Vec<f64> = (0..rows)
            .map(|i| motion(t[i as usize]) + noise(i))
            .collect();
        let samples = samples(&t, &y);
        let fit = Fourier::fit(&samples, Size::Auto).expect("a fit");
        assert!(fit.harmonics() <= 4, "{} harmonics", fit.harmonics());
        // Noise of 2.9e-5 over a tenth of the parameters of the samples: less than 2e-6.
        for turns in [1.23, 77.04, 198.77, 399.0] {
            let off = fit.value(turns) - motion(turns);
            assert!(off.abs() < 1e-5, "{rows} rows, {turns} turns: off by {off}");
        }
        let more = Fourier::fit(&samples, Size::Fixed(5)).expect_err("too many");
        assert!(more.contains("no more than 4 harmonics"), "{more}");
    }
}

/// A spline has no penalty on a cubic.
#[test]
fn a_cubic_is_a_spline() {
    let t: Vec<f64> = (0..50).map(|i| 0.1 * f64::from(i)).collect();
    let y: Vec<f64> = t
        .iter()
        .map(|t| 1.0 - t + 0.5 * t * t - 0.2 * t * t * t)
        .collect();
    let spline = Spline::fit(
        &Samples {
            floor: 1e-13,
            ..samples(&t, &y)
        },
        Size::Auto,
    )
    .expect("a fit");
    for t in [0.0, 1.234, 4.9] {
        let state = spline.state(t);
        assert!(
            (state.value[2] - (1.0 - 1.2 * t)).abs() < 1e-9,
            "{t}: {:?}",
            state.value
        );
    }
}

/// A spline under a strong penalty, fitted again to the same samples, is the same but for rounding far below its errors: the
/// digits of coefficients of 220 rad give differences of 64 times those, which the strongest penalty, e^26 of the mean
/// pivot, makes at most half of e^13 times as large, 0.07 of a standard error if all fall together.
#[test]
fn a_spline_comes_to_rest() {
    let t: Vec<f64> = (0..20_000).map(|i| 1e-4 * f64::from(i)).collect();
    let mut random = 88_172_645_463_325_252_u64;
    let mut noise = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let y: Vec<f64> = t
        .iter()
        .map(|t| 100.0 + 60.0 * t + 0.1 * (4.0 * t).sin() + 1e-3 * noise())
        .collect();
    let samples = samples(&t, &y);
    let before = Spline::fit(&samples, Size::Fixed(1024)).expect("a spline");
    let after = before.again(&Rows::from(&samples)).expect("a spline");
    for t in t.iter().step_by(37) {
        let state = after.state(*t);
        let error = after.quality().sigma * state.covariance[0].sqrt();
        let change = (state.value[0] - before.value(*t)).abs();
        assert!(change < 1e-2 * error, "{t}: {}", change / error);
    }
}

/// What fits work on is counted: whether samples have noise, none, or are rounded to steps that a slow motion takes long
/// over, a few nodes of many samples each stand for them, and no square is lost.
#[test]
fn very_many_samples_are_fitted_by_few_rows() {
    let count = 400_000;
    let t: Vec<f64> = (0..count)
        .map(|i| f64::from(i) / f64::from(count))
        .collect();
    let mut random = 1_u64;
    let mut noise = || {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let turns = |t: f64| 0.3 + 20.0 * t + 0.05 * (20.0 * t).sin();
    let steps = |step: f64| move |y: f64| (y / step).round() * step;
    let cases: [(Vec<f64>, f64); 4] = [
        (t.iter().map(|t| turns(*t) + 1e-4 * noise()).collect(), 0.0),
        (t.iter().map(|t| turns(*t)).collect(), 0.0),
        (t.iter().map(|t| steps(1e-3)(turns(*t))).collect(), 1e-3),
        (
            t.iter().map(|t| steps(5e-3)(turns(0.05 * t))).collect(),
            5e-3,
        ),
    ];
    for (case, (y, step)) in cases.iter().enumerate() {
        let samples = Samples {
            floor: step / 12f64.sqrt(),
            ..samples(&t, y)
        };
        for kind in Kind::ALL {
            let rows = kind.rows(&samples, Size::Auto, 1e-14);
            assert!(
                rows.number() * 8 <= t.len(),
                "{case}, {kind:?}: {}",
                rows.number()
            );
            if kind == Kind::Fourier && case == 3 {
                continue;
            }
            // As many samples as they stand for are counted and weighed.
            let curve = Curve::to(&rows, kind, Size::Auto).expect("a curve");
            let squares = t.iter().zip(y).map(|(t, y)| (y - curve.value(*t)).powi(2));
            let squares: f64 = squares.sum();
            let quality = curve.quality();
            // A few roundings of numbers up to 20, by the inequality of Cauchy and Schwarz.
            let one = 1e-14 * f64::from(count).sqrt();
            let rounding = one * (one + 2.0 * squares.sqrt());
            assert!(
                (quality.squares - squares).abs() < 1e-6 * squares + rounding,
                "{case}, {kind:?}: {} {squares}",
                quality.squares
            );
        }
    }
}
