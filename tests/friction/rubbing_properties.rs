//! Symmetries and balances of random motions with friction, in mechanisms of all classes, under switching loads.
//!
//! In reversed time friction would drive instead of brake, and a state of rest does not determine the motion before it:
//! only motions without friction are run back.

use crate::support::alike::{Kind, image_moves_alike, runs_back, scaling, tolerances_agree};
use crate::support::image::{Image, Setting};
use crate::support::random::cases;
use crate::support::rubbing::{Without, rubbing};
use proptest::prelude::*;
use slider_crank::plan::Method;
use slider_crank::scene::{InertiaAbout, Load, Scene};
use slider_crank::simulate::{Options, Row, simulate_rows};

const ANY: Kind = Kind {
    method: Method::Auto,
    limits: false,
    slack: 0.0,
};
/// Kind with formulas whose jumps are found only by step control.
const STEPPED: Kind = Kind { slack: 1.0, ..ANY };

const ANNOUNCED: Without = Without {
    friction: false,
    loads: false,
    jumps: true,
};
const JUMPING: Without = Without {
    jumps: false,
    ..ANNOUNCED
};
const NO_FRICTION: Without = Without {
    friction: true,
    ..ANNOUNCED
};
const NO_LOADS: Without = Without {
    loads: true,
    ..ANNOUNCED
};

/// Returns kinetic and potential energy of a row from positions and velocities of the bodies, J.
fn energy(scene: &Scene, row: &Row) -> f64 {
    let g = &scene.geometry;
    let (sin, cos) = row.theta.sin_cos();
    let a = [g.crank * cos, g.crank * sin];
    let va = [-a[1] * row.omega, a[0] * row.omega];
    let d = [(row.x - a[0]) / g.rod, (-g.offset - a[1]) / g.rod];
    // The velocity of the wrist pin relative to the crank pin is normal to the rod.
    let spin = ((row.v - va[0]) * -d[1] - va[1] * d[0]) / g.rod;
    let (crank, rod, slider) = (
        scene.crank.unwrap(),
        scene.rod.unwrap(),
        scene.slider.unwrap(),
    );
    assert_eq!(rod.inertia_about, InertiaAbout::Cg);
    let arm = [
        rod.cg * d[0] - rod.cg_lateral * d[1],
        rod.cg * d[1] + rod.cg_lateral * d[0],
    ];
    let v = [va[0] - spin * arm[1], va[1] + spin * arm[0]];
    let gravity = scene.gravity.unwrap();
    let (down_y, down_x) = gravity.direction.sin_cos();
    let height = |x: f64, y: f64| -gravity.acceleration * (down_x * x + down_y * y);
    let spring = |load: &Load| match load {
        Load::Spring { stiffness, rest } => 0.5 * stiffness * (row.x - rest).powi(2),
        other => panic!("{other:?}"),
    };
    0.5 * (crank.inertia * row.omega.powi(2)
        + rod.mass * (v[0] * v[0] + v[1] * v[1])
        + rod.inertia * spin * spin
        + slider.mass * row.v.powi(2))
        + rod.mass * height(a[0] + arm[0], a[1] + arm[1])
        + slider.mass * height(row.x, -g.offset)
        + scene.forces.iter().map(spring).sum::<f64>()
}

/// Checks that friction only dissipates energy if the other loads are weight and a spring.
fn friction_only_takes(setting: &Setting) -> Result<(), TestCaseError> {
    let scene = setting.scene(&Image::SAME).tolerance(1e-10);
    let mut rows: Vec<Row> = Vec::new();
    let run = simulate_rows(&scene, &Options::default(), &mut rows).unwrap();
    prop_assert!(
        run.summary
            .stopped
            .is_none_or(|why| why.to_string().contains("jams"))
    );
    let energies: Vec<f64> = rows.iter().map(|row| energy(&scene, row)).collect();
    let kinetic = energies[0].abs() + energies.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
    let (mut least, mut moved) = (f64::INFINITY, 0.0);
    for (row, energy) in rows.iter().zip(&energies) {
        prop_assert!(*energy <= least + 1e-8 * kinetic, "at t = {}", row.t);
        least = least.min(*energy);
        moved = f64::max(moved, row.v.abs());
    }
    // This covers the whole loss: the residual of the summary hides none.
    prop_assert!(run.summary.energy_residual.abs() < 1e-7);
    prop_assert!(moved == 0.0 || least < energies[0], "{moved}");
    Ok(())
}

proptest! {
    #![proptest_config(cases(96))]

    #[test]
    fn energy_balances_and_tolerances_agree(setting in rubbing(ANNOUNCED)) {
        tolerances_agree(&setting, ANY, Method::Dop853)?;
    }

    #[test]
    fn energy_balances_and_tolerances_agree_where_formulas_jump(setting in rubbing(JUMPING)) {
        tolerances_agree(&setting, STEPPED, Method::Dop853)?;
    }

    #[test]
    fn friction_takes_energy_and_gives_none(setting in rubbing(NO_LOADS)) {
        friction_only_takes(&setting)?;
    }

    #[test]
    fn the_mirror_image_moves_alike(setting in rubbing(ANNOUNCED)) {
        image_moves_alike(&setting, &Image::MIRRORED, ANY)?;
    }

    #[test]
    fn turned_half_round_it_moves_alike(setting in rubbing(ANNOUNCED)) {
        image_moves_alike(&setting, &Image::TURNED, ANY)?;
    }

    #[test]
    fn in_other_units_it_moves_alike(setting in rubbing(ANNOUNCED), image in scaling()) {
        image_moves_alike(&setting, &image, ANY)?;
    }

    #[test]
    fn without_friction_it_runs_back(setting in rubbing(NO_FRICTION)) {
        // At rest there is no speed to reverse.
        prop_assume!(setting.start.1 != 0.0);
        runs_back(&setting, ANY)?;
    }
}
