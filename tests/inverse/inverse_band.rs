//! The 95 % band of the slider force covers the applied force: random mechanisms and loads, Monte Carlo over the noise.
//!
//! The bands were worked out on scenes of the first kind; those of the second have other loads, sizes, bodies, times and
//! noise. Single scenes show what made bands too narrow or too wide: harmonics hidden by loud noise, and rounding.

use std::f64::consts::TAU;
use std::sync::Arc;

use slider_crank::mechanism::Linkage;
use slider_crank::scene::{
    Branch, Crank, Gravity, Instant, Load, Measured, Measurement, Rod, Scene, Slider, Variables,
};
use slider_crank::study::{FitKind, InverseOptions, Options, inverse, simulate};

/// Evenly spread and normal numbers, the same in every run.
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Random {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ 88_172_645_463_325_252);
        for _ in 0..20 {
            random.even();
        }
        random
    }

    fn even(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.even()).ln()).sqrt() * (TAU * self.even()).cos()
    }

    fn within(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.even()
    }

    fn sign(&mut self) -> f64 {
        if self.even() < 0.5 { -1.0 } else { 1.0 }
    }
}

type Force = Arc<dyn Fn(&Instant) -> f64 + Send + Sync>;

/// A mechanism with its start, the force on its slider, and how far the crank moves, rad.
struct Draft {
    scene: Scene,
    force: Force,
    reads: Variables,
    path: f64,
}

fn mechanism(random: &mut Random, scale: f64) -> Scene {
    let crank = 0.05 * scale;
    let sides = [Branch::Right, Branch::Left];
    Scene::new(crank, crank * random.within(2.5, 4.5))
        .offset(crank * random.within(-0.5, 0.5))
        .branch(sides[usize::from(random.even() < 0.5)])
        .crank(Crank {
            inertia: 2e-3 * scale.powi(5),
            ..Crank::default()
        })
        .slider(Slider {
            mass: 0.4 * scale.powi(3),
        })
        .gravity(Gravity::standard())
}

/// A swing from rest under a force in time, over part of a turn.
fn swing(random: &mut Random) -> Draft {
    let (a, w, p) = (
        random.within(5.0, 15.0),
        random.within(3.0, 12.0),
        random.within(0.0, TAU),
    );
    let b = random.within(-6.0, 6.0);
    let angle = random.within(0.5, 2.6) * random.sign();
    Draft {
        scene: mechanism(random, 1.0).start(angle, 0.0),
        force: Arc::new(move |now| a * (w * now.t + p).sin() + b),
        reads: Variables::T,
        path: TAU * random.within(0.1, 0.45),
    }
}

/// One turn or several under a force in time.
fn turns(random: &mut Random, most: f64) -> Draft {
    let (a, w, p) = (
        random.within(5.0, 15.0),
        random.within(3.0, 12.0),
        random.within(0.0, TAU),
    );
    let (angle, speed) = (
        random.within(0.0, TAU),
        random.sign() * random.within(18.0, 30.0),
    );
    Draft {
        scene: mechanism(random, 1.0).start(angle, speed),
        force: Arc::new(move |now| a * (w * now.t + p).sin()),
        reads: Variables::T,
        path: TAU * random.within(0.7, most),
    }
}

/// Steady rotation against a spring.
fn steady(random: &mut Random) -> Draft {
    let scene = mechanism(random, 1.0);
    let (k, rest) = (
        random.within(30.0, 120.0),
        0.15 * scene.geometry.branch.sign(),
    );
    let speed = random.sign() * random.within(30.0, 40.0);
    Draft {
        scene: scene.start(random.within(0.0, TAU), speed),
        force: Arc::new(move |now| -k * (now.x - rest)),
        reads: Variables::X,
        path: TAU * random.within(2.0, 8.0),
    }
}

/// Other sizes, with a rod of its own mass.
fn other(random: &mut Random) -> (Scene, f64) {
    let scale = 0.3 * 13f64.powf(random.even());
    let rod = Rod {
        mass: 0.3 * scale.powi(3),
        cg: 0.06 * scale,
        inertia: 8e-4 * scale.powi(5),
        ..Rod::default()
    };
    (mechanism(random, scale).rod(rod), scale)
}

/// A force that changes over from one value to another.
fn ramp(random: &mut Random) -> Draft {
    let (scene, scale) = other(random);
    let (a, b) = (random.within(5.0, 15.0), random.within(-8.0, 8.0));
    let (at, width, size) = (
        random.within(0.05, 0.3),
        random.within(0.05, 0.15),
        scale.powi(4),
    );
    let angle = random.within(0.4, 2.7) * random.sign();
    Draft {
        scene: scene.start(angle, 0.0),
        force: Arc::new(move |now| size * (a * ((now.t - at) / width).tanh() + b)),
        reads: Variables::T,
        path: TAU * random.within(0.1, 0.5),
    }
}

/// A force of rising frequency, over a turn or several.
fn chirp(random: &mut Random, most: f64) -> Draft {
    let (scene, scale) = other(random);
    let a = scale.powi(4) * random.within(5.0, 12.0);
    let (w, q) = (random.within(2.0, 6.0), random.within(2.0, 8.0));
    let (angle, speed) = (
        random.within(0.0, TAU),
        random.sign() * random.within(20.0, 35.0),
    );
    Draft {
        scene: scene.start(angle, speed),
        force: Arc::new(move |now| a * (w * now.t + q * now.t * now.t).sin()),
        reads: Variables::T,
        path: TAU * random.within(0.7, most),
    }
}

/// Steady rotation against a spring that stiffens.
fn stiffening(random: &mut Random) -> Draft {
    let (scene, scale) = other(random);
    let k = scale.powi(3) * random.within(30.0, 100.0);
    let (q, rest) = (
        random.within(0.0, 100.0) / (scale * scale),
        0.16 * scale * scene.geometry.branch.sign(),
    );
    let speed = random.sign() * random.within(30.0, 40.0);
    Draft {
        scene: scene.start(random.within(0.0, TAU), speed),
        force: Arc::new(move |now| {
            let off = now.x - rest;
            -k * off * (1.0 + q * off * off)
        }),
        reads: Variables::X,
        path: TAU * random.within(2.0, 8.0),
    }
}

/// Exact samples of a run: times, angles, what is measured, the force; and the scene that is inverted.
struct Case {
    scene: Scene,
    measured: Measured,
    times: Vec<f64>,
    shown: Vec<f64>,
    force: Vec<f64>,
}

impl Case {
    fn new(
        draft: &Draft,
        measured: Measured,
        rows: usize,
        jitter: f64,
        random: &mut Random,
    ) -> Case {
        let force = draft.force.clone();
        let load = Load::function(draft.reads, move |now| force(now));
        let mut scene = draft.scene.clone().force(load).duration(4.0);
        scene.run.tolerance = 1e-12;
        let options = Options {
            estimate: false,
            ..Options::default()
        };
        let run = simulate(&scene, &options).expect("a run");
        let angle = |t: f64| run.at(t).expect("inside").0;
        let (mut end, mut path, mut before) = (0.0, 0.0, angle(0.0));
        while path < draft.path && end < 3.99 {
            end += 2e-3;
            path += (angle(end) - before).abs();
            before = angle(end);
        }
        let last = (rows - 1) as f64;
        let mut time = |i: usize| {
            let inside = f64::from(i > 0 && i + 1 < rows);
            end * (i as f64 + jitter * inside * (random.even() - 0.5)) / last
        };
        let times: Vec<f64> = (0..rows).map(&mut time).collect();
        let linkage = Linkage::new(&scene.geometry);
        let (mut shown, mut force) = (Vec::new(), Vec::new());
        for &t in &times {
            let (theta, omega) = run.at(t).expect("inside");
            let pose = linkage.pose(theta);
            let (x, v) = (pose.x, pose.dx * omega);
            force.push((draft.force)(&Instant {
                t,
                theta,
                omega,
                x,
                v,
            }));
            shown.push(if measured == Measured::X { x } else { theta });
        }
        Case {
            scene: draft.scene.clone(),
            measured,
            times,
            shown,
            force,
        }
    }

    /// How the errors of the forces compare with what is said of them.
    fn coverage(&self, fit: FitKind, noise: Noise, draws: u32, random: &mut Random) -> Coverage {
        let (mut inside, mut all, mut parameters, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for _ in 0..draws {
            let values = noise.on(&self.shown, random);
            let motion = Measurement::new(self.measured, self.times.clone(), values);
            let options = InverseOptions {
                fit,
                ..InverseOptions::default()
            };
            let motion = motion.expect("samples");
            let found = inverse(&self.scene, &motion, &options).expect("an inversion");
            for (row, exact) in found.rows.iter().zip(&self.force) {
                if let (Some(force), Some(se)) = (row.slider_force, row.slider_force_se) {
                    all += 1.0;
                    let half = found.summary.band_factor * se;
                    inside += f64::from((force - exact).abs() <= half);
                    squares += ((force - exact) / se).powi(2);
                }
            }
            parameters += found.summary.fit.parameters / f64::from(draws);
        }
        let given = all / (f64::from(draws) * self.times.len() as f64);
        assert!(given > 0.7, "{given} of the rows have a force");
        Coverage {
            share: inside / all,
            parameters,
            error: (squares / all).sqrt(),
        }
    }

    /// The coverage of a scene is 90 to 99 %, but for what chance explains: the error of a fit of p parameters changes its
    /// sign about p times, which makes p/2 independent forces a draw.
    #[track_caller]
    fn is_covered(&self, fit: FitKind, noise: Noise, draws: u32, random: &mut Random) -> f64 {
        let Coverage {
            share, parameters, ..
        } = self.coverage(fit, noise, draws, random);
        let independent = f64::from(draws) * 0.5 * parameters;
        let chance = |share: f64| 3.0 * (share * (1.0 - share) / independent).sqrt();
        let (least, most) = (0.90 - chance(0.90), 0.99 + chance(0.99));
        assert!(
            share >= least && share <= most,
            "{fit:?}, {:?}, {} rows, {noise:?}: {share:.3}, not {least:.3} to {most:.3}",
            self.measured,
            self.times.len()
        );
        share
    }
}

/// How errors compare with what is said of them.
#[derive(Clone, Copy, Debug)]
struct Coverage {
    /// Part of the forces inside their bands.
    share: f64,
    /// Mean number of parameters.
    parameters: f64,
    /// Root mean square of the errors, in standard errors.
    error: f64,
}

/// What samples have beside the motion.
#[derive(Clone, Copy, Debug)]
enum Noise {
    /// Normal noise of this standard deviation.
    Normal(f64),
    /// Rounding to steps of this width, the first of which is anywhere.
    Steps(f64),
}

impl Noise {
    fn on(self, values: &[f64], random: &mut Random) -> Vec<f64> {
        let begin = random.even();
        let one = |value: &f64| match self {
            Noise::Normal(size) => value + size * random.normal(),
            Noise::Steps(step) => ((value / step + begin).round() - begin) * step,
        };
        values.iter().map(one).collect()
    }
}

const DRAWS: u32 = 8;

/// Each of some random scenes is covered, and their mean is that of a 95 % band.
#[track_caller]
fn covers(fit: FitKind, seed: u64, jitter: f64, drafts: &[&dyn Fn(&mut Random) -> Draft]) {
    let mut shares = Vec::new();
    for (number, draft) in drafts.iter().cycle().take(6).enumerate() {
        let random = &mut Random::new(seed + number as u64);
        let draft = draft(random);
        let measured = [Measured::Theta, Measured::Theta, Measured::X][number % 3];
        let rows = (80.0 * 5f64.powf(random.even())).max(40.0 * draft.path / TAU) as usize;
        let unit = match measured {
            Measured::X => 0.1 * draft.scene.geometry.crank,
            _ => 1.0,
        };
        let noise = Noise::Normal(unit * 1e-6 * 5e3f64.powf(random.even()));
        let case = Case::new(&draft, measured, rows, jitter, random);
        shares.push(case.is_covered(fit, noise, DRAWS, random));
    }
    let mean = shares.iter().sum::<f64>() / shares.len() as f64;
    assert!(
        (0.92..=0.985).contains(&mean),
        "{fit:?}: {mean}, {shares:.3?}"
    );
}

#[test]
fn polynomials() {
    covers(FitKind::Polynomial, 100, 0.0, &[&swing, &|r| turns(r, 1.3)]);
    covers(FitKind::Polynomial, 200, 0.3, &[&ramp, &|r| chirp(r, 1.2)]);
}

#[test]
fn splines() {
    covers(FitKind::Spline, 300, 0.0, &[&swing, &|r| turns(r, 5.0)]);
    covers(FitKind::Spline, 400, 0.3, &[&ramp, &|r| chirp(r, 4.0)]);
}

#[test]
fn rotation_with_harmonics() {
    covers(FitKind::Fourier, 500, 0.0, &[&steady]);
    covers(FitKind::Fourier, 600, 0.3, &[&stiffening]);
}

/// Loud noise over many turns: the harmonics that it almost hides are where the turns are alike, and bend the force away
/// there.
#[test]
fn splines_through_loud_noise() {
    for seed in [700, 701] {
        let random = &mut Random::new(seed);
        let draft = Draft {
            path: 7.0 * TAU,
            ..steady(random)
        };
        let case = Case::new(&draft, Measured::Theta, 1400, 0.0, random);
        case.is_covered(FitKind::Spline, Noise::Normal(5e-3), 8, random);
    }
}

/// Slow motion makes the errors of rounding cancel, a standstill makes them alike.
#[test]
fn rounded_samples() {
    let fits = [FitKind::Polynomial, FitKind::Spline];
    for (number, fit) in fits.into_iter().cycle().take(4).enumerate() {
        let random = &mut Random::new(800 + number as u64);
        let draft = swing(random);
        let rows = [1200, 1200, 150, 150][number];
        let case = Case::new(&draft, Measured::Theta, rows, 0.0, random);
        case.is_covered(fit, Noise::Steps(2e-3), 10, random);
    }
    let random = &mut Random::new(900);
    let case = Case::new(&steady(random), Measured::Theta, 800, 0.0, random);
    case.is_covered(FitKind::Fourier, Noise::Steps(2e-3), 8, random);
}

/// Samples about a step apart lie at about the same place of their steps for long: a polynomial that follows their errors
/// must not take them for alike.
#[test]
fn samples_a_step_apart() {
    for (seed, rows) in [(1300, 150), (1301, 300), (1302, 1000)] {
        let random = &mut Random::new(seed);
        let draft = Draft {
            path: 0.2 * TAU,
            ..turns(random, 1.0)
        };
        let case = Case::new(&draft, Measured::Theta, rows, 0.0, random);
        let way = (case.shown[rows - 1] - case.shown[0]).abs();
        let steps = Noise::Steps(way / rows as f64);
        case.is_covered(FitKind::Polynomial, steps, 20, random);
    }
}

/// Motor against a force that grows with the speed: the crank speeds up, and harmonics of a steady rotation cannot follow.
fn speeding_up(random: &mut Random) -> Draft {
    let c = random.within(1.0, 3.0);
    let (angle, speed) = (random.within(0.0, TAU), random.within(15.0, 20.0));
    let motor = Load::Motor {
        stall: random.within(1.5, 3.0),
        no_load_speed: 40.0,
    };
    Draft {
        scene: mechanism(random, 1.0).torque(motor).start(angle, speed),
        force: Arc::new(move |now| -c * now.v),
        reads: Variables::V,
        path: TAU * random.within(3.0, 6.0),
    }
}

/// Samples without noise have the rounding of the run that they come from, and what lies between them is found from fewer
/// of them: the band has the errors in it and is not much wider.
#[test]
fn computed_samples() {
    let mut errors = [const { Vec::new() }; FitKind::ALL.len()];
    for (number, fit) in FitKind::ALL.into_iter().cycle().take(15).enumerate() {
        let random = &mut Random::new(1000 + number as u64);
        let draft = match fit {
            FitKind::Polynomial => swing(random),
            FitKind::Spline => turns(random, 3.0),
            FitKind::Fourier => steady(random),
        };
        let measured = [Measured::Theta, Measured::X][number % 2];
        let rows = (150.0 * 8f64.powf(random.even())).max(60.0 * draft.path / TAU) as usize;
        let case = Case::new(&draft, measured, rows, 0.0, random);
        let found = case.coverage(fit, Noise::Normal(0.0), 1, random);
        let is_right = found.share >= 0.9 && (0.03..=1.5).contains(&found.error);
        assert!(is_right, "{fit:?}, {measured:?}, {rows} rows: {found:?}");
        errors[number % errors.len()].push(found.error);
    }
    for (fit, mut list) in FitKind::ALL.into_iter().zip(errors) {
        list.sort_by(f64::total_cmp);
        assert!(list[list.len() / 2] > 0.15, "{fit:?}: {list:.3?}");
    }
}

/// What a fit cannot follow is seen in its residuals, and the band is as wide as that.
#[test]
fn motions_that_a_fit_misses() {
    for number in 0..4 {
        let random = &mut Random::new(1100 + number);
        let case = Case::new(&speeding_up(random), Measured::Theta, 500, 0.3, random);
        let found = case.coverage(FitKind::Fourier, Noise::Normal(0.0), 1, random);
        let is_right = found.share >= 0.9 && (0.3..=1.5).contains(&found.error);
        assert!(is_right, "scene {number}: {found:?}");
    }
}

/// A rotation whose speed drifts a little: noise hides the fast waves of what harmonics miss, whose accelerations are large.
#[test]
fn drifting_rotation_with_noise() {
    let random = &mut Random::new(1400);
    let body = Crank {
        inertia: 2.5e-3,
        ..Crank::default()
    };
    let scene = Scene::new(0.045, 0.102)
        .offset(0.0024)
        .branch(Branch::Left)
        .crank(body)
        .slider(Slider { mass: 0.6 })
        .start(1.33, -40.0);
    let draft = Draft {
        scene,
        force: Arc::new(|now| 2.5 * (3.0 * now.theta + 6.0).sin()),
        reads: Variables::THETA,
        path: 10.4 * TAU,
    };
    let case = Case::new(&draft, Measured::Theta, 900, 0.0, random);
    for noise in [2e-6, 2e-5, 2e-4, 2e-3] {
        let found = case.coverage(FitKind::Fourier, Noise::Normal(noise), 4, random);
        let is_right = found.share >= 0.9 && (0.3..=1.5).contains(&found.error);
        assert!(is_right, "{noise}: {found:?}");
    }
}

/// Few samples of few steps: where in a step a value lies is hardly known from a fit that follows the steps.
#[test]
fn few_samples_rounded() {
    let (mut mean, scenes) = (0.0, 12);
    for number in 0..scenes {
        let random = &mut Random::new(1200 + number);
        let case = Case::new(&swing(random), Measured::Theta, 62, 0.0, random);
        let step = 1e-4 * 30f64.powf(random.even());
        let found = case.coverage(FitKind::Polynomial, Noise::Steps(step), 20, random);
        assert!(found.error < 1.5, "scene {number}: {found:?}");
        mean += found.share / scenes as f64;
    }
    assert!((0.93..=0.985).contains(&mean), "{mean}");
}
