//! Inversion of random mechanisms, motions and files: the result is right within the band or stated to be in doubt;
//! damaged files are refused with the place or read correctly.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

use crate::support::instrument::shown;
use crate::support::newton::Parts;
use crate::support::random::{cases, rotating_crank};
use proptest::prelude::*;
use slider_crank::inverse::{FitKind, Inverse, InverseOptions, inverse};
use slider_crank::scene::{Crank, Gravity, Measured, Measurement, Reading, Rod, Scene, Slider};

/// Motion θ(t) = start + speed (1 − exp(−slowing t))/slowing + swing sin(rate t), sampled from 0 to `end`.
#[derive(Clone, Copy, Debug)]
struct Formula {
    start: f64,
    speed: f64,
    swing: f64,
    rate: f64,
    /// Decay rate, 1/s; negative where the crank gets faster.
    slowing: f64,
    end: f64,
}

impl Formula {
    fn at(&self, t: f64) -> [f64; 3] {
        let (sin, cos) = (self.rate * t).sin_cos();
        let speed = self.speed * (-self.slowing * t).exp();
        let path = if self.slowing == 0.0 {
            self.speed * t
        } else {
            -self.speed * (-self.slowing * t).exp_m1() / self.slowing
        };
        [
            self.start + path + self.swing * sin,
            speed + self.swing * self.rate * cos,
            -self.slowing * speed - self.swing * self.rate * self.rate * sin,
        ]
    }
}

fn formula() -> impl Strategy<Value = Formula> {
    let signed = |from: f64, to: f64| prop_oneof![from..to, -to..-from];
    let start = -3.0..3.0;
    let steady = Just(0.0);
    prop_oneof![
        // Several turns in either sense, unsteady.
        (
            start.clone(),
            signed(8.0, 30.0),
            0.0..0.3,
            3.0..12.0,
            steady
        ),
        // Swings, with dead centres passed or not.
        (start.clone(), steady, signed(0.3, 3.0), 4.0..9.0, steady),
        // Run-down and run-up, by a factor of up to a hundred.
        (start.clone(), signed(20.0, 70.0), steady, steady, 1.5..4.5),
        (start, signed(1.0, 3.0), steady, steady, -3.5..-1.0),
    ]
    .prop_map(|(start, speed, swing, rate, slowing)| Formula {
        start,
        speed,
        swing,
        rate,
        slowing,
        end: 1.0,
    })
}

fn scene(geometry: slider_crank::scene::Geometry, motion: &Formula) -> Scene {
    let [theta, omega, _] = motion.at(0.0);
    let mut scene = Scene::new(geometry.crank, geometry.rod)
        .crank(Crank {
            mass: 1.0,
            cg: 0.2 * geometry.crank,
            inertia: 0.6 * geometry.crank * geometry.crank,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.7,
            cg: 0.3 * geometry.rod,
            inertia: 0.08 * geometry.rod * geometry.rod,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.9 })
        .gravity(Gravity::standard())
        .start(theta, omega);
    scene.geometry = geometry;
    scene
}

/// Returns the slider force that gives the acceleration of a motion, by the Newton-Euler equations, which are linear in
/// it.
fn force(scene: &Scene, [theta, omega, alpha]: [f64; 3]) -> f64 {
    let parts = Parts::new(scene, theta);
    let with = |force: f64| parts.solve(omega, 0.0, force).0;
    let (free, pushed) = (with(0.0), with(1.0));
    (alpha - free) / (pushed - free)
}

/// Units, order, delimiter and comments of a file.
#[derive(Clone, Copy, Debug)]
struct Style {
    time: (&'static str, f64),
    degrees: bool,
    delimiter: char,
    swapped: bool,
    extra: bool,
}

fn style() -> impl Strategy<Value = Style> {
    let time = prop_oneof![
        Just(("t [s]", 1.0)),
        Just(("t_s", 1.0)),
        Just(("time (ms)", 1e3)),
        Just(("t [min]", 1.0 / 60.0)),
    ];
    let delimiter = prop_oneof![Just(','), Just(';'), Just('\t')];
    (time, any::<bool>(), delimiter, any::<bool>(), any::<bool>()).prop_map(
        |(time, degrees, delimiter, swapped, extra)| Style {
            time,
            degrees,
            delimiter,
            swapped,
            extra,
        },
    )
}

impl Style {
    fn csv(&self, measured: Measured, samples: &[(f64, f64)]) -> String {
        let (unit, factor) = match (measured, self.degrees) {
            (Measured::X, true) => ("[mm]", 1e3),
            (Measured::X, false) => ("(m)", 1.0),
            (_, true) => ("[deg]", 1f64.to_degrees()),
            (_, false) => ("(rad)", 1.0),
        };
        let d = self.delimiter;
        let mut text = String::from("# a comment\n");
        let mut line = |time: &str, value: &str, extra: &str| {
            let (a, b) = if self.swapped {
                (value, time)
            } else {
                (time, value)
            };
            let _ = match self.extra {
                true => writeln!(text, "{a}{d}{extra}{d}{b}"),
                false => writeln!(text, "{a}{d}{b}"),
            };
        };
        line(
            self.time.0,
            &format!("{} {unit}", measured.name()),
            "load [N]",
        );
        for (t, value) in samples {
            line(
                &format!("{}", t * self.time.1),
                &format!("{:.9}", value * factor),
                "7.5",
            );
        }
        text
    }
}

/// Checks that every result is finite or empty.
fn all_finite(found: &Inverse) {
    for row in &found.rows {
        let numbers = [
            row.t,
            row.theta,
            row.omega,
            row.alpha,
            row.crank_torque.unwrap_or(0.0),
            row.crank_torque_se.unwrap_or(0.0),
        ];
        assert!(numbers.iter().all(|v| v.is_finite()), "{row:?}");
        assert_eq!(row.slider_force.is_none(), row.near_dead_centre);
        assert_eq!(row.slider_force.is_none(), row.slider_force_se.is_none());
        assert!(
            row.slider_force.is_none_or(f64::is_finite)
                && row.slider_force_se.is_none_or(f64::is_finite)
        );
    }
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn random_motions_give_their_force_or_say_what_is_in_doubt(
        geometry in rotating_crank(0.2),
        motion in formula(),
        style in style(),
        measured in prop_oneof![Just(Measured::Theta), Just(Measured::Gamma), Just(Measured::X)],
        noise in prop_oneof![Just(0.0), Just(3e-4)],
        seed in 1u64..1000,
    ) {
        let scene = scene(geometry, &motion);
        let mut random = seed;
        let mut even = || {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (random >> 11) as f64 / (1u64 << 53) as f64
        };
        let size = if measured == Measured::X { geometry.crank } else { 1.0 };
        let samples: Vec<(f64, f64)> = (0..500).map(|i| {
            let t = motion.end * f64::from(i) / 499.0;
            let normal = (0..12).map(|_| even()).sum::<f64>() - 6.0;
            let value = shown(&scene, measured, motion.at(t)[0]) + noise * size * normal;
            (t, if measured == Measured::Gamma { PI - (PI - value.abs()).abs() } else { value })
        }).collect();
        let text = style.csv(measured, &samples);
        let read = Measurement::parse(Path::new("fuzz.csv"), text, &Reading::default());
        let read = read.expect("good data");
        let options = InverseOptions { fit: FitKind::Smoother, ..InverseOptions::default() };
        let found = match inverse(&scene, &read, &options) {
            Ok(found) => found,
            // Undecidable motions are refused, with advice.
            Err(refused) => {
                prop_assert!(measured != Measured::Theta && refused.to_string().contains("help:"), "{}", refused);
                return Ok(());
            }
        };
        all_finite(&found);
        let warned = found.summary.warnings.join("; ");
        let doubt = warned.contains("cannot be told") || warned.contains("not noise") || warned.contains("did not settle");
        let turns = ((found.rows[0].theta - motion.at(found.rows[0].t)[0]) / TAU).round() * TAU;
        let off = found.rows.iter().map(|row| (row.theta - turns - motion.at(row.t)[0]).abs()).fold(0.0, f64::max);
        prop_assert!(off < 0.05 || doubt, "off by {} rad: {}", off, warned);
        if doubt {
            return Ok(());
        }
        let factor = found.summary.band_factor;
        let (mut inside, mut all) = (0, 0);
        for row in &found.rows {
            if let (Some(force_found), Some(se)) = (row.slider_force, row.slider_force_se) {
                let error = (force_found - force(&scene, motion.at(row.t))).abs();
                prop_assert!(error < 8.0 * se, "t = {}: {} and {}", row.t, error, se);
                all += 1;
                inside += usize::from(error <= factor * se);
            }
        }
        prop_assert!(f64::from(inside as u32) >= 0.75 * f64::from(all as u32), "{} of {}", inside, all);
    }

    #[test]
    fn damaged_files_are_refused_or_read(
        damage in prop::collection::vec((0usize..10, any::<prop::sample::Index>(), any::<u8>()), 1..4),
        style in style(),
        measured in prop_oneof![Just(Measured::Theta), Just(Measured::Gamma), Just(Measured::X)],
    ) {
        let motion = Formula { start: 0.4, speed: 9.0, swing: 0.2, rate: 5.0, slowing: 0.0, end: 0.8 };
        let scene = scene(crate::support::geometry(0.05, 0.15, 0.01, slider_crank::scene::Branch::Right), &motion);
        let samples: Vec<(f64, f64)> = (0..60).map(|i| {
            let t = 0.013 * f64::from(i);
            (t, shown(&scene, measured, motion.at(t)[0]))
        }).collect();
        let mut bytes = style.csv(measured, &samples).into_bytes();
        for (kind, place, byte) in damage {
            break_one(&mut bytes, kind, place, byte);
        }
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("fuzz.csv");
        std::fs::write(&file, &bytes).expect("written");
        let found = Measurement::load(&file, &Reading::default())
            .and_then(|read| inverse(&scene, &read, &InverseOptions::default()));
        match found {
            Ok(found) => all_finite(&found),
            Err(error) => {
                let text = error.to_string();
                prop_assert!(!text.is_empty() && text.len() < 20_000);
                prop_assert!(text.contains("fuzz.csv") || text.contains("help:"), "{}", text);
            }
        }
    }
}

/// Applies one kind of damage.
fn break_one(bytes: &mut Vec<u8>, kind: usize, place: prop::sample::Index, byte: u8) {
    if bytes.is_empty() {
        return;
    }
    let at = place.index(bytes.len());
    let line_end = bytes[at..]
        .iter()
        .position(|b| *b == b'\n')
        .map_or(bytes.len(), |n| at + n);
    let insert =
        |bytes: &mut Vec<u8>, piece: &[u8]| drop(bytes.splice(at..at, piece.iter().copied()));
    match kind {
        0 => bytes[at] = byte,
        1 => drop(bytes.drain(at..line_end)),
        2 => bytes.truncate(at),
        3 => insert(bytes, b"1e999"),
        4 => drop(bytes.splice(0..0, *b"\xef\xbb\xbf")),
        5 => {
            let text: Vec<u8> = bytes
                .iter()
                .flat_map(|b| {
                    if *b == b'\n' {
                        vec![b'\r', b'\n']
                    } else {
                        vec![*b]
                    }
                })
                .collect();
            *bytes = text;
        }
        6 => insert(bytes, b"\""),
        7 => insert(bytes, &[0, byte]),
        8 => insert(bytes, &[0xff, byte | 0x80]),
        _ => {
            // Duplicate a line.
            let start = bytes[..at]
                .iter()
                .rposition(|b| *b == b'\n')
                .map_or(0, |n| n + 1);
            let line: Vec<u8> = bytes[start..line_end]
                .iter()
                .copied()
                .chain([b'\n'])
                .collect();
            drop(bytes.splice(start..start, line));
        }
    }
}
