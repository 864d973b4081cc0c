//! Equations (1)-(30), at a crank angle of 1 rad and the offset of table 1.

use super::super::entry::{Claim, formula};
use super::printed::Printed;
use super::{CRANK, OFFSET, ROD, SPEED, engine};
use crate::mechanism::{EquivalentMasses, Linkage};

/// Where the formulas are compared, rad.
pub const TEST_ANGLE: f64 = 1.0;

/// The printed formulas of table 1 at the test angle.
pub fn printed() -> Printed {
    let masses = EquivalentMasses::new(&engine(OFFSET));
    Printed {
        e: OFFSET,
        theta: TEST_ANGLE,
        m2: masses.rotating_kg,
        m3: masses.reciprocating_kg,
    }
}

pub fn claims() -> Vec<Claim> {
    let p = printed();
    let pose = Linkage::new(&engine(OFFSET).geometry).pose(TEST_ANGLE);
    let squared = SPEED * SPEED;
    let cos = TEST_ANGLE.cos();
    let v2 = -pose.d2x - CRANK * cos;
    let v2_mended = p.tilt() / p.root(0.5) + p.square() / p.root(1.5);
    let rod = pose.d2phi * squared;
    vec![
        formula(
            "(2b)",
            "speed of the crank pin, middle member",
            "m/s",
            SPEED * SPEED,
            SPEED * CRANK,
        )
        .only_if("the middle member is k dtheta/dt", CRANK * SPEED),
        formula(
            "(3)",
            "centripetal acceleration of the crank pin",
            "m/s2",
            squared * CRANK,
            squared * (CRANK * pose.cos).hypot(CRANK * pose.sin),
        ),
        formula(
            "(6)",
            "sine of the rod's inclination",
            "",
            OFFSET / ROD + CRANK / ROD * TEST_ANGLE.sin(),
            pose.sin_phi,
        ),
        formula(
            "(7)",
            "cosine of the rod's inclination",
            "",
            p.root(0.5) / ROD,
            pose.cos_phi,
        ),
        formula("(8)", "slider position x", "m", p.x(), pose.x),
        formula(
            "(10)",
            "slider position s = k + c - x",
            "m",
            p.s(),
            CRANK + ROD - pose.x,
        )
        .only_if("the last sign is a minus", p.s() - 2.0 * p.root(0.5)),
        formula("(12)", "ds/dtheta", "m", p.ds(), -pose.dx),
        formula(
            "(13)",
            "slider velocity ds/dt",
            "m/s",
            SPEED * p.ds(),
            -SPEED * pose.dx,
        ),
        formula(
            "(17)",
            "dv1/dtheta",
            "m/s",
            -SPEED * CRANK * cos,
            SPEED * CRANK * pose.cos,
        )
        .only_if("the sign is a plus", SPEED * CRANK * cos),
        formula("(18)", "dv2/dtheta", "m/s", p.dv2(), SPEED * v2).only_if(
            "both signs are plus and the exponents 1/2 and 3/2",
            SPEED * v2_mended,
        ),
        formula(
            "(20)",
            "slider acceleration d2s/dt2",
            "m/s2",
            p.acceleration(),
            -pose.d2x * squared,
        )
        .only_if(
            "the exponents are 1/2 and 3/2, and all signs plus",
            -p.acceleration_mended(),
        ),
        formula(
            "(20)",
            "read as d2x/dt2",
            "m/s2",
            p.acceleration(),
            pose.d2x * squared,
        )
        .only_if("the exponents are 1/2 and 3/2", p.acceleration_mended()),
        formula("(22)", "rod inclination", "rad", p.alpha(), pose.phi()),
        formula(
            "(27)",
            "angular speed of the rod",
            "rad/s",
            p.rod_speed(),
            pose.dphi * SPEED,
        ),
        formula(
            "(29)",
            "dv_c/dtheta",
            "rad/s",
            p.rod_acceleration(-1.0) / SPEED,
            pose.d2phi * SPEED,
        )
        .only_if("the second term is added", p.rod_acceleration(1.0) / SPEED),
        formula(
            "(30)",
            "angular acceleration of the rod",
            "rad/s2",
            p.rod_acceleration(-1.0),
            rod,
        )
        .only_if("the second term is added", p.rod_acceleration(1.0)),
    ]
}
