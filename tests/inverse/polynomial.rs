//! Least-squares polynomials compared with certified values and exactly known answers.

use slider_crank::inverse::{InverseOptions, inverse};
use slider_crank::numeric::polynomial_fit::{Equations, PolynomialFit, TooFewArguments};
use slider_crank::scene::{Measured, Measurement, Scene};

/// Returns the number of correct digits.
fn digits(found: f64, exact: f64) -> f64 {
    if found == exact {
        return 17.0;
    }
    -((found - exact) / exact).abs().log10()
}

fn equations<'a>(t: &'a [f64], target: &'a [f64], floor: f64) -> Equations<'a> {
    Equations {
        t,
        target,
        weight: None,
        floor,
    }
}

/// Returns the rows of numbers below a header.
fn table(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split(',').map(|v| v.trim().parse().unwrap()).collect();
    text.lines()
        .skip(1)
        .filter(|line| !line.trim().is_empty())
        .map(row)
        .collect()
}

/// Polynomial problems of the Statistical Reference Datasets of NIST (public domain), with data, certified values, and
/// the digits that the data, rounded to floats, determine.
#[test]
fn reference_datasets() {
    macro_rules! set {
        ($name:literal, $estimates:literal, $errors:literal) => {
            (
                $name,
                include_str!(concat!("nist/", $name, ".csv")),
                include_str!(concat!("nist/", $name, ".certified.csv")),
                $estimates,
                $errors,
            )
        };
    }
    for (name, data, certified, estimates, errors) in [
        set!("filip", 12.5, 12.5),
        set!("pontius", 12.5, 12.5),
        set!("wampler1", 14.5, 0.0),
        set!("wampler2", 12.5, 0.0),
        set!("wampler3", 14.0, 14.0),
        set!("wampler4", 14.0, 14.0),
        set!("wampler5", 14.0, 14.0),
    ] {
        let (data, certified) = (table(data), table(certified));
        let (y, t): (Vec<f64>, Vec<f64>) = data.iter().map(|row| (row[0], row[1])).unzip();
        let fit = PolynomialFit::new(&equations(&t, &y, 0.0), Some(certified.len() - 1)).unwrap();
        let worst = |found: &[f64], column: usize| {
            let pairs = found
                .iter()
                .zip(&certified)
                .filter(|(_, row)| row[column] != 0.0);
            pairs
                .map(|(f, row)| digits(*f, row[column]))
                .fold(17.0, f64::min)
        };
        let found = [worst(&fit.coefficients, 1), worst(&fit.standard_errors, 2)];
        println!("{name}: {found:?} digits");
        assert!(
            found[0] > estimates && found[1] > errors,
            "{name}: {found:?}"
        );
    }
}

/// Record of Duarte et al. from their printed polynomial.
#[test]
fn printed_record() {
    let printed = [0.0649, 0.522, 2.166, -2.129, 0.472];
    let text = include_str!("../../data/duarte-motion.csv");
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    let pair = |line: &str| {
        let (t, theta) = line.split_once(',').unwrap();
        (t.parse::<f64>().unwrap(), theta.parse::<f64>().unwrap())
    };
    let (t, theta): (Vec<f64>, Vec<f64>) = lines.map(pair).unzip();
    let fit = PolynomialFit::new(&equations(&t, &theta, 0.0), None).unwrap();
    assert_eq!(fit.degree(), 4);
    for (found, exact) in fit.coefficients.iter().zip(printed) {
        assert!(
            (found - exact).abs() < 1e-15 * exact.abs().max(1.0),
            "{found} for {exact}"
        );
    }
}

/// Returns noise of unit variance as sums of twelve numbers of a linear congruential generator (Knuth's MMIX).
fn noise(count: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    (0..count)
        .map(|_| (0..12).map(|_| uniform()).sum())
        .collect()
}

/// With 0.8 degrees of noise the chosen degree is mostly that of the motion, and the bands cover the polynomial and its
/// first two derivatives.
#[test]
fn noisy_record() {
    const RECORDS: usize = 600;
    let c = [0.0649, 0.522, 2.166, -2.129, 0.472];
    let t: Vec<f64> = (0..126).map(|i| 0.02 * f64::from(i)).collect();
    let exact = |t: f64| {
        let sum = |terms: &[f64]| terms.iter().rev().fold(0.0, |sum, c| sum * t + c);
        let once: Vec<f64> = (1..5).map(|k| c[k] * k as f64).collect();
        let twice: Vec<f64> = (1..4).map(|k| once[k] * k as f64).collect();
        [sum(&c), sum(&once), sum(&twice)]
    };
    let (mut right, mut covered, mut all) = (0, [0; 3], 0);
    for seed in 1..=RECORDS as u64 {
        let errors = noise(t.len(), seed);
        let theta: Vec<f64> = t
            .iter()
            .zip(errors)
            .map(|(t, e)| exact(*t)[0] + 0.8f64.to_radians() * e)
            .collect();
        let fit = PolynomialFit::new(&equations(&t, &theta, 0.0), None).unwrap();
        right += usize::from(fit.degree() == 4);
        assert!(
            (fit.sigma / 0.8f64.to_radians() - 1.0).abs() < 0.3,
            "{}",
            fit.sigma
        );
        for t in t.iter().step_by(5) {
            let (state, exact) = (fit.state(*t), exact(*t));
            all += 1;
            for (k, entry) in [0, 2, 5].into_iter().enumerate() {
                let se = state.covariance[entry].sqrt();
                covered[k] += usize::from((state.value[k] - exact[k]).abs() < 1.96 * se);
            }
        }
    }
    assert!(
        right * 100 >= 92 * RECORDS,
        "degree 4 in {right} of {RECORDS} records"
    );
    for covered in covered {
        let share = f64::from(covered as u32) / f64::from(all);
        assert!((0.91..0.97).contains(&share), "{share}");
    }
}

/// Duarte's record with 0.8 degrees of noise: in at least nine of ten records the error of the acceleration with default options is
/// within 1.2 times of that of degree 4, which is the true one.
#[test]
fn default_options_come_near_to_the_true_degree() {
    const RECORDS: u64 = 120;
    let c = [0.0649, 0.522, 2.166, -2.129, 0.472];
    let scene = Scene::load("data/duarte-engine.toml").expect("a scene");
    let t: Vec<f64> = (0..126).map(|i| 0.02 * f64::from(i)).collect();
    let mut near = 0;
    for seed in 1..=RECORDS {
        let pairs = t.iter().zip(noise(t.len(), seed));
        let theta = pairs.map(|(t, e)| {
            let exact = c.iter().rev().fold(0.0, |sum, c| sum * t + c);
            exact + 0.8f64.to_radians() * e
        });
        let motion = Measurement::new(Measured::Theta, t.clone(), theta.collect());
        let motion = motion.expect("a motion");
        let error = |degree: Option<usize>| {
            let options = InverseOptions {
                degree,
                ..InverseOptions::default()
            };
            let rows = inverse(&scene, &motion, &options)
                .expect("an inversion")
                .rows;
            let squares = rows.iter().map(|row| {
                let exact = 2.0 * c[2] + row.t * (6.0 * c[3] + row.t * 12.0 * c[4]);
                (row.alpha - exact).powi(2)
            });
            squares.sum::<f64>().sqrt()
        };
        near += u64::from(error(None) < 1.2 * error(Some(4)));
    }
    assert!(10 * near >= 9 * RECORDS, "{near} of {RECORDS}");
}

/// Polynomial of degree 10 with ill-conditioned powers (10^14): (t + 5)^10, its coefficients and both derivatives.
#[test]
fn ten_binomial_coefficients_and_derivatives() {
    let t: Vec<f64> = (0..23).map(|i| -8.5 + 0.25 * f64::from(i)).collect();
    let y: Vec<f64> = t.iter().map(|t| (t + 5.0).powi(10)).collect();
    let fit = PolynomialFit::new(&equations(&t, &y, 0.0), Some(10)).unwrap();
    assert!(fit.condition > 1e13);
    let mut binomial = 1.0;
    for k in (0..=10usize).rev() {
        let exact = binomial * 5f64.powi(10 - k as i32);
        assert!(
            digits(fit.coefficients[k], exact) > 13.0,
            "{k}: {}",
            fit.coefficients[k]
        );
        binomial = binomial * k as f64 / (11 - k) as f64;
    }
    for t in t {
        let (u, found) = (t + 5.0, fit.state(t));
        let scale = 3.5f64.powi(8) * 90.0;
        for (k, exact) in [(1, 10.0 * u.powi(9)), (2, 90.0 * u.powi(8))] {
            assert!((found.value[k] - exact).abs() < 1e-11 * scale, "{t}");
            assert!(
                (found.value[k] - exact).abs() < 4.0 * found.rounding[k] + 1e-14 * scale,
                "{t}"
            );
        }
    }
}

/// Weights and targets of a nonlinear measurement, and too few arguments.
#[test]
fn weights_and_refusals() {
    let t: Vec<f64> = (0..9).map(f64::from).collect();
    let weight: Vec<f64> = t.iter().map(|t| (t - 4.0) / 3.0).collect();
    let target: Vec<f64> = t
        .iter()
        .zip(&weight)
        .map(|(t, w)| w * (1.0 - 2.0 * t + 0.5 * t * t))
        .collect();
    let weighted = Equations {
        t: &t,
        target: &target,
        weight: Some(&weight),
        floor: 0.0,
    };
    let fit = PolynomialFit::new(&weighted, Some(2)).unwrap();
    for (found, exact) in fit.coefficients.iter().zip([1.0, -2.0, 0.5]) {
        assert!((found - exact).abs() < 1e-13, "{found}");
    }
    let few = |t: &[f64], degree| {
        PolynomialFit::new(&equations(t, &vec![1.0; t.len()], 0.0), degree).unwrap_err()
    };
    assert_eq!(
        few(&[0.0, 1.0, 2.0], Some(3)),
        TooFewArguments {
            found: 3,
            needed: 5
        }
    );
    assert_eq!(few(&[1.0, 1.0, 2.0, 2.0], Some(2)).found, 2);
    assert_eq!(
        few(&[1.0], None),
        TooFewArguments {
            found: 1,
            needed: 2
        }
    );
}
