//! Inverse position: crank angles from other measured quantities.

use std::f64::consts::{PI, TAU};

use crate::support::random::{angle, any_class, cases};
use proptest::prelude::*;
use slider_crank::mechanism::{InversePosition, Linkage};
use slider_crank::scene::Geometry;

/// Accuracy of the angle, rad: half the digits are lost at a dead centre.
const ANGLE: f64 = 1e-6;

/// Accuracy of the measured value, relative to the lengths or in rad: half the digits are lost at the limits.
const VALUE: f64 = 1e-7;

fn turned_back(angle: f64) -> f64 {
    angle - (angle / TAU).round() * TAU
}

/// Checks that the angle is among the solutions, and that all solutions give the measured value.
fn check(found: &InversePosition, theta: f64, off: impl Fn(f64) -> Option<f64>) {
    let angles = found.angles();
    let nearest = angles
        .iter()
        .map(|found| turned_back(found - theta).abs())
        .fold(f64::INFINITY, f64::min);
    assert!(nearest < ANGLE, "{theta} is not in {angles:?}");
    for angle in angles {
        assert!((-PI..PI).contains(angle), "{angle}");
        let off = off(*angle).unwrap_or(0.0);
        assert!(off < VALUE, "{angle} is off by {off}");
    }
}

fn read_back(g: &Geometry, theta: f64) {
    let linkage = Linkage::new(g);
    let pose = linkage.pose(theta);
    if !pose.is_regular() {
        return;
    }
    let size = g.crank + g.rod + g.offset.abs();
    check(&linkage.angles_of_x(pose.x), theta, |found| {
        let there = linkage.pose(found);
        there.is_regular().then(|| (there.x - pose.x).abs() / size)
    });
    assert!(linkage.excess_of_x(pose.x) < 1e-12 * size);
    let gamma = |theta: f64| {
        let there = linkage.pose(theta);
        let signed = linkage.crank_pin_angle(theta, &there).0;
        there.is_regular().then(|| turned_back(signed).abs())
    };
    let Some(value) = gamma(theta) else { return };
    check(&linkage.angles_of_gamma(value), theta, |found| {
        gamma(found).map(|found| (found - value).abs())
    });
    assert!(linkage.excess_of_gamma(value) < 1e-9);
}

proptest! {
    #![proptest_config(cases(20_000))]

    #[test]
    fn angles_are_read_back(g in any_class(), theta in angle()) {
        read_back(&g, theta);
    }
}

#[test]
fn values_beyond_what_is_possible_are_taken_for_the_border() {
    let linkage = Linkage::new(&Geometry {
        crank: 0.05,
        rod: 0.15,
        offset: 0.01,
        branch: slider_crank::scene::Branch::Right,
    });
    let farthest = (0.2f64.powi(2) - 0.01f64.powi(2)).sqrt();
    let at_border = linkage.angles_of_x(farthest).angles()[0];
    let beyond = linkage.angles_of_x(farthest + 1e-4);
    assert!((beyond.angles()[0] - at_border).abs() < 1e-4);
    assert!((linkage.excess_of_x(farthest + 1e-4) - 1e-4).abs() < 1e-6);
    assert_eq!(linkage.excess_of_gamma(PI + 0.01), PI + 0.01 - PI);
    assert!(!linkage.angles_of_gamma(PI + 0.01).angles().is_empty());
}
