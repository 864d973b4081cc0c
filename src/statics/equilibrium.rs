//! Static slider force from the crank torque over the cycle of the loads, or the reverse, by virtual work, with the friction band.

use std::f64::consts::TAU;

use serde::Serialize;

use crate::error::Error;
use crate::kinematics::Located;
use crate::mechanism::{Equilibrium, Limits, NamedPosition, Statics};
use crate::numeric::angle;
use crate::plan::Cycle;
use crate::scene::{Load, Scene, Variables};

/// Values in place of the scene's own loads and friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StaticsOptions {
    /// Crank torque in place of the scene's torques, N m.
    pub torque: Option<f64>,
    /// Slider force in place of the scene's forces, N; with it the crank torque is sought.
    pub force: Option<f64>,
    /// Friction coefficient at the guide in place of the scene's static one.
    pub friction: Option<f64>,
}

/// Static equilibrium of a scene.
#[derive(Clone, Debug, Serialize)]
pub struct StaticAnalysis {
    /// Title of the scene.
    pub scene: String,
    /// Class of the mechanism.
    pub class: &'static str,
    /// `slider-force` or `crank-torque`.
    pub sought: &'static str,
    /// Static friction coefficient at the guide.
    pub friction: f64,
    /// Turns after which the loads repeat; 1 for loads that do not.
    pub cycle_turns: u32,
    /// Minima of the magnitude of the slider force (N) or crank torque (N m), without friction: zero where the loads
    /// balance each other.
    pub least: Vec<Located>,
    /// Minima of the magnitude of the edge of the friction band that is nearer to zero.
    pub least_with_friction: Vec<Located>,
    /// Intervals of crank angles, rad, in which guide friction locks the mechanism, from and to; none without friction.
    pub self_locking_rad: Vec<[f64; 2]>,
    /// Dead centres, self-locking intervals and other named positions, by angle.
    pub positions: Vec<NamedPosition>,
    /// Warnings about the result.
    pub warnings: Vec<String>,
    #[serde(skip)]
    pub(super) statics: Statics,
}

/// Equilibrium at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaticsRow {
    /// Crank angle, rad.
    pub theta: f64,
    /// Force or torque, side thrust, self-locking.
    pub balance: Equilibrium,
    /// Transmission angle, rad; not finite where the rod does not reach the guide.
    pub transmission: f64,
    /// Velocity of the slider over that of the crank pin, |x'|/r (Ng (A3)).
    pub velocity_ratio: f64,
    /// Interior angle between crank and rod at the crank pin, rad, 0 to π (Ng (11), Duarte et al. (10)).
    pub crank_pin_angle: f64,
}

/// Computes the static equilibrium of a scene at rest, at any offset, branch and weight.
///
/// # Errors
/// [`Error::Scene`] for impossible values, [`Error::Refused`] for a friction coefficient that is negative or not finite
/// and where [`Statics::new`] refuses.
///
/// ```
/// use slider_crank::scene::{Load, Scene};
/// use slider_crank::statics::{StaticsOptions, statics};
/// let scene = Scene::new(0.025, 0.072).torque(Load::Constant(0.26487));
/// let result = statics(&scene, &StaticsOptions::default()).unwrap();
/// let row = result.row(std::f64::consts::FRAC_PI_2);
/// assert!((row.balance.band.unwrap().value - 0.26487 / 0.025).abs() < 1e-12);
/// ```
pub fn statics(scene: &Scene, options: &StaticsOptions) -> Result<StaticAnalysis, Error> {
    let mut scene = scene.clone();
    if let Some(torque) = options.torque {
        scene.torques = vec![Load::Constant(torque)];
    }
    if let Some(force) = options.force {
        scene.forces = vec![Load::Constant(force)];
    }
    scene.check()?;
    let friction = options
        .friction
        .or(scene.friction.map(|friction| friction.static_coefficient))
        .unwrap_or(0.0);
    if !(0.0..=f64::MAX).contains(&friction) {
        return Err(Error::refused(
            format!("a friction coefficient of {friction} cannot be"),
            "give a number that is zero or more, like 0.1",
        ));
    }
    let statics = Statics::new(&scene, friction)?;
    let linkage = statics.equation.linkage();
    let limits = Limits::new(linkage, 0.0);
    let mut positions = linkage.named_positions();
    positions.extend(linkage.self_locking(friction));
    positions.sort_by(|a, b| a.theta_rad.total_cmp(&b.theta_rad));
    let locked = positions.iter().filter(|at| at.kind == "self-locking");
    let self_locking_rad = locked
        .filter_map(|at| Some([at.theta_rad, at.to_rad?]))
        .collect();
    let mut warnings = Vec::new();
    let reads = statics.equation.loads().reads;
    let motion = Variables::T.or(Variables::OMEGA).or(Variables::V);
    if !reads.disjoint(motion) {
        warnings
            .push("loads that depend on time or speed are taken at t = 0 and at rest".to_owned());
    }
    if scene.clearance.is_some() {
        warnings.push("the clearance of the scene plays no part in the equilibrium".to_owned());
    }
    let equation = &statics.equation;
    let without_value = |theta: f64| {
        linkage.pose(theta).is_regular() && !equation.load(0.0, theta, 0.0).is_finite()
    };
    let cycle_turns = Cycle::of(&scene).turns.unwrap_or(1);
    let turn = linkage.turn_grid(false);
    let whole = f64::from(cycle_turns) * TAU;
    let grid = angle::in_turns(&turn, 0..i64::from(cycle_turns));
    if grid.map(|theta| theta.rem_euclid(whole)).any(without_value) {
        warnings.push(
            "a load has no finite value at some crank angles, outside its table or the domain of its formula: their rows are left empty"
                .to_owned(),
        );
    }
    let mut result = StaticAnalysis {
        scene: scene.title.clone().unwrap_or_default(),
        class: limits.class.name(),
        sought: match options.force {
            Some(_) => "crank-torque",
            None => "slider-force",
        },
        friction,
        cycle_turns,
        least: Vec::new(),
        least_with_friction: Vec::new(),
        self_locking_rad,
        positions,
        warnings,
        statics,
    };
    [result.least, result.least_with_friction] = result.least();
    Ok(result)
}

impl StaticAnalysis {
    /// Returns the equilibrium at a crank angle, rad.
    pub fn row(&self, theta: f64) -> StaticsRow {
        let linkage = self.statics.equation.linkage();
        let pose = linkage.pose(theta);
        // Between the directions from A to O and from A to P.
        let (axis_x, axis_y) = (linkage.s * pose.cos_phi, -pose.sin_phi);
        let along = -(pose.cos * axis_x + pose.sin * axis_y);
        let across = pose.cos * axis_y - pose.sin * axis_x;
        StaticsRow {
            theta,
            balance: self.balance(theta),
            transmission: pose.transmission(),
            velocity_ratio: pose.dx.abs() / linkage.r,
            crank_pin_angle: across.abs().atan2(along),
        }
    }

    /// Iterates over the rows of the cycle, from angle 0 to its end inclusive, every `step` (rad).
    pub fn rows(&self, step: f64) -> impl Iterator<Item = StaticsRow> + '_ {
        angle::turns(self.cycle_turns, step).map(|theta| self.row(theta))
    }

    /// Returns the angle at which the cycle ends, rad.
    pub(super) fn whole(&self) -> f64 {
        f64::from(self.cycle_turns) * TAU
    }

    pub(super) fn balance(&self, theta: f64) -> Equilibrium {
        match self.sought {
            "crank-torque" => self.statics.crank_torque(theta),
            _ => self.statics.slider_force(theta),
        }
    }
}
