//! The printed equations (2)-(11) at a crank angle of 0.7 rad.

use std::f64::consts::PI;

use super::super::entry::{Claim, formula, number, without_data};
use super::{
    CRANK, CRANK_INERTIA, ROD, ROD_CG, ROD_INERTIA, SLIDER_MASS, TEST_ANGLE, complete, engine,
    interior_angle, lever, printed, printed_share,
};
use crate::mechanism::Linkage;
use crate::numeric::difference;
use crate::scene::Scene;

pub fn claims() -> Vec<Claim> {
    let mut claims = kinematics();
    claims.extend(equation());
    claims.extend(measured());
    claims
}

/// (2), (3), (5) and (6).
fn kinematics() -> Vec<Claim> {
    let linkage = Linkage::new(&Scene::duarte().geometry);
    let (pose, start) = (linkage.pose(TEST_ANGLE), linkage.pose(0.0).x);
    let arm = lever(TEST_ANGLE);
    vec![
        formula(
            "(2)",
            "rod inclination at 0.7 rad",
            "rad",
            inclination(),
            pose.phi(),
        ),
        formula("(3)", "d theta2/d theta", "", turn_ratio(), pose.dphi),
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
    ]
}

/// (8) and (9).
fn equation() -> Vec<Claim> {
    let theta = TEST_ANGLE;
    let ([m, half_dm, weight, _], mended) = (printed(theta, -1.0), complete(theta));
    let terms = engine().terms(theta);
    let sin = theta.sin();
    let height = CRANK * sin * (1.0 - ROD_CG / ROD);
    let whole = "v4 is -x', and the rod moves with its centre of gravity";
    vec![
        formula(
            "(9)",
            "speed of the slider over that of the crank",
            "m",
            CRANK * sin * printed_share(theta),
            -terms.pose.dx,
        )
        .only_if(
            "it is L2 sin theta (1 + d theta2/d theta)",
            CRANK * sin * (1.0 + turn_ratio()),
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
            "(7)",
            "twice the kinetic energy at 1 rad/s",
            "kg m2",
            CRANK_INERTIA + ROD_INERTIA * turn_ratio().powi(2) + SLIDER_MASS * lever(theta).powi(2),
            terms.inertia.m,
        )
        .only_if(
            "the rod has m3 v_G^2 + (I3 - m3 r_B3c^2) (d theta2/d theta)^2",
            mended[0],
        ),
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
    ]
}

/// (10) and (11).
fn measured() -> Vec<Claim> {
    let pose = Linkage::new(&Scene::duarte().geometry).pose(TEST_ANGLE);
    let gamma = PI - TEST_ANGLE - inclination();
    // Of a quartic through |t|, the folded angle of a crank at constant speed, by Legendre polynomials:
    // the explained variance is (5/8)²/5 + (3/16)²/9 of 1/12.
    let one_fold = (25.0 / 64.0 / 5.0 + 9.0 / 256.0 / 9.0) * 12.0;
    let mut claims = vec![
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

/// (2): inclination of the rod at the test angle, rad.
fn inclination() -> f64 {
    (CRANK / ROD * TEST_ANGLE.sin()).asin()
}

/// (3): d theta2/d theta at the test angle.
fn turn_ratio() -> f64 {
    CRANK * TEST_ANGLE.cos() / (ROD * (1.0 - (CRANK / ROD * TEST_ANGLE.sin()).powi(2)).sqrt())
}

/// Half the derivative of the first factor of (9) as printed.
fn half_slope(theta: f64) -> f64 {
    0.5 * difference::slope(|theta| printed(theta, -1.0)[0], theta, 1e-3)
}

/// Height of the rod's centre of gravity, from its place between the pins.
fn height_of_rod(theta: f64) -> f64 {
    let pose = Linkage::new(&Scene::duarte().geometry).pose(theta);
    CRANK * pose.sin - ROD_CG * pose.sin_phi
}
