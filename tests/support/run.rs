//! One random case with its loads, the equation under test, and the sizes that scale rounding.

use slider_crank::mechanism::{Equation, Reactions, Terms};

use super::exact::Jet;
use super::newton::Parts;
use super::random::Case;
use super::{Sizes, close};

/// Case with its bodies, the torque and force acting on it, and the equation under test.
pub struct Run<'a> {
    pub case: &'a Case,
    pub equation: Equation,
    pub parts: Parts,
    pub torque: f64,
    pub force: f64,
    pub dx: f64,
    /// Size of the terms of the load Q.
    pub load_size: f64,
    /// Size of the terms of the force.
    pub force_size: f64,
}

impl Run<'_> {
    pub fn new(case: &Case) -> Run<'_> {
        let parts = Parts::new(&case.scene, case.theta);
        let (x, dx) = (parts.exact.p[0].value(), parts.exact.p[0].d(1));
        let [torque, force] = case
            .drive
            .value(case.t, case.theta, case.omega, x, dx * case.omega);
        let sizes = Sizes::new(&case.scene.geometry, &parts.exact);
        let [torque_size, force_size] = case.drive.sizes(sizes.x, sizes.dx, case.omega);
        Run {
            case,
            equation: Equation::new(&case.scene),
            parts,
            torque,
            force,
            dx,
            load_size: torque_size + force_size * sizes.dx,
            force_size,
        }
    }

    pub fn terms(&self) -> Terms {
        self.equation.terms(self.case.theta)
    }

    pub fn acceleration(&self) -> f64 {
        self.equation
            .acceleration(self.case.t, self.case.theta, self.case.omega)
    }

    /// Returns M, ½ M' and V' of the bodies.
    pub fn expected_terms(&self) -> [f64; 3] {
        let Parts { all, gravity, .. } = &self.parts;
        let inertia = all
            .iter()
            .fold(Jet::from(0.0), |sum, part| sum + part.inertia());
        let potential = all
            .iter()
            .fold(Jet::from(0.0), |sum, part| sum + part.potential(*gravity));
        [inertia.d(0), 0.5 * inertia.d(1), potential.d(1)]
    }

    /// Returns the size of the joint forces of a motion, N.
    pub fn joint_size(&self, alpha: f64) -> f64 {
        let length = self.case.scene.geometry.rod;
        self.parts.force_size(self.case.omega, alpha, length)
            + self.force_size / self.parts.exact.cos_phi.value()
    }

    /// Returns the size of the terms of the equation for a motion, N m.
    pub fn size(&self, alpha: f64) -> f64 {
        let [m, half_dm, dv] = self.parts.sizes();
        m * alpha.abs() + half_dm * self.case.omega.powi(2) + dv + self.load_size
    }
}

/// Checks every joint force, and the shaking force and moment.
pub fn check_reactions(got: &Reactions, want: &Reactions, size: f64, arm: f64, tolerance: f64) {
    for (what, got, want) in [
        ("crank bearing", got.crank_bearing, want.crank_bearing),
        ("crank pin", got.crank_pin, want.crank_pin),
        ("wrist pin", got.wrist_pin, want.wrist_pin),
        ("guide", [0.0, got.guide], [0.0, want.guide]),
        ("shaking force", got.shaking, want.shaking),
    ] {
        close(what, got[0], want[0], size, tolerance);
        close(what, got[1], want[1], size, tolerance);
    }
    close(
        "shaking moment",
        got.shaking_moment,
        want.shaking_moment,
        size * arm,
        tolerance,
    );
}
