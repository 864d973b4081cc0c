//! Interface of the energy engine to a mechanism, and its reasons not to apply.

use super::piece::Piece;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values};

/// Mechanism as the energy engine sees it.
pub trait Profile {
    /// Returns the inertia M (kg m²) and the generalized force F (N m) with K' = F at an angle, rad; both have to be
    /// smooth between the corners only.
    fn inertia_and_force(&self, theta: f64) -> (f64, f64);

    /// Computes inertia and force at some angles, rad.
    fn tabulate(&self, angles: &Values) -> [Values; 2];

    /// Returns the rounding error of the inertia at an angle (rad), which may be rounded itself, relative to the inertia.
    fn inertia_rounding(&self, theta: f64, is_rounded: bool) -> f64;

    /// Returns the rounding error of the force at an angle, N m, beyond that due to the rounded angle.
    fn rounding(&self, theta: f64) -> f64;

    /// Returns the angles in [0, 2π), in rising order, at which panels must end in each turn.
    fn corners(&self) -> &[f64];

    /// Returns the branch points of √M and of the forces in the complex angle: real part and distance from it, rad.
    fn branch_points(&self) -> Vec<[f64; 2]>;

    /// Returns the next angle from `from` towards `to`, other than [`Self::corners`], at which a panel must end.
    fn corner_between(&self, from: f64, to: f64) -> Option<f64>;

    /// True if the force has a pole at the end of a panel, rad.
    fn has_pole(&self, at: f64) -> bool;

    /// True if the limit of tabulated positions is reached: the run ends with the panels that it has.
    fn is_spent(&self) -> bool;

    /// True if everything repeats after a turn that does no work.
    fn repeats(&self) -> bool;

    /// Returns the work of the forces in a turn counter-clockwise and its error bound, J, if all turns have the same.
    fn work_of_turn(&self) -> Option<(f64, f64)>;
}

impl dyn Profile + '_ {
    /// Computes inertia and force at the points of the rule of the largest degree on a piece.
    pub(super) fn on_piece(&self, piece: &Piece) -> [Values; 2] {
        self.tabulate(&Rule::of(MAX_DEGREE).values(|x| piece.angle(x)))
    }
}

/// Reason why a motion cannot be computed over the crank angle, as a clause of a message.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotApplicable {
    /// Equilibrium: at rest without a force.
    #[error("it starts at rest without a force")]
    Equilibrium,
    /// Value not finite: limit position of the mechanism, or undefined load.
    #[error("a load has no finite value on the way")]
    NotFinite,
    /// Evaluation limit reached.
    #[error("it takes more evaluations than the work limit allows")]
    WorkLimit,
    /// Number of turns for which the limit would be reached long before the end.
    #[error("it takes more turns than the work limit allows")]
    TooManyTurns,
    /// Too many panels to keep: a long run with unequal turns.
    #[error("its turns differ from each other, and they are too many to be kept")]
    TooLong,
    /// Jump of a load, or a corner that the mechanism does not announce.
    #[error("a load is not smooth")]
    NotSmooth,
    /// Speed too near zero for the angle to be the independent variable.
    #[error("the crank comes too near to rest")]
    TooSlow,
}
