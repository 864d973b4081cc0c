//! What fitted curves say of their errors, against curves that are known.

use std::f64::consts::TAU;

use crate::noise::Random;

use slider_crank::numeric::fit::{Curve, Kind, Samples, Size};

/// Numbers from −1/2 to 1/2 that do not repeat soon.
fn scattered(i: usize) -> f64 {
    (i as f64 * 0.618_033_988_749_895).fract() - 0.5
}

/// Uneven arguments over five periods.
fn arguments(count: usize) -> Vec<f64> {
    let last = (count - 1) as f64;
    let inside = |i: usize| f64::from(i > 0 && i + 1 < count);
    (0..count)
        .map(|i| 5.0 * (i as f64 + 0.4 * inside(i) * scattered(7 * i)) / last)
        .collect()
}

/// A wave that grows, and its derivatives.
fn wave(t: f64) -> [f64; 3] {
    let (size, rate) = ((0.3 * t).exp(), TAU);
    let (sin, cos) = (rate * t).sin_cos();
    [
        size * sin,
        size * (0.3 * sin + rate * cos),
        size * ((0.09 - rate * rate) * sin + 0.6 * rate * cos),
    ]
}

fn through(t: &[f64], noise: f64) -> (Curve, bool) {
    let target: Vec<f64> = t
        .iter()
        .enumerate()
        .map(|(i, t)| wave(*t)[0] + noise * 12f64.sqrt() * scattered(i * i))
        .collect();
    let samples = Samples {
        t,
        target: &target,
        weight: None,
        floor: 1e-16,
    };
    let mut curve = Curve::fit(&samples, Kind::Spline, Size::Auto).expect("a spline");
    let compared = curve.compare(&samples);
    (curve, compared)
}

/// Errors between samples without noise, at places that are not samples, in what is said of them.
#[test]
fn splines_through_samples() {
    for count in [70, 110, 200, 400] {
        let (curve, compared) = through(&arguments(count), 0.0);
        assert!(compared, "{count}");
        let sigma = curve.quality().sigma;
        for k in [1, 2] {
            let (mut squares, mut inside) = (0.0, 0);
            let gradient = std::array::from_fn(|l| f64::from(k == l));
            for i in 0..1000 {
                let t = 5.0 * (f64::from(i) + 0.37) / 1000.0;
                let state = curve.state(t);
                let variance = sigma * sigma * state.variance(&gradient) + state.bias_of(&gradient);
                let error = (state.value[k] - wave(t)[k]).abs() / variance.sqrt();
                squares += error * error / 1000.0;
                inside += usize::from(error < 2.0);
            }
            let error = squares.sqrt();
            assert!((0.03..=1.2).contains(&error), "{count} {k}: {error}");
            assert!(inside >= 950, "{count} {k}: {inside}");
        }
    }
}

/// Noise that hardly shows beside the motion is found in the differences of the samples.
#[test]
fn noise_of_splines_through_samples() {
    for noise in [1e-6, 1e-8, 1e-10] {
        let (curve, compared) = through(&arguments(100), noise);
        let part = curve.quality().sigma / noise;
        assert!(compared && (0.7..=1.3).contains(&part), "{noise:e}: {part}");
    }
}

/// Part of the second derivatives of noisy samples of a curve, as fitted, that are within 1.96 standard errors of the
/// true ones, and the root mean square of their errors in standard errors.
fn second_derivatives(
    kind: Kind,
    curve: fn(f64) -> [f64; 2],
    noise: f64,
    draws: u64,
) -> (f64, f64) {
    const ROWS: usize = 400;
    let t: Vec<f64> = (0..ROWS).map(|i| i as f64 / 199.5 - 1.0).collect();
    let (mut inside, mut squares) = (0.0, 0.0);
    for draw in 0..draws {
        let mut random =
            Random(0x9E37_79B9_7F4A_7C15 ^ (draw + 1).wrapping_mul(0xD134_2543_DE82_EF95));
        let target: Vec<f64> = t
            .iter()
            .map(|t| curve(*t)[0] + noise * random.normal())
            .collect();
        let samples = Samples {
            t: &t,
            target: &target,
            weight: None,
            floor: 1e-16,
        };
        let fit = Curve::fit(&samples, kind, Size::Auto).expect("a fit");
        let second = [0.0, 0.0, 1.0];
        for t in &t {
            let state = fit.state(*t);
            let variance = fit.quality().sigma.powi(2) * state.variance(&second);
            let square =
                (state.value[2] - curve(*t)[1]).powi(2) / (variance + state.bias_of(&second));
            inside += f64::from(square <= 1.96 * 1.96);
            squares += square;
        }
    }
    let all = draws as f64 * ROWS as f64;
    (inside / all, (squares / all).sqrt())
}

/// A peak, and its second derivative: its terms fall off by 1.07 each.
fn peak(t: f64) -> [f64; 2] {
    let (a, off) = (200.0, t - 0.2);
    let below = 1.0 + a * off * off;
    [1.0 / below, (6.0 * a * off * off - 2.0) * a / below.powi(3)]
}

/// A motion that needs more terms than are tried: those that are left out are many.
#[test]
fn polynomials_of_the_highest_degree() {
    let (share, error) = second_derivatives(Kind::Polynomial, peak, 1e-5, 6);
    assert!(
        share >= 0.9 && (0.2..=1.2).contains(&error),
        "{share} {error}"
    );
}

/// Part of a wave, and its second derivative.
fn slow_wave(t: f64) -> [f64; 2] {
    let sin = (1.3 * t + 0.4).sin();
    [sin, -1.69 * sin]
}

/// Noise that hides all but about six terms leaves the roughness of the rest to a guess.
#[test]
fn splines_that_are_hardly_more_than_polynomials() {
    for noise in [1e-3, 3e-4, 1e-4, 3e-5, 1e-5] {
        let (share, error) = second_derivatives(Kind::Spline, slow_wave, noise, 40);
        let is_right = (0.9..=0.995).contains(&share) && (0.6..=1.2).contains(&error);
        assert!(is_right, "{noise:e}: {share} {error}");
    }
}

/// Even rotation with a faint fast wave, and its second derivative.
fn faint_wave(t: f64) -> [f64; 2] {
    let sin = 0.015 * (40.0 * t + 0.4).sin();
    [20.0 * t + sin, -1600.0 * sin]
}

/// The same with strong slow waves.
fn faint_beside_strong(t: f64) -> [f64; 2] {
    let slow = 0.3 * (7.0 * t).sin();
    let [value, second] = faint_wave(t);
    [value + slow, second - 49.0 * slow]
}

/// Noise hides a wave but from those who look for it: curves of a broad spectrum would be as smooth as if it were not there.
#[test]
fn splines_of_faint_waves() {
    for curve in [faint_wave, faint_beside_strong] {
        for noise in [0.02, 0.01, 1e-3] {
            let (share, error) = second_derivatives(Kind::Spline, curve, noise, 30);
            let is_right = (0.9..=0.99).contains(&share) && (0.6..=1.3).contains(&error);
            assert!(is_right, "{noise:e}: {share} {error}");
        }
    }
}

/// The angle of uneven rotation, and its derivatives.
fn turning(t: f64, turns: f64) -> [f64; 3] {
    let rate = TAU * turns;
    let (sin, cos) = (rate * t).sin_cos();
    [
        rate * t + 0.03 * sin,
        rate * (1.0 + 0.03 * cos),
        -0.03 * rate * rate * sin,
    ]
}

/// Long records of many turns, whose pieces are told from a part of them: errors are what is said of them, and rows of
/// which nothing but digits is left are not followed one by one.
#[test]
fn splines_of_many_turns() {
    let count = 60_000;
    for (turns, noise, most) in [(200.0, 0.0, 30_000), (1000.0, 1e-4, count)] {
        let random = &mut Random(5);
        let t: Vec<f64> = (0..count).map(|i| i as f64 / count as f64).collect();
        let value = |t: &f64| turning(*t, turns)[0] + noise * random.normal();
        let target: Vec<f64> = t.iter().map(value).collect();
        let samples = Samples {
            t: &t,
            target: &target,
            weight: None,
            floor: f64::EPSILON * TAU * turns / 12f64.sqrt(),
        };
        let mut curve = Curve::fit(&samples, Kind::Spline, Size::Auto).expect("a spline");
        curve.compare(&samples);
        assert!(curve.size() < most, "{} pieces", curve.size());
        // Computed angles are off by their rounding.
        let sigma = curve.quality().sigma.hypot(f64::EPSILON * TAU * turns);
        for k in 0..3 {
            let mut gradient = [0.0; 3];
            gradient[k] = 1.0;
            let (mut inside, mut places) = (0, 0);
            for i in (500..count - 500).step_by(101) {
                let state = curve.state(t[i]);
                let variance = sigma * sigma * state.variance(&gradient) + state.bias_of(&gradient);
                let error = (state.value[k] - turning(t[i], turns)[k]).abs();
                let said = 1.96 * variance.sqrt() + state.rounding_of(&gradient);
                places += 1;
                inside += i32::from(error <= said);
            }
            let share = f64::from(inside) / f64::from(places);
            assert!(share >= 0.9, "{turns} turns, derivative {k}: {share}");
            assert!(
                noise == 0.0 || share <= 0.99,
                "{turns} turns, derivative {k}: {share}"
            );
        }
    }
}
