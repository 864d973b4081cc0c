//! What the energy engine needs of a mechanism, and why it cannot serve.

use crate::numeric::chebyshev::Values;

/// What the engine needs of a mechanism.
pub trait Profile {
    /// Inertia M (kg m²) and the generalized force (N m) that accelerates it, K' = F, at an angle, rad. Both only
    /// need to be smooth between the corners.
    fn inertia_and_force(&self, theta: f64) -> (f64, f64);

    /// Inertia and force at the first `count` of some angles.
    fn tabulate(&self, angles: &Values, count: usize, inertia: &mut Values, force: &mut Values);

    /// By how much rounding may change the force at an angle beside the rounding of the angle, N m.
    fn rounding(&self, theta: f64) -> f64;

    /// Angles in [0, 2π), in rising order, at which panels must end in each turn.
    fn corners(&self) -> &[f64];

    /// Branch points of inertia and force as functions of a complex angle: angle and distance from it, rad.
    fn branch_points(&self) -> [[f64; 2]; 2];

    /// The nearest angle after `from` and before `to`, in either direction, at which a panel must end beside them.
    fn corner_between(&self, from: f64, to: f64) -> Option<f64>;

    /// Whether as many positions were tabulated as the run may take: then it ends with the panels that it has.
    fn is_spent(&self) -> bool;

    /// Whether everything repeats after a turn and no work is done in one.
    fn repeats(&self) -> bool;

    /// Work of the forces in one turn counter-clockwise, J, and how far it may be off, if they are the same in each
    /// turn.
    fn work_of_turn(&self) -> Option<(f64, f64)>;
}

/// Why a motion cannot be computed from its energy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotApplicable {
    /// At rest without a force.
    Equilibrium,
    /// A value is not finite: the mechanism reaches a limit, or a load has no value.
    NotFinite,
    /// The run takes more evaluations than are allowed.
    WorkLimit,
    /// The crank turns so often that the limit would be reached long before the end.
    TooManyTurns,
    /// More panels than are kept: a long run whose turns differ from each other.
    TooLong,
    /// A load jumps, or has a corner that nobody announced.
    NotSmooth,
    /// The speed comes too near to zero for the angle to be the independent variable.
    TooSlow,
}
