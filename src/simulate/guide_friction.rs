//! Coulomb friction at the guide of a crank that turns fully: the slider reverses at the dead centres only.

use crate::engine::angle::{State, Table};
use crate::mechanism::{
    Curve, CurveEquation, Equation, GuideForces, LoadValue, Loads, Normal, UnitLoadEffects,
};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::Interval;
use crate::scene::{Instant, Scene};

/// Distance from a dead centre, rad, within which the crank is at it and x' has no sign: far above its rounding.
pub(super) const DEAD_CENTRE_WIDTH: f64 = 1e-12;
/// Distance from an angle, rad, at which signs are read and slopes are taken: far above rounding, far below a radian.
pub(super) const NEARBY_ANGLE: f64 = 1e-6;

#[derive(Debug)]
pub(super) struct GuideFriction {
    /// Equation of motion on the curve, with the force of the guide.
    pub equation: CurveEquation,
    /// Kinetic coefficient of friction.
    pub mu: f64,
}

/// Effect of the loads on the guide at one position of a panel.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct GuideLoadEffect {
    /// dN/dτ, change of the normal force with a crank torque, 1/m
    torque: f64,
    /// dN/dF, change of the normal force with a slider force
    force: f64,
    /// Crank torque of the friction for one newton of frictionless normal force, N m/N.
    grip: f64,
}

impl GuideLoadEffect {
    /// Returns the part of a load in the frictionless normal force, N.
    pub fn normal_force(&self, load: LoadValue) -> f64 {
        self.torque * load.torque + self.force * load.force
    }

    /// Returns the crank torque of the friction that a load causes, N m.
    pub fn friction_torque(&self, load: LoadValue) -> f64 {
        self.grip * self.normal_force(load)
    }
}

/// Position as the loads see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelPlace {
    /// Slider position, m.
    pub x: f64,
    /// Derivative of the slider position by the crank angle, m/rad.
    pub dx: f64,
    /// Effect of the loads on the guide; zero without friction.
    pub load_effect: GuideLoadEffect,
}

impl PanelPlace {
    /// Converts states of the crank to instants of the loads.
    #[inline]
    pub fn instants<const N: usize>(at: &[State<'_, PanelPlace>; N]) -> [Instant; N] {
        let mut instants = [Instant::default(); N];
        for (instant, at) in instants.iter_mut().zip(at) {
            let PanelPlace { x, dx, .. } = *at.place;
            *instant = Instant {
                t: at.t,
                theta: at.angle.radians(),
                omega: at.speed,
                x,
                v: dx * at.speed,
            };
        }
        instants
    }
}

/// Returns the sign of x' on a panel between two dead centres from x' at its nodes; at the ends it may be rounding.
pub(super) fn sign_between_dead_centres(dx: &[f64]) -> f64 {
    let larger = |a: f64, b: &f64| if a.abs() < b.abs() { *b } else { a };
    dx.iter().fold(0.0, larger).signum()
}

impl GuideFriction {
    /// Makes the guide of a scene; none without friction.
    pub fn new(scene: &Scene, equation: &Equation) -> Option<GuideFriction> {
        scene.friction?;
        let equation = CurveEquation::new(scene, Curve::on_crank(equation.linkage()));
        Some(GuideFriction {
            mu: equation.friction?.coefficient,
            equation,
        })
    }

    /// Adds friction to the table of a panel between two dead centres. At its nodes: x' (m/rad), normal forces and, in
    /// `of_place`, the loads of the position alone. `signs`: sgn(ω) sgn(N).
    pub fn tabulate(
        &self,
        (dx, normals): (&[f64], &[Normal]),
        signs: f64,
        loads: &Loads,
        of_place: &[LoadValue],
        table: &mut Table<PanelPlace>,
    ) {
        let c = -self.mu * signs * sign_between_dead_centres(dx);
        let LoadValue { torque, force } = loads.damping;
        let mut switch = table.switch.take().unwrap_or_default();
        for (i, normal) in normals.iter().enumerate() {
            let load_effect = GuideLoadEffect {
                torque: normal.torque,
                force: normal.force,
                // The plan takes another engine where rigid bodies jam at an angle of the turn.
                grip: normal.grip(c).unwrap_or(f64::NAN),
            };
            let force = force * dx[i];
            let damping = LoadValue { torque, force };
            switch.place[i] = normal.place + load_effect.normal_force(of_place[i]);
            switch.rate[i] = -load_effect.normal_force(damping);
            switch.square[i] = normal.square;
            switch.force[i] = load_effect.grip * normal.square;
            table.push[i] += load_effect.grip * switch.place[i];
            table.damping[i] += load_effect.friction_torque(damping);
            if let Some(spot) = table.places.get_mut(i) {
                spot.load_effect = load_effect;
            }
        }
        table.switch = Some(switch);
    }

    /// Computes the largest crank torque of friction for a unit load, N m, at the ends and the middle of a range of
    /// angles (rad): the nodes of a panel show the effect of the linkage between them.
    pub fn unit_load_effects(&self, angle: Interval) -> UnitLoadEffects {
        let at = |theta: f64| {
            let normal = self.equation.terms(theta).normal();
            let grip = |c| normal.grip(c).unwrap_or(f64::INFINITY).abs();
            let most = grip(self.mu).max(grip(-self.mu));
            UnitLoadEffects {
                torque: normal.torque * most,
                force: normal.force * most,
            }
        };
        [angle.low, angle.middle(), angle.high]
            .map(at)
            .into_iter()
            .fold(UnitLoadEffects::default(), UnitLoadEffects::larger)
    }

    /// Returns θ̈ (rad/s²) and the forces of the guide; zeros at rest.
    pub fn state(&self, t: f64, angle: Angle, omega: f64) -> (f64, GuideForces) {
        if omega == 0.0 {
            return (0.0, GuideForces::default());
        }
        let free = self.equation.free(t, angle, omega);
        let crank = self.equation.curve().linkage.r;
        let mut dx = free.dx;
        if dx.abs() < DEAD_CENTRE_WIDTH * crank {
            // At a dead centre x' is taken just before it, at the start of the run just after it.
            let way = NEARBY_ANGLE.copysign(if t == 0.0 { omega } else { -omega });
            dx = self.equation.curve().pose(angle.rest + way).dx;
        }
        let sgn_v = (dx * omega).signum();
        free.sliding(free.opposing(self.mu, sgn_v))
    }
}
