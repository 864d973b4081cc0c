//! Closed-form geometry compared with Taylor series of the loop closure, also near the limits.

use std::f64::consts::{FRAC_PI_2, PI};

use crate::support::exact::{Dd, Jet, SinCos};
use crate::support::random::{angle, any_class, cases, rotating_crank};
use crate::support::{Exact, Point, Sizes, close, condition, geometry};
use proptest::prelude::*;
use slider_crank::mechanism::{Linkage, Path};
use slider_crank::scene::{Branch, Geometry};

/// Checks everything in a pose to `tolerance` times the sizes of its terms.
fn check_pose(g: &Geometry, theta: f64, tolerance: f64) {
    let linkage = Linkage::new(g);
    let pose = linkage.pose(theta);
    let exact = Exact::new(g, theta);
    let sizes = Sizes::new(g, &exact);
    let near = |what: &str, got: f64, want: f64, size: f64| close(what, got, want, size, tolerance);
    let (x, dphi) = (&exact.p[0], &exact.dphi);
    near(
        "sin phi",
        pose.sin_phi,
        exact.sin_phi.value(),
        (g.offset.abs() + g.crank) / g.rod,
    );
    near(
        "cos phi",
        pose.cos_phi,
        exact.cos_phi.value(),
        exact.cos_phi.value(),
    );
    near("phi'", pose.dphi, dphi.d(0), sizes.dphi);
    near("phi''", pose.d2phi, dphi.d(1), sizes.d2phi);
    near("x", pose.x, x.d(0), sizes.x);
    near("x'", pose.dx, x.d(1), sizes.dx);
    near("x''", pose.d2x, x.d(2), sizes.d2x);
    let (d3phi, d3x) = linkage.third_derivatives(&pose);
    near("phi'''", d3phi, dphi.d(2), sizes.d3phi);
    near("x'''", d3x, x.d(3), sizes.d3x);
    let tangent = (exact.cos_phi.exactly(0) / exact.sin_phi.exactly(0).abs()).value();
    near(
        "transmission angle",
        pose.transmission(),
        tangent.atan(),
        tangent.atan(),
    );
    near(
        "phi",
        pose.phi(),
        exact.sin_phi.value().atan2(exact.cos_phi.value()),
        1.0,
    );
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn a_rotating_crank_is_right_to_rounding_however_close_to_its_limit(
        g in rotating_crank(1e-13), theta in angle(),
    ) {
        check_pose(&g, theta, 5e-15);
    }

    #[test]
    fn every_class_is_right_to_rounding_and_conditioning(g in any_class(), theta in angle()) {
        prop_assume!((g.offset + g.crank * theta.sin()).abs() < g.rod);
        check_pose(&g, theta, 5e-15 * condition(&g, theta));
    }

    #[test]
    fn where_the_rod_does_not_reach_there_is_no_position(g in any_class(), theta in angle()) {
        let reached = (g.offset + g.crank * theta.sin()).abs() < g.rod;
        prop_assert_eq!(Linkage::new(&g).pose(theta).is_regular(), reached);
    }

    #[test]
    fn a_linkage_with_another_rod_is_the_linkage_of_those_lengths(
        g in any_class(), rod in 0.01..10.0,
    ) {
        prop_assert_eq!(Linkage::new(&g).with_rod(rod), Linkage::new(&Geometry { rod, ..g }));
    }

    #[test]
    fn paths_of_points_on_every_body_are_right_to_rounding(
        g in rotating_crank(1e-6), theta in angle(), along in -2.0..2.0, left in -2.0..2.0,
    ) {
        let exact = Exact::new(&g, theta);
        let sizes = Sizes::new(&g, &exact);
        let linkage = Linkage::new(&g);
        let pose = linkage.pose(theta);
        let check = |path: &Path, point: &Point, size: [f64; 2]| {
            for (i, exact) in point.iter().enumerate() {
                close("p'", path.dp[i], exact.d(1), size[0], 5e-15);
                close("p''", path.d2p[i], exact.d(2), size[1], 5e-15);
            }
        };
        let (r, l) = (g.crank, g.rod);
        let point = exact.on_crank(along * r, left * r);
        let (a, b) = (along * r, left * r);
        let arm = [a * pose.cos - b * pose.sin, a * pose.sin + b * pose.cos];
        let turning = Path::turning(arm, [1.0, 0.0]);
        check(&turning, &point, [4.0 * r, 4.0 * r]);
        prop_assert_eq!((turning.dpsi, turning.d2psi), (1.0, 0.0));
        let sliding = Path { dp: [pose.dx, 0.0], d2p: [pose.d2x, 0.0], ..Path::default() };
        check(&sliding, &exact.p, [sizes.dx, sizes.d2x]);
        let path = Path::on_rod(&linkage, &pose, along * l, left * l);
        let arm = 4.0 * l;
        let size = [r + arm * sizes.dphi, r + arm * (sizes.d2phi + sizes.dphi * sizes.dphi)];
        check(&path, &exact.on_rod(along * l, left * l), size);
        close("psi'", path.dpsi, exact.dpsi().d(0), sizes.dphi, 5e-15);
        close("psi''", path.d2psi, exact.dpsi().d(1), sizes.d2phi, 5e-15);
    }

    #[test]
    fn the_left_branch_is_the_right_one_with_opposite_offset_turned_half_round(
        g in rotating_crank(0.01), theta in -3.0..3.0,
    ) {
        let left = Linkage::new(&Geometry { branch: Branch::Left, ..g });
        let right = Linkage::new(&Geometry { branch: Branch::Right, offset: -g.offset, ..g });
        let (here, there) = (left.pose(theta), right.pose(theta + PI));
        let size = g.crank + g.rod;
        close("x", here.x, -there.x, size, 1e-14);
        close("x'", here.dx, -there.dx, size, 1e-13);
        close("phi'", here.dphi, -there.dphi, 1.0, 1e-13);
    }
}

#[test]
fn at_a_margin_of_2_to_the_minus_40_no_digit_of_cos_phi_is_lost() {
    let margin = 2f64.powi(-40);
    for (offset, quarter) in [(0.5, FRAC_PI_2), (-0.5, -FRAC_PI_2)] {
        for branch in [Branch::Right, Branch::Left] {
            let g = geometry(1.0, 1.5 + margin, offset, branch);
            for distance in [0.0, 1e-15, 1e-12, 1e-9, 3e-7, 1e-6, 1e-5, 1e-3, 0.1] {
                for theta in [quarter - distance, quarter + distance] {
                    check_pose(&g, theta, 5e-15);
                    // l² cos²φ = (l − u)(l + u), l − u = margin + 2 r sin²(d/2), with d computed without cancellation
                    // from the angle.
                    let d = (FRAC_PI_2 - theta.abs()) + 6.123233995736766e-17;
                    let minus = margin + 2.0 * (d / 2.0).sin().powi(2);
                    let w = (minus * (2.0 * g.rod - minus)).sqrt();
                    let pose = Linkage::new(&g).pose(theta);
                    close("cos phi", pose.cos_phi, w / g.rod, w, 1e-15);
                    close("phi'", pose.dphi, d.sin() / w, d.sin().abs() / w, 1e-14);
                }
            }
        }
    }
}

/// Computes l cos φ from its square in 31 digits, for rods and offsets much longer than the crank.
#[test]
fn a_large_offset_takes_no_digits_of_the_rods_height() {
    for (ratio, margin) in [(1e3, 1e-3), (1e3, 0.5), (1e6, 1e-3), (1e6, 2.0), (1e9, 0.1)] {
        for theta in [1.5, 0.4, 0.1, -0.1, -0.4, -1.0, -1.5, -3.0, 3.0, 2.0] {
            for mirror in [1.0, -1.0] {
                let g = geometry(
                    0.1,
                    0.1 * (ratio + 1.0 + margin),
                    0.1 * mirror * ratio,
                    Branch::Left,
                );
                let dd = Dd::from;
                let u = dd(g.offset) + dd(g.crank) * Dd::from(mirror * theta).sin_cos().0;
                let w = ((dd(g.rod) - u) * (dd(g.rod) + u)).sqrt().value();
                let pose = Linkage::new(&g).pose(mirror * theta);
                close("l cos phi", pose.cos_phi * g.rod, w, w, 2e-15);
            }
        }
    }
}

#[test]
fn margins_typed_in_decimals_keep_their_digits() {
    for margin in [1e-6, 1e-12] {
        for e in [0.0, 0.3, -0.3] {
            for theta in [FRAC_PI_2, -FRAC_PI_2, 1.5705, -1.57, 1.5, 4.712388] {
                check_pose(
                    &geometry(0.1, 0.1 + f64::abs(e) + margin * 0.1, e, Branch::Right),
                    theta,
                    5e-15,
                );
            }
        }
    }
}

#[test]
fn the_reference_closes_the_loop_to_thirty_digits() {
    let cos = Dd::from(FRAC_PI_2).sin_cos().1.value();
    assert_eq!(cos, 6.123233995736766e-17);
    for theta in [-19.3, -2.0, 0.7, FRAC_PI_2, 4.6, 17.0] {
        let g = geometry(1.1, 2.3, -0.9, Branch::Left);
        let exact = Exact::new(&g, theta);
        let squared = |[x, y]: [Jet; 2]| x * x + y * y;
        let [a, p] = [exact.a, exact.p];
        let (crank, rod) = (squared(a), squared([p[0] - a[0], p[1] - a[1]]));
        for order in 0..4 {
            let rest =
                |jet: Jet, length: f64| (jet - Jet::from(length) * Jet::from(length)).d(order);
            assert!(rest(crank, 1.1).abs() < 1e-29, "{}", rest(crank, 1.1));
            assert!(rest(rod, 2.3).abs() < 1e-29, "{}", rest(rod, 2.3));
        }
    }
}
