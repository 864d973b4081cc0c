//! Duarte, Valencia and Obregon 2018: Lagrange equation of a Diesel engine, equations (1)-(11).

mod claims;
mod figures;

use crate::mechanism::{Equation, Pose};
use crate::numeric::difference;
use crate::scene::{Gravity, Scene};

pub(super) use claims::claims;
pub(super) use figures::drawings;

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
        0.5 * difference::slope(inertia, theta, 1e-3),
        G * theta.cos() * ROD_MASS * CRANK * (1.0 - ROD_CG / ROD),
    ]
}

/// Interior angle between crank and rod, from the sides of the triangle O, A, P.
fn interior_angle(pose: &Pose) -> f64 {
    let cos = (CRANK * CRANK + ROD * ROD - pose.x * pose.x) / (2.0 * CRANK * ROD);
    cos.acos()
}
