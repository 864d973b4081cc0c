//! Mechanisms without inertia, always or where they start.

use super::problem;
use crate::mechanism::CurveEquation;
use crate::scene::Problem;

/// Of a mechanism that has none in any position.
pub(super) fn none() -> Problem {
    problem(
        "crank.inertia",
        "the mechanism has no inertia, so its loads decide no motion",
        "give the crank an inertia, or the rod or the slider a mass, or use motion kind = \"constant-speed\"",
    )
}

/// Of one that has none at its start, crank angle `theta` (rad).
pub(super) fn at_start(theta: f64) -> Problem {
    problem(
        "motion.angle",
        format!("the effective inertia vanishes at the start, theta = {theta} rad"),
        "give the crank an inertia, or start away from the dead centre",
    )
}

/// Whether M vanishes at coordinate `q` (rad): it is so small there that rounding `q` makes more of it.
pub(super) fn vanishes(equation: &CurveEquation, q: f64) -> bool {
    let m = |q: f64| equation.across(q).m;
    let rounding = 4.0 * f64::EPSILON * q.abs().max(1.0);
    !m(q).is_normal() || m(q) < 0.25 * (m(q - rounding) + m(q + rounding))
}
