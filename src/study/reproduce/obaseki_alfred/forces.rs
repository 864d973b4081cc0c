//! Equations (31)-(53): masses, forces and torques, at a crank angle of 1 rad and the offset of table 1.

use super::super::entry::{Claim, formula};
use super::equations::{TEST_ANGLE, printed};
use super::printed::{existing_acceleration, existing_torque};
use super::{CRANK, CRANK_MASS, OFFSET, ROD, ROD_MASS, SLIDER_MASS, SPEED, engine};
use crate::error::Error;
use crate::mechanism::{EquivalentMasses, Limits, Linkage, size_from_stroke};
use crate::scene::{RodModel, Scene};
use crate::study::forces;

/// The same engine with a rigid rod.
fn rigid() -> Scene {
    let mut scene = engine(OFFSET);
    scene.rod = scene.rod.map(|rod| crate::scene::Rod {
        model: RodModel::Rigid,
        ..rod
    });
    scene
}

pub fn claims() -> Result<Vec<Claim>, Error> {
    let mut claims = masses();
    claims.extend(forces_on_bodies()?);
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

fn forces_on_bodies() -> Result<Vec<Claim>, Error> {
    let p = printed();
    let pose = Linkage::new(&engine(OFFSET).geometry).pose(TEST_ANGLE);
    let (acceleration, cos) = (pose.d2x * SPEED * SPEED, TEST_ANGLE.cos());
    let two_mass = forces(&engine(OFFSET))?.row(TEST_ANGLE);
    let whole = forces(&rigid())?.row(TEST_ANGLE).reactions;
    // Tension of the massless rod between the two masses; the slider is free.
    let slider_inertia = -p.m3 * acceleration;
    let tension = slider_inertia / pose.cos_phi;
    let (alpha, angle) = (p.alpha(), p.alpha() + TEST_ANGLE);
    let mended = -p.m3 * p.acceleration_mended();
    let left = EquivalentMasses::new(&engine(OFFSET)).rod_inertia_left_kg_m2;
    let couple = left * p.rod_acceleration(1.0) / p.root(0.5);
    let radial = p.crank_force();
    let mended_tension = mended / alpha.cos();
    Ok(vec![
        formula(
            "(38)",
            "reaction at the crank centre along x",
            "N",
            -radial * cos,
            whole.crank_bearing[0],
        )
        .only_if("m3 d2x/dt2 is added", -radial * cos - mended),
        formula(
            "(39)",
            "reaction at the crank centre along y",
            "N",
            -radial * TEST_ANGLE.sin(),
            whole.crank_bearing[1],
        )
        .only_if(
            "-m3 d2x/dt2 tan alpha and the couple of the rod are added",
            -radial * TEST_ANGLE.sin() + mended * alpha.tan() + couple,
        ),
        formula(
            "(40)",
            "tangential force at the crank pin",
            "N",
            p.tangential(),
            two_mass.torque / CRANK,
        )
        .only_if(
            "it is F_c sin(alpha + theta) with F_c = -m3 d2x/dt2 / cos alpha",
            mended_tension * angle.sin(),
        ),
        formula(
            "(41)",
            "axial force of the rod, tension",
            "N",
            p.rod_force(),
            tension,
        )
        .only_if("it is -m3 d2x/dt2 / cos alpha", mended_tension),
        formula(
            "(42a)",
            "inertia force of the slider, a_s = d2s/dt2",
            "N",
            p.m3 * acceleration,
            slider_inertia,
        )
        .only_if("a_s is d2x/dt2", mended),
        formula(
            "(42b)",
            "inertia force of the slider",
            "N",
            p.slider_inertia(),
            slider_inertia,
        )
        .only_if(
            "e stands before sin theta and the third term is added",
            mended,
        ),
        formula(
            "(43)",
            "horizontal force of the rod",
            "N",
            p.rod_force() * alpha.cos(),
            slider_inertia,
        )
        .only_if("F_c is mended", mended_tension * alpha.cos()),
        formula(
            "(44)",
            "vertical force of the rod",
            "N",
            p.rod_force() * alpha.sin(),
            tension * pose.sin_phi,
        )
        .only_if("F_c is mended", mended_tension * alpha.sin()),
        formula(
            "(45)",
            "sum of the forces on the free slider",
            "N",
            p.slider_inertia() + p.rod_force() * alpha.cos(),
            0.0,
        )
        .only_if(
            "it is F_Is - F_c cos alpha with both mended",
            mended - mended_tension * alpha.cos(),
        ),
        formula(
            "(46b)",
            "sum of mass times acceleration along x, with (20) mended",
            "N",
            p.inertia(p.acceleration_mended()),
            -two_mass.reactions.shaking[0],
        )
        .only_if("a_s is d2s/dt2", p.inertia(-p.acceleration_mended())),
        formula(
            "(47)",
            "torque of the crank's own inertia at constant speed",
            "N m",
            p.crank_torque(),
            0.0,
        )
        .cannot("a force through O has no moment about O"),
        formula(
            "(48)",
            "driving torque, with (20) mended",
            "N m",
            p.torque(p.acceleration_mended()),
            two_mass.torque,
        )
        .only_if(
            "it is F_Is (x tan alpha - e)",
            mended * (p.x() * alpha.tan() - OFFSET),
        ),
        formula(
            "(48)",
            "driving torque, with (20) as printed",
            "N m",
            p.torque(p.acceleration()),
            two_mass.torque,
        )
        .cannot("(20), the lever arm and the mass m2 are wrong together"),
    ])
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
