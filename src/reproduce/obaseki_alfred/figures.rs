//! Figures 5 to 19.

use std::f64::consts::TAU;

use super::super::drawing::{Drawing, Plot, sampled};
use super::equations::printed;
use super::printed::{Printed, existing_acceleration, existing_torque};
use super::results::{EXPERIMENT, EXPERIMENT_SPEED};
use super::{CRANK, OFFSET, ROD, SPEED, engine};
use crate::error::Error;
use crate::kinematics::{ForceAnalysis, forces};
use crate::mechanism::{Linkage, Pose};
use crate::scene::Scene;

const TIME: &str = "time [s]";
const ANGLE: &str = "crank angle [deg]";
const ACCELERATION: &str = "slider acceleration d2x/dt2 [m/s2]";
const TORQUE: &str = "torque [N m]";
/// The range of table 1 from its start at 0, s.
const END: f64 = 0.06;
/// Two turns of figures 15 and 16, deg.
const TWO_TURNS: f64 = 720.0;

type Curve = Vec<(f64, f64)>;

fn over_time(f: impl Fn(f64) -> f64) -> Curve {
    sampled(0.0, END, 1200, |t| f(SPEED * t))
}

fn over_angle(to: f64, f: impl Fn(f64) -> f64) -> Curve {
    sampled(0.0, to, to as u32, |degrees| f(degrees.to_radians()))
}

/// Where a printed formula has a pole its curve is left open.
fn within(limit: f64, points: Curve) -> Curve {
    let open = |(x, y): (f64, f64)| (x, if y.abs() <= limit { y } else { f64::NAN });
    points.into_iter().map(open).collect()
}

pub fn drawings() -> Result<Vec<Drawing>, Error> {
    let mut found = motion();
    found.extend(reactions()?);
    found.extend(offsets()?);
    found.extend(existing());
    Ok(found)
}

fn figure(number: u32, title: &str, plot: Plot) -> Drawing {
    Drawing::new(&format!("figure-{number:02}"), title, vec![plot])
}

fn motion() -> Vec<Drawing> {
    let linkage = Linkage::new(&engine(OFFSET).geometry);
    let pose = |theta: f64| -> Pose { linkage.pose(theta) };
    let at = |theta: f64| Printed { theta, ..printed() };
    let s = |theta: f64| CRANK + ROD - pose(theta).x;
    let squared = SPEED * SPEED;
    vec![
        figure(
            5,
            "Stroke against time",
            Plot::new(TIME, "s = k + c - x [m]")
                .line("ours", over_time(s))
                .dashed("(10) as printed", over_time(|theta| at(theta).s())),
        ),
        figure(
            6,
            "Stroke against crank angle",
            Plot::new(ANGLE, "s = k + c - x [m]")
                .line("ours", over_angle(360.0, s))
                .dashed("(10) as printed", over_angle(360.0, |theta| at(theta).s())),
        ),
        figure(
            7,
            "Velocity of the slider",
            Plot::new(TIME, "ds/dt [m/s]").line("ours", over_time(|theta| -pose(theta).dx * SPEED)),
        ),
        figure(
            8,
            "Acceleration of the slider",
            Plot::new(TIME, "d2s/dt2 [m/s2]")
                .line("ours", over_time(|theta| -pose(theta).d2x * squared))
                .dashed(
                    "(20) with its exponents mended: d2x/dt2",
                    over_time(|theta| at(theta).acceleration_mended()),
                ),
        ),
        figure(
            9,
            "Angular speed of the rod",
            Plot::new(TIME, "d alpha/dt [rad/s]")
                .line("ours", over_time(|theta| pose(theta).dphi * SPEED)),
        ),
        figure(
            10,
            "Angular acceleration of the rod",
            Plot::new(TIME, "d2 alpha/dt2 [rad/s2]")
                .line("ours", over_time(|theta| pose(theta).d2phi * squared))
                .dashed(
                    "(30) as printed",
                    over_time(|theta| at(theta).rod_acceleration(-1.0)),
                ),
        ),
    ]
}

fn reactions() -> Result<Vec<Drawing>, Error> {
    let result = forces(&engine(OFFSET))?;
    let at = |theta: f64| Printed { theta, ..printed() };
    let bearing = |i: usize| over_time(|theta| result.row(theta).reactions.crank_bearing[i]);
    let radial = |theta: f64| -at(theta).crank_force();
    let mended = |theta: f64| at(theta).acceleration_mended();
    Ok(vec![
        figure(
            11,
            "Horizontal reaction at the crank centre",
            Plot::new(TIME, "force [N]")
                .line("ours", bearing(0))
                .dashed(
                    "(38) as printed",
                    over_time(|theta| radial(theta) * theta.cos()),
                ),
        ),
        figure(
            12,
            "Vertical reaction at the crank centre",
            Plot::new(TIME, "force [N]")
                .line("ours", bearing(1))
                .dashed(
                    "(39) as printed",
                    over_time(|theta| radial(theta) * theta.sin()),
                ),
        ),
        figure(
            13,
            "Inertia force along x",
            Plot::new(TIME, "shaking force [N]")
                .line(
                    "ours",
                    over_time(|theta| result.row(theta).reactions.shaking[0]),
                )
                .dashed(
                    "(46b), (20) mended",
                    over_time(|theta| at(theta).inertia(mended(theta))),
                ),
        ),
        figure(
            14,
            "Torque, e = 20 mm",
            Plot::new(TIME, TORQUE)
                .line(
                    "driving torque, ours",
                    over_time(|theta| result.torque(theta)),
                )
                .dashed(
                    "(48), (20) mended",
                    over_time(|theta| at(theta).torque(mended(theta))),
                ),
        ),
    ])
}

fn offsets() -> Result<Vec<Drawing>, Error> {
    let (mut accelerations, mut torques) = (
        Plot::new(ANGLE, ACCELERATION),
        Plot::new(ANGLE, "driving torque [N m]"),
    );
    for offset in [0.02, 0.01, 0.0] {
        let scene = engine(offset);
        let linkage = Linkage::new(&scene.geometry);
        let result: ForceAnalysis = forces(&scene)?;
        let label = format!("e = {} mm", offset * 1e3);
        accelerations = accelerations.line(
            &label,
            over_angle(TWO_TURNS, |theta| linkage.pose(theta).d2x * SPEED * SPEED),
        );
        torques = torques.line(&label, over_angle(TWO_TURNS, |theta| result.torque(theta)));
    }
    Ok(vec![
        figure(15, "Offset and acceleration", accelerations),
        figure(16, "Offset and torque", torques),
    ])
}

fn existing() -> Vec<Drawing> {
    let straight = Linkage::new(&engine(0.0).geometry);
    let [k, c] = EXPERIMENT;
    let tested = Linkage::new(&Scene::new(k, c).geometry);
    let (squared, m3) = (SPEED * SPEED, printed().m3);
    let slow = EXPERIMENT_SPEED * EXPERIMENT_SPEED;
    let last = TAU / EXPERIMENT_SPEED * 2.0;
    let tested_exact = sampled(0.0, last, 800, |t| {
        tested.pose(EXPERIMENT_SPEED * t).d2x * slow
    });
    let tested_existing = sampled(0.0, last, 800, |t| {
        existing_acceleration(EXPERIMENT, EXPERIMENT_SPEED, EXPERIMENT_SPEED * t)
    });
    let level = |value: f64| vec![(0.0, value), (last, value)];
    vec![
        figure(
            17,
            "Acceleration and the existing model, e = 0",
            Plot::new(ANGLE, ACCELERATION)
                .line(
                    "exact",
                    over_angle(360.0, |theta| straight.pose(theta).d2x * squared),
                )
                .dashed(
                    "(52)",
                    over_angle(360.0, |theta| {
                        existing_acceleration([CRANK, ROD], SPEED, theta)
                    }),
                ),
        ),
        figure(
            18,
            "Inertia torque and the existing model, e = 0",
            Plot::new(ANGLE, "inertia torque [N m]")
                .line(
                    "exact",
                    over_angle(360.0, |theta| {
                        let pose = straight.pose(theta);
                        -m3 * squared * pose.dx * pose.d2x
                    }),
                )
                .dashed(
                    "(53)",
                    over_angle(360.0, |theta| {
                        existing_torque(m3, [CRANK, ROD], SPEED, theta)
                    }),
                )
                .dashed(
                    "k F_i tan alpha, (48)",
                    within(
                        400.0,
                        over_angle(360.0, |theta| {
                            let at = Printed {
                                theta,
                                e: 0.0,
                                ..printed()
                            };
                            at.torque(at.acceleration_mended())
                        }),
                    ),
                ),
        ),
        figure(
            19,
            "Acceleration and the extremes measured",
            Plot::new(TIME, ACCELERATION)
                .line("exact", tested_exact)
                .dashed("(52)", tested_existing)
                .dashed("measured maximum, table 3", level(19.56))
                .dashed("measured minimum, table 3", level(-13.97)),
        ),
    ]
}
