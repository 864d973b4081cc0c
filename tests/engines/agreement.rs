//! Engines compared over random scenes: two engines that apply to one scene must agree within their stated errors, at
//! the end and inside the run, in events, extreme speeds and energy balance.

use std::path::Path;
use std::thread;

use crate::support::scenes::{DRAWS, Draws, write_tables};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;
use slider_crank::plan::Method;
use slider_crank::scene::{Extent, Scene};
use slider_crank::simulate::{Event, Options, Simulation, simulate};

const SCENES: usize = 320;
/// Largest number of evaluations of a method under comparison.
const EVALUATIONS: u64 = 50_000;
/// Largest accepted ratio of true to stated error.
const STATED: f64 = 2.0;

const METHODS: [Method; 5] = [
    Method::Energy,
    Method::Angle,
    Method::Time,
    Method::Dop853,
    Method::Dopri5,
];

/// Run to the end, and a run that ends inside it.
struct Run {
    method: Method,
    whole: Simulation,
    part: Simulation,
}

impl Run {
    fn is_of_library(&self) -> bool {
        matches!(self.method, Method::Dop853 | Method::Dopri5)
    }

    /// Returns the allowed energy residual, relative to the largest energy; tolerances are absolute for slow motions.
    fn residual_allowed(&self, tolerance: f64) -> f64 {
        let summary = &self.whole.summary;
        let fastest = summary.omega_min.abs().max(summary.omega_max.abs());
        let steps = summary.steps as f64;
        tolerance * (100.0 + 10.0 * steps) * (1.0 + 1.0 / fastest).powi(2) + 1e-12
    }
}

/// Disagreements found in one scene.
struct Scenery<'a> {
    text: &'a str,
    tolerance: f64,
    inside: f64,
    wrong: Vec<String>,
    pairs: usize,
}

fn stated(run: &Simulation) -> [f64; 2] {
    let error = run.summary.error_estimate.expect("an estimate");
    [error.theta_rad, error.omega_rad_per_s]
}

/// Returns the distance of two runs that their stated errors allow.
fn both(a: &Simulation, b: &Simulation) -> [f64; 2] {
    let (ea, eb) = (stated(a), stated(b));
    [0, 1].map(|k| STATED * (ea[k] + eb[k]))
}

/// Returns an allowed distance increased by an absolute and relative slack.
fn with(allowed: [f64; 2], slack: f64, at: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k| allowed[k] + slack * (1.0 + at[k].abs()))
}

/// Returns a finished run with its estimate; none where the method does not apply, stops, or takes too long.
fn run(scene: &Scene, method: Method) -> Option<Simulation> {
    let alone = Options {
        method,
        estimate: false,
        max_evaluations: EVALUATIONS,
        ..Options::default()
    };
    let alone = simulate(scene, &alone).ok()?;
    if alone.summary.stopped.is_some() {
        return None;
    }
    // The estimate takes more evaluations than the run.
    let options = Options {
        method,
        max_evaluations: 20 * EVALUATIONS,
        ..Options::default()
    };
    let run = simulate(scene, &options).ok()?;
    let complete = run.summary.stopped.is_none() && run.summary.error_estimate.is_some();
    complete.then_some(run)
}

fn until(scene: &Scene, t: f64) -> Scene {
    let mut scene = scene.clone();
    scene.run.extent = Some(Extent::Duration(t));
    scene
}

/// Returns a time inside the run: that of an event, if there is one.
fn inside(first: &Simulation, draw: f64) -> f64 {
    let summary = &first.summary;
    let within = |t: f64| t > 0.02 * summary.last.t_s && t < 0.98 * summary.last.t_s;
    let events: Vec<f64> = summary.events.iter().map(|event| event.t_s).collect();
    let events: Vec<f64> = events.into_iter().filter(|t| within(*t)).collect();
    match events.len() {
        0 => draw.clamp(0.05, 0.95) * summary.last.t_s,
        count => events[(draw * count as f64) as usize],
    }
}

impl Scenery<'_> {
    fn check(&mut self, holds: bool, what: impl FnOnce() -> String) {
        if !holds {
            self.wrong.push(what());
        }
    }

    /// Checks one run by itself.
    fn alone(&mut self, run: &Run) {
        let summary = &run.whole.summary;
        let [theta, omega] = stated(&run.whole);
        let numbers = [
            summary.last.theta_rad,
            summary.last.omega_rad_per_s,
            summary.energy_residual,
            theta,
            omega,
        ];
        self.check(numbers.iter().all(|x| x.is_finite()), || {
            format!("{}: {numbers:?}", run.method)
        });
        let residual = summary.energy_residual.abs();
        let allowed = run.residual_allowed(self.tolerance);
        self.check(residual <= allowed || theta > 1e-4, || {
            format!("{}: residual {residual:e}, allowed {allowed:e}", run.method)
        });
        let (low, high) = (summary.omega_min, summary.omega_max);
        let margin = 2.0 * omega + 10.0 * self.tolerance * (1.0 + low.abs().max(high.abs()));
        // Between the ends of steps the methods of ode_solvers are unreliable.
        for k in 0..=200 {
            let t = summary.last.t_s * (f64::from(k) / 200.0);
            let speed = run.whole.at(t).expect("a time of the run").1;
            let within = low - margin <= speed && speed <= high + margin;
            self.check(within || run.is_of_library(), || {
                format!(
                    "{}: speed {speed} at {t} s beyond {low} to {high}",
                    run.method
                )
            });
        }
    }

    fn pair(&mut self, a: &Run, b: &Run) {
        self.pairs += 1;
        let who = format!("{} and {}", a.method, b.method);
        let of_library = a.is_of_library() || b.is_of_library();
        let last = |run: &Simulation| {
            let last = run.summary.last;
            [last.theta_rad, last.omega_rad_per_s]
        };
        let (x, y) = (last(&a.whole), last(&b.whole));
        let at_end = both(&a.whole, &b.whole);
        self.states(&format!("{who} at the end"), x, y, with(at_end, 0.0, x));
        let (x, y) = (last(&a.part), last(&b.part));
        let in_run = both(&a.part, &b.part);
        let what = format!("{who} where shorter runs end");
        self.states(&what, x, y, with(in_run, 0.0, x));
        // Inside a step the error is of the size of the tolerance. The program interpolates the methods of ode_solvers
        // between the ends of steps, without error control.
        let slack = self.tolerance * if of_library { 1e4 } else { 2.0 };
        let at = |run: &Run| run.whole.at(self.inside).expect("a time of the run");
        let [x, y] = [at(a), at(b)].map(|(theta, omega)| [theta, omega]);
        let allowed = with(in_run, slack, x);
        self.states(&format!("{who} inside"), x, y, allowed);
        // Stated errors this large allow no conclusion about the motion before the end.
        if at_end[0] < 1e-4 && in_run[0] < 1e-4 {
            self.events(&who, a, b, allowed, at_end);
        }
    }

    fn states(&mut self, who: &str, a: [f64; 2], b: [f64; 2], allowed: [f64; 2]) {
        for k in 0..2 {
            let apart = (a[k] - b[k]).abs();
            self.check(apart <= allowed[k], || {
                let what = ["theta", "omega"][k];
                format!(
                    "{who}: {what} {} and {}, apart {apart:e}, allowed {:e}",
                    a[k], b[k], allowed[k]
                )
            });
        }
    }

    fn events(&mut self, who: &str, a: &Run, b: &Run, allowed: [f64; 2], at_end: [f64; 2]) {
        let (ours, theirs) = (&a.whole.summary, &b.whole.summary);
        let kinds = |events: &[Event]| events.iter().map(|event| event.kind).collect::<Vec<_>>();
        // An event closer to the end than the error may fall on either side of it.
        let is_clear = |event: Option<&Event>| {
            event.is_none_or(|event| {
                let ahead = (event.theta_rad - ours.last.theta_rad).abs();
                let turning = event.kind == "turning-point";
                ahead > 10.0 * at_end[0]
                    && !(turning && ours.last.omega_rad_per_s.abs() < at_end[1])
            })
        };
        let clear = is_clear(ours.events.last()) && is_clear(theirs.events.last());
        let same = kinds(&ours.events) == kinds(&theirs.events)
            && ours.events_total == theirs.events_total;
        self.check(same || !clear, || {
            format!(
                "{who}: {} and {} events",
                ours.events_total, theirs.events_total
            )
        });
        if !same {
            return;
        }
        let here = ours.events.iter().zip(&theirs.events);
        let inside = self.inside;
        for (x, y) in here.filter(|(x, _)| x.t_s == inside) {
            // Where the inertia vanishes the speed is unbounded: compare the rotation of the crank in the time between.
            let turned = |run: &Run| {
                let [here, there] = [x.t_s, y.t_s].map(|t| run.whole.at(t));
                let (here, there) = here.zip(there)?;
                Some((here.0 - there.0).abs())
            };
            let late = [a, b].into_iter().filter_map(turned);
            let late = late.fold(f64::INFINITY, f64::min);
            let apart = (x.theta_rad - y.theta_rad).abs();
            self.check(
                late <= 2.0 * allowed[0] && apart <= 2.0 * allowed[0],
                || {
                    format!(
                        "{who}: {x:?} and {y:?}, late by {late:e} rad, allowed {:e}",
                        allowed[0]
                    )
                },
            );
        }
    }

    /// Compares the largest and least speed of engines with a dense solution.
    fn extremes(&mut self, a: &Run, b: &Run) {
        let (ours, theirs) = (&a.whole.summary, &b.whole.summary);
        let errors = [&a.whole, &b.whole, &a.part, &b.part].map(|run| stated(run)[1]);
        let size = ours.omega_min.abs().max(ours.omega_max.abs());
        let allowed = 10.0 * (errors.iter().sum::<f64>() + self.tolerance * (1.0 + size));
        for (x, y) in [
            (ours.omega_min, theirs.omega_min),
            (ours.omega_max, theirs.omega_max),
        ] {
            self.check(
                (x - y).abs() <= allowed || !x.is_finite() || !y.is_finite(),
                || {
                    format!(
                        "{} and {}: extreme speeds {x} and {y}, allowed {allowed:e}",
                        a.method, b.method
                    )
                },
            );
        }
    }
}

/// Compares all methods that apply to a scene; returns the disagreements and the number of pairs.
fn judge(folder: &Path, text: &str, draw: f64) -> (Vec<String>, usize) {
    let scene = Scene::parse(&folder.join("scene.toml"), text)
        .unwrap_or_else(|why| panic!("{why}\n{text}"));
    let whole: Vec<(Method, Simulation)> = METHODS
        .into_iter()
        .filter_map(|method| Some((method, run(&scene, method)?)))
        .collect();
    let Some((_, first)) = whole.first() else {
        return (Vec::new(), 0);
    };
    let inside = inside(first, draw);
    let short = until(&scene, inside);
    let runs: Vec<Run> = whole
        .into_iter()
        .filter_map(|(method, whole)| {
            let part = run(&short, method)?;
            Some(Run {
                method,
                whole,
                part,
            })
        })
        .collect();
    let mut scenery = Scenery {
        text,
        tolerance: scene.run.tolerance,
        inside,
        wrong: Vec::new(),
        pairs: 0,
    };
    for (i, a) in runs.iter().enumerate() {
        scenery.alone(a);
        for b in &runs[i + 1..] {
            scenery.pair(a, b);
            if !a.is_of_library() && !b.is_of_library() {
                scenery.extremes(a, b);
            }
        }
    }
    let found = scenery
        .wrong
        .iter()
        .map(|wrong| format!("{wrong}\n{}", scenery.text));
    (found.collect(), scenery.pairs)
}

/// Returns random scenes, each with a number that selects a time inside the run.
fn scenes(seed: u64, count: usize) -> Vec<(String, f64)> {
    let mut runner = TestRunner::new(ProptestConfig {
        rng_seed: crate::support::seed::seed(seed),
        ..ProptestConfig::default()
    });
    let numbers = prop::collection::vec(0.0..1.0f64, DRAWS);
    (0..count)
        .map(|_| {
            let numbers = numbers.new_tree(&mut runner).unwrap().current();
            let draw = numbers[0];
            (Draws::new(numbers).scene(), draw)
        })
        .collect()
}

#[test]
fn engines_agree_to_what_they_state() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_tables(folder.path());
    let scenes = scenes(11, SCENES);
    let threads = thread::available_parallelism().map_or(2, usize::from);
    let every = |k: usize| {
        let mine = scenes.iter().skip(k).step_by(threads);
        let judged = mine.map(|(text, draw)| judge(folder.path(), text, *draw));
        judged.collect::<Vec<_>>()
    };
    let judged: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|k| scope.spawn(move || every(k)))
            .collect();
        let results = workers.into_iter().map(|worker| worker.join().unwrap());
        results.flatten().collect()
    });
    let pairs: usize = judged.iter().map(|(_, pairs)| pairs).sum();
    let wrong: Vec<&String> = judged.iter().flat_map(|(wrong, _)| wrong).collect();
    assert!(wrong.is_empty(), "{} of {pairs}: {}", wrong.len(), wrong[0]);
    assert!(pairs > 4 * SCENES, "{pairs} pairs");
}

fn parsed(folder: &Path, text: &str) -> Scene {
    Scene::parse(&folder.join("scene.toml"), text).unwrap_or_else(|why| panic!("{why}"))
}

fn finished(scene: &Scene, method: Method) -> Simulation {
    let options = Options {
        method,
        ..Options::default()
    };
    let run = simulate(scene, &options).unwrap();
    assert_eq!(run.summary.stopped, None);
    run
}

/// Four-stroke cycle: the start angle determines in which of the two turns the crank is.
#[test]
fn a_cycle_of_two_turns_begins_in_the_turn_of_the_start() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write_tables(folder.path());
    let scene = |angle: f64, turns: f64| {
        let text = format!(
            "[geometry]\ncrank = \"47 mm\"\nrod = \"156 mm\"\n[crank]\ninertia = \"0.05 kg m^2\"\n\
             [slider]\nmass = \"0.5 kg\"\n\
             [[force]]\nkind = \"gas\"\nfile = \"cycle.csv\"\nbore = \"20 mm\"\nperiod = \"720 deg\"\n\
             [motion]\nangle = \"{angle} deg\"\nspeed = \"100 rad/s\"\n[run]\nrevolutions = {turns}\ntolerance = 1e-9"
        );
        parsed(folder.path(), &text)
    };
    // The last case has so many turns that the Poincare map takes over.
    for (angle, turns) in [(-330.0, 3.0), (30.0, 3.0), (390.0, 3.0), (-330.0, 300.0)] {
        let scene = scene(angle, turns);
        let [a, b] = [Method::Energy, Method::Time].map(|method| finished(&scene, method));
        let (ours, theirs) = (a.summary.last, b.summary.last);
        let allowed = STATED * (stated(&a)[1] + stated(&b)[1]);
        let late = (ours.t_s - theirs.t_s).abs() * ours.omega_rad_per_s;
        assert!(
            late <= STATED * (stated(&a)[0] + stated(&b)[0]) + 1e-7,
            "{angle} {turns}: {late}"
        );
        let apart = (ours.omega_rad_per_s - theirs.omega_rad_per_s).abs();
        assert!(apart <= allowed, "{angle} {turns}: {ours:?} {theirs:?}");
    }
    // The cycle repeats after two turns, not after one.
    let [a, b, c] = [-330.0, 390.0, 30.0].map(|angle| finished(&scene(angle, 3.0), Method::Energy));
    let t = [a, b, c].map(|run| run.summary.last.t_s);
    assert!(
        (t[0] - t[1]).abs() < 1e-12 && (t[0] - t[2]).abs() > 1e-6,
        "{t:?}"
    );
}

/// Heavy crank that swings about its lowest position, which is also a dead centre.
#[test]
fn a_swing_from_a_dead_centre_passes_it_again_and_again() {
    let text = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n\
        [crank]\nmass = \"1 kg\"\ncg = \"20 mm\"\ninertia = \"1e-3 kg m^2\"\n\
        [gravity]\nacceleration = \"9.80665 m/s^2\"\ndirection = \"0 deg\"\n\
        [motion]\nangle = \"0 deg\"\nspeed = \"5 rad/s\"\n[run]\nduration = \"2.05 s\"";
    let scene = parsed(Path::new(""), text);
    for method in [Method::Energy, Method::Time, Method::Dop853] {
        let run = finished(&scene, method);
        let events = &run.summary.events;
        // Turning points and dead centres alternate.
        assert!(events.len() > 8, "{method}: {events:?}");
        for (i, event) in events.iter().enumerate() {
            let kind = ["turning-point", "dead-centre"][i % 2];
            assert_eq!(event.kind, kind, "{method}: {event:?}");
        }
        for pair in events.windows(2) {
            let quarter = events[0].t_s;
            assert!(
                (pair[1].t_s - pair[0].t_s - quarter).abs() < 1e-8,
                "{method}: {pair:?}"
            );
        }
    }
}

/// The downward speed reaches 5 rad/s only after a whole swing.
#[test]
fn extreme_speeds_are_those_of_the_run_not_of_the_period() {
    let text = "[geometry]\ncrank = \"50 mm\"\nrod = \"150 mm\"\n\
        [crank]\nmass = \"1 kg\"\ncg = \"20 mm\"\ninertia = \"1e-3 kg m^2\"\n\
        [gravity]\nacceleration = \"9.80665 m/s^2\"\ndirection = \"0 deg\"\n\
        [motion]\nangle = \"0 deg\"\nspeed = \"5 rad/s\"";
    let scene = parsed(Path::new(""), text);
    let period = 4.0 * finished(&until(&scene, 0.5), Method::Energy).summary.events[0].t_s;
    for part in [0.1, 0.3, 0.45, 0.6, 0.8, 0.95, 1.3] {
        let scene = until(&scene, part * period);
        for method in [Method::Energy, Method::Time, Method::Dop853] {
            let run = finished(&scene, method);
            let speed = |k: i32| run.at(part * period * (f64::from(k) / 2000.0)).unwrap().1;
            let sampled = (0..=2000).map(speed);
            let (low, high) = sampled.fold((5.0f64, 5.0f64), |(low, high), speed| {
                (low.min(speed), high.max(speed))
            });
            let (least, largest) = (run.summary.omega_min, run.summary.omega_max);
            // Samples miss an extreme by at most half their spacing.
            let near = (least - low).abs() < 1e-4 && (largest - high).abs() < 1e-4;
            assert!(
                near,
                "{method} {part}: {least} to {largest}, sampled {low} to {high}"
            );
        }
    }
}
