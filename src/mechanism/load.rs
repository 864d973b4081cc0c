//! Virtual work of the loads: all that is linear is summed once, the rest is called.

use super::nonlinear_loads::NonlinearLoads;
use super::{LoadValue, Pose};
use crate::numeric::angle::Angle;
use crate::scene::{Instant, Load, Scene, Variables};

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
    /// Loads of the position alone, without a potential that is known.
    pub(super) placed: NonlinearLoads,
    /// Loads of the time alone.
    pub(super) timed: NonlinearLoads,
    /// All others.
    pub(super) mixed: NonlinearLoads,
    /// Loads that oppose motion.
    pub(super) dry: NonlinearLoads,
    reads: Variables,
    pub(super) on_slider: bool,
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
                other => loads.class(other, false).torques.push(other.clone()),
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
                other => loads.class(other, true).forces.push(other.clone()),
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

    /// Whether there is no load at all.
    pub fn are_none(&self) -> bool {
        self.torque == 0.0 && self.force == 0.0 && self.stiffness == 0.0 && self.have_potential()
    }

    /// Whether all work of the loads follows from a potential.
    pub fn have_potential(&self) -> bool {
        self.rotary_damping == 0.0 && self.linear_damping == 0.0 && self.are_linear()
    }

    /// Whether all loads are linear in position and speed.
    pub fn are_linear(&self) -> bool {
        self.called().next().is_none()
    }

    fn class(&mut self, load: &Load, on_slider: bool) -> &mut NonlinearLoads {
        let reads = load.reads(on_slider);
        let position = Variables::THETA.or(Variables::X);
        if matches!(load, Load::Dry(_)) {
            &mut self.dry
        } else if reads.or(position) == position {
            &mut self.placed
        } else if reads == Variables::T {
            &mut self.timed
        } else {
            &mut self.mixed
        }
    }

    pub(super) fn called(&self) -> impl Iterator<Item = &Load> {
        let classes = [&self.placed, &self.timed, &self.mixed, &self.dry];
        classes.into_iter().flat_map(NonlinearLoads::loads)
    }

    /// Whether there are loads that depend on speed or time otherwise than by damping.
    pub fn are_called(&self) -> bool {
        !(self.timed.is_empty() && self.mixed.is_empty() && self.dry.is_empty())
    }

    /// Crank angles, rad, at which tables over the crank angle have their rows.
    pub fn angle_corners(&self) -> Vec<f64> {
        self.called().flat_map(Load::angle_corners).collect()
    }

    /// Corners between two angles, rad.
    pub fn corners_between(&self, low: f64, high: f64) -> Vec<f64> {
        let corners = |load: &Load| load.corners_between(low, high);
        self.called().flat_map(corners).collect()
    }

    /// Crank angles between two, rad, at which tables have rows that do not keep step with the turns.
    pub fn corners_out_of_step(&self, low: f64, high: f64) -> Vec<f64> {
        let corners = |load: &Load| load.corners_out_of_step(low, high);
        self.called().flat_map(corners).collect()
    }

    /// The first of them, rad, after `from` on the way to `to`, in either direction.
    pub fn corner_out_of_step(&self, from: f64, to: f64) -> Option<f64> {
        self.first_on_way(from, |load| load.corner_out_of_step(from, to))
    }

    /// The first row, rad, of tables over the crank angle after `from` on the way to `to`, in either direction.
    pub fn row_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.first_on_way(from, |load| load.row_on_way(from, to))
    }

    fn first_on_way(&self, from: f64, corner: impl Fn(&Load) -> Option<f64>) -> Option<f64> {
        let corners = self.called().filter_map(corner);
        corners.min_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs()))
    }

    /// The constant torque on the crank, N m.
    pub fn constant_torque(&self) -> f64 {
        self.torque
    }

    /// The next time after `t` (s) at which a load is not smooth in time.
    pub fn next_corner(&self, t: f64) -> f64 {
        self.called()
            .map(|load| load.next_corner(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// Torque and force of all loads together.
    pub fn value(&self, t: f64, theta: impl Into<Angle>, omega: f64, pose: &Pose) -> LoadValue {
        let steady = self.with_potential_at(pose.x);
        let rest = self.without_potential(t, theta, omega, pose);
        steady.plus(rest)
    }

    /// Loads with a potential at slider position x, m.
    pub fn with_potential_at(&self, x: f64) -> LoadValue {
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
        if self.timed.is_empty() {
            return LoadValue::default();
        }
        let now = Instant {
            t,
            ..Instant::default()
        };
        self.timed.value(&now)
    }

    /// Torque and force of the loads without a potential that depend on the position alone, at slider position
    /// x, m.
    pub fn of_place(&self, theta: impl Into<Angle>, x: f64) -> LoadValue {
        if self.placed.is_empty() {
            return LoadValue::default();
        }
        self.placed.value(&Instant {
            theta: theta.into().radians(),
            x,
            ..Instant::default()
        })
    }

    /// −dQ/dω of the loads that are linear in the speed, N m s/rad, where x' is `dx` (m/rad).
    pub fn damping(&self, dx: f64) -> f64 {
        self.rotary_damping + self.linear_damping * dx * dx
    }

    /// −d torque/dω (N m s/rad) and −d force/dv (N s/m) of the same.
    pub fn dampings(&self) -> [f64; 2] {
        [self.rotary_damping, self.linear_damping]
    }

    /// Torque and force of the loads of speed and time that are no damping, at some instants.
    pub fn of_states<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        let mut sums = self.timed.values(now);
        if !self.mixed.is_empty() {
            for (sum, mixed) in sums.iter_mut().zip(&self.mixed.values(now)) {
                *sum = sum.plus(*mixed);
            }
        }
        sums
    }

    fn mixed_at(&self, t: f64, theta: Angle, omega: f64, [x, dx]: [f64; 2]) -> LoadValue {
        if self.mixed.is_empty() {
            return LoadValue::default();
        }
        self.mixed.value(&Instant {
            t,
            theta: theta.radians(),
            omega,
            x,
            v: dx * omega,
        })
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
        let theta = theta.into();
        let damped = LoadValue {
            torque: -self.rotary_damping * omega,
            force: -self.linear_damping * (dx * omega),
        };
        let mixed = self.mixed_at(t, theta, omega, [x, dx]);
        damped
            .plus(of_time)
            .plus(self.of_place(theta, x))
            .plus(mixed)
            .plus(self.dry_of_speed(t, theta, omega, [x, dx]))
    }

    /// Torque and force of the loads whose work must be integrated, without dry ones.
    pub(super) fn spent(&self, now: &Instant) -> LoadValue {
        let damped = LoadValue {
            torque: -self.rotary_damping * now.omega,
            force: -self.linear_damping * now.v,
        };
        let called = [&self.placed, &self.timed, &self.mixed];
        let called = called.into_iter().filter(|loads| !loads.is_empty());
        called.fold(damped, |sum, loads| sum.plus(loads.value(now)))
    }

    /// Torque and force of all loads together, for a slider whose motion is not that of the ideal joints.
    pub fn at(&self, now: &Instant) -> LoadValue {
        let spent = self.spent(now).plus(self.dry.value(now));
        self.with_potential_at(now.x).plus(spent)
    }

    /// Potential of the loads that have one, J, from crank angle (from any fixed start) and position.
    pub fn potential(&self, theta: f64, x: f64) -> f64 {
        -self.torque * theta - self.force * x + 0.5 * self.stiffness * x * x
    }
}
