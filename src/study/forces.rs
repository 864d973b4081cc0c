//! Forces of the whole mechanism at constant crank speed over one turn.

use std::f64::consts::TAU;

use serde::Serialize;

use super::Located;
use crate::error::Error;
use crate::mechanism::{Equation, EquivalentMasses, InertiaForces, Linkage, Reactions, Reactor};
use crate::numeric::{angle, difference, root};
use crate::scene::Scene;

/// Forces at constant crank speed.
#[derive(Clone, Debug, Serialize)]
pub struct ForceAnalysis {
    /// rad/s, counter-clockwise
    pub speed_rad_per_s: f64,
    /// Rotating and reciprocating masses.
    pub masses: EquivalentMasses,
    /// Greatest and least driving torque on the outward stroke, N m; none for a crank that cannot turn fully.
    pub outward: Option<StrokeTorque>,
    /// The same on the inward stroke.
    pub inward: Option<StrokeTorque>,
    #[serde(skip)]
    equation: Equation,
    #[serde(skip)]
    reactor: Reactor,
}

/// Extremes of the driving torque on one stroke, with their crank angles.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StrokeTorque {
    /// N m
    pub max: Located,
    /// N m
    pub min: Located,
}

/// Forces at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceRow {
    /// Torque that drives the crank beside the loads of the scene, N m.
    pub torque: f64,
    /// Inertia forces of the bodies.
    pub inertia: InertiaForces,
    /// Tension of the rod at the wrist pin, N; negative: compression.
    pub rod_axial: f64,
    /// Force of the crank on the rod along the path of the crank pin, counter-clockwise, N.
    pub crank_tangential: f64,
    /// The same away from O, N.
    pub crank_radial: f64,
    /// Joint, guide and shaking forces.
    pub reactions: Reactions,
    /// Slider acceleration to first order in r/l and e/l, m/s².
    pub first_order_acceleration: f64,
    /// Torque that drives the reciprocating mass, to first order, N m.
    pub first_order_torque: f64,
}

/// Forces of a scene at its speed, taken as constant, under its weight and loads.
///
/// # Errors
/// [`Error::Scene`] for impossible values; [`Error::Refused`] without a speed and for the rod model
/// `spin-only`.
pub fn forces(scene: &Scene) -> Result<ForceAnalysis, Error> {
    scene.check()?;
    let speed = scene.motion.speed;
    if speed == 0.0 {
        return Err(Error::refused(
            "forces at constant speed need a speed",
            "give motion.speed, like \"300 rpm\"; for forces at rest use `statics`",
        ));
    }
    let mut analysis = ForceAnalysis {
        speed_rad_per_s: speed,
        masses: EquivalentMasses::new(scene),
        outward: None,
        inward: None,
        equation: Equation::new(scene),
        reactor: Reactor::new(scene)?,
    };
    [analysis.outward, analysis.inward] = analysis.strokes();
    Ok(analysis)
}

impl ForceAnalysis {
    fn linkage(&self) -> &Linkage {
        self.equation.linkage()
    }

    /// Driving torque at a crank angle, N m; time counts from θ = 0.
    pub fn torque(&self, theta: f64) -> f64 {
        let speed = self.speed_rad_per_s;
        self.equation
            .driving_torque(theta / speed, theta, speed, 0.0)
    }

    /// All forces at a crank angle, rad.
    pub fn row(&self, theta: f64) -> ForceRow {
        let (linkage, speed) = (self.linkage(), self.speed_rad_per_s);
        let pose = linkage.pose(theta);
        let time = theta / speed;
        let reactions = self.reactor.at(&self.equation, time, theta, speed, 0.0);
        let axis = [linkage.s * pose.cos_phi, -pose.sin_phi];
        let [px, py] = reactions.wrist_pin;
        let [cx, cy] = reactions.crank_pin;
        let first = linkage.first_order(theta);
        let squared = speed * speed;
        ForceRow {
            torque: self.torque(theta),
            inertia: self.reactor.inertia_forces(&pose, speed, 0.0),
            rod_axial: -(px * axis[0] + py * axis[1]),
            crank_tangential: cy * pose.cos - cx * pose.sin,
            crank_radial: cx * pose.cos + cy * pose.sin,
            reactions,
            first_order_acceleration: first.d2x * squared,
            first_order_torque: self.masses.reciprocating_kg * first.dx_d2x * squared,
        }
    }

    /// Rows of one turn, from 0 to 360 degrees inclusive, every `step` (rad).
    pub fn rows(&self, step: f64) -> impl Iterator<Item = (f64, ForceRow)> + '_ {
        angle::turn(step).map(|theta| (theta, self.row(theta)))
    }

    /// Extremes of the torque on the outward and on the inward stroke.
    fn strokes(&self) -> [Option<StrokeTorque>; 2] {
        let linkage = self.linkage();
        let centres = crate::mechanism::Limits::new(linkage, self.speed_rad_per_s).dead_centres;
        let [first, second] = centres.as_slice() else {
            return [None; 2];
        };
        if linkage.margin() <= 0.0 {
            return [None; 2];
        }
        let arcs = [
            (first.theta, second.theta),
            (second.theta, first.theta + TAU),
        ];
        let mut found = [None; 2];
        for (from, to) in arcs {
            let middle = linkage.pose(0.5 * (from + to));
            let outward = middle.x * middle.dx * self.speed_rad_per_s > 0.0;
            found[usize::from(!outward)] = self.extremes(from, to);
        }
        found
    }

    fn extremes(&self, from: f64, to: f64) -> Option<StrokeTorque> {
        // That of the rows, from 0 to 360 degrees: loads need not be the same in the next turn.
        let torque = |theta: f64| {
            self.torque(if theta == TAU {
                TAU
            } else {
                theta.rem_euclid(TAU)
            })
        };
        let seam = [0.0, TAU].into_iter().filter(|_| (from..to).contains(&TAU));
        let mut angles = vec![from, to];
        let grid = self.linkage().turn_grid();
        let inside = (-1..=2)
            .flat_map(|turn| grid.iter().map(move |theta| theta + f64::from(turn) * TAU))
            .filter(|theta| (from..=to).contains(theta));
        angles.extend(inside);
        angles.sort_by(f64::total_cmp);
        let slope = |theta: f64| difference::slope(torque, theta, 1e-3);
        let tops = angles
            .windows(2)
            .filter_map(|w| root::bracketed(slope, w[0], w[1]));
        let mut found: Vec<Located> = tops
            .chain([from, to])
            .chain(seam)
            .map(|theta| Located {
                value: torque(theta),
                theta_rad: theta.rem_euclid(TAU) % TAU,
            })
            .filter(|located| located.value.is_finite())
            .collect();
        found.sort_by(|a, b| a.value.total_cmp(&b.value));
        Some(StrokeTorque {
            min: *found.first()?,
            max: *found.last()?,
        })
    }
}
