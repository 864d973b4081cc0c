//! Gupta: offset slider-crank in a multibody program and by Newton-Raphson, equations (1)-(11).

use std::f64::consts::{PI, TAU};

use super::drawing::{Drawing, Plot, sampled};
use super::entry::{Claim, about, formula, number};
use crate::mechanism::{Extremes, Limits, Linkage, Pose, Shape};
use crate::scene::Scene;

/// m, rad/s
const CRANK: f64 = 0.14;
const ROD: f64 = 0.31;
const OFFSET: f64 = 0.06;
const SPEED: f64 = 31.416;
/// Initial guess of the script: 180 degrees and 40 mm, and its tolerance of 1e-6 mm.
const GUESS: (f64, f64) = (PI, 0.04);
const TOLERANCE: f64 = 1e-9;
/// Crank angle at which the equations are compared, deg.
const TEST_ANGLE: f64 = 120.0;

fn linkage(crank: f64, rod: f64) -> Linkage {
    Linkage::new(&Scene::new(crank, rod).offset(OFFSET).geometry)
}

fn original() -> Linkage {
    linkage(CRANK, ROD)
}

/// Position, velocity and acceleration by the script: theta3, R4, omega3, R4', alpha3, R4'', SI.
fn script(theta: f64) -> [f64; 6] {
    let Ok(found) = original().close_loop(theta, GUESS, TOLERANCE) else {
        return [f64::NAN; 6];
    };
    let (sin3, cos3) = found.theta3.sin_cos();
    let omega3 = CRANK * theta.cos() * SPEED / (ROD * cos3);
    let velocity = ROD * sin3 * omega3 - CRANK * theta.sin() * SPEED;
    let alpha3 =
        (ROD * sin3 * omega3 * omega3 - CRANK * theta.sin() * SPEED * SPEED) / (ROD * cos3);
    let acceleration =
        ROD * cos3 * omega3 * omega3 + ROD * sin3 * alpha3 - CRANK * theta.cos() * SPEED * SPEED;
    [
        found.theta3,
        found.x,
        omega3,
        velocity,
        alpha3,
        acceleration,
    ]
}

/// The same in closed form; the script's rod points from the slider to the crank pin.
fn closed_form(theta: f64) -> [f64; 6] {
    let pose = original().pose(theta);
    [
        PI - pose.phi(),
        pose.x,
        -pose.dphi * SPEED,
        pose.dx * SPEED,
        -pose.d2phi * SPEED * SPEED,
        pose.d2x * SPEED * SPEED,
    ]
}

pub(super) fn claims() -> Vec<Claim> {
    let mut claims = masses();
    claims.extend(motion());
    claims.extend(iteration());
    claims
}

fn masses() -> Vec<Claim> {
    let mut claims = Vec::new();
    // Mass in kg, then the moments of inertia in kg mm2 in the order of the paper.
    let bodies = [
        ("AB", 0.14, ["0.764", "1758.88", "1729.192", "80.607"]),
        ("BC", 0.31, ["1.56", "14559.33482", "14496.4", "166.808"]),
    ];
    let as_list = |shape: Shape, depth: f64, density: f64| {
        let p = shape.plate(depth, density);
        [p.mass, p.normal * 1e6, p.across * 1e6, p.along * 1e6]
    };
    let what = |i: usize, body: &str| match i {
        0 => format!("mass of {body}"),
        _ => format!("{} of {body}", ["Mxx", "Myy", "Mzz"][i - 1]),
    };
    let unit = |i: usize| if i == 0 { "kg" } else { "kg mm2" };
    let place = |i: usize| if i == 0 { "1.2.2" } else { "1.2.3" };
    for (body, length, printed) in bodies {
        let bar = as_list(Shape::rectangle(length, 0.03), 0.02, 7800.0);
        let drawn = as_list(Shape::polygon_ended(length, 0.03, 20), 0.02, 7801.0);
        let condition = "7801 kg/m3 and half-round ends drawn as half of a 20-gon each";
        for (i, text) in printed.into_iter().enumerate() {
            let claim = number(place(i), &what(i, body), unit(i), text, bar[i]);
            claims.push(match text {
                "14496.4" => claim.only_if_cut(condition, drawn[i]),
                _ => claim.only_if(condition, drawn[i]),
            });
        }
    }
    let block = |density: f64| as_list(Shape::rectangle(0.1, 0.05), 0.05, density);
    let (ours, denser) = (block(7800.0), block(7801.0));
    for (i, text) in ["1.95", "2031.51", "2031.51", "812.6041"]
        .into_iter()
        .enumerate()
    {
        let claim = number(place(i), &what(i, "slider D"), unit(i), text, ours[i]);
        claims.push(match i {
            0 => claim,
            3 => claim.only_if_cut("the density is 7801 kg/m3", denser[i]),
            _ => claim.only_if("the density is 7801 kg/m3", denser[i]),
        });
    }
    claims
}

fn motion() -> Vec<Claim> {
    let theta = TEST_ANGLE.to_radians();
    let (script, ours) = (script(theta), closed_form(theta));
    let names = [
        ("(3)", "rod angle theta3 at 120 deg", "rad"),
        ("(2)", "slider position R4 at 120 deg", "m"),
        ("(6)", "rod speed at 120 deg", "rad/s"),
        ("(7)", "slider velocity at 120 deg", "m/s"),
        ("(10)", "rod acceleration at 120 deg", "rad/s2"),
        ("(11)", "slider acceleration at 120 deg", "m/s2"),
    ];
    let mut claims = vec![
        number(
            "1.4.1",
            "crank speed of 300 rpm",
            "rad/s",
            "31.416",
            300.0 * TAU / 60.0,
        ),
        number("1.4.1", "time of one turn", "s", "0.2", TAU / SPEED),
    ];
    for (i, (place, what, unit)) in names.into_iter().enumerate() {
        claims.push(formula(place, what, unit, script[i], ours[i]));
    }
    let limits = Limits::new(&original(), SPEED);
    let largest = Extremes::new(&original()).map_or(f64::NAN, |e| {
        e.acceleration_max
            .value
            .abs()
            .max(e.acceleration_min.value.abs())
    });
    for centre in &limits.dead_centres {
        let name = if centre.outer { "outer" } else { "inner" };
        let there = original().pose(centre.theta).d2x.abs();
        claims.push(
            formula(
                "2.1.4",
                &format!("largest acceleration, said to be at the {name} position"),
                "m/s2",
                there * SPEED * SPEED,
                largest * SPEED * SPEED,
            )
            .cannot("with an offset the largest acceleration is not at a dead centre"),
        );
    }
    claims
}

fn iteration() -> Vec<Claim> {
    let last = |size: u32, i: u32| 360.0 * f64::from(i) / f64::from(size - 1);
    let mut claims = Vec::new();
    for (i, text) in ["0", "90", "270", "360"].into_iter().enumerate() {
        let i = i as u32;
        let of_five = [0, 1, 3, 4][i as usize];
        let claim = number(
            "3.1",
            &format!("crank angle {} of `size = 4`", i + 1),
            "deg",
            text,
            last(4, i),
        );
        claims.push(if text == "0" || text == "360" {
            claim
        } else {
            claim.only_if("size is 5", last(5, of_five))
        });
    }
    let worst = (0..200)
        .map(|i| TAU * f64::from(i) / 199.0)
        .map(|theta| {
            let (script, ours) = (script(theta), closed_form(theta));
            (0..6)
                .map(|i| (script[i] / ours[i] - 1.0).abs())
                .fold(0.0, f64::max)
        })
        .fold(0.0, f64::max);
    claims.push(about(
        "3.2.4",
        "least agreement of the 200 positions of the script with the closed form",
        "%",
        99.0,
        1.0,
        100.0 * (1.0 - worst),
    ));
    claims
}

fn quantity(i: usize) -> &'static str {
    [
        "slider position [m]",
        "slider velocity [m/s]",
        "slider acceleration [m/s2]",
    ][i]
}

fn motion_of(pose: &Pose, i: usize) -> f64 {
    [pose.x, pose.dx * SPEED, pose.d2x * SPEED * SPEED][i]
}

pub(super) fn drawings() -> Vec<Drawing> {
    let names = ["Displacement", "Velocity", "Acceleration"];
    let over_time = |linkage: Linkage, i: usize| {
        sampled(0.0, 0.2, 400, |t| motion_of(&linkage.pose(SPEED * t), i))
    };
    let mut found = Vec::new();
    for (i, name) in names.into_iter().enumerate() {
        let plot = Plot::new("time [s]", quantity(i)).line("ours", over_time(original(), i));
        found.push(Drawing::new(
            &format!("figure-{:02}", 4 + i),
            &format!("{name} of the slider"),
            vec![plot],
        ));
    }
    let changes = [
        ("AB 140 to 150 mm", linkage(0.15, ROD)),
        ("BC 310 to 320 mm", linkage(CRANK, 0.32)),
    ];
    for (i, name) in names.into_iter().enumerate() {
        for (k, (label, changed)) in changes.into_iter().enumerate() {
            let plot = Plot::new("time [s]", quantity(i))
                .line("140, 310, 60 mm", over_time(original(), i))
                .dashed(label, over_time(changed, i));
            found.push(Drawing::new(
                &format!("figure-{:02}", 7 + 2 * i + k),
                &format!("{name}, {label}"),
                vec![plot],
            ));
        }
    }
    found.push(six_panels());
    for (i, name) in names.into_iter().enumerate() {
        let column = [1, 3, 5][i];
        let sample = |size: u32| {
            sampled(0.0, 360.0, size - 1, |degrees| {
                script(degrees.to_radians())[column]
            })
        };
        let plot = Plot::new("crank angle [deg]", quantity(i))
            .line(
                "closed form",
                sampled(0.0, 360.0, 360, |degrees| {
                    motion_of(&original().pose(degrees.to_radians()), i)
                }),
            )
            .points("script, size = 4", sample(4))
            .points("script, size = 5", sample(5));
        found.push(Drawing::new(
            &format!("figure-{:02}", 20 + i),
            &format!("{name}, script and closed form"),
            vec![plot],
        ));
    }
    found
}

fn six_panels() -> Drawing {
    let names = [
        "theta3 [rad]",
        "R4 [m]",
        "omega3 [rad/s]",
        "R4 dot [m/s]",
        "alpha3 [rad/s2]",
        "R4 dotdot [m/s2]",
    ];
    let panel = |(i, name): (usize, &'static str)| {
        let of = |f: fn(f64) -> [f64; 6]| sampled(0.0, TAU, 199, move |theta| f(theta)[i]);
        Plot::new("theta2 [rad]", name)
            .line("script", of(script))
            .dashed("closed form", of(closed_form))
    };
    let plots = names.into_iter().enumerate().map(panel).collect();
    Drawing::new(
        "figure-19",
        "The six quantities of the script, 200 positions",
        plots,
    )
}
