//! What fitted curves say of their errors, against curves that are known.

use std::f64::consts::TAU;

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
