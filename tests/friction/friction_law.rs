//! Equation on the configuration curve and the friction law, compared with the Newton-Euler equations of the single
//! bodies.

use crate::support::random::{Case, any_class, case, cases, magnitude, rotating_crank};
use crate::support::run::Run;
use crate::support::{close, condition};
use proptest::prelude::*;
use slider_crank::mechanism::{
    Curve, CurveEquation, Equation, Free, FromRest, Instants, Linkage, Sense,
};
use slider_crank::numeric::angle::Angle;
use slider_crank::scene::{Friction, Scene};

/// Case on its curve: equation, coordinate, speed along the curve, θ' and θ''.
struct OnCurve {
    equation: CurveEquation,
    q: Angle,
    speed: f64,
    dtheta: f64,
    d2theta: f64,
}

fn on_curve(case: &Case, omega: f64) -> OnCurve {
    let linkage = Linkage::new(&case.scene.geometry);
    let (curve, q) = Curve::through(&linkage, Angle::from(case.theta)).expect("a position");
    let place = curve.pose(q.rest);
    OnCurve {
        equation: CurveEquation::new(&case.scene, curve),
        q,
        speed: omega / place.dtheta,
        dtheta: place.dtheta,
        d2theta: place.d2theta,
    }
}

impl OnCurve {
    fn crank_acceleration(&self, acceleration: f64) -> f64 {
        self.dtheta * acceleration + self.d2theta * self.speed * self.speed
    }
}

impl OnCurve {
    /// Returns θ̈ and the power of a motion that slides, from instants that are evaluated together.
    fn among_others(&self, case: &Case, c: f64) -> [f64; 2] {
        let apart = [-0.3, 0.0, 0.2, 0.4, 0.7];
        let t = apart.map(|apart| case.t + apart);
        let at = Instants {
            t: &t,
            of_time: &self.equation.loads().of_times(&t),
            turns: self.q.turns,
            theta: &apart.map(|apart| self.q.rest + apart),
            omega: &apart.map(|apart| self.speed * (1.0 + apart)),
        };
        let (mut alpha, mut power) = ([0.0; 5], [0.0; 5]);
        let way = (c, Sense::default());
        self.equation
            .accelerations(&at, way, &mut alpha, &mut power);
        [alpha[1], power[1]]
    }
}

/// Returns θ̈ and N from the Newton-Euler equations with this friction force.
fn newton(run: &Run<'_>, omega: f64, friction: f64) -> (f64, f64) {
    let (alpha, reactions) = run.parts.solve(omega, run.torque, run.force + friction);
    (alpha, reactions.guide)
}

fn check_forces(case: &Case, mu: f64, tolerance: f64) {
    let run = Run::new(case);
    let on = on_curve(case, case.omega);
    let free = on.equation.free(case.t, on.q, on.speed);
    let (alpha, normal) = newton(&run, case.omega, 0.0);
    let size = run.joint_size(alpha);
    let size_alpha = run.size(alpha) / run.expected_terms()[0];
    close(
        "theta",
        on.equation.curve().crank_angle(on.q).radians(),
        case.theta,
        1.0,
        tolerance,
    );
    close(
        "acceleration",
        on.crank_acceleration(free.acceleration),
        alpha,
        size_alpha,
        tolerance,
    );
    close("normal force", free.normal, normal, size, tolerance);
    // The equations are linear in the friction force.
    let unit = size.max(1.0);
    let (with, pressed) = newton(&run, case.omega, unit);
    let large = size + run.joint_size(with);
    close(
        "kappa",
        free.kappa * unit,
        pressed - normal,
        large,
        tolerance,
    );
    let large_alpha = size_alpha + run.size(with) / run.expected_terms()[0];
    close(
        "gain",
        on.dtheta * free.gain * unit,
        with - alpha,
        large_alpha,
        tolerance,
    );
    if mu * free.kappa.abs() < 0.9 {
        let sgn_v = (run.dx * case.omega).signum();
        let (acceleration, touch) = free.sliding(free.opposing(mu, sgn_v));
        let (alpha, normal) = newton(&run, case.omega, touch.friction);
        let size = 10.0 * (size + run.joint_size(alpha));
        close(
            "normal force with friction",
            touch.normal,
            normal,
            size,
            tolerance,
        );
        let size_alpha = 10.0 * (size_alpha + run.size(alpha) / run.expected_terms()[0]);
        if on.equation.curve().is_crank_angle() {
            let [together, power] = on.among_others(case, free.opposing(mu, sgn_v));
            close(
                "sliding, with others",
                together,
                alpha,
                size_alpha,
                tolerance,
            );
            let one = free.power + touch.friction * free.dx * on.speed;
            let size_power = (size * free.dx * on.speed).abs() + free.power.abs();
            close("power, with others", power, one, size_power, tolerance);
        }
        close(
            "sliding",
            on.crank_acceleration(acceleration),
            alpha,
            size_alpha,
            tolerance,
        );
        assert!(touch.friction * sgn_v <= 0.0, "friction opposes sliding");
        close(
            "Coulomb",
            touch.friction.abs(),
            mu * touch.normal.abs(),
            touch.normal.abs(),
            1e-15,
        );
    }
}

/// Returns the signs of N for which sliding in direction `sgn_v` satisfies its equations.
fn solutions(free: &Free, mu: f64, sgn_v: f64) -> usize {
    let consistent = |sgn_n: f64| free.sliding(-mu * sgn_v * sgn_n).1.normal * sgn_n > 0.0;
    [1.0, -1.0]
        .into_iter()
        .filter(|sgn_n| consistent(*sgn_n))
        .count()
}

proptest! {
    #![proptest_config(cases(10_000))]

    #[test]
    fn forces_and_acceleration_are_those_of_newton_and_euler(
        case in case(rotating_crank(0.05)), mu in 0.0..1.0,
    ) {
        check_forces(&case, mu, 1e-13);
    }

    #[test]
    fn on_rockers_too(case in case(any_class()), mu in 0.0..1.0) {
        let g = &case.scene.geometry;
        prop_assume!((g.offset + g.crank * case.theta.sin()).abs() < 0.999 * g.rod);
        check_forces(&case, mu, 1e-12 * condition(g, case.theta));
    }

    #[test]
    fn one_and_only_one_way_to_slide_unless_jammed(
        case in case(rotating_crank(0.01)), mu in magnitude(0.01, 100.0),
    ) {
        let on = on_curve(&case, case.omega);
        let free = on.equation.free(case.t, on.q, on.speed);
        prop_assume!(free.clear_of_jam(mu).abs() > 1e-9);
        for sgn_v in [1.0, -1.0] {
            let found = solutions(&free, mu, sgn_v);
            if free.clear_of_jam(mu) > 0.0 {
                prop_assert_eq!(found, 1);
            } else {
                let none = free.jam(mu, sgn_v) == slider_crank::mechanism::Jam::NoSolution;
                prop_assert_eq!(found, if none { 0 } else { 2 });
            }
        }
    }

    #[test]
    fn from_rest_it_holds_or_moves_one_way(
        case in case(rotating_crank(0.05)), mu in magnitude(0.01, 3.0), more in 1.0..2.0,
    ) {
        let case = Case { omega: 0.0, ..case };
        let run = Run::new(&case);
        let on = on_curve(&case, 0.0);
        let free = on.equation.free(case.t, on.q, 0.0);
        let held = free.holding().expect("not at a dead centre");
        let (alpha, normal) = newton(&run, 0.0, held.friction);
        let size = run.joint_size(0.0) * (1.0 + held.friction.abs() / run.force_size.max(1.0));
        close("held at rest", alpha, 0.0, run.size(0.0) / run.expected_terms()[0] + free.gain.abs() * size, 1e-12);
        close("normal force at rest", held.normal, normal, size, 1e-12);
        let needs_less = |mu: f64| held.friction.abs() <= mu * normal.abs();
        match free.from_rest(mu, more * mu) {
            FromRest::Hold(touch) => {
                prop_assert_eq!(touch, held);
                prop_assert!(needs_less(more * mu * (1.0 + 1e-9)));
            }
            FromRest::Move(direction) => {
                prop_assert!(!needs_less(more * mu * (1.0 - 1e-9)));
                for way in [1.0, -1.0] {
                    let sgn_v = way * run.dx.signum();
                    let acceleration = free.sliding(free.opposing(mu, sgn_v)).0;
                    // Between the kinetic and the static band both are possible; motion starts only beyond the static
                    // one.
                    prop_assert_eq!(acceleration * way > 0.0, way == direction, "{} {}", way, acceleration);
                }
            }
            FromRest::Jam => prop_assert!(free.clear_of_jam(mu) <= 0.0),
        }
    }

    #[test]
    fn a_driven_crank_feels_what_newton_and_euler_say(
        case in case(rotating_crank(0.05)), mu in 0.0..1.0, alpha in -100.0..100.0,
    ) {
        let scene = Scene {
            friction: Some(Friction { coefficient: mu, static_coefficient: mu }),
            ..case.scene.clone()
        };
        let linkage = Linkage::new(&scene.geometry);
        let equation = CurveEquation::new(&scene, Curve::on_crank(&linkage));
        let run = Run::new(&case);
        let slope = run.parts.exact.sin_phi.value() / run.parts.exact.cos_phi.value();
        let touch = equation.driven(case.t, Angle::from(case.theta), case.omega, alpha);
        prop_assert_eq!(touch.is_some(), mu * slope.abs() < 1.0);
        prop_assume!(mu * slope.abs() < 0.9);
        let touch = touch.unwrap();
        // The torque for this motion with this friction, from Newton's equations, which are linear in it.
        let with = |torque: f64| run.parts.solve(case.omega, run.torque + torque, run.force + touch.friction);
        let (rest, _) = with(0.0);
        let m = run.expected_terms()[0];
        let (got, reactions) = with(m * (alpha - rest));
        let size = 10.0 * (run.joint_size(alpha) + touch.normal.abs() + run.size(alpha) / scene.geometry.crank);
        close("driven acceleration", got, alpha, run.size(alpha) / m + alpha.abs() + rest.abs(), 1e-12);
        close("guide", touch.normal, reactions.guide, size, 1e-11);
        close("Coulomb", touch.friction, -mu * (run.dx * case.omega).signum() * touch.normal.abs(), touch.normal.abs(), 1e-13);
    }
}

/// Positions along each curve satisfy the loop closure, and their derivatives agree with finite differences.
#[test]
fn the_curve_closes_and_is_smooth() {
    use slider_crank::scene::{Branch, Geometry};
    let shapes = [
        (1.0, 3.0, 0.5),
        (1.0, 0.4, 0.2),
        (1.0, 0.4, -0.5),
        (1.0, 0.9, 0.5),
        (1.0, 0.9, -0.5),
        (1.0, 1.2, 0.3),
        (1.0, 1.2, -2.1),
        (1.0, 1.5, 0.5),
        (1.0, 1.5, -0.5),
        (1.5, 1.0, 0.5),
        (1.5, 1.0, -0.5),
        (1.0, 1.0, 0.0),
        (1.0, 1.0, 0.7),
        (1.0, 1.5 - 1e-9, 0.5),
        (1.0, 1.5 + 1e-9, 0.5),
    ];
    for (crank, rod, offset) in shapes {
        for branch in [Branch::Right, Branch::Left] {
            for theta in [0.1, -0.2, 3.0, 3.3, 9.5, -12.8] {
                let g = Geometry {
                    crank,
                    rod,
                    offset,
                    branch,
                };
                let linkage = Linkage::new(&g);
                let Some((curve, q0)) = Curve::through(&linkage, Angle::from(theta)) else {
                    continue;
                };
                let start = linkage.pose(theta);
                close("start", curve.crank_angle(q0).radians(), theta, 1.0, 1e-14);
                close("start x", curve.pose(q0.rest).x, start.x, 1.0, 1e-14);
                for i in 0..400 {
                    let q = q0.rest + 0.0157 * f64::from(i);
                    let place = curve.pose(q);
                    let closure = offset + crank * place.sin - rod * place.rod_sin;
                    close("closure", closure, 0.0, crank + rod, 1e-15);
                    close("unit", place.sin.hypot(place.cos), 1.0, 1.0, 1e-15);
                    close("unit", place.rod_sin.hypot(place.rod_cos), 1.0, 1.0, 1e-15);
                    close(
                        "x",
                        place.x,
                        crank * place.cos + rod * place.rod_cos,
                        1.0,
                        1e-15,
                    );
                    let (sin, cos) = curve
                        .crank_angle(Angle {
                            turns: 0.0,
                            rest: q,
                        })
                        .radians()
                        .sin_cos();
                    close("sin theta", sin, place.sin, 1.0, 4e-15);
                    close("cos theta", cos, place.cos, 1.0, 4e-15);
                    if ((crank - rod).abs() - offset.abs()).abs() < 1e-6 && rod != 1.5 && rod != 1.0
                    {
                        continue;
                    }
                    let h = 1e-4;
                    let (a, b) = (curve.pose(q - h), curve.pose(q + h));
                    let turn = |p: &slider_crank::mechanism::CurvePose| {
                        [p.sin, p.cos, p.rod_sin, p.rod_cos, p.x]
                    };
                    let rate = |p: &slider_crank::mechanism::CurvePose| {
                        [
                            p.cos * p.dtheta,
                            -p.sin * p.dtheta,
                            p.rod_cos * p.drod,
                            -p.rod_sin * p.drod,
                            p.dx,
                        ]
                    };
                    let second = |p: &slider_crank::mechanism::CurvePose| {
                        [
                            p.cos * p.d2theta - p.sin * p.dtheta * p.dtheta,
                            -p.sin * p.d2theta - p.cos * p.dtheta * p.dtheta,
                            p.rod_cos * p.d2rod - p.rod_sin * p.drod * p.drod,
                            -p.rod_sin * p.d2rod - p.rod_cos * p.drod * p.drod,
                            p.d2x,
                        ]
                    };
                    for k in 0..5 {
                        close(
                            "first",
                            (turn(&b)[k] - turn(&a)[k]) / (2.0 * h),
                            rate(&place)[k],
                            10.0,
                            3e-7,
                        );
                        close(
                            "second",
                            (rate(&b)[k] - rate(&a)[k]) / (2.0 * h),
                            second(&place)[k],
                            10.0,
                            3e-7,
                        );
                    }
                }
                // A full cycle along the curve returns to the same position.
                let round = curve.pose(q0.rest + std::f64::consts::TAU);
                close("round", round.x, start.x, 1.0, 1e-13);
            }
        }
    }
}

/// Compares the normal force at a batch of angles with that of the equation on the configuration curve at each.
fn check_normals(case: &Case, tolerance: f64) {
    let scene = &case.scene;
    let equation = Equation::new(scene);
    let one_by_one = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
    let r = equation.linkage().r;
    let mass =
        scene.slider.map_or(0.0, |slider| slider.mass) + one_by_one.terms(case.theta).m / r.powi(2);
    let weight = mass * scene.gravity.map_or(0.0, |gravity| gravity.acceleration);
    let angles: [f64; 7] = std::array::from_fn(|i| case.theta + 0.9 * i as f64);
    let (_, normals) = equation.first_guided(&angles, angles.len());
    for (theta, found) in angles.iter().zip(normals) {
        let expected = one_by_one.terms(*theta).normal();
        let near = |what, found: f64, expected: f64, size: f64| {
            close(what, found, expected, size + expected.abs(), tolerance);
        };
        near("place", found.place, expected.place, weight);
        near("torque", found.torque, expected.torque, 1.0 / r);
        near("force", found.force, expected.force, 1.0);
        near("square", found.square, expected.square, mass * r);
    }
}

proptest! {
    #![proptest_config(cases(300))]

    #[test]
    fn normal_forces_side_by_side_are_those_one_by_one(case in case(rotating_crank(1e-3))) {
        check_normals(&case, 1e-9);
    }
}
