//! Loads of a scene as crank torque and slider force: linear ones are summed once, the others evaluated when asked for.

use super::nonlinear_loads::NonlinearLoads;
use super::{LoadValue, Pose, Sense};
use crate::numeric::angle::Angle;
use crate::scene::{Instant, Load, Scene, Variables};

/// Loads of a scene; those with a potential (constants, springs) apart from those whose work must be integrated.
#[derive(Clone, Debug, Default)]
pub struct Loads {
    /// Constant torque, N m, and force, N.
    pub constant: LoadValue,
    /// Damping coefficients −d torque/dω, N m s/rad, and −d force/dv, N s/m.
    pub damping: LoadValue,
    pub(super) stiffness: f64,
    /// Loads of the position alone, without a known potential.
    pub(super) placed: NonlinearLoads,
    /// Loads of the time alone.
    pub(super) timed: NonlinearLoads,
    /// All others.
    pub(super) mixed: NonlinearLoads,
    /// Dry loads, which oppose motion.
    pub(super) dry: NonlinearLoads,
    /// Variables that the loads depend on.
    pub reads: Variables,
    /// Variables that the nonlinear loads of speed or time depend on.
    pub reads_of_states: Variables,
    /// Whether a force acts on the slider.
    pub on_slider: bool,
}

impl Loads {
    /// Collects the loads of a scene.
    pub fn new(scene: &Scene) -> Loads {
        let mut loads = Loads {
            on_slider: !scene.forces.is_empty(),
            ..Loads::default()
        };
        for of in scene.loads() {
            let on_slider = of.key.on_slider;
            // With a loose joint nothing is held at rest.
            let parts = match scene.clearance {
                Some(_) => vec![of.load.clone()],
                None => of.load.parts(on_slider),
            };
            for part in parts {
                loads.add(part, on_slider);
            }
        }
        loads
    }

    fn add(&mut self, load: Load, on_slider: bool) {
        self.reads = self.reads.or(load.reads(on_slider));
        match load {
            Load::Viscous(coefficient) => *self.damping.on(on_slider) += coefficient,
            Load::Motor {
                stall,
                no_load_speed,
            } if !on_slider => {
                self.constant.torque += stall;
                self.damping.torque += stall / no_load_speed;
            }
            Load::Spring { stiffness, rest } if on_slider => {
                self.stiffness += stiffness;
                self.constant.force += stiffness * rest;
            }
            other => match other.fixed() {
                Some(value) => *self.constant.on(on_slider) += value,
                None => self.class(&other, on_slider).0.push((other, on_slider)),
            },
        }
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
        if reads.or(position) == position {
            return &mut self.placed;
        }
        self.reads_of_states = self.reads_of_states.or(reads);
        match load {
            Load::Dry(_) => &mut self.dry,
            _ if reads == Variables::T => &mut self.timed,
            _ => &mut self.mixed,
        }
    }

    pub(super) fn classes(&self) -> [&NonlinearLoads; 4] {
        [&self.placed, &self.timed, &self.mixed, &self.dry]
    }

    /// Iterates over the nonlinear loads.
    pub fn called(&self) -> impl Iterator<Item = &Load> {
        self.classes().into_iter().flat_map(NonlinearLoads::loads)
    }

    /// Returns the first load that has no finite value.
    pub fn without_value(&self, now: &Instant) -> Option<&Load> {
        let classes = self.classes();
        classes.into_iter().find_map(|of| of.without_value(now))
    }

    /// Whether a load depends on speed or time other than by linear damping.
    pub fn have_nonlinear_rates(&self) -> bool {
        !(self.timed.is_empty() && self.mixed.is_empty() && self.dry.is_empty())
    }

    /// Returns the rows of tables over the crank angle between two angles, rad.
    pub fn corners_between(&self, low: f64, high: f64) -> Vec<f64> {
        let corners = |load: &Load| load.corners_between(low, high);
        self.called().flat_map(corners).collect()
    }

    /// Returns the first row out of step with the turns, rad, after `from` on the way to `to`, in either direction.
    pub fn corner_out_of_step(&self, from: f64, to: f64) -> Option<f64> {
        self.first_on_way(from, |load| load.out_of_step()?.row_on_way(from, to))
    }

    /// Returns the first row, rad, of tables over the crank angle after `from` on the way to `to`, in either direction.
    pub fn row_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.first_on_way(from, |load| load.row_on_way(from, to))
    }

    fn first_on_way(&self, from: f64, corner: impl Fn(&Load) -> Option<f64>) -> Option<f64> {
        let corners = self.called().filter_map(corner);
        corners.min_by(|a, b| (a - from).abs().total_cmp(&(b - from).abs()))
    }

    /// Whether the scene has dry loads, which oppose motion.
    pub fn are_dry(&self) -> bool {
        !self.dry.is_empty()
    }

    /// Whether dry loads act on the crank, and on the slider.
    pub fn dry_on(&self) -> [bool; 2] {
        [false, true].map(|slider| self.dry.are_on(slider))
    }

    /// Returns the magnitudes with which the dry loads oppose motion, N m and N.
    pub fn dry_magnitude(&self, now: &Instant) -> LoadValue {
        self.dry.magnitude(now)
    }

    /// Returns torque and force of the dry loads against motion in these senses.
    pub fn dry(&self, now: &Instant, against: Sense) -> LoadValue {
        let most = self.dry_magnitude(now);
        LoadValue {
            torque: -against.crank * most.torque,
            force: -against.slider * most.force,
        }
    }

    /// Returns the next time after `t` (s) at which a load is not smooth in time; infinite if none is known.
    pub fn next_corner(&self, t: f64) -> f64 {
        let corners = self.called().map(|load| load.next_corner(t));
        corners.fold(f64::INFINITY, f64::min)
    }

    /// Returns torque and force of all loads together.
    pub fn value(&self, t: f64, theta: impl Into<Angle>, omega: f64, pose: &Pose) -> LoadValue {
        self.at(&pose.instant(t, theta, omega))
    }

    /// Returns torque and force of the loads with a potential at slider position x, m.
    pub fn with_potential_at(&self, x: f64) -> LoadValue {
        LoadValue {
            torque: self.constant.torque,
            force: self.constant.force - self.stiffness * x,
        }
    }

    /// Returns torque and force of the loads whose work must be integrated.
    pub fn without_potential(&self, now: &Instant) -> LoadValue {
        let [dry] = NonlinearLoads::sums([&self.dry], &[*now]);
        self.non_conservative(now).plus(dry)
    }

    /// Returns torque and force of the loads that depend on time alone, at some times, s.
    pub fn of_times<const N: usize>(&self, t: &[f64; N]) -> [LoadValue; N] {
        let now = t.map(|t| instant(t, Angle::default(), 0.0, [0.0; 2]));
        NonlinearLoads::sums([&self.timed], &now)
    }

    /// Returns torque and force of the loads of position alone without a known potential, at slider position x, m.
    pub fn of_place(&self, theta: impl Into<Angle>, x: f64) -> LoadValue {
        if self.placed.is_empty() {
            return LoadValue::default();
        }
        let now = instant(0.0, theta, 0.0, [x, 0.0]);
        let [value] = NonlinearLoads::sums([&self.placed], &[now]);
        value
    }

    /// Returns −dQ/dω of the loads that are linear in the speed, N m s/rad, where x' is `dx` (m/rad).
    pub fn damping(&self, dx: f64) -> f64 {
        self.damping.torque + self.damping.force * dx * dx
    }

    /// Returns torque and force of the nonlinear loads of speed or time at some instants.
    pub fn of_states<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        NonlinearLoads::sums([&self.timed, &self.mixed, &self.dry], now)
    }

    /// Returns torque and force of the nonlinear loads, but for those of time alone, at some instants.
    pub(super) fn beside_time<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        NonlinearLoads::sums([&self.placed, &self.mixed, &self.dry], now)
    }

    /// Returns torque and force of the nonlinear loads at some instants, but for dry ones and those of time alone.
    pub(super) fn smooth_beside_time<const N: usize>(&self, now: &[Instant; N]) -> [LoadValue; N] {
        NonlinearLoads::sums([&self.placed, &self.mixed], now)
    }

    /// Returns torque and force of the loads that are linear in the speed.
    pub(super) fn damped(&self, now: &Instant) -> LoadValue {
        LoadValue {
            torque: -self.damping.torque * now.omega,
            force: -self.damping.force * now.v,
        }
    }

    /// Returns torque and force of the loads whose work must be integrated, without dry loads.
    pub fn non_conservative(&self, now: &Instant) -> LoadValue {
        let [called] = self.smooth_beside_time(&[*now]);
        let [timed] = self.of_times(&[now.t]);
        self.damped(now).plus(timed).plus(called)
    }

    /// Returns torque and force of all loads together, also for a slider whose motion is not that of the ideal joints.
    pub fn at(&self, now: &Instant) -> LoadValue {
        self.with_potential_at(now.x)
            .plus(self.without_potential(now))
    }

    /// Returns the potential of the loads that have one, J, from crank angle (from any fixed start) and position.
    pub fn potential(&self, theta: f64, x: f64) -> f64 {
        let LoadValue { torque, force } = self.constant;
        -torque * theta - force * x + 0.5 * self.stiffness * x * x
    }
}

impl Pose {
    /// Returns the variables of loads for a motion through this pose, at a time (s), crank angle (rad), speed (rad/s).
    pub fn instant(&self, t: f64, theta: impl Into<Angle>, omega: f64) -> Instant {
        instant(t, theta, omega, [self.x, self.dx])
    }
}

/// Returns the variables of loads for a motion with slider position x (m) and x' (m/rad).
pub(super) fn instant(t: f64, theta: impl Into<Angle>, omega: f64, [x, dx]: [f64; 2]) -> Instant {
    Instant {
        t,
        theta: theta.into().radians(),
        omega,
        x,
        v: dx * omega,
    }
}
