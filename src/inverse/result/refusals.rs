//! Refusals of scenes and motions that inverse dynamics cannot treat.

use super::super::row::InverseRow;
use super::inverse_dynamics::InverseDynamics;
use crate::error::Error;
use crate::plan::{Method, Plan};
use crate::scene::{Measurement, MotionKind, Scene};

/// Returns the plan of a scene whose motion was measured; refuses clearance.
pub(in crate::inverse) fn plan(scene: &Scene) -> Result<Plan, Error> {
    if scene.reduced().clearance.is_some() {
        return Err(Error::refused(
            "with clearance in a joint the motion of the crank does not say where the slider is: inverse reads the equation of tight joints",
            "take [clearance] out of the scene, or set its radial to 0",
        ));
    }
    let mut prescribed = scene.clone();
    prescribed.motion.kind = MotionKind::ConstantSpeed;
    let mut plan = Plan::new(&prescribed, Method::Auto)?;
    plan.reason = "the crank motion is measured: nothing to integrate, the equation is read backwards along the estimated theta(t)".into();
    Ok(plan)
}

/// Refuses loads without a finite value along the motion, and a guide that locks at every sample; returns a warning if
/// it locks at some.
pub(in crate::inverse) fn finite(
    backwards: &InverseDynamics<'_>,
    measurement: &Measurement,
    rows: &[InverseRow],
) -> Result<Option<String>, Error> {
    let place = |sample: usize| {
        let InverseRow { t, theta, .. } = rows[sample];
        let place = measurement.place(sample);
        format!("at {place} (t = {t} s, theta = {theta} rad)")
    };
    let all = 0..rows.len();
    let without: Vec<usize> = all.filter(|i| rows[*i].crank_torque.is_none()).collect();
    for &sample in &without {
        let row = &rows[sample];
        let load = backwards.equation.load(row.t, row.theta, row.omega);
        if !load.is_finite() {
            return Err(Error::refused(
                format!(
                    "the loads of the scene have no finite value {}",
                    place(sample)
                ),
                "let the tables of the scene cover the measured motion, or take the load out",
            ));
        }
        if backwards.guide.is_none() {
            return Err(Error::refused(
                format!("the crank torque is not a finite number {}", place(sample)),
                "check the units of the data, of the time above all",
            ));
        }
    }
    let [first, ..] = without[..] else {
        return Ok(None);
    };
    let locks = |place: String| {
        format!(
            "the guide locks itself {place}: friction holds the slider against any torque on the crank"
        )
    };
    if without.len() == rows.len() {
        return Err(Error::refused(
            locks(place(first)),
            "a motion like this one needs less friction, or the longer rod of another mechanism: check [friction] and [geometry]",
        ));
    }
    let samples = match without.len() {
        1 => place(first),
        count => format!("at {count} samples, the first {}", place(first)),
    };
    Ok(Some(format!(
        "{}; their crank torque is left empty, and the slider force is what drives it by a pull or push on the slider",
        locks(samples)
    )))
}
