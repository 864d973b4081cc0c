//! Properties of the lengths alone: class, dead centres, stroke, time ratio, reach, least transmission angle, extremes;
//! each compared with its definition and with numbers of the source papers.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::support::exact::Dd;
use crate::support::random::{angle, any_class, cases, rotating_crank};
use crate::support::{Exact, Sizes, close, condition, geometry};
use proptest::prelude::*;
use slider_crank::mechanism::{Class, Extremes, Limits, Linkage, Located};
use slider_crank::scene::{Branch, Geometry};

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn dead_centres_have_crank_and_rod_in_line(g in any_class()) {
        let limits = Limits::new(&Linkage::new(&g), 1.0);
        let (r, l, e) = (g.crank, g.rod, g.offset);
        let number = if (l - r).abs() > e.abs() { 2 } else { 1 };
        prop_assert_eq!(limits.dead_centres.len(), number);
        prop_assert_eq!(limits.dead_centres.iter().filter(|d| d.kind == "outer").count(), 1);
        // Without an inner dead centre the slider moves from one outer dead centre to its mirror image.
        let dd = Dd::from;
        let farthest = ((dd(l) + dd(r)) * (dd(l) + dd(r)) - dd(e) * dd(e)).sqrt();
        let nearest = if number == 2 {
            ((dd(l) - dd(r)) * (dd(l) - dd(r)) - dd(e) * dd(e)).sqrt()
        } else {
            -farthest
        };
        let stroke = (farthest - nearest).value();
        close("stroke", limits.stroke, stroke, stroke, 4e-15);
        for dead in &limits.dead_centres {
            prop_assert!((0.0..TAU).contains(&dead.theta));
            let (sin, cos) = dead.theta.sin_cos();
            let distance = if dead.kind == "outer" { l + r } else { (l - r).abs() };
            close("|OP|", dead.x.hypot(e), distance, l + r, 1e-15);
            close("O, A, P in line", cos * e + sin * dead.x, 0.0, distance, 2e-15);
            let same_side = dead.kind == "outer" || r > l;
            prop_assert_eq!(cos * dead.x - sin * e > 0.0, same_side, "{:?}", dead);
            prop_assert_eq!((dead.x - r * cos) * g.branch.sign() > 0.0, true, "{:?}", dead);
            let (pose, exact) = (Linkage::new(&g).pose(dead.theta), Exact::new(&g, dead.theta));
            let worse = condition(&g, dead.theta);
            close("x", pose.x, dead.x, l + r, 2e-15 * worse);
            close("x'", exact.p[0].d(1), 0.0, Sizes::new(&g, &exact).d2x, 2e-15 * worse);
        }
    }

    #[test]
    fn the_class_follows_from_the_lengths(g in any_class()) {
        let (r, l, e) = (g.crank, g.rod, g.offset.abs());
        let class = if l - r > e {
            Class::RotatingCrank
        } else if r - l > e {
            Class::RotatingRod
        } else {
            Class::DoubleRocker
        };
        prop_assert_eq!(Limits::new(&Linkage::new(&g), 1.0).class, class);
    }

    #[test]
    fn reach_is_where_the_rod_reaches_the_guide(g in any_class(), theta in -PI..PI) {
        let linkage = Linkage::new(&g);
        let reach = Limits::new(&linkage, 1.0).reach;
        prop_assert_eq!(reach.is_empty(), g.rod - g.crank > g.offset.abs());
        let lift = |theta: f64| (g.offset + g.crank * theta.sin()).abs() - g.rod;
        prop_assume!(lift(theta).abs() > 1e-9 * g.crank);
        let inside = |[from, to]: &[f64; 2]| {
            (-2..=2).any(|turn| (from..to).contains(&&(theta + TAU * f64::from(turn))))
        };
        prop_assert_eq!(reach.is_empty() || reach.iter().any(inside), lift(theta) < 0.0);
        for end in reach.iter().flatten() {
            close("|e + r sin theta|", lift(*end), 0.0, g.crank + g.rod, 2e-15);
        }
        for [from, to] in &reach {
            prop_assert!(linkage.pose(0.5 * (from + to)).is_regular());
        }
    }

    #[test]
    fn clear_reach_ends_a_milliradian_of_the_rod_before_it_stands_normal_to_the_guide(
        g in any_class(),
    ) {
        let linkage = Linkage::new(&g);
        let (reach, clear) = (Limits::new(&linkage, 1.0).reach, Limits::clear_reach(&linkage));
        prop_assert_eq!(clear.len(), reach.len());
        for ([from, to], [clear_from, clear_to]) in reach.iter().zip(&clear) {
            prop_assert!(from < clear_from && clear_from < clear_to && clear_to < to);
            for end in [clear_from, clear_to] {
                close("transmission angle", linkage.pose(*end).transmission(), 1e-3, 1e-3, 1e-6);
            }
        }
    }

    #[test]
    fn the_least_transmission_angle_is_attained_where_the_crank_points_away_from_the_guide(
        g in rotating_crank(1e-13), theta in angle(),
    ) {
        let linkage = Linkage::new(&g);
        let least = Limits::new(&linkage, 1.0).transmission_min;
        prop_assert!(linkage.pose(theta).transmission() >= least * (1.0 - 1e-14));
        let (r, l, e) = (Dd::from(g.crank), Dd::from(g.rod), Dd::from(g.offset.abs()));
        let u = e + r;
        let angle = ((l * l - u * u).sqrt() / u).value().atan();
        close("least transmission angle", least, angle, angle, 1e-14);
    }

    #[test]
    fn advance_is_the_angle_over_which_the_slider_moves_outwards(
        g in rotating_crank(1e-3), part in 0.0..1.0,
    ) {
        let linkage = Linkage::new(&g);
        let limits = Limits::new(&linkage, 1.0);
        let inner = limits.dead_centres.iter().find(|d| d.kind == "inner").unwrap().theta;
        let (advance, retreat) = (limits.advance.unwrap(), limits.retreat.unwrap());
        close("whole turn", advance + retreat, TAU, 1.0, 1e-15);
        prop_assume!((1e-6..1.0 - 1e-6).contains(&part));
        let outwards = |theta: f64| linkage.pose(theta).dx * linkage.s;
        prop_assert!(outwards(inner + part * advance) > 0.0);
        prop_assert!(outwards(inner - part * retreat) < 0.0);
        let back = Limits::new(&linkage, -1.0);
        close("advance, turning back", back.advance.unwrap(), retreat, 1.0, 1e-15);
        close("time ratio", limits.time_ratio().unwrap(), advance / retreat, 1.0, 1e-15);
    }
}

proptest! {
    #![proptest_config(cases(2_000))]

    #[test]
    fn no_sample_exceeds_the_extremes_and_their_slope_vanishes(g in rotating_crank(1e-12)) {
        let linkage = Linkage::new(&g);
        let found = Extremes::new(&linkage).unwrap();
        let travel = dense_turn().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], theta| {
            let x = linkage.pose(theta).x;
            [low.min(x), high.max(x)]
        });
        let stroke = Limits::new(&linkage, 1.0).stroke;
        let missed = stroke - (travel[1] - travel[0]);
        prop_assert!((-1e-14 * (g.rod + g.crank)..1e-3 * stroke).contains(&missed), "{missed} of {stroke}");
        for (order, low, high) in [
            (1, found.velocity_min, found.velocity_max),
            (2, found.acceleration_min, found.acceleration_max),
        ] {
            for extreme in [low, high] {
                check_extreme(&g, order, &extreme);
            }
            for theta in dense_turn() {
                let pose = linkage.pose(theta);
                let value = if order == 1 { pose.dx } else { pose.d2x };
                let slack = 1e-14 * value.abs().max(g.crank);
                prop_assert!(low.value - slack <= value && value <= high.value + slack,
                    "order {order}: {value} at {theta} is outside {low:?} to {high:?}");
            }
        }
    }
}

/// Checks that an extreme is a value of the derivative of this order, and that the next derivative vanishes up to its
/// own rounding and that of the angle.
fn check_extreme(g: &Geometry, order: usize, extreme: &Located) {
    assert!((0.0..TAU).contains(&extreme.theta_rad));
    let exact = Exact::new(g, extreme.theta_rad);
    let sizes = Sizes::new(g, &exact);
    let (size, next) = if order == 1 {
        (sizes.dx, sizes.d2x)
    } else {
        (sizes.d2x, sizes.d3x)
    };
    close("extreme", extreme.value, exact.p[0].d(order), size, 1e-14);
    let slope =
        |ulps: f64| Exact::new(g, extreme.theta_rad + ulps * f64::EPSILON * TAU).p[0].d(order + 1);
    let rounding = (slope(2.0) - slope(-2.0)).abs();
    close(
        "slope at the extreme",
        exact.p[0].d(order + 1),
        0.0,
        1e-14 * next + rounding,
        1.0,
    );
}

/// Returns a turn in steps of 0.3 degrees, refined towards ±90°.
fn dense_turn() -> impl Iterator<Item = f64> {
    let near = (0..300).flat_map(|i| {
        let distance = 10f64.powf(-8.0 * f64::from(i) / 300.0);
        [
            FRAC_PI_2 - distance,
            FRAC_PI_2 + distance,
            -FRAC_PI_2 - distance,
            -FRAC_PI_2 + distance,
        ]
    });
    (0..1200).map(|i| TAU * f64::from(i) / 1200.0).chain(near)
}

#[test]
fn limits_of_the_engine_of_obaseki_and_alfred() {
    for (e, stroke, ratio, [outer, inner]) in [
        (
            0.020,
            88.79230742e-3,
            1.673701493,
            [348.9125108, 123.5573098],
        ),
        (
            0.010,
            81.70069013e-3,
            1.237506101,
            [354.4822656, 155.3756816],
        ),
        (0.0, 80e-3, 1.0, [0.0, 180.0]),
    ] {
        for (offset, branch, speed) in [
            (e, Branch::Right, 1.0),
            (-e, Branch::Right, -1.0),
            (e, Branch::Left, -1.0),
            (-e, Branch::Left, 1.0),
        ] {
            let limits = Limits::new(
                &Linkage::new(&geometry(0.040, 0.064, offset, branch)),
                speed,
            );
            close("stroke", limits.stroke, stroke, stroke, 1e-9);
            close(
                "time ratio",
                limits.time_ratio().unwrap(),
                ratio,
                ratio,
                1e-9,
            );
            for dead in &limits.dead_centres {
                let mut angle = if dead.kind == "outer" { outer } else { inner };
                if offset < 0.0 {
                    angle = -angle;
                }
                if branch == Branch::Left {
                    angle = 180.0 - angle;
                }
                let apart = (dead.theta.to_degrees() - angle + 180.0).rem_euclid(360.0) - 180.0;
                assert!(dead.theta.is_sign_positive());
                close("dead centre", apart, 0.0, 1.0, 1e-7);
            }
        }
    }
}

#[test]
fn dead_centres_of_the_mechanism_of_gupta() {
    let limits = Limits::new(
        &Linkage::new(&geometry(0.140, 0.310, 0.060, Branch::Right)),
        1.0,
    );
    let found: Vec<_> = limits
        .dead_centres
        .iter()
        .map(|d| (d.theta.to_degrees(), d.kind == "outer"))
        .collect();
    assert!(
        (found[0].0 - 159.3326835).abs() < 1e-7 && !found[0].1,
        "{found:?}"
    );
    assert!(
        (found[1].0 - 352.3377443).abs() < 1e-7 && found[1].1,
        "{found:?}"
    );
}

#[test]
fn lengths_typed_in_decimals_on_a_border_are_change_points() {
    for (r, l, e) in [
        (0.1, 0.15, 0.05),
        (0.1, 0.3, 0.2),
        (0.3, 0.1, 0.2),
        (0.1, 0.1, 0.0),
        (0.1, 0.2, 0.3),
        (0.047, 0.15583, 0.10883),
    ] {
        for (e, branch) in [(e, Branch::Right), (-e, Branch::Left)] {
            let limits = Limits::new(&Linkage::new(&geometry(r, l, e, branch)), 1.0);
            assert_eq!(limits.class, Class::ChangePoint, "{r} {l} {e}");
            assert_eq!((limits.advance, limits.transmission_min), (None, 0.0));
        }
    }
    let class =
        |l: f64| Limits::new(&Linkage::new(&geometry(0.1, l, 0.05, Branch::Right)), 1.0).class;
    assert_eq!(class(0.15 * (1.0 + 1e-13)), Class::RotatingCrank);
    assert_eq!(class(0.15 * (1.0 - 1e-13)), Class::DoubleRocker);
}

/// Where the rod is parallel to the guide, x' is ± r and extreme.
#[test]
fn with_offset_equal_to_the_crank_the_speed_is_extreme_where_the_rod_lies_along_the_guide() {
    for branch in [Branch::Right, Branch::Left] {
        let extremes = |e| Extremes::new(&Linkage::new(&geometry(1.0, 3.0, e, branch))).unwrap();
        let (above, below) = (extremes(-1.0).velocity_min, extremes(1.0).velocity_max);
        close("least x'", above.value, -1.0, 1.0, 1e-15);
        close("its angle", above.theta_rad, FRAC_PI_2, 1.0, 1e-14);
        close("largest x'", below.value, 1.0, 1.0, 1e-15);
        close("its angle", below.theta_rad, 3.0 * FRAC_PI_2, 1.0, 1e-14);
    }
}

#[test]
fn a_change_point_has_no_extremes_whatever_the_rounding_of_its_lengths() {
    for (r, l, e) in [(0.1, 0.15, 0.05), (0.1, 0.4, 0.3), (0.1, 0.1, 0.0)] {
        let linkage = Linkage::new(&geometry(r, l, e, Branch::Right));
        assert_eq!(Limits::new(&linkage, 1.0).class, Class::ChangePoint);
        assert_eq!(Extremes::new(&linkage), None, "{r} {l} {e}");
    }
}
