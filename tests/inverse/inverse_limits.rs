//! Measured motions of cranks that cannot turn fully, near their limits and past them: the force is inside its band or
//! empty, or the motion is refused.

use std::f64::consts::{PI, TAU};

use crate::noise::Random;
use slider_crank::inverse::{FitKind, InverseOptions, inverse};
use slider_crank::mechanism::Linkage;
use slider_crank::scene::{
    Branch, Crank, Gravity, Load, Measured, Measurement, Scene, Slider, Variables,
};
use slider_crank::simulate::{Options, simulate};

const CRANK: f64 = 0.05;
const INERTIA: f64 = 2e-3;
const MASS: f64 = 0.4;

/// Returns a crank with inertia and a slider, joined by a massless rod.
fn rocker(rod: f64, offset: f64, branch: Branch) -> Scene {
    Scene::new(CRANK, rod)
        .offset(offset)
        .branch(branch)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .slider(Slider { mass: MASS })
        .gravity(Gravity::standard())
}

/// Sample: crank angle, slider position, angle at the crank pin, and the slider force by Newton's law: force − m x''
/// acts through the rod, whose moment about O accelerates the crank.
struct Sample {
    theta: f64,
    x: f64,
    gamma: f64,
    force: f64,
}

/// Returns the position with the rod at angle φ from the guide, for a rod that passes φ = 90°: cos θ > 0.
fn place(scene: &Scene, phi: f64) -> [f64; 2] {
    let (r, l, e) = (
        scene.geometry.crank,
        scene.geometry.rod,
        scene.geometry.offset,
    );
    let theta = ((l * phi.sin() - e) / r).asin();
    [theta, r * theta.cos() + l * phi.cos()]
}

/// Samples a motion φ(t) of the rod, with derivatives by central differences of fourth order.
fn sample(scene: &Scene, phi: &dyn Fn(f64) -> f64, t: f64) -> Sample {
    let h = 2e-4;
    let at = |k: f64| place(scene, phi(t + k * h));
    let second = |i: usize| {
        let [a, b, c, d, e] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(k)[i]);
        (-a + 16.0 * b - 30.0 * c + 16.0 * d - e) / (12.0 * h * h)
    };
    let ([theta, x], [alpha, acceleration]) = (at(0.0), [second(0), second(1)]);
    let e = scene.geometry.offset;
    let (ax, ay) = (CRANK * theta.cos(), CRANK * theta.sin());
    let (ux, uy) = (
        (x - ax) / scene.geometry.rod,
        (-e - ay) / scene.geometry.rod,
    );
    // The rod pulls the crank pin along u with tension T, and the slider back: J alpha = T (a × u), m x'' = F − T u_x.
    let tension = INERTIA * alpha / (ax * uy - ay * ux);
    let (px, py) = (x - ax, -e - ay);
    Sample {
        theta,
        x,
        gamma: (px * ay - py * ax).abs().atan2(-ax * px - ay * py),
        force: MASS * acceleration + tension * ux,
    }
}

/// Outcome of an inversion.
#[derive(Debug, PartialEq)]
enum Outcome {
    Refused(String),
    /// Result with a warning that the motion is unexplained or contradicts the scene.
    Warned,
    Given(Given),
}

/// Counts of rows with a force, of those inside the band, and of all rows; the first two also for cos φ below 0.3.
#[derive(Debug, Default, PartialEq)]
struct Given {
    rows: usize,
    inside: usize,
    of: usize,
    near: usize,
    near_inside: usize,
}

impl Given {
    fn add(&mut self, other: &Given) {
        self.rows += other.rows;
        self.inside += other.inside;
        self.of += other.of;
        self.near += other.near;
        self.near_inside += other.near_inside;
    }
}

fn invert(
    scene: &Scene,
    measured: Measured,
    times: &[f64],
    samples: &[Sample],
    noise: f64,
    random: &mut Random,
) -> Outcome {
    let unit = if measured == Measured::X { CRANK } else { 1.0 };
    let value = |s: &Sample| {
        let exact = match measured {
            Measured::Theta => s.theta,
            Measured::X => s.x,
            Measured::Omega => panic!("a sample has no speed"),
            Measured::Gamma => s.gamma,
        };
        exact + noise * unit * random.normal()
    };
    let values = samples.iter().map(value).collect();
    let motion = Measurement::new(measured, times.to_vec(), values).expect("samples");
    let options = InverseOptions {
        fit: FitKind::Smoother,
        ..InverseOptions::default()
    };
    let found = match inverse(scene, &motion, &options) {
        Ok(found) => found,
        Err(error) => return Outcome::Refused(error.to_string()),
    };
    let said = |warning: &String| warning.contains("not white noise");
    if found.summary.warnings.iter().any(said) {
        return Outcome::Warned;
    }
    let mut given = Given {
        of: samples.len(),
        ..Given::default()
    };
    let linkage = Linkage::new(&scene.geometry);
    for (row, sample) in found.rows.iter().zip(samples) {
        if let (Some(force), Some(se)) = (row.slider_force, row.slider_force_se) {
            let near = linkage.pose(sample.theta).cos_phi < 0.3;
            let good = (force - sample.force).abs() <= found.summary.band_factor * se;
            given.rows += 1;
            given.inside += usize::from(good);
            given.near += usize::from(near);
            given.near_inside += usize::from(near && good);
        } else {
            assert!(row.near_dead_centre);
        }
    }
    Outcome::Given(given)
}

const ALL: [Measured; 3] = [Measured::Theta, Measured::X, Measured::Gamma];

/// Runs a rod that swings about `middle` by `swing`, both in rad, and its mirror image on the left branch.
fn runs(middle: f64, swing: f64, noise: f64, draws: u32) -> Vec<(Measured, f64, Outcome)> {
    let times: Vec<f64> = (0..400).map(|i| 0.7 * f64::from(i) / 399.0).collect();
    let mut random = Random(88_172_645_463_325_252);
    let mut outcomes = Vec::new();
    for (branch, sign) in [(Branch::Right, 1.0), (Branch::Left, -1.0)] {
        for offset in [0.005, -0.008] {
            let scene = rocker(0.04, offset, branch);
            let phi = |t: f64| {
                let phi = middle + swing * (7.0 * t).sin();
                if sign > 0.0 { phi } else { PI - phi }
            };
            let samples: Vec<Sample> = times.iter().map(|t| sample(&scene, &phi, *t)).collect();
            let [theta, speed] = [samples[0].theta, samples[1].theta - samples[0].theta];
            let scene = scene.start(theta, speed);
            for measured in ALL {
                for _ in 0..draws {
                    let found = invert(&scene, measured, &times, &samples, noise, &mut random);
                    outcomes.push((measured, offset * sign, found));
                }
            }
        }
    }
    outcomes
}

/// The formulas of this test agree with those of the mechanism.
#[test]
fn the_reference_lies_on_the_branch() {
    for (branch, phi) in [(Branch::Right, 1.2), (Branch::Left, PI - 1.2)] {
        let scene = rocker(0.04, 0.005, branch);
        let [theta, x] = place(&scene, phi);
        assert!((Linkage::new(&scene.geometry).pose(theta).x - x).abs() < 1e-15);
    }
}

#[test]
fn motions_that_pass_a_limit_are_refused() {
    for noise in [0.0, 1e-6, 1e-4] {
        for beyond in [0.6, 0.1, 0.01, 1e-3, 0.0] {
            for (measured, offset, outcome) in runs(1.1, PI / 2.0 - 1.1 + beyond, noise, 1) {
                let Outcome::Refused(text) = &outcome else {
                    panic!("{measured:?}, {offset}, {noise}, {beyond}: {outcome:?}");
                };
                let reasons = [
                    "limit",
                    "impossible",
                    "cannot be reached",
                    "does not reach",
                    "leaves the angles",
                ];
                let named = reasons.iter().any(|words| text.contains(words));
                assert!(named, "{measured:?}, {offset}, {noise}: {text}");
            }
        }
    }
}

/// Reversals at distances from the limit that the noise may or may not cover: the band covers the force, also near the
/// limit.
#[test]
fn motions_that_turn_back_before_a_limit_are_inside_their_bands() {
    for noise in [1e-6, 1e-5, 1e-4] {
        for short in [0.3, 0.1, 0.01, 1e-3] {
            let mut total = Given::default();
            let runs = runs(1.1, PI / 2.0 - 1.1 - short, noise, 1);
            for (measured, offset, outcome) in runs {
                match outcome {
                    Outcome::Warned => {}
                    Outcome::Refused(text) => {
                        let clear = short >= 0.1;
                        assert!(!clear, "{measured:?}, {offset}, {noise}, {short}: {text}");
                    }
                    Outcome::Given(given) => {
                        let share = given.inside as f64 / given.rows as f64;
                        assert!(
                            share > 0.75,
                            "{measured:?}, {offset}, {noise}, {short}: {share}"
                        );
                        total.add(&given);
                    }
                }
            }
            let share = |inside: usize, rows: usize| inside as f64 / rows.max(1) as f64;
            let all = share(total.inside, total.rows);
            assert!(total.rows == 0 || all > 0.93, "{noise}, {short}: {all}");
            let near = share(total.near_inside, total.near);
            assert!(
                total.near == 0 || near > 0.9,
                "{noise}, {short}: {near} near the limit"
            );
            assert!(total.rows as f64 >= 0.9 * total.of as f64);
        }
    }
}

/// Forward runs under a known force, some of them past a limit: every given force is inside its band.
#[test]
fn forward_runs_of_rockers_give_back_their_force_or_are_refused() {
    let mut random = Random(88_172_645_463_325_252);
    let (mut total, mut passing, mut refused) = (Given::default(), 0, 0);
    for number in 0..80 {
        let branch = [Branch::Right, Branch::Left][number % 2];
        let measured = ALL[number % 3];
        let offset = 0.02 * (random.even() - 0.5);
        let (a, w, p) = (
            6.0 + 8.0 * random.even(),
            4.0 + 6.0 * random.even(),
            TAU * random.even(),
        );
        let force = move |t: f64| a * (w * t + p).sin();
        let speed = 12.0 * (random.even() - 0.5);
        let free = rocker(0.04, offset, branch).start(0.3 + 0.2 * random.even(), speed);
        let load = Load::function(Variables::T, move |now| force(now.t));
        let mut scene = free.clone().force(load).duration(0.35);
        scene.run.tolerance = 1e-12;
        let options = Options {
            estimate: false,
            ..Options::default()
        };
        let run = simulate(&scene, &options).expect("a run");
        let limit = run.summary.events.iter().any(|e| e.kind == "limit");
        let linkage = Linkage::new(&free.geometry);
        let times: Vec<f64> = (0..300).map(|i| 0.35 * f64::from(i) / 299.0).collect();
        // Beyond a limit only the crank angle is available here.
        let measured = if limit { Measured::Theta } else { measured };
        let samples: Vec<Sample> = times
            .iter()
            .map(|t| {
                let theta = run.at(*t).expect("inside").0;
                let pose = linkage.pose(theta);
                Sample {
                    theta,
                    x: pose.x,
                    gamma: linkage.crank_pin_angle(theta, &pose).0,
                    force: force(*t),
                }
            })
            .map(|s| Sample {
                gamma: (s.gamma - (s.gamma / TAU).round() * TAU).abs(),
                ..s
            })
            .collect();
        let noise = [1e-7, 1e-6, 1e-5, 1e-4, 1e-3][number % 5];
        let outcome = invert(&free, measured, &times, &samples, noise, &mut random);
        passing += usize::from(limit);
        match outcome {
            Outcome::Warned => {}
            Outcome::Refused(text) => {
                refused += 1;
                assert!(
                    text.contains("limit") || text.contains("reach"),
                    "{number}: {text}"
                );
            }
            Outcome::Given(given) => {
                assert!(!limit, "{number}: {given:?}");
                if !limit {
                    total.add(&given);
                }
            }
        }
    }
    assert!(
        passing >= 4 && refused <= passing + 2,
        "{passing} pass, {refused} are refused"
    );
    assert!(total.inside as f64 > 0.93 * total.rows as f64, "{total:?}");
}
