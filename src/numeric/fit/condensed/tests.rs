//! Condensed samples against all of them.

use super::super::penalized::Normal;
use super::super::{Fourier, Size};
use super::*;

/// Sums of weight² t^k and weight t^k target over rows.
fn moments(rows: &Rows<'_>, degree: i32) -> [f64; 2] {
    let sum = |f: &dyn Fn(f64, f64, f64) -> f64| rows.iter().map(|(t, w, y)| f(t, w, y)).sum();
    [
        sum(&|t, w, _| w * w * t.powi(degree)),
        sum(&|t, w, y| w * t.powi(degree) * y),
    ]
}

#[test]
fn moments_and_squares_are_kept() {
    let t: Vec<f64> = (0..600)
        .map(|i| f64::from(i) / 600.0 + 0.4e-3 * f64::from(i % 7))
        .collect();
    let y: Vec<f64> = t
        .iter()
        .map(|t| (3.0 * t).sin() + (1e4 * t).cos())
        .collect();
    let weight: Vec<f64> = t.iter().map(|t| (3.0 * t).cos()).collect();
    for weight in [None, Some(weight.as_slice())] {
        let samples = Samples {
            t: &t,
            target: &y,
            weight,
            floor: 0.0,
        };
        let all = Rows::from(&samples);
        let few = all.condensed(&[100, 170, 310, 600]);
        let few = few.condensed(&[2 * NODES, 4 * NODES]);
        assert_eq!((few.t.len(), few.count), (2 * NODES, 600));
        for degree in 0..2 * NODES as i32 {
            let ([a, b], [c, d]) = (moments(&all, degree), moments(&few, degree));
            assert!((a - c).abs() < 1e-12 * a.abs(), "{degree}: {a} {c}");
            if degree < NODES as i32 {
                assert!((b - d).abs() < 1e-11, "{degree}: {b} {d}");
            }
        }
        let squares = |rows: &Rows<'_>| rows.iter().map(|(_, _, y)| y * y).sum::<f64>();
        assert!((squares(&few) + few.left - squares(&all)).abs() < 1e-10);
    }
}

#[test]
fn blocks_without_weight_or_with_few_samples_are_served() {
    let t: Vec<f64> = (0..200).map(|i| f64::from(i).sqrt()).collect();
    let y = vec![1.0; 200];
    let weight: Vec<f64> = t
        .iter()
        .map(|t| if *t < 12.0 { 0.0 } else { 1.0 })
        .collect();
    let samples = Samples {
        t: &t,
        target: &y,
        weight: Some(&weight),
        floor: 0.0,
    };
    let rows = Rows::from(&samples).condensed(&[10, 20, 22, 140, 148, 200]);
    let total: f64 = rows.iter().map(|(_, w, _)| w * w).sum();
    assert!((total - weight.iter().sum::<f64>()).abs() < 1e-12);
    assert!(rows.t.iter().all(|t| t.is_finite()));
}

/// A motion of many turns with noise, and a fast oscillation of given size.
fn record(oscillation: f64) -> (Vec<f64>, Vec<f64>) {
    let t: Vec<f64> = (0..60_000).map(|i| 1e-4 * f64::from(i)).collect();
    let mut random = 88_172_645_463_325_252_u64;
    let mut noise = || {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let one = |t: &f64| {
        let turn = 20.0 * t + 0.1 * (20.0 * t).sin() + 0.02 * (40.0 * t).cos();
        turn + oscillation * (2e3 * t).sin() + 1e-3 * noise()
    };
    let y = t.iter().map(one).collect();
    (t, y)
}

fn samples<'a>((t, target): &'a (Vec<f64>, Vec<f64>)) -> Samples<'a> {
    Samples {
        t,
        target,
        weight: None,
        floor: 0.0,
    }
}

#[test]
fn fits_to_condensed_samples_are_those_to_all() {
    let record = record(0.0);
    let samples = samples(&record);
    let (all, few) = (Rows::from(&samples), Rows::new(&samples, 4, 0.0));
    assert!(few.number() < all.number() / 4);
    let fit = |rows: &Rows<'_>| Normal::new(rows, 128).choose().expect("a spline");
    let (a, b) = (fit(&all), fit(&few));
    assert!((a.strength / b.strength - 1.0).abs() < 1e-6);
    assert!((a.cost - b.cost).abs() < 1e-6 * a.cost.abs());
    let pairs = a.coefficients.iter().zip(&b.coefficients);
    assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-10));
    let fit = |rows: &Rows<'_>| Fourier::to(rows, Size::Fixed(5)).expect("a rotation");
    let (a, b) = (fit(&all), fit(&few));
    assert!((a.quality().sigma / b.quality().sigma - 1.0).abs() < 1e-10);
    let (a, b) = (a.coefficients(), b.coefficients());
    for i in 0..a.0.len() {
        assert!((a.0[i] - b.0[i]).abs() < 1e-6 * a.1[i], "{i}");
        assert!((a.1[i] / b.1[i] - 1.0).abs() < 1e-9, "{i}");
    }
}

#[test]
fn what_blocks_would_lose_is_not_condensed() {
    assert!(
        Rows::new(&samples(&record(1e-2)), 4, 0.0)
            .blocks()
            .is_none()
    );
}
