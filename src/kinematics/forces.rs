//! Forces of the mechanism at constant crank speed over the cycle of its loads, by the Newton-Euler equations.

use std::f64::consts::TAU;

use serde::Serialize;

use super::Located;
use crate::error::Error;
use crate::mechanism::{
    Equation, EquivalentMasses, InertiaForces, Limits, Linkage, Reactions, Reactor,
};
use crate::numeric::maximum;
use crate::plan::Cycle;
use crate::scene::Scene;

/// Forces at constant crank speed.
#[derive(Clone, Debug, Serialize)]
pub struct ForceAnalysis {
    /// Crank speed, rad/s, counter-clockwise.
    pub speed_rad_per_s: f64,
    /// Turns over which the forces are computed: the cycle of the loads, or the first turn.
    pub cycle_turns: u32,
    /// Reason why the loads do not repeat, if they do not: other turns then have other forces.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub not_repeating: Option<String>,
    /// Equivalent rotating and reciprocating masses.
    pub masses: EquivalentMasses,
    /// Extremes of the driving torque on the outward strokes of the cycle; none for a crank that cannot turn fully.
    pub outward: Option<StrokeTorque>,
    /// Extremes of the driving torque on the inward strokes of the cycle; none for a crank that cannot turn fully.
    pub inward: Option<StrokeTorque>,
    #[serde(skip)]
    pub(super) equation: Equation,
    #[serde(skip)]
    reactor: Reactor,
}

/// Extremes of the driving torque on strokes of one direction, with their crank angles in the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StrokeTorque {
    /// Greatest torque, N m.
    pub max: Located,
    /// Least torque, N m.
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
    /// Force of the crank on the rod along the crank, away from O, N.
    pub crank_radial: f64,
    /// Joint, guide and shaking forces.
    pub reactions: Reactions,
    /// Slider acceleration to first order in r/l and e/l, m/s².
    pub first_order_acceleration: f64,
    /// Torque that drives the reciprocating mass, to first order, N m.
    pub first_order_torque: f64,
}

/// Computes the forces of a scene at its speed, taken as constant, under its weight and loads.
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
    let cycle = Cycle::of(scene);
    let mut analysis = ForceAnalysis {
        speed_rad_per_s: speed,
        cycle_turns: cycle.turns.unwrap_or(1),
        not_repeating: cycle.why_not,
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
    pub(super) fn linkage(&self) -> &Linkage {
        self.equation.linkage()
    }

    /// Returns the driving torque at a crank angle (rad), N m; time counts from θ = 0.
    pub fn torque(&self, theta: f64) -> f64 {
        let speed = self.speed_rad_per_s;
        self.equation
            .driving_torque(theta / speed, theta, speed, 0.0)
    }

    /// Computes all forces at a crank angle, rad.
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

    /// Returns the angle at which the cycle ends, rad.
    pub(super) fn whole(&self) -> f64 {
        f64::from(self.cycle_turns) * TAU
    }

    /// Locates the extremes of the torque on the outward and on the inward strokes.
    fn strokes(&self) -> [Option<StrokeTorque>; 2] {
        let linkage = self.linkage();
        let centres = Limits::new(linkage, self.speed_rad_per_s).dead_centres;
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
        let mut found = [const { Vec::new() }; 2];
        for turn in 0..self.cycle_turns {
            let before = f64::from(turn) * TAU;
            for (from, to) in arcs {
                let middle = linkage.pose(0.5 * (from + to));
                let outward = middle.x * middle.dx * self.speed_rad_per_s > 0.0;
                // Loads may differ in the next cycle.
                let (from, to, end) = (from + before, to + before, self.whole());
                let found = &mut found[usize::from(!outward)];
                found.extend(self.extremes(from, to.min(end)));
                if to > end {
                    found.extend(self.extremes(0.0, to - end));
                }
            }
        }
        found.map(|mut found: Vec<Located>| {
            found.sort_by(|a, b| a.value.total_cmp(&b.value));
            Some(StrokeTorque {
                min: *found.first()?,
                max: *found.last()?,
            })
        })
    }

    /// Returns crank angles between which the torque is smooth and resolved, from before `from` to after `to`, rad, both
    /// of them and the rows of tables between them included.
    pub(super) fn grid(&self, from: f64, to: f64) -> Vec<f64> {
        let mut corners = self.equation.loads().corners_between(from, to);
        corners.extend([from, to]);
        self.linkage().grid_between(from, to, &corners)
    }

    /// Locates possible extremes of the torque on a stroke within the cycle: its ends and local extremes.
    fn extremes(&self, from: f64, to: f64) -> Vec<Located> {
        let grid = self.grid(from, to);
        let peaks = |sign: f64| {
            let torque = |theta: f64| Some(sign * self.torque(theta)).filter(|t| t.is_finite());
            maximum::peaks(|theta| torque(theta).unwrap_or(f64::NEG_INFINITY), &grid)
        };
        let tops = [1.0, -1.0].into_iter().flat_map(peaks);
        let tops = tops.map(|(theta, _)| theta);
        tops.filter(|theta| (from..=to).contains(theta))
            .chain([from, to])
            .map(|theta| Located {
                value: self.torque(theta),
                theta_rad: theta % self.whole(),
            })
            .filter(|located| located.value.is_finite())
            .collect()
    }
}
