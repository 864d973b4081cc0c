//! Enclosures of positions contain every position in their interval, on each kind of configuration curve.

use std::f64::consts::TAU;

use slider_crank::mechanism::{Class, Curve, Limits, Linkage, SliderUse};
use slider_crank::numeric::angle::Angle;
use slider_crank::numeric::enclosure::{Interval, MotionPiece};
use slider_crank::scene::{Branch, Geometry};

/// Crank, rod, offset (m) and start angle (rad) for each kind of curve.
const CURVES: [([f64; 3], f64); 6] = [
    ([0.05, 0.15, 0.01], 0.3),
    ([0.15, 0.05, 0.01], 0.2),
    ([0.15, 0.05, -0.01], 3.0),
    ([0.1, 0.12, 0.05], 0.4),
    ([0.1, 0.12, -0.05], 0.4),
    ([0.1, 0.1, 0.0], 0.4),
];

#[test]
fn every_position_lies_in_its_enclosure() {
    let mut kinds = std::collections::BTreeSet::new();
    for (lengths, start) in CURVES {
        for branch in [Branch::Right, Branch::Left] {
            let [crank, rod, offset] = lengths;
            let geometry = Geometry {
                crank,
                rod,
                offset,
                branch,
            };
            let linkage = Linkage::new(&geometry);
            kinds.insert(format!("{:?}", Class::of(&linkage)));
            assert!(Limits::new(&linkage, start).dead_centres.len() < 9);
            let (curve, _) = Curve::through(&linkage, Angle::from(start)).expect("a position");
            for k in 0..200 {
                let low = -7.0 + 0.07 * f64::from(k);
                let width = 2.0f64.powi(-(k % 12));
                let q = Interval::new(low, low + width);
                let reach = MotionPiece {
                    t: Interval::point(0.0),
                    angle: q,
                    speed: Interval::point(1.0),
                };
                let seen = curve.enclosed_state(&reach, SliderUse::Read);
                for part in 0..=20 {
                    let q = low + width * f64::from(part) / 20.0;
                    let place = curve.pose(q);
                    let theta = curve.crank_angle(Angle::from(q)).radians();
                    let holds = |of: Interval, value: f64| {
                        assert!(
                            of.widened(1e-13).contains(value),
                            "{of:?} {value} {curve:?}"
                        );
                    };
                    holds(seen.theta, theta);
                    holds(seen.omega, place.dtheta);
                    holds(seen.x, place.x);
                    holds(seen.dx, place.dx);
                }
            }
        }
    }
    assert_eq!(kinds.len(), 4, "{kinds:?}");
}

#[test]
fn between_dead_centres_the_slider_keeps_its_direction() {
    for offset in [-0.06, -0.01, 0.0, 0.03, 0.0999999] {
        for branch in [Branch::Right, Branch::Left] {
            let geometry = Geometry {
                crank: 0.05,
                rod: 0.15,
                offset,
                branch,
            };
            let linkage = Linkage::new(&geometry);
            let found = Limits::new(&linkage, 0.3).dead_centres;
            let [one, other] = [found[0].theta, found[1].theta];
            for turn in [-3.0, 0.0, 1.0, 20.0] {
                let ends = [one, other, one + TAU].map(|theta| theta + turn * TAU);
                for [low, high] in [[ends[0], ends[1]], [ends[1], ends[2]]] {
                    let reach = MotionPiece {
                        t: Interval::point(0.0),
                        angle: Interval::new(low, high),
                        speed: Interval::new(3.0, 5.0),
                    };
                    let v = linkage.enclosed_state(&reach, SliderUse::Read).v;
                    let middle = linkage.pose(0.5 * (low + high)).dx;
                    assert!(v.low >= 0.0 || v.high <= 0.0, "{v:?} {offset} {turn}");
                    assert!(v.contains(3.0 * middle), "{v:?} {middle}");
                }
            }
        }
    }
}
