//! Equations (38)-(48): forces on crank, rod and slider, and the torques that go with them.

use super::super::entry::{Claim, formula};
use super::equations::{TEST_ANGLE, printed};
use super::printed::Printed;
use super::{CRANK, OFFSET, SPEED, engine};
use crate::error::Error;
use crate::kinematics::{ForceRow, forces};
use crate::mechanism::{EquivalentMasses, Linkage, Pose, Reactions};
use crate::scene::{Rod, RodModel, Scene};

/// The same engine with a rigid rod.
fn rigid() -> Scene {
    let mut scene = engine(OFFSET);
    scene.rod = scene.rod.map(|rod| Rod {
        model: RodModel::Rigid,
        ..rod
    });
    scene
}

pub fn claims() -> Result<Vec<Claim>, Error> {
    let on_bodies = OnBodies::new()?;
    let mut claims = on_bodies.on_crank();
    claims.extend(on_bodies.on_rod_and_slider());
    claims.extend(on_bodies.on_all());
    Ok(claims)
}

/// What the printed forces on the bodies are compared with.
struct OnBodies {
    printed: Printed,
    pose: Pose,
    /// With the rod as two masses, as the paper has it.
    two_mass: ForceRow,
    /// With a rigid rod.
    rigid: Reactions,
    /// d²x/dt², m/s²
    acceleration: f64,
    /// −m3 d²x/dt² with (20) mended, N
    mended: f64,
    /// Tension of the rod that it asks for, N
    mended_tension: f64,
}

impl OnBodies {
    fn new() -> Result<OnBodies, Error> {
        let printed = printed();
        let pose = Linkage::new(&engine(OFFSET).geometry).pose(TEST_ANGLE);
        let mended = -printed.m3 * printed.acceleration_mended();
        Ok(OnBodies {
            printed,
            pose,
            two_mass: forces(&engine(OFFSET))?.row(TEST_ANGLE),
            rigid: forces(&rigid())?.row(TEST_ANGLE).reactions,
            acceleration: pose.d2x * SPEED * SPEED,
            mended,
            mended_tension: mended / printed.alpha().cos(),
        })
    }

    /// Equations (38)-(40).
    fn on_crank(&self) -> Vec<Claim> {
        let (p, mended) = (&self.printed, self.mended);
        let (alpha, radial) = (p.alpha(), p.crank_force());
        let left = EquivalentMasses::new(&engine(OFFSET)).rod_inertia_left_kg_m2;
        let couple = left * p.rod_acceleration(1.0) / p.root(0.5);
        vec![
            formula(
                "(38)",
                "reaction at the crank centre along x",
                "N",
                -radial * TEST_ANGLE.cos(),
                self.rigid.crank_bearing[0],
            )
            .only_if("m3 d2x/dt2 is added", -radial * TEST_ANGLE.cos() - mended),
            formula(
                "(39)",
                "reaction at the crank centre along y",
                "N",
                -radial * TEST_ANGLE.sin(),
                self.rigid.crank_bearing[1],
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
                self.two_mass.torque / CRANK,
            )
            .only_if(
                "it is F_c sin(alpha + theta) with F_c = -m3 d2x/dt2 / cos alpha",
                self.mended_tension * (alpha + TEST_ANGLE).sin(),
            ),
        ]
    }

    /// Equations (41)-(45); the slider is free.
    fn on_rod_and_slider(&self) -> Vec<Claim> {
        let (p, mended, mended_tension) = (&self.printed, self.mended, self.mended_tension);
        let alpha = p.alpha();
        let slider_inertia = -p.m3 * self.acceleration;
        // Tension of the massless rod between the two masses.
        let tension = slider_inertia / self.pose.cos_phi;
        vec![
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
                p.m3 * self.acceleration,
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
                tension * self.pose.sin_phi,
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
        ]
    }

    /// Equations (46)-(48).
    fn on_all(&self) -> Vec<Claim> {
        let (p, two_mass) = (&self.printed, &self.two_mass);
        vec![
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
                self.mended * (p.x() * p.alpha().tan() - OFFSET),
            ),
            formula(
                "(48)",
                "driving torque, with (20) as printed",
                "N m",
                p.torque(p.acceleration()),
                two_mass.torque,
            )
            .cannot("(20), the lever arm and the mass m2 are wrong together"),
        ]
    }
}
