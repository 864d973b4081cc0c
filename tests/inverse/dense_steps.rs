//! Samples rounded to steps, so dense that many lie within each: motions in closed form, and the force that moves a slider
//! on massless links, which is its mass times its acceleration.

use std::f64::consts::TAU;

use slider_crank::scene::{Measured, Measurement, Scene, Slider};
use slider_crank::study::{FitKind, Inverse, InverseOptions, inverse};

/// Crank and rod, m, and mass of the slider, kg.
const CRANK: f64 = 0.05;
const ROD: f64 = 0.16;
const MASS: f64 = 2.0;

/// Evenly spread numbers, the same in every run.
struct Random(u64);

impl Random {
    fn even(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.even()).ln()).sqrt() * (TAU * self.even()).cos()
    }
}

/// Crank angle a + bWt + c sin(Wt + d), rad, from 0 to 1 s.
#[derive(Clone, Copy, Debug)]
struct Motion {
    a: f64,
    b: f64,
    c: f64,
    d: f64,
    rate: f64,
}

impl Motion {
    fn turning(turns: f64, random: &mut Random) -> Motion {
        Motion {
            a: 0.3 + 0.4 * random.even(),
            b: 1.0,
            c: 0.02 + 0.02 * random.even(),
            d: TAU * random.even(),
            rate: TAU * turns,
        }
    }

    fn swinging(random: &mut Random) -> Motion {
        Motion {
            a: 1.2 + 0.2 * random.even(),
            b: 0.0,
            c: 0.5,
            d: TAU * random.even(),
            rate: 1.2 * TAU,
        }
    }

    /// Angle, speed and acceleration.
    fn at(&self, t: f64) -> [f64; 3] {
        let Motion { a, b, c, d, rate } = *self;
        let (sin, cos) = (rate * t + d).sin_cos();
        [
            a + b * rate * t + c * sin,
            rate * (b + c * cos),
            -rate * rate * c * sin,
        ]
    }

    /// What a column shows, and the force.
    fn shown(&self, t: f64, column: Measured) -> (f64, f64) {
        let [theta, omega, alpha] = self.at(t);
        let (sin, cos) = theta.sin_cos();
        let root = (ROD * ROD - (CRANK * sin).powi(2)).sqrt();
        let x = CRANK * cos + root;
        let first = -CRANK * sin * (1.0 + CRANK * cos / root);
        let second = -CRANK * cos
            - CRANK * CRANK * (cos * cos - sin * sin) / root
            - (CRANK * CRANK * sin * cos).powi(2) / root.powi(3);
        let force = MASS * (second * omega * omega + first * alpha);
        let gamma = (CRANK * CRANK + ROD * ROD - x * x) / (2.0 * CRANK * ROD);
        let value = match column {
            Measured::Theta => theta,
            Measured::X => x,
            Measured::Gamma => gamma.clamp(-1.0, 1.0).acos(),
        };
        (value, force)
    }
}

/// Samples of a motion, their steps and their noise.
#[derive(Clone, Copy, Debug)]
struct Samples {
    column: Measured,
    rows: usize,
    step: f64,
    noise: f64,
}

impl Samples {
    fn inverted(&self, motion: &Motion, fit: FitKind, random: &mut Random) -> Inverse {
        let times: Vec<f64> = (0..self.rows)
            .map(|i| i as f64 / self.rows as f64)
            .collect();
        let rounded = |t: &f64| {
            let value = motion.shown(*t, self.column).0 + self.noise * random.normal();
            (value / self.step).round() * self.step
        };
        let values = times.iter().map(rounded).collect();
        let samples = Measurement::new(self.column, times, values).expect("samples");
        let speed = motion.at(0.0)[1].signum();
        let scene = Scene::new(CRANK, ROD)
            .slider(Slider { mass: MASS })
            .start(motion.at(0.0)[0], speed);
        let options = InverseOptions {
            fit,
            ..InverseOptions::default()
        };
        inverse(&scene, &samples, &options).expect("an inversion")
    }

    /// Part of the forces inside their bands, and root mean square of the errors of the crank angle, rad.
    fn score(&self, motion: &Motion, fit: FitKind, random: &mut Random) -> (f64, f64) {
        let found = self.inverted(motion, fit, random);
        assert!(found.summary.fit.passages.is_some(), "{self:?} {motion:?}");
        let turns = (found.rows[0].theta - motion.at(0.0)[0]) / TAU;
        let (mut inside, mut all, mut squares) = (0.0, 0.0, 0.0);
        for row in &found.rows {
            let off = row.theta - motion.at(row.t)[0] - TAU * turns.round();
            squares += off * off;
            if let (Some(force), Some(se)) = (row.slider_force, row.slider_force_se) {
                let exact = motion.shown(row.t, self.column).1;
                all += 1.0;
                inside += f64::from((force - exact).abs() <= found.summary.band_factor * se);
            }
        }
        assert!(all > 0.9 * self.rows as f64, "{all} forces");
        (inside / all, (squares / self.rows as f64).sqrt())
    }

    /// Bands cover the force, and the angle is much better known than a sample's, whose error is `alone`, rad.
    #[track_caller]
    fn is_right(&self, motion: impl Fn(&mut Random) -> Motion, fit: FitKind, alone: f64) -> f64 {
        let draws = 6;
        let random = &mut Random(3 + self.rows as u64);
        let mut mean = 0.0;
        for _ in 0..draws {
            let motion = motion(random);
            let (share, error) = self.score(&motion, fit, random);
            assert!(error < alone, "{self:?}, {fit:?}, {motion:?}: {error:e}");
            mean += share / f64::from(draws);
        }
        assert!(mean > 0.85, "{self:?}, {fit:?}: {mean}");
        mean
    }
}

const KINDS: [FitKind; 3] = [FitKind::Polynomial, FitKind::Spline, FitKind::Fourier];

/// The angle is known to what it turns from one sample to the next, whatever the steps.
#[test]
fn steps_of_a_rotation() {
    let (mut mean, mut cases) = (0.0, 0.0);
    for fit in KINDS {
        let turns = if fit == FitKind::Fourier { 3.2 } else { 1.3 };
        let columns = [Measured::Theta, Measured::X, Measured::Gamma];
        for (column, step) in columns.into_iter().zip([1e-2, 1e-3, 1e-2]) {
            // Passages of x leave the dead centres out in each turn, and harmonics open there.
            if (fit, column) == (FitKind::Fourier, Measured::X) {
                continue;
            }
            let samples = Samples {
                column,
                rows: 20_000,
                step,
                noise: 0.0,
            };
            let of_sample = TAU * turns / samples.rows as f64;
            let motion = |random: &mut Random| Motion::turning(turns, random);
            mean += samples.is_right(motion, fit, of_sample);
            cases += 1.0;
        }
    }
    mean /= cases;
    assert!((0.92..=0.99).contains(&mean), "{mean}");
}

/// Noise that takes values forth and back over each border.
#[test]
fn steps_with_slight_noise() {
    let (mut mean, mut cases) = (0.0, 0.0);
    for fit in [FitKind::Polynomial, FitKind::Spline] {
        for (column, step) in [(Measured::Theta, 1e-2), (Measured::X, 1e-3)] {
            let samples = Samples {
                column,
                rows: 20_000,
                step,
                noise: 0.02 * step,
            };
            let motion = |random: &mut Random| Motion::turning(1.3, random);
            let size = if column == Measured::X { CRANK } else { 1.0 };
            mean += samples.is_right(motion, fit, samples.noise / size);
            cases += 1.0;
        }
    }
    mean /= cases;
    assert!((0.92..=0.995).contains(&mean), "{mean}");
}

/// A motion that turns back, over the same border twice.
#[test]
fn steps_of_a_swing() {
    let cases = [
        (Measured::Theta, FitKind::Polynomial),
        (Measured::Theta, FitKind::Spline),
        (Measured::X, FitKind::Spline),
    ];
    for (column, fit) in cases {
        let samples = Samples {
            column,
            rows: 20_000,
            step: if column == Measured::X { 5e-4 } else { 1e-2 },
            noise: 0.0,
        };
        // A tenth of what one sample is known to.
        samples.is_right(Motion::swinging, fit, 0.1 * 1e-2 / 12f64.sqrt());
    }
}

/// Residuals are those of all samples, and have the standard deviation of rounding.
#[test]
fn residuals_are_those_of_the_samples() {
    let random = &mut Random(11);
    let motion = Motion::turning(1.3, random);
    let mut samples = Samples {
        column: Measured::X,
        rows: 20_000,
        step: 1e-3,
        noise: 0.0,
    };
    let found = samples.inverted(&motion, FitKind::Spline, random);
    let expected = samples.step / 12f64.sqrt();
    assert_eq!(found.residuals.len(), samples.rows);
    for (residual, row) in found.residuals.iter().zip(&found.rows) {
        // The value that the motion shows at this time lies within the step of the sample.
        assert!(residual.residual.abs() < 0.51 * samples.step);
        assert_eq!(residual.t, row.t);
    }
    let fit = &found.summary.fit;
    assert!((fit.rms / expected - 1.0).abs() < 0.05, "{}", fit.rms);
    assert!((fit.sigma / expected - 1.0).abs() < 0.05, "{}", fit.sigma);
    // Samples a step or more apart count themselves, and so do those whose noise spreads them over steps.
    samples.rows = 300;
    let found = samples.inverted(&motion, FitKind::Spline, random);
    assert_eq!(found.summary.fit.passages, None);
    samples.rows = 20_000;
    samples.column = Measured::Theta;
    samples.noise = 0.5 * samples.step;
    let found = samples.inverted(&motion, FitKind::Spline, random);
    assert_eq!(found.summary.fit.passages, None);
}
