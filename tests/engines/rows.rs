//! Rows of a run: first and last state, and no time twice.

use slider_crank::plan::Method;
use slider_crank::scene::{Crank, Load, Scene, Slider};
use slider_crank::simulate::{Options, Row, simulate, simulate_rows};

const SLIDER: &str = "[slider]\nmass = \"600 g\"\n";
const FRICTION: &str = "[friction]\ncoefficient = 0.1\n";
const PUSHED: &str = "[[torque]]\nkind = \"expression\"\nvalue = \"1e-3*sin(t) - 1e-4*omega\"\n";
const LOOSE: &str = r#"
[rod]
mass = "300 g"
cg = "60 mm"
inertia = "1e-3 kg m^2"
[clearance]
joint = "crank-pin"
radial = "0.1 mm"
bearing_radius = "10 mm"
young_modulus = "200 GPa"
poisson_ratio = 0.3
restitution = 0.8
"#;

/// Machine with a crank of constant inertia and these parts.
fn scene(rod: &str, parts: &str, motion: &str, run: &str) -> Scene {
    let text = format!(
        "[geometry]\ncrank = \"50 mm\"\nrod = \"{rod}\"\n[crank]\ninertia = \"0.02 kg m^2\"\n{parts}\n\
         [motion]\nangle = \"10 deg\"\n{motion}\n[run]\n{run}\n"
    );
    Scene::parse("scene.toml".as_ref(), &text).unwrap()
}

const SPEED: &str = "speed = \"600 rpm\"";

/// Returns the times of the rows and of the end; none if the method does not apply, or the run ends between rows.
fn times(scene: &Scene, method: Method) -> Option<(Vec<f64>, f64)> {
    let options = Options {
        method,
        estimate: false,
        ..Options::default()
    };
    let mut rows: Vec<Row> = Vec::new();
    let run = simulate_rows(scene, &options, &mut rows).ok()?;
    let summary = run.summary;
    let at_limit = summary.stopped.is_some() && summary.engine == "closed-form";
    let times = rows.iter().map(|row| row.t).collect();
    (!at_limit).then_some((times, summary.last.t_s))
}

#[test]
fn no_time_is_written_twice() {
    let parts = [
        "",
        SLIDER,
        &[SLIDER, FRICTION].concat(),
        &[SLIDER, PUSHED].concat(),
        &[SLIDER, PUSHED, FRICTION].concat(),
        &[SLIDER, LOOSE].concat(),
    ];
    let motions = [
        SPEED,
        "speed = \"-600 rpm\"",
        "kind = \"constant-speed\"\nspeed = \"600 rpm\"",
    ];
    // The ends fall on rows up to rounding.
    let runs = [
        "duration = 0",
        "revolutions = 0",
        "revolutions = 1",
        "duration = \"0.1 s\"",
    ];
    let methods = [Method::Auto, Method::Angle, Method::Time, Method::Dop853];
    let mut looked_at = 0;
    for rod in ["150 mm", "40 mm"] {
        for (parts, motion, run) in each(&parts, &motions, &runs) {
            for every in ["36 deg", "10 ms"] {
                let run = format!("{run}\noutput_every = \"{every}\"");
                let scene = scene(rod, parts, motion, &run);
                for method in methods {
                    let Some((times, end)) = times(&scene, method) else {
                        continue;
                    };
                    let what = format!("{rod} {parts} {motion} {run} {method}: {times:?}");
                    assert_eq!(times.first(), Some(&0.0), "{what}");
                    assert_eq!(times.last(), Some(&end), "{what}");
                    let apart = |w: &[f64]| w[1] - w[0] > 1e-9 * end;
                    assert!(times.windows(2).all(apart), "{what}");
                    looked_at += 1;
                }
            }
        }
    }
    assert!(looked_at > 200, "{looked_at}");
}

fn each<'a>(
    parts: &'a [&'a str],
    motions: &'a [&'a str],
    runs: &'a [&'a str],
) -> impl Iterator<Item = (&'a str, &'a str, &'a str)> {
    let pairs = parts
        .iter()
        .flat_map(|part| motions.iter().map(move |motion| (part, motion)));
    pairs.flat_map(|(part, motion)| runs.iter().map(move |run| (*part, *motion, *run)))
}

/// The last whole step of the rows coincides with the end in one row; a step slightly before the end does not.
#[test]
fn an_end_beside_a_row_is_a_row_of_its_own() {
    for (turns, rows) in [(1.0, 11), (1.0 + 1e-6, 12), (1.0 - 1e-6, 11)] {
        for every in ["36 deg", "10 ms"] {
            let run = format!("revolutions = {turns}\noutput_every = \"{every}\"");
            let scene = scene("150 mm", "", SPEED, &run);
            for method in [Method::Auto, Method::Time] {
                let (times, _) = times(&scene, method).unwrap();
                assert_eq!(times.len(), rows, "{turns} {every} {method}: {times:?}");
            }
        }
    }
}

/// Rows over time would continue to the largest representable time.
#[test]
fn turns_of_a_crank_that_stays_at_rest_are_refused() {
    for rod in ["150 mm", "40 mm"] {
        let run = "revolutions = 0.01\noutput_every = \"1 ms\"";
        let scene = scene(rod, SLIDER, "speed = 0", run);
        let mut rows: Vec<Row> = Vec::new();
        let error = simulate_rows(&scene, &Options::default(), &mut rows).unwrap_err();
        let words = error.to_string();
        assert!(words.contains("a crank at rest never completes"), "{words}");
        assert!(rows.is_empty());
    }
}

/// Every engine: loads over theta, a motor, friction with stick, constant speed, a rocker past its limits.
#[test]
fn a_row_asked_for_afterwards_is_the_row_that_was_written() {
    let load = |name: &str| Scene::load(format!("data/{name}.toml")).expect("a scene");
    let rocker = Scene::new(0.2, 0.1)
        .offset(0.02)
        .crank(Crank {
            inertia: 0.02,
            ..Crank::default()
        })
        .slider(Slider { mass: 0.5 })
        .torque(Load::Constant(-2.0))
        .start(0.2, 3.0)
        .duration(1.0);
    let names = [
        "duarte-engine",
        "spring-press",
        "motor-and-losses",
        "brake",
        "gupta",
    ];
    for (name, scene) in names
        .map(|name| (name, load(name)))
        .into_iter()
        .chain([("rocker", rocker)])
    {
        let options = Options {
            reactions: true,
            ..Options::default()
        };
        let mut rows: Vec<Row> = Vec::new();
        simulate_rows(&scene, &options, &mut rows).expect("a run");
        let run = simulate(&scene, &options).expect("a run");
        let numbers = |row: &Row| {
            let forces = row.reactions.expect("asked for");
            let [x, y] = forces.wrist_pin;
            [
                row.theta,
                row.omega,
                row.alpha,
                row.x,
                row.v,
                row.a,
                x,
                y,
                forces.guide,
            ]
        };
        let largest = rows.iter().map(numbers).fold([0f64; 9], |most, row| {
            std::array::from_fn(|k| most[k].max(row[k].abs()))
        });
        let (mut compared, mut apart) = (0, 0);
        for row in &rows {
            let Some(again) = run.row(row.t) else {
                continue;
            };
            let (said, now) = (numbers(row), numbers(&again));
            let close = |k: usize| (said[k] - now[k]).abs() <= 1e-9 * largest[k];
            compared += 1;
            apart += usize::from(!(0..9).all(close));
        }
        assert!(
            compared + 2 >= rows.len(),
            "{name}: {compared} of {}",
            rows.len()
        );
        // Where friction jumps, a row at that exact time may be from either side.
        assert!(apart <= 2, "{name}: {apart} of {compared}");
    }
    let outside = simulate(&load("gupta"), &Options::default()).expect("a run");
    assert!(outside.row(-1.0).is_none() && outside.row(1e9).is_none());
}
