//! Narrow pulses of loads on a mechanism with a loose joint: none is stepped over, in flight or in contact.

use slider_crank::scene::{
    Clearance, ContactLaw, Crank, Expression, Interpolation, Joint, Load, Rod, RodModel, Scene,
    Slider, Table, Variable,
};
use slider_crank::simulate::{Options, simulate};

/// Crank inertia, kg m².
const INERTIA: f64 = 0.02;
/// Start speed, rad/s.
const SPEED: f64 = 5.0;
/// Duration, s; the gap does not close before it ends.
const DURATION: f64 = 0.02;
/// Constant torque, N m.
const TORQUE: f64 = 0.05;

fn loose(load: &str) -> Scene {
    let formula = Expression::parse(load).expect("a formula");
    let mut scene = Scene::new(0.05, 0.15)
        .crank(Crank {
            inertia: INERTIA,
            ..Crank::default()
        })
        .rod(Rod {
            model: RodModel::Rigid,
            mass: 0.4,
            cg: 0.07,
            inertia: 0.002,
            ..Rod::default()
        })
        .slider(Slider { mass: 0.6 })
        .torque(Load::Constant(TORQUE))
        .torque(Load::Expression(formula))
        .start(1.0, SPEED)
        .duration(DURATION);
    scene.clearance = Some(Clearance {
        bearing_radius: Some(0.01),
        young_modulus: Some(207e9),
        poisson_ratio: Some(0.3),
        restitution: Some(0.9),
        ..Clearance::new(Joint::CrankPin, 2e-3)
    });
    scene
}

/// A crank with a loose pin turns freely until the gap closes: I dω = T dt and I ω dω = T dθ.
#[test]
fn pulses_in_flight_change_the_speed_as_their_area_says() {
    let free = SPEED + TORQUE * DURATION / INERTIA;
    for width in [1e-3, 1e-4, 1e-6] {
        // Box pulse of 1e-3 N m s.
        let (height, from) = (1e-3 / width, 0.013);
        let box_in_time = format!("{height}*step(t-{from})*step({from}+{width}-t)");
        // Gaussian bell of the same area.
        let bell = format!("{height}*exp(-((t-{from})/{width})^2)/sqrt(pi)");
        // Passes from one speed to the next with more torque, which shifts the time.
        let more = 30.0 * TORQUE;
        let box_of_speed = format!("{more}*step(omega-5.02)*step(5.02+{width}-omega)");
        let saved = width * INERTIA * (1.0 / TORQUE - 1.0 / (TORQUE + more));
        for (load, speed) in [
            (box_in_time, free + 1e-3 / INERTIA),
            (bell, free + 1e-3 / INERTIA),
            (box_of_speed, free + saved * TORQUE / INERTIA),
        ] {
            let summary = simulate(&loose(&load), &Options::default())
                .expect("a run")
                .summary;
            let stated = summary.error_estimate.expect("an estimate").omega_rad_per_s;
            let off = (summary.last.omega_rad_per_s - speed).abs();
            assert!(
                summary.clearance.is_some_and(|loose| loose.impacts == 0),
                "{load}"
            );
            assert!(
                off <= 2.0 * stated + 1e-11,
                "{load}: {off:e}, stated {stated:e}"
            );
        }
    }
}

/// Tent over time as a formula, and as a table, whose rows end steps: in contact, in flight and with a massless link.
#[test]
fn a_formula_does_what_its_table_does() {
    for law in [ContactLaw::LankaraniNikravesh, ContactLaw::MasslessLink] {
        for (from, width) in [(0.031, 1e-3), (0.0317, 1e-5), (0.0291, 2e-7)] {
            let height = 4e-3 / width;
            let formula = format!("{height}*max(0, 1-abs(t-{from})/{width})");
            let rows = [-1.0, from - width, from, from + width, 1.0];
            let values = [0.0, 0.0, height, 0.0, 0.0];
            let table = Table::new(Variable::T, &rows, &values, Interpolation::Linear, None);
            let last = |load: Load| {
                let mut scene = loose("0").torque(load).duration(0.045);
                let clearance = scene.clearance.as_mut().expect("a clearance");
                (clearance.law, clearance.radial) = (law, 1e-4);
                let summary = simulate(&scene, &Options::default())
                    .expect("a run")
                    .summary;
                let stated = summary.error_estimate.expect("an estimate").omega_rad_per_s;
                let joint = summary.clearance.expect("a joint");
                assert!(law != ContactLaw::LankaraniNikravesh || joint.impacts > 0);
                (summary.last.omega_rad_per_s, stated, joint.last.x_m)
            };
            let formula = Expression::parse(&formula).expect("a formula");
            let (speed, stated, x) = last(Load::Expression(formula));
            let (tabled, also, at) = last(Load::Table(table.expect("a table")));
            let off = (speed - tabled).abs();
            assert!(
                off <= 2.0 * (stated + also),
                "{law:?} {width}: {off:e}, stated {stated:e}, {also:e}"
            );
            assert!((x - at).abs() <= 1e-9, "{law:?} {width}: {x} {at}");
        }
    }
}
