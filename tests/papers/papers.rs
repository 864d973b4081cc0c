//! Numbers of the four source papers, recomputed to ten digits by other software: Obaseki & Alfred 2020, Gupta, Ng,
//! Duarte et al. 2018.

use crate::support::{close, geometry};
use slider_crank::mechanism::{Equation, Linkage, Pose, Reactor};
use slider_crank::scene::{Branch, Crank, Gravity, InertiaAbout, Rod, RodModel, Scene, Slider};
use std::f64::consts::{FRAC_PI_2, TAU};

const MM: f64 = 1e-3;
const KG_MM2: f64 = 1e-6;

/// Checks agreement to the digits given.
#[track_caller]
fn agrees(what: &str, got: f64, want: f64) {
    close(what, got, want, want.abs(), 1e-9);
}

fn pose(crank: f64, rod: f64, offset: f64, theta: f64) -> Pose {
    Linkage::new(&geometry(crank, rod, offset, Branch::Right)).pose(theta)
}

/// Speed of the engine of Obaseki & Alfred, rad/s, without gravity.
const SPEED: f64 = 251.0;

fn obaseki(offset: f64) -> Scene {
    Scene::new(40.0 * MM, 64.0 * MM)
        .offset(offset)
        .constant_speed(0.0, SPEED)
}

/// Returns their masses lumped at the pins: 0.35 kg at the crank pin, 1.05 kg at the wrist pin.
fn lumped(offset: f64) -> Scene {
    let (at_crank_pin, r) = (0.35, 40.0 * MM);
    let crank = Crank {
        mass: at_crank_pin,
        cg: r,
        cg_lateral: 0.0,
        inertia: at_crank_pin * r * r,
    };
    obaseki(offset).crank(crank).slider(Slider { mass: 1.05 })
}

#[test]
fn motion_of_the_engine_of_obaseki_and_alfred() {
    let pose = pose(40.0 * MM, 64.0 * MM, 20.0 * MM, 1.0);
    agrees("x", pose.x, 0.05649373433);
    agrees("v", pose.dx * SPEED, -16.79314860);
    agrees("a", pose.d2x * SPEED * SPEED, -939.4781244);
    agrees("rod speed", pose.dphi * SPEED, 155.5154753);
    agrees("rod acceleration", pose.d2phi * SPEED * SPEED, -23588.28530);
}

#[test]
fn forces_of_the_engine_of_obaseki_and_alfred() {
    let scene = lumped(20.0 * MM);
    let equation = Equation::new(&scene);
    agrees(
        "driving torque",
        equation.driving_torque(0.0, 1.0, SPEED, 0.0),
        65.99854797,
    );
    let forces = Reactor::new(&scene)
        .unwrap()
        .at(&equation, 0.0, 1.0, SPEED, 0.0);
    agrees(
        "rod tension",
        forces.wrist_pin[0].hypot(forces.wrist_pin[1]),
        1809.918518,
    );
    agrees("slider inertia force", -forces.wrist_pin[0], 986.4520307);
    agrees("bearing, x", forces.crank_bearing[0], -1463.006229);
    close("bearing, y", forces.crank_bearing[1], 775.3, 1.0, 0.05);
    agrees("shaking force", forces.shaking[0], 1463.006229);
}

#[test]
fn bearing_force_with_uniform_links() {
    let (crank, rod, r, l) = (0.2, 0.5, 40.0 * MM, 64.0 * MM);
    let scene = obaseki(20.0 * MM)
        .crank(Crank {
            mass: crank,
            cg: r / 2.0,
            cg_lateral: 0.0,
            inertia: crank * r * r / 3.0,
        })
        .rod(Rod {
            mass: rod,
            cg: l / 2.0,
            inertia: rod * l * l / 12.0,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.8 });
    let forces = Reactor::new(&scene)
        .unwrap()
        .at(&Equation::new(&scene), 0.0, 1.0, SPEED, 0.0);
    agrees("bearing, x", forces.crank_bearing[0], -1463.006229);
    agrees("bearing, y", forces.crank_bearing[1], 1006.104053);
}

#[test]
fn extreme_driving_torques_of_the_engine_of_obaseki_and_alfred() {
    for (offset, inward, outward) in [
        (
            20.0,
            [-316.0611128, 185.2973566],
            [-81.30245599, 47.50780798],
        ),
        (
            10.0,
            [-133.7494065, 130.3897829],
            [-90.42377844, 62.15235530],
        ),
        (
            0.0,
            [-85.72588325, 105.0859843],
            [-105.0859843, 85.72588325],
        ),
    ] {
        let equation = Equation::new(&lumped(offset * MM));
        let mut found = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        for i in 0..200_000 {
            let theta = TAU * f64::from(i) / 200_000.0;
            let torque = equation.driving_torque(0.0, theta, SPEED, 0.0);
            let stroke = &mut found[usize::from(equation.linkage().pose(theta).dx > 0.0)];
            *stroke = [stroke[0].min(torque), stroke[1].max(torque)];
        }
        for (found, want) in found.iter().flatten().zip(inward.iter().chain(&outward)) {
            close("extreme torque", *found, *want, want.abs(), 1e-7);
        }
    }
}

#[test]
fn motion_of_the_mechanism_of_gupta() {
    let speed = 31.416;
    for (degrees, theta3, x, omega3, v, alpha3, a) in [
        (
            0.0f64,
            168.8400631,
            444.1381265,
            -14.46132404,
            -867.6794423,
            -41.25689114,
            -204254.8951,
        ),
        (
            120.0,
            144.2212635,
            181.4970640,
            8.744117982,
            -2224.172530,
            420.7021035,
            126107.7347,
        ),
        (
            240.0,
            191.3943024,
            233.8901558,
            7.236562153,
            3365.794769,
            -383.2172878,
            76643.07499,
        ),
    ] {
        let pose = pose(140.0 * MM, 310.0 * MM, 60.0 * MM, degrees.to_radians());
        // Gupta's rod points from slider to crank pin.
        agrees("theta3", 180.0 - pose.phi().to_degrees(), theta3);
        agrees("R4", pose.x / MM, x);
        agrees("omega3", -pose.dphi * speed, omega3);
        agrees("dR4/dt", pose.dx * speed / MM, v);
        agrees("alpha3", -pose.d2phi * speed * speed, alpha3);
        agrees("d2R4/dt2", pose.d2x * speed * speed / MM, a);
    }
}

#[test]
fn static_slider_force_of_ng() {
    for (degrees, force) in [
        (10.0f64, 22.7225),
        (90.0, 5.29740),
        (120.0, 7.47822),
        (160.0, 23.0693),
    ] {
        let pose = pose(25.0 * MM, 72.0 * MM, 0.0, degrees.to_radians());
        close(
            "force against 132.435 N mm",
            -0.132435 / pose.dx,
            force,
            force,
            3e-6,
        );
    }
}

#[test]
fn terms_of_the_equation_of_duarte() {
    let (about_pin, about_cg) = (InertiaAbout::CrankPin, InertiaAbout::Cg);
    for (model, inertia_about, m, half_dm, dv) in [
        (
            RodModel::SpinOnly,
            about_pin,
            0.02876701070,
            0.0005181640458,
            1.335367404,
        ),
        (
            RodModel::Rigid,
            about_pin,
            0.03006015904,
            0.001227803339,
            0.2039306753,
        ),
        (
            RodModel::Rigid,
            about_cg,
            0.03018423342,
            0.001129076477,
            0.2039306753,
        ),
    ] {
        let scene = Scene::new(47.0 * MM, 155.83 * MM)
            .crank(Crank {
                mass: 15.3351,
                cg: 0.0,
                cg_lateral: 0.0,
                inertia: 27698.81 * KG_MM2,
            })
            .rod(Rod {
                model,
                mass: 0.8602,
                cg: 51.07 * MM,
                cg_lateral: 0.0,
                inertia: 5807.55 * KG_MM2,
                inertia_about,
            })
            .slider(Slider { mass: 0.5341 })
            .gravity(Gravity {
                acceleration: 9.81,
                direction: -FRAC_PI_2,
            });
        let terms = Equation::new(&scene).terms(0.7);
        agrees("M", terms.m, m);
        agrees("M'/2", terms.half_dm, half_dm);
        agrees("V'", terms.dv, dv);
        let slider_force = Equation::new(&scene).terms(0.7).pose.dx;
        agrees("work of a unit force", slider_force, -0.03739865745);
    }
}
