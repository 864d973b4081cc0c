//! Sizing from a stroke, mass properties, equivalent masses, first-order motion, iterative loop closure: compared with
//! exact relations and with numbers computed in 40 digits by other software.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::support::random::{cases, magnitude, rotating_crank};
use crate::support::{close, geometry};
use proptest::prelude::*;
use slider_crank::mechanism::{
    Closure, EquivalentMasses, Limits, Linkage, Shape, size_from_stroke,
};
use slider_crank::scene::{Branch, Crank, Rod, Scene, Slider};

proptest! {
    #![proptest_config(cases(3000))]

    /// Sizing from the stroke of a mechanism gives one with this stroke, ratio and offset.
    #[test]
    fn a_size_from_the_stroke_has_that_stroke(g in rotating_crank(1e-3)) {
        let stroke = Limits::new(&Linkage::new(&g), 0.0).stroke;
        let ratio = g.rod / g.crank;
        let (crank, rod) = size_from_stroke(stroke, ratio, g.offset).unwrap();
        close("ratio", rod / crank, ratio, ratio, 1e-15);
        let sized = Linkage::new(&geometry(crank, rod, g.offset, g.branch));
        prop_assert!(sized.margin() > 0.0);
        // The stroke is sensitive where the crank barely turns fully.
        let steep = (sized.r / sized.margin()).sqrt() * (1.0 + ratio);
        close("stroke", Limits::new(&sized, 0.0).stroke, stroke, stroke * steep, 1e-14);
        prop_assert!(crank >= g.crank * (1.0 - 1e-6), "the longer crank: {} {}", crank, g.crank);
    }

    #[test]
    fn the_first_order_motion_is_what_is_left_of_a_long_rod(
        r in magnitude(0.01, 1.0), e in -1.0..1.0, theta in -7.0..7.0, left in any::<bool>(),
    ) {
        let branch = if left { Branch::Left } else { Branch::Right };
        // The next order is proportional to 1/l², so that ten times the rod leaves a hundredth or less.
        let rest = |l: f64| {
            let linkage = Linkage::new(&geometry(r, l, e * r, branch));
            let (pose, first) = (linkage.pose(theta), linkage.first_order(theta));
            (pose.d2x - first.d2x).abs() * (l / r).powi(3) / r
        };
        prop_assert!(rest(300.0 * r) < 20.0, "{}", rest(300.0 * r));
        let product = |l: f64| {
            let linkage = Linkage::new(&geometry(r, l, e * r, branch));
            let pose = linkage.pose(theta);
            (pose.dx * pose.d2x - linkage.first_order(theta).dx_d2x).abs() * (l / r).powi(2) / (r * r)
        };
        prop_assert!(product(300.0 * r) < 30.0, "{}", product(300.0 * r));
    }

    #[test]
    fn the_closed_loop_is_the_closed_form(g in rotating_crank(0.05), theta in -7.0..7.0) {
        let linkage = Linkage::new(&g);
        let pose = linkage.pose(theta);
        for (guess, sign) in [(PI, 1.0), (0.0, -1.0)] {
            let right = Linkage::new(&geometry(g.crank, g.rod, g.offset, if sign > 0.0 { Branch::Right } else { Branch::Left }));
            let Some(found) = linkage.close_loop(theta, (guess, 0.0), 1e-13 * g.rod) else { continue };
            if branch(&found) == sign {
                let want = right.pose(theta);
                close("x", found.x, want.x, g.rod / pose.cos_phi.powi(2), 1e-12);
                close("theta3", found.theta3.sin(), want.sin_phi, 1.0, 1e-12);
            }
        }
    }
}

/// Obaseki & Alfred (49): without offset the stroke is twice the crank; with 20 mm offset, a stroke of 80 mm needs 36
/// mm.
#[test]
fn sizing_of_obaseki_and_alfred() {
    let (crank, rod) = size_from_stroke(0.08, 1.6, 0.0).unwrap();
    close("crank", crank, 0.04, 0.04, 1e-15);
    close("rod", rod, 0.064, 0.064, 1e-15);
    let (crank, rod) = size_from_stroke(0.08879230742, 1.6, 0.02).unwrap();
    close("crank", crank, 0.04, 0.04, 1e-8);
    close("rod", rod, 0.064, 0.064, 1e-8);
    let said = size_from_stroke(0.08, 1.6, 0.02).unwrap_err().to_string();
    // S (ρ² − 1)/(4 ρ)
    assert!(said.contains("0.0195"), "{said}");
    for (stroke, ratio, offset) in [
        (0.0, 1.6, 0.0),
        (0.1, 1.0, 0.0),
        (0.1, f64::NAN, 0.0),
        (-1.0, 2.0, 0.0),
        (1.0, 2.0, f64::INFINITY),
    ] {
        assert!(size_from_stroke(stroke, ratio, offset).is_err());
    }
}

/// Gupta's bodies, in kg and kg mm²: plain bars, round ends, and ends of half a 20-gon at 7801 kg/m³.
#[test]
fn mass_properties_of_gupta() {
    let mm = 1e-3;
    let check = |shape: Shape, depth: f64, density: f64, want: [f64; 4], digits: f64| {
        let got = shape.plate(depth * mm, density);
        let got = [
            got.mass,
            got.normal * 1e6,
            got.across * 1e6,
            got.along * 1e6,
        ];
        for (got, want) in got.into_iter().zip(want) {
            close("mass property", got, want, want, digits);
        }
    };
    let bar = |length: f64| Shape::rectangle(length * mm, 30.0 * mm);
    let drawn = |length: f64| Shape::polygon_ended(length * mm, 30.0 * mm, 20);
    check(
        bar(140.0),
        20.0,
        7800.0,
        [0.6552, 1119.3, 1092.0, 70.98],
        1e-4,
    );
    check(
        bar(310.0),
        20.0,
        7800.0,
        [1.4508, 11727.3, 11666.85, 157.17],
        1e-5,
    );
    check(
        drawn(140.0),
        20.0,
        7801.0,
        [0.763763, 1758.8819, 1729.192, 80.6074],
        1e-6,
    );
    check(
        drawn(310.0),
        20.0,
        7801.0,
        [1.55946, 14559.335, 14496.491, 166.808],
        4e-6,
    );
    let slider = Shape::rectangle(100.0 * mm, 50.0 * mm);
    check(
        slider,
        50.0,
        7801.0,
        [
            1.95025,
            2031.5104166666667,
            2031.5104166666667,
            812.6041666666666,
        ],
        1e-12,
    );
    for (length, printed) in [(140.0, 0.76547), (310.0, 1.56107)] {
        // With more corners the shape approaches a rectangle with two half discs, whose centroids lie 4r/(3 pi) further
        // out.
        let (l, r) = (length * mm, 15.0 * mm);
        let (bar, disc) = (2.0 * r * l, PI * r * r);
        let centre = 4.0 * r / (3.0 * PI);
        let polar = bar * (l * l + 4.0 * r * r) / 12.0
            + disc * (0.5 * r * r - centre * centre + (0.5 * l + centre).powi(2));
        let lateral = bar * 4.0 * r * r / 12.0 + disc * 0.25 * r * r;
        let per_area = 20.0 * mm * 7800.0;
        let mass = per_area * (bar + disc);
        close("round ends", mass, printed, printed, 1e-5);
        let fine = Shape::polygon_ended(l, 2.0 * r, 20_000).plate(20.0 * mm, 7800.0);
        let thick = mass * (20.0 * mm).powi(2) / 12.0;
        let (normal, along) = (per_area * polar, per_area * lateral + thick);
        close("mass", fine.mass, mass, mass, 1e-7);
        close("inertia", fine.normal, normal, normal, 1e-7);
        close("inertia", fine.along, along, along, 1e-7);
    }
}

#[test]
fn equivalent_masses_of_obaseki_and_alfred() {
    let scene = Scene::new(0.04, 0.064)
        .crank(Crank {
            mass: 0.2,
            cg: 0.02,
            ..Crank::default()
        })
        .rod(Rod {
            mass: 0.5,
            cg: 0.032,
            inertia: 0.5 * 0.064 * 0.064 / 12.0,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.8 });
    let masses = EquivalentMasses::new(&scene);
    for (got, want) in [
        (masses.rotating_kg, 0.35),
        (masses.reciprocating_kg, 1.05),
        (masses.rod_at_crank_pin_kg, 0.25),
        (masses.rod_at_wrist_pin_kg, 0.25),
        (masses.crank_at_pin_kg, 0.1),
        // 0.000170667 kg m² of a uniform rod, 0.000512 kg m² of its two masses.
        (masses.rod_inertia_left_kg_m2, 0.0001706666667 - 0.000512),
    ] {
        close("mass", got, want, want.abs(), 1e-9);
    }
}

/// Returns the branch sign of a closed loop.
fn branch(found: &Closure) -> f64 {
    if found.theta3.cos() > 0.0 { -1.0 } else { 1.0 }
}

/// Gupta's code: from 180 degrees, 2 to 4 iterations for each of 200 angles, always to the right branch.
#[test]
fn newton_raphson_of_gupta() {
    let linkage = Linkage::new(&geometry(0.14, 0.31, 0.06, Branch::Right));
    let run = |guess: f64| -> Vec<_> {
        (0..200)
            .map(|i| {
                linkage.close_loop(TAU * f64::from(i) / 199.0, (guess.to_radians(), 0.04), 1e-9)
            })
            .collect()
    };
    let good: Vec<_> = run(180.0).into_iter().map(Option::unwrap).collect();
    let steps: Vec<_> = good.iter().map(|found| found.iterations).collect();
    assert_eq!(
        (steps.iter().min(), steps.iter().max()),
        (Some(&2), Some(&4))
    );
    assert!(good.iter().all(|found| branch(found) == 1.0));
    assert!(
        run(0.0)
            .into_iter()
            .all(|found| branch(&found.unwrap()) == -1.0)
    );
    let mixed: Vec<_> = run(89.0)
        .into_iter()
        .flatten()
        .map(|found| branch(&found))
        .collect();
    assert!(mixed.contains(&1.0) && mixed.contains(&-1.0));
    let upright = Linkage::new(&geometry(0.1, 0.3, 0.0, Branch::Right));
    let never = Linkage::new(&geometry(0.3, 0.1, 0.0, Branch::Right));
    assert!(never.close_loop(FRAC_PI_2, (PI, 0.0), 1e-9).is_none());
    assert_eq!(upright.close_loop(0.0, (f64::NAN, 0.0), 1e-9), None);
}
