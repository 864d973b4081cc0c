//! Loads that repeat after several turns, after parts of a turn, or never: compared with formulas, and with a piecewise
//! integration written out here.

use std::f64::consts::{PI, TAU};
use std::path::Path;

use slider_crank::plan::{Cycle, Method};
use slider_crank::scene::{
    Crank, Expression, Friction, Gravity, Interpolation, Load, Period, Scene, Slider, Table,
    Variable, Variables,
};
use slider_crank::simulate::{Options, SteadyState, Summary, simulate, steady_state};

const INERTIA: f64 = 0.02;

/// Returns a crank that carries all the inertia.
fn crank() -> Scene {
    Scene::new(0.05, 0.15).crank(Crank {
        inertia: INERTIA,
        ..Crank::default()
    })
}

fn formula(text: &str) -> Load {
    Load::Expression(Expression::parse(text).expect("a formula"))
}

/// Returns a periodic piecewise linear load over angles in degrees.
fn lines(rows: &[(f64, f64)], period: f64) -> Load {
    let angles: Vec<f64> = rows.iter().map(|row| row.0.to_radians()).collect();
    let values: Vec<f64> = rows.iter().map(|row| row.1).collect();
    let period = Some(period.to_radians());
    let linear = Interpolation::Linear;
    Load::Table(Table::new(Variable::Theta, &angles, &values, linear, period).expect("a table"))
}

/// Pulse of three degrees in the first of two turns; its peak is twice its mean.
const PULSE: [(f64, f64); 4] = [(0.0, 0.0), (21.7, 0.0), (23.2, 200.0), (24.7, 0.0)];

fn pulsed() -> Load {
    lines(&PULSE, 720.0)
}

fn run(scene: &Scene, method: Method) -> Summary {
    let options = Options {
        method,
        ..Options::default()
    };
    let run = simulate(scene, &options).unwrap().summary;
    assert_eq!(run.stopped, None, "{method}");
    run
}

/// Integration of I ω dω/dθ = T(θ) − c ω over a cycle of `turns` turns by the Runge-Kutta method between the angles of
/// `cuts` (rad), where T has corners. Gives the final speed, the least and largest speed, and the time.
struct Pieces<'a> {
    torque: &'a dyn Fn(f64) -> f64,
    cuts: Vec<f64>,
    turns: f64,
    c: f64,
}

impl Pieces<'_> {
    fn cycle(&self, speed: f64) -> [f64; 4] {
        const STEPS: u32 = 400;
        let (mut w, mut time, mut low, mut high) = (speed, 0.0, speed, speed);
        let mut ends = self.cuts.clone();
        ends.extend([0.0, self.turns * TAU]);
        ends.sort_by(f64::total_cmp);
        for ends in ends.windows(2) {
            let h = (ends[1] - ends[0]) / f64::from(STEPS);
            // Evaluate inside the piece also at its ends.
            let inside = |at: f64| at.clamp(ends[0] + 1e-13, ends[1] - 1e-13);
            let slope = |at: f64, w: f64| ((self.torque)(inside(at)) - self.c * w) / (INERTIA * w);
            for i in 0..STEPS {
                let at = ends[0] + f64::from(i) * h;
                let k1 = slope(at, w);
                let k2 = slope(at + 0.5 * h, w + 0.5 * h * k1);
                let k3 = slope(at + 0.5 * h, w + 0.5 * h * k2);
                let k4 = slope(at + h, w + h * k3);
                let next = w + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
                let middle = w + h / 24.0 * (5.0 * k1 + 4.0 * k2 + 4.0 * k3 - k4);
                time += h / 6.0 * (1.0 / w + 4.0 / middle + 1.0 / next);
                // The speed has an extreme inside the step: take the vertex of the parabola through its slopes.
                if k1 * k4 < 0.0 {
                    let top = w - 0.5 * h * k1 * k1 / (k4 - k1);
                    (low, high) = (low.min(top), high.max(top));
                }
                w = next;
                (low, high) = (low.min(w), high.max(w));
            }
        }
        [w, low, high, time]
    }

    /// Returns the result of the last of this many cycles.
    fn after(&self, cycles: u32, speed: f64) -> [f64; 4] {
        (1..cycles).fold(self.cycle(speed), |last, _| self.cycle(last[0]))
    }
}

fn pulse(at: f64) -> f64 {
    200.0 * (1.0 - ((at.to_degrees() - 23.2) / 1.5).abs()).max(0.0)
}

fn pulse_cuts() -> Vec<f64> {
    [21.7f64, 23.2, 24.7, 360.0].map(f64::to_radians).to_vec()
}

/// Each pulse does ½ 200 N m · 3 deg of work, once every two turns.
#[test]
fn a_pulse_in_every_second_turn_drives_every_second_turn() {
    for turns in [10.0, 11.0, 400.0] {
        let scene = crank()
            .torque(pulsed())
            .start(0.0, 100.0)
            .revolutions(turns);
        let work = (0.5f64 * turns).ceil() * 0.5 * 200.0 * 3f64.to_radians();
        let expected = (1e4 + 2.0 * work / INERTIA).sqrt();
        for method in [Method::Auto, Method::Energy, Method::Angle] {
            let found = run(&scene, method);
            let stated = found.error_estimate.unwrap().omega_rad_per_s;
            let off = (found.last.omega_rad_per_s - expected).abs();
            assert!(
                off <= 2.0 * stated + 1e-13 * expected,
                "{method}: {off:e} {stated:e}"
            );
            assert!(stated < 1e-9 * expected, "{method}: {stated:e}");
        }
    }
}

#[test]
fn many_cycles_follow_from_the_map_of_a_cycle() {
    let torque = |at: f64| pulse(at);
    let pieces = Pieces {
        torque: &torque,
        cuts: pulse_cuts(),
        turns: 2.0,
        c: 0.01,
    };
    let scene = |turns: f64| {
        let loaded = crank().torque(pulsed()).torque(Load::Viscous(0.01));
        loaded.start(0.0, 100.0).revolutions(turns)
    };
    for cycles in [5, 60, 400] {
        let expected = pieces.after(cycles, 100.0)[0];
        let found = run(&scene(2.0 * f64::from(cycles)), Method::Auto);
        assert_eq!(found.engine, "angle");
        let stated = found.error_estimate.unwrap().omega_rad_per_s;
        let off = (found.last.omega_rad_per_s - expected).abs();
        assert!(off <= 2.0 * stated + 1e-10, "{cycles}: {off:e} {stated:e}");
        assert!(stated < 1e-8, "{stated:e}");
    }
    // An odd number of turns in either direction and from the second turn, and half a turn more.
    for (angle, speed) in [(0.0, 100.0), (TAU + 0.3, 100.0), (0.3, -100.0)] {
        let scene = scene(61.5).start(angle, speed).tolerance(1e-12);
        let [a, b] = [Method::Angle, Method::Time].map(|method| run(&scene, method));
        let [a, b] = [a, b].map(|run| (run.last, run.error_estimate.unwrap().omega_rad_per_s));
        let off = (a.0.omega_rad_per_s - b.0.omega_rad_per_s).abs();
        assert!(
            off <= 2.0 * a.1 + 2.0 * b.1,
            "{angle} {speed}: {off:e} {} {}",
            a.1,
            b.1
        );
        assert!(a.1 + b.1 < 1e-6, "{} {}", a.1, b.1);
    }
}

fn turns_of(scene: &Scene) -> Option<u32> {
    Cycle::of(scene).turns
}

#[test]
fn the_cycle_is_the_least_common_multiple_of_the_periods() {
    let wave = |text: &str| crank().torque(formula(text));
    assert_eq!(turns_of(&crank()), Some(1));
    assert_eq!(turns_of(&wave("sin(2*theta)")), Some(1));
    assert_eq!(turns_of(&wave("sin(2/3*theta)")), Some(3));
    let both = wave("sin(2/3*theta)").force(lines(&PULSE, 720.0));
    assert_eq!(turns_of(&both), Some(6));
    for (text, why) in [
        ("exp(-((theta-20.4)/0.035)^2)", "outside of sin"),
        ("sin(1.5*t)", "depends on the time t"),
        ("cos(sqrt(2)*theta)", "no fraction of a turn"),
        ("cos(theta/121)", "after 121 turns"),
    ] {
        let cycle = Cycle::of(&wave(text));
        assert_eq!(cycle.turns, None, "{text}");
        assert!(cycle.why_not.unwrap().contains(why), "{text}");
    }
    let sine = |now: &slider_crank::scene::Instant| (0.5 * now.theta).sin();
    let silent = Load::function(Variables::THETA, sine);
    assert_eq!(turns_of(&crank().torque(silent.clone())), None);
    let stated = silent.with_period(Period::turns(2).unwrap());
    assert_eq!(turns_of(&crank().torque(stated)), Some(2));
}

/// Single blows: 90 angles in four turns need not hit them.
#[test]
fn a_blow_in_one_turn_is_not_repeated_in_all() {
    let gauss = "-30*exp(-((theta-20.4)/0.35)^2)";
    let scene = crank().torque(formula(gauss)).torque(Load::Viscous(1e-4));
    let scene = scene.start(PI, 100.0).revolutions(6.0);
    let auto = run(&scene, Method::Auto);
    assert_eq!(auto.engine, "time");
    assert!(
        auto.plan.reason.contains("outside of sin"),
        "{}",
        auto.plan.reason
    );
    let options = Options {
        method: Method::Angle,
        ..Options::default()
    };
    let refused = simulate(&scene, &options).unwrap_err().to_string();
    assert!(refused.contains("theta stands outside of sin"), "{refused}");
}

fn steady(scene: &Scene) -> SteadyState {
    steady_state(scene, None, &Options::default()).unwrap()
}

/// Compares a steady state with the speed, least and largest speed and time of the last cycle of a motion.
fn compare(found: &SteadyState, [_, low, high, time]: [f64; 4], beside: f64) {
    let mean = f64::from(found.cycle_turns) * TAU / time;
    for (name, estimated, expected) in [
        ("slowest", found.slowest.omega_rad_per_s, low),
        ("fastest", found.fastest.omega_rad_per_s, high),
        ("mean", found.omega_mean_rad_per_s, mean),
        ("fluctuation", found.fluctuation, (high - low) / mean),
    ] {
        let off = (estimated.value - expected).abs();
        assert!(
            off <= 2.0 * estimated.error + beside * expected,
            "{name}: {off:e} {estimated:?} {expected}"
        );
        assert!(
            estimated.error <= 1e-6 * estimated.value,
            "{name}: {estimated:?}"
        );
    }
}

#[test]
fn a_steady_state_of_two_turns() {
    let c = 0.01;
    let torque = |at: f64| pulse(at) + 0.05;
    let pieces = Pieces {
        torque: &torque,
        cuts: pulse_cuts(),
        turns: 2.0,
        c,
    };
    let scene = crank()
        .torque(pulsed())
        .torque(Load::Constant(0.05))
        .torque(Load::Viscous(c));
    let found = steady(&scene.start(0.0, 60.0));
    assert_eq!(found.cycle_turns, 2);
    compare(&found, pieces.after(300, 60.0), 1e-10);
    // The speed has its maximum nearly where the pulse ends, and its minimum where the pulse begins.
    let [fast, slow] =
        [found.fastest, found.slowest].map(|e| e.theta_rad.unwrap().value.to_degrees());
    assert!(
        (24.0..24.7).contains(&fast) && (21.7..22.0).contains(&slow),
        "{fast} {slow}"
    );
    assert!((found.power_in_w.value - found.power_out_w.value).abs() < 1e-8);
}

/// Torque with jumps: 5 N m while sin θ > ½, else −1.5 N m.
#[test]
fn a_steady_state_under_a_torque_that_jumps() {
    let c = 0.02;
    let torque = |at: f64| if at.sin() > 0.5 { 5.0 } else { -1.5 };
    let pieces = Pieces {
        torque: &torque,
        cuts: vec![PI / 6.0, 5.0 * PI / 6.0],
        turns: 1.0,
        c,
    };
    let load = formula("6.5*step(sin(theta) - 0.5) - 1.5");
    let scene = crank()
        .torque(load)
        .torque(Load::Viscous(c))
        .start(0.0, 50.0);
    let found = steady(&scene);
    compare(&found, pieces.after(400, 50.0), 1e-10);
}

/// Returns the limit of a long motion, over its last turn.
fn in_the_end(scene: &Scene, turns: f64) -> [f64; 4] {
    let long = simulate(&scene.clone().revolutions(turns), &Options::default()).unwrap();
    let speed = long.summary.last.omega_rad_per_s;
    let last = scene
        .clone()
        .start(scene.motion.angle, speed)
        .revolutions(1.0);
    let last = run(&last, Method::Time);
    [speed, last.omega_min, last.omega_max, last.last.t_s]
}

#[test]
fn steady_states_with_friction_at_the_guide_and_tables_over_x() {
    let press = |scene: Scene| {
        let loaded = scene
            .slider(Slider { mass: 0.8 })
            .gravity(Gravity::standard());
        loaded
            .torque(Load::Constant(6.0))
            .torque(Load::Viscous(0.15))
            .start(0.4, 30.0)
    };
    let mut rubbing = press(crank()).force(Load::Spring {
        stiffness: 800.0,
        rest: 0.12,
    });
    rubbing.friction = Some(Friction {
        coefficient: 0.1,
        static_coefficient: 0.1,
    });
    let found = steady(&rubbing);
    compare(&found, in_the_end(&rubbing, 300.0), 1e-8);
    let friction = found.loads.last().unwrap();
    assert!(friction.name.contains("friction") && friction.power_w.value < 0.0);
    let sum: f64 = found.loads.iter().map(|load| load.power_w.value).sum();
    assert!(sum.abs() < 1e-7 * found.power_in_w.value, "{sum:e}");

    let rows = [0.05, 0.11, 0.14, 0.16, 0.25];
    let forces = [0.0, 0.0, -60.0, -150.0, -150.0];
    let linear = Interpolation::Linear;
    let table = Table::new(Variable::X, &rows, &forces, linear, None).expect("a table");
    let pressing = press(crank()).force(Load::Table(table));
    let found = steady(&pressing);
    compare(&found, in_the_end(&pressing, 300.0), 1e-8);
}

/// Example of a four-stroke engine, with the flywheel for two per cent.
#[test]
fn a_flywheel_for_a_four_stroke_engine() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/four-stroke.toml");
    let scene = Scene::load(&path).unwrap();
    let found = steady_state(&scene, Some(0.02), &Options::default()).unwrap();
    assert_eq!(found.cycle_turns, 2);
    // Reference: DOP853 of SciPy between the rows of the table, with the speeds at 200 angles of each piece.
    for (estimated, expected) in [
        (found.omega_rad_per_s, 166.21350245954),
        (found.omega_mean_rad_per_s, 157.57188039473),
        (found.slowest.omega_rad_per_s, 142.893534075),
        (found.fastest.omega_rad_per_s, 166.746543486),
        (found.fluctuation, 0.1513785921),
    ] {
        assert!(
            (estimated.value / expected - 1.0).abs() < 1e-9,
            "{estimated:?} {expected}"
        );
    }
    let wheel = found.flywheel.unwrap();
    let mut heavy = scene.clone();
    heavy.crank.as_mut().unwrap().inertia += wheel.added_inertia_kg_m2.value;
    let heavy = steady(&heavy).start(&heavy);
    for method in [Method::Angle, Method::Time] {
        let run = run(&heavy.clone().revolutions(2.0), method);
        let mean = 2.0 * TAU / run.last.t_s;
        let fluctuation = (run.omega_max - run.omega_min) / mean;
        assert!((fluctuation - 0.02).abs() < 5e-7, "{method}: {fluctuation}");
        let closed = (run.last.omega_rad_per_s / heavy.motion.speed - 1.0).abs();
        assert!(closed < 1e-6, "{method}: {closed:e}");
    }
}
