//! Duarte, Valencia and Obregon 2018: Lagrange equation of a Diesel engine, equations (1)-(11).

use super::drawing::{Drawing, Plot, sampled};
use super::entry::{Claim, formula, number, without_data};
use crate::mechanism::{Equation, Linkage};
use crate::scene::{Gravity, Scene};

/// Table 1, SI.
const CRANK: f64 = 0.047;
const ROD: f64 = 0.15583;
const CRANK_INERTIA: f64 = 27698.81e-6;
const ROD_INERTIA: f64 = 5807.55e-6;
const ROD_MASS: f64 = 0.8602;
const SLIDER_MASS: f64 = 0.5341;
const ROD_CG: f64 = 0.05107;
const G: f64 = 9.81;
/// Where the terms are compared, rad.
const TEST_ANGLE: f64 = 0.7;
/// The polynomial (11), from the constant on.
const MOTION: [f64; 5] = [0.0649, 0.522, 2.166, -2.129, 0.472];
/// The range over which the polynomial looks like figure 3, s.
const END: f64 = 2.5;

/// The complete equation of the engine; the rod's inertia is about the crank pin, the crank balanced.
fn engine() -> Equation {
    let gravity = Gravity {
        acceleration: G,
        ..Gravity::standard()
    };
    Equation::new(&Scene::duarte().gravity(gravity))
}

/// Angle, speed and acceleration of (11).
fn motion(t: f64) -> [f64; 3] {
    let [c0, c1, c2, c3, c4] = MOTION;
    [
        c0 + t * (c1 + t * (c2 + t * (c3 + t * c4))),
        c1 + t * (2.0 * c2 + t * (3.0 * c3 + t * 4.0 * c4)),
        2.0 * c2 + t * (6.0 * c3 + t * 12.0 * c4),
    ]
}

/// (9) as printed: the factors of acceleration and of the speed's square, the weight, and the lever arm of
/// the force. `sign` is that of L2² sin² in the slider's term of the second factor, printed as −1.
fn printed(theta: f64, sign: f64) -> [f64; 4] {
    let (sin, cos) = theta.sin_cos();
    let (c2, r2, rs) = (ROD * ROD, CRANK * CRANK, CRANK * CRANK * sin * sin);
    let w2 = c2 - rs;
    let first = CRANK_INERTIA
        + ROD_INERTIA * r2 * cos * cos / w2
        + SLIDER_MASS * rs * printed_share(theta).powi(2);
    let second = SLIDER_MASS
        * r2
        * cos
        * sin
        * (ROD - CRANK).powi(2)
        * (c2 + sign * rs)
        * (ROD + CRANK).powi(2)
        / w2.powi(3)
        - ROD_INERTIA * r2 * (c2 - r2) * (2.0 * theta).sin() / (2.0 * w2 * w2);
    let weight = G * cos * ROD_MASS * (ROD + ROD_CG);
    [first, second, weight, lever(theta)]
}

/// The square root of (L3² − L2²)²/(L3² − L2² sin²)² of the slider's term: 1 − (d theta2/d theta)².
fn printed_share(theta: f64) -> f64 {
    let rs = (CRANK * theta.sin()).powi(2);
    (ROD * ROD - CRANK * CRANK) / (ROD * ROD - rs)
}

/// (5) and (6): x'.
fn lever(theta: f64) -> f64 {
    let (sin, cos) = theta.sin_cos();
    let ratio = CRANK / ROD;
    sin * (-CRANK - CRANK * CRANK * cos / (ROD * (1.0 - ratio * ratio * sin * sin).sqrt()))
}

/// The complete terms written out a second time: M, ½ M' by a difference, V'.
fn complete(theta: f64) -> [f64; 3] {
    let inertia = |theta: f64| {
        let (sin, cos) = theta.sin_cos();
        let w = (ROD * ROD - (CRANK * sin).powi(2)).sqrt();
        let spin = CRANK * cos / w;
        let share = ROD_CG / ROD;
        // The rod's centre of gravity between A and P, with the velocities of both.
        let vx = (1.0 - share) * -CRANK * sin + share * lever(theta);
        let vy = (1.0 - share) * CRANK * cos;
        CRANK_INERTIA
            + ROD_MASS * (vx * vx + vy * vy)
            + (ROD_INERTIA - ROD_MASS * ROD_CG * ROD_CG) * spin * spin
            + SLIDER_MASS * lever(theta).powi(2)
    };
    [
        inertia(theta),
        0.5 * crate::numeric::difference::slope(inertia, theta, 1e-3),
        G * theta.cos() * ROD_MASS * CRANK * (1.0 - ROD_CG / ROD),
    ]
}

/// Slider force along the motion by terms of the equation, N; none within 0.2 mm of lever arm.
fn force(t: f64, terms: impl Fn(f64) -> [f64; 4]) -> f64 {
    let [theta, speed, acceleration] = motion(t);
    let [m, half_dm, dv, arm] = terms(theta);
    if arm.abs() < 2e-4 {
        return f64::NAN;
    }
    (m * acceleration + half_dm * speed * speed + dv) / arm
}

fn ours(theta: f64) -> [f64; 4] {
    let terms = engine().terms(theta);
    [
        terms.inertia.m,
        terms.inertia.half_dm,
        terms.dv,
        terms.pose.dx,
    ]
}

pub(super) fn claims() -> Vec<Claim> {
    let theta = TEST_ANGLE;
    let pose = Linkage::new(&Scene::duarte().geometry).pose(theta);
    let ([m, half_dm, weight, arm], mended) = (printed(theta, -1.0), complete(theta));
    let terms = engine().terms(theta);
    let (sin, cos) = theta.sin_cos();
    let inclination = (CRANK / ROD * sin).asin();
    let speed_4 = CRANK * sin * printed_share(theta);
    let start = Linkage::new(&Scene::duarte().geometry).pose(0.0).x;
    let height = CRANK * sin * (1.0 - ROD_CG / ROD);
    let whole = "v4 is -x', and the rod moves with its centre of gravity";
    let ratio = CRANK * cos / (ROD * (1.0 - (CRANK / ROD * sin).powi(2)).sqrt());
    let gamma = std::f64::consts::PI - theta - inclination;
    // Of a quartic through |t|, the folded angle of a crank at constant speed, by Legendre polynomials:
    // the explained variance is (5/8)²/5 + (3/16)²/9 of 1/12.
    let one_fold = (25.0 / 64.0 / 5.0 + 9.0 / 256.0 / 9.0) * 12.0;
    let mut claims = vec![
        formula(
            "(2)",
            "rod inclination at 0.7 rad",
            "rad",
            inclination,
            pose.phi(),
        ),
        formula("(3)", "d theta2/d theta", "", ratio, pose.dphi),
        formula("(5)", "dr_P/d theta", "m", arm, pose.dx),
        formula("(6)", "generalized force of 1 N", "N m", arm, pose.dx),
        formula(
            "(6)",
            "read as the work of 1 N from 0 to 0.7 rad",
            "J",
            arm,
            pose.x - start,
        )
        .cannot("nothing was integrated: (6) is the generalized force"),
        formula(
            "(9)",
            "speed of the slider over that of the crank",
            "m",
            speed_4,
            -pose.dx,
        )
        .only_if(
            "it is L2 sin theta (1 + d theta2/d theta)",
            CRANK * sin * (1.0 + ratio),
        ),
        formula(
            "(8)",
            "height of the rod's c.g.",
            "m",
            (ROD + ROD_CG) * sin,
            height_of_rod(theta),
        )
        .only_if("it is L2 sin theta (1 - r_B3c/L3)", height),
        formula(
            "(9)",
            "factor of the acceleration",
            "kg m2",
            m,
            terms.inertia.m,
        )
        .only_if(whole, mended[0]),
        formula(
            "(9)",
            "factor of the speed's square",
            "kg m2",
            half_dm,
            terms.inertia.half_dm,
        )
        .only_if(whole, mended[1]),
        formula(
            "(9)",
            "the same as half the derivative of its own first factor",
            "kg m2",
            half_dm,
            half_slope(theta),
        )
        .only_if("it has L3^2 + L2^2 sin^2", printed(theta, 1.0)[1]),
        formula(
            "(9)",
            "weight term, balanced crank, g = 9.81 m/s2",
            "N m",
            weight,
            terms.dv,
        )
        .only_if("the height of the rod's c.g. is mended", mended[2]),
        formula(
            "(10)",
            "interior angle at the crank pin at 0.7 rad",
            "rad",
            gamma,
            interior_angle(&pose),
        ),
        number("(11)", "R squared of a quartic", "", "0.9974", one_fold).cannot(
            "the data are not printed; ours is that of a crank at constant speed through one fold",
        ),
    ];
    for (i, text) in ["0.0649", "0.522", "2.166", "-2.129", "0.472"]
        .into_iter()
        .enumerate()
    {
        claims.push(without_data(
            "(11)",
            &format!("coefficient of t^{i}"),
            "SI",
            text,
        ));
    }
    claims
}

/// Half the derivative of the first factor of (9) as printed.
fn half_slope(theta: f64) -> f64 {
    0.5 * crate::numeric::difference::slope(|theta| printed(theta, -1.0)[0], theta, 1e-3)
}

/// Height of the rod's centre of gravity, from its place between the pins.
fn height_of_rod(theta: f64) -> f64 {
    let pose = Linkage::new(&Scene::duarte().geometry).pose(theta);
    CRANK * pose.sin - ROD_CG * pose.sin_phi
}

/// Interior angle between crank and rod, from the sides of the triangle O, A, P.
fn interior_angle(pose: &crate::mechanism::Pose) -> f64 {
    let cos = (CRANK * CRANK + ROD * ROD - pose.x * pose.x) / (2.0 * CRANK * ROD);
    cos.acos()
}

pub(super) fn drawings() -> Vec<Drawing> {
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
