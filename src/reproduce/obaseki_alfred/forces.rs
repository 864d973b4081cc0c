//! Equations (31)-(53): masses, forces and torques, at a crank angle of 1 rad and the offset of table 1.

use super::super::entry::{Claim, formula};
use super::equations::{TEST_ANGLE, printed};
use super::on_bodies;
use super::printed::{existing_acceleration, existing_torque};
use super::{CRANK, CRANK_MASS, OFFSET, ROD, ROD_MASS, SLIDER_MASS, SPEED, engine};
use crate::error::Error;
use crate::mechanism::{EquivalentMasses, Limits, Linkage, size_from_stroke};

pub fn claims() -> Result<Vec<Claim>, Error> {
    let mut claims = masses();
    claims.extend(on_bodies::claims()?);
    claims.extend(design()?);
    claims.extend(existing_model());
    Ok(claims)
}

fn masses() -> Vec<Claim> {
    let masses = EquivalentMasses::new(&engine(OFFSET));
    let (uniform, half) = (ROD_MASS * ROD * ROD / 12.0, 0.5 * ROD);
    let crank = engine(OFFSET).crank.unwrap_or_default();
    let at_pin = CRANK_MASS * 0.5 * CRANK * CRANK;
    vec![
        formula(
            "(34)",
            "reciprocating mass",
            "kg",
            ROD_MASS * half / ROD + SLIDER_MASS,
            masses.reciprocating_kg,
        ),
        formula(
            "(36)",
            "rotating mass",
            "kg",
            ROD_MASS * half / ROD + CRANK_MASS * 0.5,
            masses.rotating_kg,
        ),
        formula(
            "(31)-(33)",
            "inertia of the rod's two masses about its c.g., of a uniform rod",
            "kg m2",
            ROD_MASS * half * half,
            uniform,
        )
        .only_if(
            "the couple (I_G - m c2 c3) alpha is kept",
            ROD_MASS * half * half + masses.rod_inertia_left_kg_m2,
        ),
        formula(
            "(35)",
            "inertia of the crank's mass at the pin about O, of a uniform crank",
            "kg m2",
            at_pin,
            crank.inertia,
        )
        .only_if(
            "I_O = m k1^2 + I_G is taken",
            CRANK_MASS * (0.25 + 1.0 / 12.0) * CRANK * CRANK,
        ),
    ]
}

fn design() -> Result<Vec<Claim>, Error> {
    let linkage = Linkage::new(&engine(OFFSET).geometry);
    let stroke = Limits::new(&linkage, SPEED).stroke;
    let exact = ((CRANK + ROD).powi(2) - OFFSET * OFFSET).sqrt()
        - ((ROD - CRANK).powi(2) - OFFSET * OFFSET).sqrt();
    let (crank, rod) = size_from_stroke(0.08, 1.6, 0.0)?;
    Ok(vec![
        formula("(49)", "stroke, e = 20 mm", "m", 2.0 * CRANK, stroke)
            .only_if("it is sqrt((c+k)^2 - e^2) - sqrt((c-k)^2 - e^2)", exact),
        formula(
            "(49)",
            "stroke, e = 0",
            "m",
            2.0 * CRANK,
            Limits::new(&Linkage::new(&engine(0.0).geometry), SPEED).stroke,
        ),
        formula(
            "(49)",
            "crank for a stroke of 80 mm, e = 0",
            "m",
            0.08 / 2.0,
            crank,
        ),
        formula("(50)", "rod, with e = 10 mm", "m", 3.2 * 0.01, rod)
            .only_if("it is c = 1.6 k", 1.6 * CRANK),
    ])
}

fn existing_model() -> Vec<Claim> {
    let p = printed();
    let lengths = [CRANK, ROD];
    let linkage = Linkage::new(&engine(0.0).geometry);
    let acceleration = |theta: f64| linkage.pose(theta).d2x * SPEED * SPEED;
    let (pose, first) = (linkage.pose(TEST_ANGLE), linkage.first_order(TEST_ANGLE));
    let existing = existing_acceleration(lengths, SPEED, TEST_ANGLE);
    let torque = existing_torque(p.m3, lengths, SPEED, TEST_ANGLE);
    let per_mass = -p.m3 * SPEED * SPEED;
    let outer = existing_acceleration(lengths, SPEED, 0.0);
    vec![
        formula(
            "(52)",
            "slider acceleration d2x/dt2, e = 0, at 1 rad",
            "m/s2",
            existing,
            acceleration(TEST_ANGLE),
        )
        .cannot("it is the first order in k/c of the exact one"),
        formula(
            "(52)",
            "the first order of our own",
            "m/s2",
            existing,
            first.d2x * SPEED * SPEED,
        ),
        formula(
            "(52)",
            "slider acceleration at the outer dead centre",
            "m/s2",
            outer,
            acceleration(0.0),
        ),
        formula(
            "(53)",
            "inertia torque, e = 0, at 1 rad",
            "N m",
            torque,
            per_mass * pose.dx * pose.d2x,
        )
        .cannot("it is the first order in k/c of the exact one"),
        formula(
            "(53)",
            "the first order of our own",
            "N m",
            torque,
            per_mass * first.dx_d2x,
        ),
    ]
}
