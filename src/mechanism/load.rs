//! Virtual work of the loads: all that is linear is summed once, the rest is called.

use super::nonlinear_loads::NonlinearLoads;
use super::{LoadValue, Pose, Sense};
use crate::numeric::angle::Angle;
use crate::scene::{Instant, Load, LoadOf, Scene, Variables};

/// All loads of a scene. Those with a potential (constant torque and force, springs) are kept apart from
/// those whose work must be integrated.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    constant: LoadValue,
    /// −d torque/dω, N m s/rad, and −d force/dv, N s/m.
    damping: LoadValue,
    stiffness: f64,
    /// Loads of the position alone, without a potential that is known.
    pub(super) placed: NonlinearLoads,
    /// Loads of the time alone.
    pub(super) timed: NonlinearLoads,
    /// All others.
    pub(super) mixed: NonlinearLoads,
    /// Loads that oppose motion.
    pub(super) dry: NonlinearLoads,
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
        for LoadOf {
            load, on_slider, ..
        } in scene.loads()
        {
            loads.reads = loads.reads.or(load.reads(on_slider));
            match load {
                Load::Viscous(coefficient) => *loads.damping.on(on_slider) += coefficient,
                Load::Motor {
                    stall,
                    no_load_speed,
                } if !on_slider => {
                    loads.constant.torque += stall;
                    loads.damping.torque += stall / no_load_speed;
                }
                Load::Spring { stiffness, rest } if on_slider => {
                    loads.stiffness += stiffness;
                    loads.constant.force += stiffness * rest;
                }
                other => match other.fixed() {
                    Some(value) => *loads.constant.on(on_slider) += value,
                    None => loads.class(other, on_slider).push(other, on_slider),
                },
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
        self.constant == LoadValue::default() && self.stiffness == 0.0 && self.have_potential()
    }

    /// Whether all work of the loads follows from a potential.
    pub fn have_potential(&self) -> bool {
        self.damping == LoadValue::default() && self.are_linear()
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

    fn classes(&self) -> [&NonlinearLoads; 4] {
        [&self.placed, &self.timed, &self.mixed, &self.dry]
    }

    pub(super) fn called(&self) -> impl Iterator<Item = &Load> {
        self.classes().into_iter().flat_map(NonlinearLoads::loads)
    }

    /// The first load that has no finite value.
    pub fn without_value(&self, now: &Instant) -> Option<&Load> {
        let mut classes = self.classes().into_iter();
        classes.find_map(|class| class.without_value(now))
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
        self.constant.torque
    }

    /// Whether there are loads that oppose motion.
    pub fn are_dry(&self) -> bool {
        !self.dry.is_empty()
    }

    /// Whether such loads act on the crank, and on the slider.
    pub fn dry_on(&self) -> [bool; 2] {
        [false, true].map(|slider| self.dry.are_on(slider))
    }

    /// What they oppose motion with at most, N m and N.
    pub fn dry_magnitude(&self, now: &Instant) -> LoadValue {
        self.dry.magnitude(now)
    }

    /// Torque and force of the dry loads against motion in these senses.
    pub fn dry(&self, now: &Instant, against: Sense) -> LoadValue {
        let most = self.dry_magnitude(now);
        LoadValue {
            torque: -against.crank * most.torque,
            force: -against.slider * most.force,
        }
    }

    /// The next time after `t` (s) at which a load is not smooth in time.
    pub fn next_corner(&self, t: f64) -> f64 {
        self.called()
            .map(|load| load.next_corner(t))
            .fold(f64::INFINITY, f64::min)
    }

    /// Torque and force of all loads together.
    pub fn value(&self, t: f64, theta: impl Into<Angle>, omega: f64, pose: &Pose) -> LoadValue {
        let non_conservative = self.without_potential(t, theta, omega, pose);
        self.with_potential_at(pose.x).plus(non_conservative)
    }

    /// Loads with a potential at slider position x, m.
    pub fn with_potential_at(&self, x: f64) -> LoadValue {
        LoadValue {
            torque: self.constant.torque,
            force: self.constant.force - self.stiffness * x,
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
        self.without_potential_beside(self.of_time(t), &pose.instant(t, theta, omega))
    }

    /// Torque and force of the loads that depend on time (s) alone.
    pub fn of_time(&self, t: f64) -> LoadValue {
        self.timed.value(&Instant {
            t,
            ..Instant::default()
        })
    }

    /// Torque and force of the loads without a potential that depend on the position alone, at slider position
    /// x, m.
    pub fn of_place(&self, theta: impl Into<Angle>, x: f64) -> LoadValue {
        self.placed.value(&instant(0.0, theta, 0.0, [x, 0.0]))
    }

    /// −dQ/dω of the loads that are linear in the speed, N m s/rad, where x' is `dx` (m/rad).
    pub fn damping(&self, dx: f64) -> f64 {
        self.damping.torque + self.damping.force * dx * dx
    }

    /// −d torque/dω (N m s/rad) and −d force/dv (N s/m) of the same.
    pub fn dampings(&self) -> [f64; 2] {
        [self.damping.torque, self.damping.force]
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

    /// As [`Self::without_potential`], with [`Self::of_time`] already known.
    pub(super) fn without_potential_beside(&self, of_time: LoadValue, now: &Instant) -> LoadValue {
        let called = [&self.placed, &self.mixed, &self.dry].map(|loads| loads.value(now));
        let damped = self.damped(now).plus(of_time);
        called.into_iter().fold(damped, LoadValue::plus)
    }

    fn damped(&self, now: &Instant) -> LoadValue {
        LoadValue {
            torque: -self.damping.torque * now.omega,
            force: -self.damping.force * now.v,
        }
    }

    /// Torque and force of the loads whose work must be integrated, without dry ones.
    pub(super) fn non_conservative(&self, now: &Instant) -> LoadValue {
        let called = [&self.placed, &self.timed, &self.mixed].map(|loads| loads.value(now));
        called.into_iter().fold(self.damped(now), LoadValue::plus)
    }

    /// Torque and force of all loads together, also for a slider whose motion is not that of the ideal joints.
    pub fn at(&self, now: &Instant) -> LoadValue {
        let non_conservative = self.non_conservative(now).plus(self.dry.value(now));
        self.with_potential_at(now.x).plus(non_conservative)
    }

    /// Potential of the loads that have one, J, from crank angle (from any fixed start) and position.
    pub fn potential(&self, theta: f64, x: f64) -> f64 {
        let LoadValue { torque, force } = self.constant;
        -torque * theta - force * x + 0.5 * self.stiffness * x * x
    }
}

impl Pose {
    /// What loads see of a motion through it, at a time (s), crank angle (rad) and speed (rad/s).
    pub fn instant(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> Instant {
        instant(t, theta, omega, [self.x, self.dx])
    }
}

/// What loads see of a motion with these slider position x (m) and x' (m/rad).
pub(super) fn instant(t: f64, theta: impl Into<Angle>, omega: f64, [x, dx]: [f64; 2]) -> Instant {
    Instant {
        t,
        theta: theta.into().radians(),
        omega,
        x,
        v: dx * omega,
    }
}
