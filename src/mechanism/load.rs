//! Virtual work of the loads: all that is linear is summed once, the rest is called.

use super::Pose;
use crate::numeric::angle::Angle;
use crate::scene::{Instant, Load, Scene, Variable, Variables};

/// Torque on the crank and force on the slider at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadValue {
    /// N m, counter-clockwise
    pub torque: f64,
    /// N, along +x
    pub force: f64,
}

impl LoadValue {
    /// The generalized force Q = τ + F x', N m.
    pub fn generalized(&self, pose: &Pose) -> f64 {
        self.torque + self.force * pose.dx
    }
}

/// All loads of a scene. Those with a potential (constant torque and force, springs) are kept apart from
/// those whose work must be integrated.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    torque: f64,
    /// −d torque/d omega, N m s/rad
    rotary_damping: f64,
    force: f64,
    stiffness: f64,
    /// −d force/d v, N s/m
    linear_damping: f64,
    /// Loads that are called, beside those of time alone.
    torques: Vec<Load>,
    forces: Vec<Load>,
    /// Loads that depend on time alone.
    timed_torques: Vec<Load>,
    timed_forces: Vec<Load>,
    reads: Variables,
    on_slider: bool,
}

impl Loads {
    /// The loads of a scene.
    pub fn new(scene: &Scene) -> Loads {
        let mut loads = Loads {
            on_slider: !scene.forces.is_empty(),
            ..Loads::default()
        };
        for load in &scene.torques {
            loads.reads = loads.reads.or(load.reads(false));
            if let Some(value) = load.fixed() {
                loads.torque += value;
                continue;
            }
            match load {
                Load::Viscous(coefficient) => loads.rotary_damping += coefficient,
                Load::Motor {
                    stall,
                    no_load_speed,
                } => {
                    loads.torque += stall;
                    loads.rotary_damping += stall / no_load_speed;
                }
                other if depends_on_time_alone(other, false) => {
                    loads.timed_torques.push(other.clone());
                }
                other => loads.torques.push(other.clone()),
            }
        }
        for load in &scene.forces {
            loads.reads = loads.reads.or(load.reads(true));
            if let Some(value) = load.fixed() {
                loads.force += value;
                continue;
            }
            match load {
                Load::Viscous(coefficient) => loads.linear_damping += coefficient,
                Load::Spring { stiffness, rest } => {
                    loads.stiffness += stiffness;
                    loads.force += stiffness * rest;
                }
                other if depends_on_time_alone(other, true) => {
                    loads.timed_forces.push(other.clone());
                }
                other => loads.forces.push(other.clone()),
            }
        }
        loads
    }

    /// What the loads depend on.
    pub fn reads(&self) -> Variables {
        self.reads
    }

    /// Whether a force acts on the slider.
    pub fn on_slider(&self) -> bool {
        self.on_slider
    }

    /// Whether all work of the loads follows from a potential.
    pub fn have_potential(&self) -> bool {
        self.rotary_damping == 0.0 && self.linear_damping == 0.0 && self.called().next().is_none()
    }

    fn called(&self) -> impl Iterator<Item = &Load> {
        let torques = self.torques.iter().chain(&self.timed_torques);
        torques.chain(&self.forces).chain(&self.timed_forces)
    }

    /// Crank angles, rad, at which tables over the crank angle have their rows.
    pub fn angle_corners(&self) -> Vec<f64> {
        self.called().flat_map(Load::angle_corners).collect()
    }

    /// Whether a constant torque does work in every turn.
    pub fn turn_the_crank(&self) -> bool {
        self.torque != 0.0
    }

    /// The next time after `t` (s) at which a load is not smooth in time.
    pub fn next_corner(&self, t: f64) -> f64 {
        self.called()
            .map(|load| load.next_corner(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// Torque and force of all loads together.
    pub fn value(&self, t: f64, theta: impl Into<Angle>, omega: f64, pose: &Pose) -> LoadValue {
        let steady = self.with_potential(pose);
        let rest = self.without_potential(t, theta, omega, pose);
        LoadValue {
            torque: steady.torque + rest.torque,
            force: steady.force + rest.force,
        }
    }

    /// Torque and force of the loads that have a potential.
    pub fn with_potential(&self, pose: &Pose) -> LoadValue {
        self.with_potential_at(pose.x)
    }

    /// The same at slider position x, m.
    pub(super) fn with_potential_at(&self, x: f64) -> LoadValue {
        LoadValue {
            torque: self.torque,
            force: self.force - self.stiffness * x,
        }
    }

    /// Torque and force of the loads whose work must be integrated.
    pub fn without_potential(
        &self,
        t: f64,
        theta: impl Into<Angle>,
        omega: f64,
        pose: &Pose,
    ) -> LoadValue {
        self.without_potential_beside(self.of_time(t), t, theta, omega, pose.x, pose.dx)
    }

    /// Torque and force of the loads that depend on time (s) alone.
    pub fn of_time(&self, t: f64) -> LoadValue {
        let now = Instant {
            t,
            ..Instant::default()
        };
        LoadValue {
            torque: sum(&self.timed_torques, false, &now),
            force: sum(&self.timed_forces, true, &now),
        }
    }

    /// As [`Self::without_potential`], with [`Self::of_time`] already known, at slider position x (m) and its derivative.
    pub(super) fn without_potential_beside(
        &self,
        of_time: LoadValue,
        t: f64,
        theta: impl Into<Angle>,
        omega: f64,
        x: f64,
        dx: f64,
    ) -> LoadValue {
        let v = dx * omega;
        let mut value = LoadValue {
            torque: of_time.torque - self.rotary_damping * omega,
            force: of_time.force - self.linear_damping * v,
        };
        if !(self.torques.is_empty() && self.forces.is_empty()) {
            let now = Instant {
                t,
                theta: theta.into().radians(),
                omega,
                x,
                v,
            };
            value.torque += sum(&self.torques, false, &now);
            value.force += sum(&self.forces, true, &now);
        }
        value
    }

    /// Potential of the loads that have one, J, from crank angle (from any fixed start) and position.
    pub fn potential(&self, theta: f64, x: f64) -> f64 {
        -self.torque * theta - self.force * x + 0.5 * self.stiffness * x * x
    }
}

fn depends_on_time_alone(load: &Load, on_slider: bool) -> bool {
    load.reads(on_slider) == Variables::T
}

fn sum(loads: &[Load], on_slider: bool, now: &Instant) -> f64 {
    loads.iter().map(|load| single(load, on_slider, now)).sum()
}

/// Value of one load, as a torque or as a force on the slider.
pub fn single(load: &Load, on_slider: bool, now: &Instant) -> f64 {
    match load {
        Load::Constant(value) => *value,
        Load::Viscous(coefficient) if on_slider => -coefficient * now.v,
        Load::Viscous(coefficient) => -coefficient * now.omega,
        Load::Motor {
            stall,
            no_load_speed,
        } => stall * (1.0 - now.omega / no_load_speed),
        Load::Spring { stiffness, rest } => -stiffness * (now.x - rest),
        Load::Table(table) => table.value(now.get(table.of())),
        Load::Gas {
            pressure,
            ambient,
            area,
            towards_crank,
        } => towards_crank * (pressure.value(now.get(Variable::Theta)) - ambient) * area,
        Load::Expression(expression) => expression.value(now),
        Load::Function { function, .. } => function(now),
    }
}
