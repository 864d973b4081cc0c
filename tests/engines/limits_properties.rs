//! Symmetries, balances and reversal of random motions that pass limits.

use std::f64::consts::PI;

use crate::support::alike::{
    Kind, bodies, branch, image_moves_alike, runs_back, scaling, tolerances_agree,
};
use crate::support::image::{Act, Image, Setting};
use crate::support::random::{cases, magnitude};
use proptest::prelude::*;
use slider_crank::plan::Method;

const ROCKER: Kind = Kind {
    method: Method::Auto,
    limits: true,
    slack: 0.0,
};

/// Returns a crank angle at which the crank pin is at this fraction of the way between the least and the largest height
/// that the rod can reach.
fn reached([r, l, e]: [f64; 3], part: f64, beyond: bool) -> f64 {
    let (low, high) = (f64::max(-l, e - r), f64::min(l, e + r));
    let angle = ((low + part * (high - low) - e) / r).asin();
    if beyond { PI - angle } else { angle }
}

/// Strategy for a double rocker or a rotating rod, about a twentieth of the sum of the lengths away from change points.
fn lengths() -> impl Strategy<Value = [f64; 3]> {
    let size = || magnitude(0.02, 0.3);
    prop_oneof![
        (size(), 0.2..0.9f64, -0.9..0.9f64).prop_map(|(r, l, e)| [r, r * l, r * (1.0 - l) * e]),
        (size(), 0.3..3.0f64, 0.1..0.9f64, any::<bool>()).prop_map(|(r, l, e, below)| {
            let (least, most) = ((1.0 - l).abs(), 1.0 + l);
            let e = least + e * (most - least);
            [r, r * l, if below { -r * e } else { r * e }]
        }),
    ]
}

fn rocker() -> impl Strategy<Value = Setting> {
    let start = (
        0.1..0.9f64,
        any::<bool>(),
        magnitude(3.0, 30.0),
        any::<bool>(),
        4.0..25.0f64,
    );
    let loads = (-0.3..0.3f64, -0.3..0.3f64, 0.0..0.5f64, 0.0..0.3f64);
    (lengths(), any::<bool>(), bodies(), start, loads).prop_map(
        |(lengths, left, bodies, start, loads)| {
            let (part, beyond, omega, back, way) = start;
            let (torque, force, stiffness, gravity) = loads;
            let [r, ..] = lengths;
            let unit = r * omega * omega;
            let mut setting = Setting::new(lengths, branch(left), bodies);
            setting.gravity = gravity * unit;
            setting.start = (
                reached(lengths, part, beyond),
                if back { -omega } else { omega },
            );
            setting.duration = way / omega;
            setting.torques = vec![Act::Formula(format!(
                "({})*sin(2*(THETA) + 1)",
                torque * r * unit
            ))];
            setting.forces = vec![
                Act::Formula(format!("({})", force * unit)),
                Act::Spring {
                    stiffness: stiffness * omega * omega,
                    rest: force * r,
                },
            ];
            setting
        },
    )
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn rockers_balance_their_energy_and_tolerances_agree(setting in rocker()) {
        tolerances_agree(&setting, ROCKER, Method::Dop853)?;
    }

    #[test]
    fn the_mirror_image_of_a_rocker_moves_alike(setting in rocker()) {
        image_moves_alike(&setting, &Image::MIRRORED, ROCKER)?;
    }

    #[test]
    fn a_rocker_turned_half_round_moves_alike(setting in rocker()) {
        image_moves_alike(&setting, &Image::TURNED, ROCKER)?;
    }

    #[test]
    fn a_rocker_in_other_units_moves_alike(setting in rocker(), image in scaling()) {
        image_moves_alike(&setting, &image, ROCKER)?;
    }

    #[test]
    fn rockers_run_back(setting in rocker()) {
        runs_back(&setting, ROCKER)?;
    }
}
