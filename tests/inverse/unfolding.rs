//! The crank angle from a slider position or a crank-pin angle: right, or said to be in doubt where the samples do not tell.

use std::f64::consts::{PI, TAU};

use crate::noise::Random;
use crate::support::instrument::shown;
use crate::support::random::{cases, magnitude, rotating_crank};
use proptest::prelude::*;
use slider_crank::mechanism::Linkage;
use slider_crank::scene::{Branch, Measured, Measurement, Scene, Slider};
use slider_crank::study::{FitKind, FitSize, Inverse, InverseOptions, inverse};

const BOTH: [Measured; 2] = [Measured::X, Measured::Gamma];

/// A wrong choice at a dead centre is off by more than that, rad; a fit through a sharp turn is not.
const WRONG: f64 = 0.3;

fn scene(crank: f64, rod: f64, offset: f64, branch: Branch) -> Scene {
    Scene::new(crank, rod)
        .offset(offset)
        .branch(branch)
        .slider(Slider { mass: 1.0 })
}

fn plain() -> Scene {
    scene(0.05, 0.15, 0.0, Branch::Right)
}

/// What comes of a motion.
#[derive(Clone, Debug)]
enum Found {
    Right,
    Wrong,
    /// With what is said.
    Doubt(String),
}

struct Motion<'a> {
    theta: &'a dyn Fn(f64) -> f64,
    samples: usize,
    /// Standard deviation, rad or in crank lengths.
    noise: f64,
    /// To which values are rounded, rad or in crank lengths.
    step: f64,
}

impl std::fmt::Debug for Motion<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [a, b, c] = [0.0, 0.5, 1.0].map(|t| (self.theta)(t));
        write!(
            f,
            "{} samples from {a} by {b} to {c} rad, noise {}, step {}",
            self.samples, self.noise, self.step
        )
    }
}

impl Motion<'_> {
    /// Sampled evenly.
    fn unfold(&self, scene: &Scene, measured: Measured) -> Found {
        let last = (self.samples - 1) as f64;
        let times = (0..self.samples).map(|i| i as f64 / last).collect();
        self.unfold_at(scene, measured, times)
    }

    /// Begins with angle and speed of the first sample.
    fn unfold_at(&self, scene: &Scene, measured: Measured, times: Vec<f64>) -> Found {
        let [first, next] = [0.0, 1e-6].map(|by| (self.theta)(times[0] + by));
        let scene = scene.clone().start(first, (next - first) * 1e6);
        self.unfold_from(&scene, measured, times)
    }

    /// Begins as the scene says.
    fn unfold_from(&self, scene: &Scene, measured: Measured, times: Vec<f64>) -> Found {
        let theta: Vec<f64> = times.iter().map(|t| (self.theta)(*t)).collect();
        let size = match measured {
            Measured::X => scene.geometry.crank,
            _ => 1.0,
        };
        let mut random = Random(88_172_645_463_325_252);
        let values = theta.iter().map(|theta| {
            let value = shown(scene, measured, *theta) + self.noise * size * random.normal();
            let value = match measured {
                Measured::X => value,
                _ => PI - (PI - value.abs()).abs(),
            };
            match self.step * size {
                0.0 => value,
                step => (value / step).round() * step,
            }
        });
        let values = values.collect();
        let measurement = Measurement::new(measured, times, values).expect("samples");
        let options = |fit: FitKind, size: FitSize| InverseOptions {
            fit,
            size,
            ..InverseOptions::default()
        };
        // A straight line is fitted to whatever comes of the samples.
        let line = inverse(
            scene,
            &measurement,
            &options(FitKind::Polynomial, FitSize::Fixed(1)),
        );
        let spline = inverse(
            scene,
            &measurement,
            &options(FitKind::Spline, FitSize::Auto),
        );
        // Either fit may be refused; what was said of the angles is the same.
        let said = |fit: &Result<Inverse, _>| {
            let warnings = fit.as_ref().ok().map(|fit| &fit.summary.warnings);
            let doubt = |said: &&String| said.contains("cannot be told");
            warnings.and_then(|list| list.iter().find(doubt).cloned())
        };
        if let Some(said) = said(&line).or_else(|| said(&spline)) {
            return Found::Doubt(said);
        }
        let found = match spline {
            Ok(found) => found,
            Err(refused) => return Found::Doubt(refused.to_string()),
        };
        let middle = found.rows.len() / 2;
        let turns = ((found.rows[middle].theta - theta[middle]) / TAU).round() * TAU;
        let off = found
            .rows
            .iter()
            .zip(&theta)
            .map(|(row, theta)| (row.theta - turns - theta).abs());
        if off.fold(0.0, f64::max) < WRONG {
            Found::Right
        } else {
            Found::Wrong
        }
    }
}

fn is_right(motion: &Motion<'_>, scene: &Scene) {
    for measured in BOTH {
        let found = motion.unfold(scene, measured);
        assert!(
            matches!(found, Found::Right),
            "{measured:?}, {motion:?}, {:?}: {found:?}",
            scene.geometry
        );
    }
}

fn is_not_wrong(motion: &Motion<'_>, scene: &Scene) {
    for measured in BOTH {
        let found = motion.unfold(scene, measured);
        assert!(
            !matches!(found, Found::Wrong),
            "{measured:?}, {motion:?}, {:?}: {found:?}",
            scene.geometry
        );
    }
}

fn is_in_doubt(motion: &Motion<'_>, scene: &Scene) {
    for measured in BOTH {
        let found = motion.unfold(scene, measured);
        assert!(
            matches!(found, Found::Doubt(_)),
            "{measured:?}, {motion:?}: {found:?}"
        );
    }
}

/// From 0 to 1, at rest at both ends.
fn ease(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)
}

/// Without offset the strokes are mirror images: after a rest at a dead centre a motion that goes on and one that goes
/// back show the same.
#[test]
fn a_rest_at_a_dead_centre_is_in_doubt_where_it_is() {
    for dead_centre in [0.0, PI] {
        for way in [1.0, -1.0] {
            let theta = move |t: f64| {
                dead_centre - 2.0 * (1.0 - ease(t / 0.4)) + way * 2.5 * ease((t - 0.6) / 0.4)
            };
            for (samples, noise) in [(200, 0.0), (200, 1e-4), (5000, 1e-3)] {
                let motion = Motion {
                    theta: &theta,
                    samples,
                    noise,
                    step: 0.0,
                };
                for measured in BOTH {
                    let found = motion.unfold(&plain(), measured);
                    let Found::Doubt(said) = &found else {
                        panic!("{measured:?}, {way}, {samples}, {noise}: {found:?}")
                    };
                    let number = |after: &str| -> f64 {
                        let (_, rest) = said.split_once(after).expect("a number");
                        let end = rest.find([' ', ')']).expect("an end");
                        rest[..end].parse().expect("a number")
                    };
                    assert!(said.contains("theta = "), "{samples}, {noise}, {said}");
                    let t = number("(t = ");
                    assert!((0.3..0.7).contains(&t), "{said}");
                    assert!(
                        (number("theta = ") - dead_centre).abs() % TAU < 0.2,
                        "{said}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_rest_away_from_a_dead_centre_is_told() {
    // It rests 0.3 rad before the dead centre, and passes it later or goes back.
    for way in [1.0, -1.0] {
        let theta =
            move |t: f64| -0.3 - 2.0 * (1.0 - ease(t / 0.4)) + way * 2.0 * ease((t - 0.6) / 0.4);
        for noise in [0.0, 1e-6, 1e-4] {
            let motion = Motion {
                theta: &theta,
                samples: 600,
                noise,
                step: 0.0,
            };
            is_right(&motion, &plain());
            is_not_wrong(&motion, &scene(0.05, 0.15, 0.02, Branch::Left));
        }
    }
}

/// The turning point comes as near to the dead centre as to 0.1 rad.
#[test]
fn swings_that_turn_just_before_a_dead_centre_go_back() {
    for (short, noise) in [(0.1, 0.0), (0.1, 1e-5), (0.2, 3e-4), (0.4, 2e-3)] {
        for dead_centre in [0.0, PI] {
            let theta = move |t: f64| dead_centre - short - 0.9 * (1.0 - (5.0 * t + 0.4).sin());
            let motion = Motion {
                theta: &theta,
                samples: 800,
                noise,
                step: 0.0,
            };
            is_right(&motion, &plain());
        }
    }
}

#[test]
fn swings_across_a_dead_centre_pass_it() {
    for (swing, noise) in [(0.3, 0.0), (0.3, 1e-5), (0.8, 1e-3), (2.5, 3e-3)] {
        for dead_centre in [0.0, PI] {
            let theta = move |t: f64| dead_centre + swing * (9.0 * t + 0.4).sin();
            let motion = Motion {
                theta: &theta,
                samples: 900,
                noise,
                step: 0.0,
            };
            is_right(&motion, &plain());
        }
    }
}

/// The crank begins next to a dead centre, turns soon and goes the other way: the scene's speed is that of the first samples.
#[test]
fn a_crank_that_soon_turns_begins_with_the_sense_of_the_scene() {
    let scene = scene(0.0138, 0.0309, 0.0007, Branch::Right);
    for sense in [1.0, -1.0] {
        for noise in [0.0, 1e-4, 1e-3] {
            let theta = move |t: f64| sense * (0.005 + 6.5 * t - 36.8 * t * t);
            let motion = Motion {
                theta: &theta,
                samples: 159,
                noise,
                step: 0.0,
            };
            if noise < 1e-3 {
                is_right(&motion, &scene);
            } else {
                is_not_wrong(&motion, &scene);
            }
        }
    }
}

/// From rest at a dead centre the crank may go either way: angle and speed of the scene are the same.
#[test]
fn a_rest_at_a_dead_centre_that_begins_a_record_is_in_doubt() {
    for way in [1.0, -1.0] {
        for noise in [1e-6, 1e-3] {
            let theta = move |t: f64| PI + way * 3.0 * ease((t - 0.3) / 0.7);
            let motion = Motion {
                theta: &theta,
                samples: 300,
                noise,
                step: 0.0,
            };
            is_in_doubt(&motion, &plain());
        }
    }
}

/// The first samples alone are before the dead centre, and the crank turns soon beyond it: with much noise a slider position does not
/// show that turning point.
#[test]
fn a_record_may_begin_just_before_a_dead_centre() {
    for dead_centre in [0.0, PI] {
        for sense in [1.0, -1.0] {
            let theta = move |t: f64| dead_centre + sense * (1.8 * t - 3.2 * t * t - 0.032);
            for samples in [30, 35, 60, 200] {
                for noise in [1e-5, 1e-4, 1e-3, 3e-3] {
                    let motion = Motion {
                        theta: &theta,
                        samples,
                        noise,
                        step: 0.0,
                    };
                    is_not_wrong(&motion, &plain());
                }
            }
        }
    }
}

/// At rest the difference quotient of the scene's speed is some rounding: its sign says nothing.
#[test]
fn a_speed_that_is_as_good_as_none_does_not_tell_how_a_record_begins() {
    let scene = scene(0.0864, 0.4814, 0.0245, Branch::Left);
    for (path, samples, noise) in [(30.0, 2400, 1e-3), (3.0, 300, 1e-3), (30.0, 2400, 1e-4)] {
        for sense in [1.0, -1.0] {
            let theta = move |t: f64| -3.0984 + sense * path * ease(t);
            let motion = Motion {
                theta: &theta,
                samples,
                noise,
                step: 0.0,
            };
            let found = motion.unfold(&scene, Measured::X);
            assert!(
                matches!(found, Found::Doubt(_)),
                "{sense}, {path}, {noise}: {found:?}"
            );
        }
    }
}

/// Where the strokes are farther apart than noise blurs them the angle tells, whatever the sign of a speed that is none.
#[test]
fn the_angle_tells_how_a_record_begins_at_rest() {
    let scene = scene(0.01725, 0.10825, 0.05176, Branch::Left);
    for sense in [1.0, -1.0] {
        let theta = move |t: f64| 3.7983 + sense * 2.5 * ease(t);
        let motion = Motion {
            theta: &theta,
            samples: 6000,
            noise: 3e-3,
            step: 0.0,
        };
        let found = motion.unfold(&scene, Measured::X);
        assert!(!matches!(found, Found::Wrong), "{sense}: {found:?}");
    }
}

/// From rest next to a dead centre both strokes begin near the scene's angle. Where noise leaves them apart the nearer one counts,
/// not the sign of a speed that is some rounding.
#[test]
fn the_nearer_angle_tells_how_a_record_begins_at_rest() {
    for (away, samples, noise) in [(0.015, 1637, 4e-6), (-0.015, 147, 3e-6), (0.007, 37, 2e-4)] {
        for sense in [1.0, -1.0] {
            for speed in [1e-6, -1e-6] {
                let theta = move |t: f64| away + sense * 1.8 * t * t;
                let motion = Motion {
                    theta: &theta,
                    samples,
                    noise,
                    step: 0.0,
                };
                let times = (0..samples).map(|i| i as f64 / (samples - 1) as f64);
                let scene = plain().start(away, speed);
                let found = motion.unfold_from(&scene, Measured::Gamma, times.collect());
                assert!(
                    matches!(found, Found::Right),
                    "{away}, {sense}, {speed}: {found:?}"
                );
            }
        }
    }
}

/// A motion may reverse at once, so the angle decides, and it is said that the speed is not that of the motion.
#[test]
fn a_plain_angle_counts_before_a_speed_of_the_other_sense() {
    let scene = plain().start(0.8, -30.0);
    let times: Vec<f64> = (0..300).map(|i| 1e-3 * f64::from(i)).collect();
    let theta = |t: &f64| 0.8 + 30.0 * t;
    for measured in BOTH {
        let value = |t: &f64| shown(&scene, measured, theta(t)).abs();
        let values = times.iter().map(value).collect();
        let measurement = Measurement::new(measured, times.clone(), values).expect("samples");
        let found = inverse(&scene, &measurement, &InverseOptions::default());
        let found = found.expect("an inversion");
        for (row, t) in found.rows.iter().zip(&times) {
            assert!((row.theta - theta(t)).abs() < WRONG, "{measured:?}, {t}");
        }
        let warnings = &found.summary.warnings;
        let is_said = |said: &String| said.contains("belong to different motions");
        assert!(warnings.iter().any(is_said), "{measured:?}: {warnings:?}");
    }
}

/// A scene that says nothing of how the motion begins leaves it to a rule, which is no knowledge.
#[test]
fn without_angle_and_speed_the_beginning_cannot_be_told() {
    let scene = plain().start(0.0, 0.0);
    let times: Vec<f64> = (0..200).map(|i| 1e-3 * f64::from(i)).collect();
    for measured in BOTH {
        let value = |t: &f64| shown(&scene, measured, 0.3 + 30.0 * t).abs();
        let values = times.iter().map(value).collect();
        let measurement = Measurement::new(measured, times.clone(), values).expect("samples");
        let found = inverse(&scene, &measurement, &InverseOptions::default());
        let warnings = found.expect("an inversion").summary.warnings;
        let is_said = |said: &String| said.contains("which one it is cannot be told");
        assert!(warnings.iter().any(is_said), "{measured:?}: {warnings:?}");
    }
}

/// The crank stops just at a dead centre and goes on at once, with a jump of its acceleration. One that goes back has none there,
/// and shows the same.
#[test]
fn a_stop_at_a_dead_centre_is_in_doubt() {
    for dead_centre in [0.0, PI] {
        for way in [1.0, -1.0] {
            let theta = move |t: f64| {
                let short = 1.2 * (1.0 - (TAU * (t - 0.5)).cos());
                dead_centre + if t < 0.5 { -short } else { way * short }
            };
            for noise in [1e-6, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3] {
                let motion = Motion {
                    theta: &theta,
                    samples: 801,
                    noise,
                    step: 0.0,
                };
                is_in_doubt(&motion, &plain());
            }
        }
    }
}

/// The same without noise, or with steps alone, on mechanisms that are not symmetric: one polynomial tells the motion that goes back,
/// and its root is one or is none.
#[test]
fn a_stop_at_a_dead_centre_without_noise_is_in_doubt() {
    let right = [(0.0, 0.0), (0.02, 0.0), (-0.02, 1e-10)].map(|case| (Branch::Right, 1.0, case));
    let left = [(1e-11, 0.0), (-0.02, 0.0), (0.02, 1e-7)].map(|case| (Branch::Left, -1.0, case));
    for (branch, sign, (offset, step)) in right.into_iter().chain(left) {
        let scene = scene(0.05, 0.15, offset, branch);
        for (reach, turn) in [(0.2f64, 0.0), (0.1, PI)] {
            let x = sign * (reach * reach - offset * offset).sqrt();
            let dead_centre = (-offset).atan2(x) + turn;
            let shorts: [fn(f64) -> f64; 2] = [
                |t| 1.2 * (1.0 - (TAU * t).cos()),
                |t| 6.0 * t * t * (1.0 + t),
            ];
            for short in shorts {
                let theta = move |t: f64| dead_centre + (t - 0.5).signum() * short(t - 0.5);
                let motion = Motion {
                    theta: &theta,
                    samples: 801,
                    noise: 0.0,
                    step,
                };
                is_in_doubt(&motion, &scene);
            }
        }
    }
}

/// A long rest at a dead centre without noise, at uneven times: no polynomial follows that, and the one that misses less in one
/// range of samples does not decide.
#[test]
fn a_long_rest_at_a_dead_centre_without_noise_is_in_doubt() {
    let scene = scene(
        0.04699911291015789,
        0.056592150845861826,
        0.006956012292161392,
        Branch::Left,
    );
    let dead_centre = 0.8111948070534849;
    for draw in 1..=6 {
        let mut random = Random(88_172_645_463_325_252 + draw);
        let theta = move |t: f64| {
            dead_centre + 0.836 * (1.0 - ease(t / 0.25)) - 3.7 * ease((t - 0.845) / 0.155)
        };
        let samples = 25_000;
        let even = (0..samples).map(|i| i as f64 + 0.6 * (random.even() - 0.5));
        let times = even.map(|i| i / samples as f64).collect();
        let motion = Motion {
            theta: &theta,
            samples,
            noise: 0.0,
            step: 0.0,
        };
        let found = motion.unfold_at(&scene, Measured::X, times);
        assert!(!matches!(found, Found::Wrong), "{draw}: {found:?}");
    }
}

/// A rest at a dead centre in steps of an instrument that are finer than what any polynomial misses: what one range of samples tells
/// is not enough.
#[test]
fn one_range_of_samples_that_no_motion_explains_does_not_decide() {
    let (crank, rod, offset) = (0.3617710317036641, 1.7966982159614449, -0.13595664043886765);
    let scene = scene(crank, rod, offset, Branch::Right);
    let dead_centre = f64::asin(-offset / (crank + rod)) - TAU;
    let part = |t: f64| ease((2.0 * t - 0.16423877697) / 0.67152244605);
    let theta = |t: f64| {
        let [to, from] = [part(t), part(t - 0.5)];
        3.0212390740327892 * (1.0 - to) + dead_centre * (to - from) + 9.519668409941954 * from
    };
    for samples in [7500, 10_000, 15_000] {
        let motion = Motion {
            theta: &theta,
            samples,
            noise: 0.0,
            step: 7.8425e-5,
        };
        let found = motion.unfold(&scene, Measured::X);
        // A fit to the wrong motion may be refused.
        let is_named = matches!(&found, Found::Doubt(said) if said.contains("cannot be told"));
        assert!(is_named, "{samples}: {found:?}");
    }
}

/// Few samples beyond a dead centre, blurred by noise, do not bend a motion that is plain up to there.
#[test]
fn a_record_may_end_just_after_a_dead_centre() {
    let step = 0.2;
    for beyond in (0..16).map(|k| 0.25 * f64::from(k) * step) {
        for dead_centre in [0.0, PI] {
            let theta = move |t: f64| dead_centre + beyond - (1.0 - t) * 100.0 * step;
            let motion = Motion {
                theta: &theta,
                samples: 101,
                noise: 1e-4,
                step: 0.0,
            };
            is_right(&motion, &plain());
        }
    }
}

/// The crank almost stops once in each turn, at some place.
#[test]
fn a_crank_that_almost_stops_goes_on_or_is_in_doubt() {
    for slowest in [0.3, 0.1, 0.03] {
        for place in 0..8 {
            let start = TAU * f64::from(place) / 8.0;
            let theta =
                move |t: f64| start + 3.0 * TAU * t - (1.0 - slowest) * (3.0 * TAU * t).sin();
            for noise in [0.0, 1e-5, 1e-3] {
                let motion = Motion {
                    theta: &theta,
                    samples: 500,
                    noise,
                    step: 0.0,
                };
                let scene = scene(0.05, 0.12, 0.01, Branch::Right);
                if slowest > 0.2 && noise < 1e-4 {
                    is_right(&motion, &scene);
                } else {
                    is_not_wrong(&motion, &scene);
                }
            }
        }
    }
}

#[test]
fn few_samples_of_a_turn_are_enough_for_a_steady_motion() {
    for (samples, noise) in [(81, 0.0), (161, 0.0), (161, 1e-3)] {
        for sense in [1.0, -1.0] {
            let theta = move |t: f64| 0.4 + sense * (10.0 * TAU * t + 0.2 * (7.0 * t).sin());
            let motion = Motion {
                theta: &theta,
                samples,
                noise,
                step: 0.0,
            };
            let scene = scene(0.05, 0.2, 0.01, Branch::Left);
            if samples > 100 {
                is_right(&motion, &scene);
            } else {
                is_not_wrong(&motion, &scene);
            }
        }
    }
}

/// With ten samples a turn the folds of a crank-pin angle are no noise: at the end of the samples at most is there a doubt.
#[test]
fn few_samples_of_many_uneven_turns_tell_them() {
    const TURNS: f64 = 400.0;
    let scene = scene(0.05, 0.15, 0.01, Branch::Right).start(0.3, 1.0);
    for measured in BOTH {
        let times: Vec<f64> = (0..=4000).map(|i| f64::from(i) / 4000.0).collect();
        let values = times.iter().map(|t| {
            let turned = TURNS * TAU * t;
            shown(&scene, measured, 0.3 + turned + 0.3 * turned.sin()).abs()
        });
        let values = values.collect();
        let measurement = Measurement::new(measured, times, values).expect("samples");
        let options = InverseOptions {
            fit: FitKind::Polynomial,
            size: FitSize::Fixed(1),
            ..InverseOptions::default()
        };
        let found = inverse(&scene, &measurement, &options).expect("a line");
        let Inverse { summary, rows, .. } = &found;
        let turns = (rows[rows.len() - 1].theta - rows[0].theta) / TAU;
        assert!((turns - TURNS).abs() < 0.1, "{measured:?}: {turns} turns");
        let doubt = summary.warnings.iter().find(|w| w.contains("choices"));
        assert!(doubt.is_none(), "{measured:?}: {doubt:?}");
    }
}

/// In a gap of more than half a turn dead centres are passed unseen; one of a quarter does no harm.
#[test]
fn a_gap_in_which_turns_may_be_lost_is_named() {
    let scene = plain().start(0.3, 30.0);
    for (gap, lost) in [(0.25, false), (0.6, true), (1.3, true)] {
        let all = (0..600).map(|i| 1e-3 * f64::from(i));
        let times: Vec<f64> = all
            .filter(|t| *t < 0.25 || *t > 0.25 + gap * TAU / 30.0)
            .collect();
        for measured in [Measured::Theta, Measured::X, Measured::Gamma] {
            let value = |t: &f64| match measured {
                Measured::Theta => (0.3 + 30.0 * t) % TAU,
                Measured::X => shown(&scene, measured, 0.3 + 30.0 * t),
                Measured::Gamma => shown(&scene, measured, 0.3 + 30.0 * t).abs(),
            };
            let values = times.iter().map(value).collect();
            let measurement = Measurement::new(measured, times.clone(), values).expect("samples");
            let found = inverse(&scene, &measurement, &InverseOptions::default());
            let warnings = found.expect("an inversion").summary.warnings;
            let said = warnings
                .iter()
                .find(|w| w.contains("how far the crank turns"));
            assert_eq!(said.is_some(), lost, "{measured:?}, {gap}: {warnings:?}");
            assert!(said.is_none_or(|w| w.contains("sample 251 ")), "{said:?}");
        }
    }
}

/// Of samples at random times the longest wait may be just at a fold, from which the value is far before and after.
#[test]
fn turns_sampled_at_random_times_are_told() {
    let mut random = Random(6_364_136_223_846_793_005);
    for case in 0..40 {
        let (start, turns, swing) = (
            TAU * random.even(),
            2.0 + 5.0 * random.even(),
            0.3 * random.even(),
        );
        let theta = move |t: f64| start + TAU * turns * t + swing * (5.0 * turns * t).sin();
        let samples = ([100.0, 150.0, 250.0][case % 3] * turns) as usize;
        let mut times: Vec<f64> = (0..samples).map(|_| random.even()).collect();
        times.sort_by(f64::total_cmp);
        let motion = Motion {
            theta: &theta,
            samples,
            noise: [0.0, 1e-4][case % 2],
            step: 0.0,
        };
        let scene = scene(0.05, 0.15, 0.02 * random.even(), Branch::Right);
        for measured in BOTH {
            let found = motion.unfold_at(&scene, measured, times.clone());
            assert!(
                matches!(found, Found::Right),
                "{case}, {measured:?}, {motion:?}: {found:?}"
            );
        }
    }
}

/// Four samples from fold to fold of an uneven motion tell hardly any choice: that is seen before all are looked at.
#[test]
fn very_many_turns_in_doubt_are_refused_by_some_of_them() {
    const TURNS: f64 = 6000.0;
    let scene = scene(0.05, 0.15, 0.01, Branch::Right).start(0.3, 1.0);
    for measured in BOTH {
        let times: Vec<f64> = (0..48_000).map(|i| f64::from(i) / 48_000.0).collect();
        let values = times.iter().map(|t| {
            let turned = TURNS * TAU * t;
            let ripple = 0.5 * (0.7 * turned).sin() + 0.5 * (1.31 * turned).sin();
            shown(&scene, measured, 0.3 + turned + ripple).abs()
        });
        let values = values.collect();
        let measurement = Measurement::new(measured, times, values).expect("samples");
        let refused = inverse(&scene, &measurement, &InverseOptions::default());
        let refused = refused.expect_err("doubts").to_string();
        let choices = refused.split_once("of ").and_then(|(_, rest)| {
            let (all, rest) = rest.split_once(" choices that were looked at, ")?;
            let (doubts, _) = rest.split_once(" of the motion")?;
            Some((all.parse::<usize>().ok()?, doubts.parse::<usize>().ok()?))
        });
        let (all, doubts) = choices.expect("choices");
        assert!(
            all < 2 * TURNS as usize / 8 && 2 * doubts >= all,
            "{refused}"
        );
    }
}

#[test]
fn coarse_steps_of_an_instrument_do_not_mislead() {
    for step in [1e-4, 1e-3, 5e-3] {
        let theta = |t: f64| 0.7 + 30.0 * t - 14.0 * t * t;
        let motion = Motion {
            theta: &theta,
            samples: 700,
            noise: 0.0,
            step,
        };
        is_not_wrong(&motion, &plain());
    }
}

#[test]
fn the_size_of_a_mechanism_does_not_matter() {
    for crank in [2e-6, 0.05, 8.0] {
        let theta = |t: f64| 0.7 + 30.0 * t - 14.0 * t * t;
        let motion = Motion {
            theta: &theta,
            samples: 700,
            noise: 1e-4,
            step: 0.0,
        };
        is_right(
            &motion,
            &scene(crank, 2.7 * crank, -0.4 * crank, Branch::Right),
        );
    }
}

/// On a crank that cannot turn fully the crank-pin angle turns back also where the wrist pin is beside the pivot.
#[test]
fn swings_of_rockers_across_either_fold_are_told() {
    let linkage = |scene: &Scene| Linkage::new(&scene.geometry);
    for (branch, sign) in [(Branch::Right, 1.0), (Branch::Left, -1.0)] {
        let rocker = scene(0.05, 0.07, 0.06, branch);
        // The angles at which the wrist pin is beside the pivot, on this branch.
        let x = |theta: f64| sign * linkage(&rocker).pose(theta).x;
        let beside = (0..2000).map(|k| TAU * f64::from(k) / 2000.0);
        let mut beside = beside.filter(|theta| {
            let [a, b] = [theta - 0.3, theta + 0.3].map(|theta| linkage(&rocker).pose(theta));
            a.exists() && b.exists() && x(*theta).abs() < 2e-4
        });
        let Some(middle) = beside.next_back() else {
            panic!("the wrist pin is nowhere beside the pivot")
        };
        for swing in [0.1, 0.25] {
            for noise in [0.0, 1e-5] {
                let theta = move |t: f64| middle + swing * (12.0 * t + 0.5).sin();
                let motion = Motion {
                    theta: &theta,
                    samples: 600,
                    noise,
                    step: 0.0,
                };
                is_right(&motion, &rocker);
            }
        }
    }
}

/// θ(t) for 0 ≤ t ≤ 1.
#[derive(Clone, Copy, Debug)]
enum Formula {
    Turns { path: f64, swing: f64, rate: f64 },
    Swing { swing: f64, rate: f64 },
    Coast { path: f64, ratio: f64 },
    StopAndGo { path: f64, part: f64, rate: f64 },
}

impl Formula {
    fn at(&self, t: f64) -> f64 {
        match *self {
            Formula::Turns { path, swing, rate } => path * t + swing * (rate * t).sin(),
            Formula::Swing { swing, rate } => swing * (rate * t).sin(),
            Formula::Coast { path, ratio } => path * (1.0 - ratio.powf(-t)) / (1.0 - 1.0 / ratio),
            Formula::StopAndGo { path, part, rate } => path * (t + part * (rate * t).sin() / rate),
        }
    }
}

fn formula() -> impl Strategy<Value = Formula> {
    let path = || magnitude(2.5, 70.0);
    prop_oneof![
        (path(), 0.0..0.5, 1.0..6.0).prop_map(|(path, swing, rate)| Formula::Turns {
            path,
            swing,
            rate
        }),
        (magnitude(0.2, 3.0), 3.0..12.0).prop_map(|(swing, rate)| Formula::Swing { swing, rate }),
        (path(), magnitude(2.0, 100.0)).prop_map(|(path, ratio)| Formula::Coast { path, ratio }),
        (path(), 0.3..0.98, 6.0..35.0).prop_map(|(path, part, rate)| Formula::StopAndGo {
            path,
            part,
            rate
        }),
    ]
}

proptest! {
    #![proptest_config(cases(150))]

    #[test]
    fn random_motions_are_unfolded_or_in_doubt(
        geometry in rotating_crank(0.05),
        formula in formula(),
        start in -PI..PI,
        sense in prop_oneof![Just(1.0), Just(-1.0)],
        samples in magnitude(150.0, 2500.0),
        noise in prop_oneof![Just(0.0), magnitude(1e-7, 3e-3)],
        measured in prop_oneof![Just(Measured::X), Just(Measured::Gamma)],
    ) {
        let theta = move |t: f64| start + sense * formula.at(t);
        let fastest = (0..500).map(|k| (formula.at(f64::from(k + 1) / 500.0) - formula.at(f64::from(k) / 500.0)).abs());
        let fastest = 500.0 * fastest.fold(0.0, f64::max);
        // At least 25 in a turn.
        let samples = (samples as usize).max((25.0 * fastest / TAU) as usize);
        let mut scene = plain();
        scene.geometry = geometry;
        let motion = Motion { theta: &theta, samples, noise, step: 0.0 };
        let found = motion.unfold(&scene, measured);
        prop_assert!(!matches!(found, Found::Wrong), "{:?}", found);
    }
}

/// Doubt is for what cannot be told: hardly for motions that do not stop near a dead centre.
#[test]
fn steady_motions_are_hardly_ever_in_doubt() {
    let mut random = Random(9_007_199_254_740_881);
    let (mut doubts, mut all) = (0, 0);
    for _ in 0..60 {
        let path = 3.0 + 40.0 * random.even();
        let (swing, start) = (0.4 * random.even(), TAU * random.even());
        let noise = 10f64.powf(-6.0 + 3.5 * random.even());
        let theta = move |t: f64| start + path * t + swing * (5.0 * t).sin();
        let motion = Motion {
            theta: &theta,
            samples: 600,
            noise,
            step: 0.0,
        };
        for measured in BOTH {
            let found = motion.unfold(&scene(0.05, 0.15, 0.01, Branch::Right), measured);
            assert!(!matches!(found, Found::Wrong), "{found:?}");
            doubts += usize::from(matches!(found, Found::Doubt(_)));
            all += 1;
        }
    }
    assert!(doubts * 25 < all, "{doubts} of {all}");
}
