//! Figures 2-6: the motion (11), and the slider force along it.

use super::super::drawing::{Drawing, Plot, sampled};
use super::{engine, interior_angle, motion, printed};
use crate::mechanism::Linkage;
use crate::scene::Scene;

/// The range over which the polynomial looks like figure 3, s.
const END: f64 = 2.5;

/// Slider force along the motion by terms of the equation, N; none within 0.2 mm of lever arm.
fn force(t: f64, terms: impl Fn(f64) -> [f64; 4]) -> f64 {
    let [theta, speed, acceleration] = motion(t);
    let [m, half_dm, dv, arm] = terms(theta);
    if arm.abs() < 2e-4 {
        return f64::NAN;
    }
    (m * acceleration + half_dm * speed * speed + dv) / arm
}

/// Those of the complete equation at a crank angle, rad.
fn ours(theta: f64) -> [f64; 4] {
    let terms = engine().terms(theta);
    [
        terms.inertia.m,
        terms.inertia.half_dm,
        terms.dv,
        terms.pose.dx,
    ]
}

pub fn drawings() -> Vec<Drawing> {
    let time = "time [s]";
    let linkage = Linkage::new(&Scene::duarte().geometry);
    let gamma = |t: f64| interior_angle(&linkage.pose(motion(t)[0])).to_degrees();
    let over_time = |f: &dyn Fn(f64) -> f64| sampled(0.0, END, 1000, f);
    let figure = |number: u32, title: &str, plot: Plot| {
        Drawing::new(&format!("figure-{number:02}"), title, vec![plot])
    };
    vec![
        figure(
            2,
            "Angle at the crank pin, from the polynomial (11)",
            Plot::new(time, "gamma [deg]").line("(10) of (11)", over_time(&gamma)),
        ),
        figure(
            3,
            "Crank angle",
            Plot::new(time, "theta [rad]").line("(11)", over_time(&|t| motion(t)[0])),
        ),
        figure(
            4,
            "Crank speed",
            Plot::new(time, "d theta/dt [rad/s]").line("(11)", over_time(&|t| motion(t)[1])),
        ),
        figure(
            5,
            "Crank acceleration",
            Plot::new(time, "d2 theta/dt2 [rad/s2]").line("(11)", over_time(&|t| motion(t)[2])),
        ),
        figure(
            6,
            "Slider force along the motion (11), balanced crank",
            Plot::new(time, "slider force [N]")
                .line("complete equation", over_time(&|t| force(t, ours)))
                .dashed(
                    "(9) as printed",
                    over_time(&|t| force(t, |theta| printed(theta, -1.0))),
                ),
        ),
    ]
}
