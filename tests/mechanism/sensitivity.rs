//! Derivatives with respect to the lengths compared with central differences in arithmetic of 31 digits.

use crate::support::exact::{Dd, Jet};
use crate::support::newton::Parts;
use crate::support::random::{case, cases, rotating_crank};
use crate::support::{Exact, close};
use proptest::prelude::*;
use slider_crank::mechanism::{Equation, Length, Linkage, TorqueSlope};
use slider_crank::scene::{
    Branch, Crank, Geometry, Gravity, Load, Rod, RodModel, Scene, Slider, Variables,
};

/// Returns the lengths with one of them shifted.
fn shifted(g: &Geometry, length: Length, by: f64) -> Geometry {
    let mut g = *g;
    *value(&mut g, length) += by;
    g
}

fn value(g: &mut Geometry, length: Length) -> &mut f64 {
    match length {
        Length::Crank => &mut g.crank,
        Length::Rod => &mut g.rod,
        Length::Offset => &mut g.offset,
    }
}

/// Returns the central difference of a function of the geometry; the step is the actual difference of the rounded
/// lengths.
fn difference(g: &Geometry, length: Length, f: impl Fn(&Geometry) -> Dd) -> f64 {
    let step = g.crank * 2f64.powi(-26);
    let (mut more, mut less) = (shifted(g, length, step), shifted(g, length, -step));
    let apart = Dd::from(*value(&mut more, length)) - Dd::from(*value(&mut less, length));
    ((f(&more) - f(&less)) / apart).value()
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn the_motion(case in case(rotating_crank(0.1))) {
        let g = case.scene.geometry;
        let linkage = Linkage::new(&g);
        let pose = linkage.pose(case.theta);
        let steep = pose.cos_phi.powi(-7);
        for length in Length::ALL {
            let slope = linkage.slope(&pose, length);
            let exact = |f: fn(&Exact) -> Dd| difference(&g, length, |g| f(&Exact::new(g, case.theta)));
            let x = exact(|e| e.p[0].exactly(0));
            close("x", slope.x, x, steep, 1e-14);
            close("x'", slope.dx, exact(|e| e.p[0].exactly(1)), steep, 1e-14);
            close("x''", slope.d2x, exact(|e| e.p[0].exactly(2)), steep, 1e-13);
            let per_length = steep / g.crank;
            close("phi'", slope.dphi, exact(|e| e.dphi.exactly(0)), per_length, 1e-14);
            close("phi''", slope.d2phi, exact(|e| e.dphi.exactly(1)), per_length, 1e-13);
            let (sin, cos) = (case.theta.sin(), case.theta.cos());
            let formula = match (length, g.branch) {
                (Length::Crank, Branch::Right) => (cos * pose.cos_phi - sin * pose.sin_phi) / pose.cos_phi,
                (Length::Rod, Branch::Right) => 1.0 / pose.cos_phi,
                (Length::Offset, Branch::Right) => -pose.sin_phi / pose.cos_phi,
                _ => x,
            };
            close("formula", x, formula, steep, 1e-14);
        }
    }

    #[test]
    fn the_driving_torque(case in case(rotating_crank(0.1)), force in -100.0..100.0) {
        let scene = Scene {
            torques: vec![Load::function(Variables::OMEGA, |now| now.omega)],
            forces: vec![
                Load::Constant(force),
                Load::Spring { stiffness: 30.0, rest: 0.2 },
                Load::Viscous(4.0),
                Load::function(Variables::THETA, |now| 20.0 * now.theta.sin()),
            ],
            ..case.scene.clone()
        };
        let g = scene.geometry;
        let linkage = Linkage::new(&g);
        let pose = linkage.pose(case.theta);
        let omega = Dd::from(case.omega);
        let torque = |g: &Geometry| {
            let parts = Parts::new(&Scene { geometry: *g, ..scene.clone() }, case.theta);
            let sum = |f: &dyn Fn(usize) -> Jet| (0..3).fold(Jet::from(0.0), |sum, i| sum + f(i));
            let half_dm = sum(&|i| parts.all[i].inertia()).exactly(1) * Dd::from(0.5);
            let dv = sum(&|i| parts.all[i].potential(parts.gravity)).exactly(1);
            let (x, dx) = (parts.exact.p[0].exactly(0), parts.exact.p[0].exactly(1));
            let load = Dd::from(force) + Dd::from(20.0 * case.theta.sin()) - Dd::from(30.0) * (x - Dd::from(0.2)) - Dd::from(4.0) * dx * omega;
            half_dm * omega * omega + dv - load * dx
        };
        let slopes = TorqueSlope::new(&scene).unwrap();
        let [m, half_dm, dv] = Parts::new(&scene, case.theta).sizes();
        let size = (half_dm + m) * case.omega * case.omega + dv
            + (force.abs() + 20.0 + 30.0 * (g.rod + g.crank + 0.2) + 4.0 * g.crank * case.omega.abs()) * g.crank;
        for length in Length::ALL {
            let want = difference(&g, length, torque);
            let got = slopes.driving_torque(case.theta, case.omega, length);
            close("torque", got, want, size / g.crank * pose.cos_phi.powi(-8), 1e-13);
        }
    }
}

/// Other rod models, whose mass distribution depends on the rod length: compared with the equation itself.
#[test]
fn every_rod_model() {
    for model in [RodModel::Rigid, RodModel::TwoMass, RodModel::SpinOnly] {
        let scene = Scene::new(0.04, 0.064)
            .offset(0.02)
            .branch(Branch::Left)
            .crank(Crank {
                mass: 0.2,
                cg: 0.04,
                cg_lateral: 0.0,
                inertia: 1e-4,
            })
            .rod(Rod {
                model,
                mass: 0.5,
                cg: 0.02,
                inertia: 3e-4,
                ..Rod::default()
            })
            .slider(Slider { mass: 0.8 })
            .gravity(Gravity {
                acceleration: 900.0,
                direction: 1.0,
            })
            .constant_speed(0.0, 25.0);
        let slopes = TorqueSlope::new(&scene).unwrap();
        for length in Length::ALL {
            for theta in [0.3, 1.9, 4.0, 5.5] {
                let torque = |by: f64| {
                    let geometry = shifted(&scene.geometry, length, by);
                    Equation::new(&Scene {
                        geometry,
                        ..scene.clone()
                    })
                    .driving_torque(0.0, theta, 25.0, 0.0)
                };
                let h = 1e-5;
                let want = (8.0 * (torque(h) - torque(-h)) - (torque(2.0 * h) - torque(-2.0 * h)))
                    / (12.0 * h);
                let got = slopes.driving_torque(theta, 25.0, length);
                close(
                    &format!("{model:?} {length:?} {theta}"),
                    got,
                    want,
                    want.abs() + 30.0,
                    1e-9,
                );
            }
        }
    }
}

#[test]
fn a_force_that_follows_a_formula_of_the_position_is_refused() {
    let scene = Scene::new(0.1, 0.3).force(Load::function(Variables::X, |now| now.x));
    let said = TorqueSlope::new(&scene).unwrap_err().to_string();
    assert!(said.contains("function"), "{said}");
}
