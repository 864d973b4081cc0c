//! Saltation matrix: what a jump of the acceleration makes of a perturbation of the motion (Leine and Nijmeijer, Dynamics
//! and Bifurcations of Non-Smooth Mechanical Systems, Springer 2004, section 7.3).
//!
//! A load that jumps where the crank passes an angle jumps earlier on a motion that is ahead, by δθ/θ̇; one that jumps
//! with the speed, by δθ̇/θ̈. One that jumps in time jumps on all motions at once.

use crate::engine::Counted;
use crate::engine::step::Step;
use crate::numeric::angle::Angle;
use crate::numeric::covariance_factor::Transition;

/// Returns the saltation matrix at the start of a step, from the acceleration `before`, rad/s²; none for a jump in
/// time.
pub(super) fn saltation(motion: &Counted<'_>, step: &Step, before: f64) -> Option<Transition> {
    let start = &step.start;
    let jump = start.alpha - before;
    // A jump in the last half of the digits changes no more of a perturbation.
    if jump.abs() <= f64::EPSILON.sqrt() * start.alpha.abs().max(before.abs()) {
        return None;
    }
    // Distances of angle, rad, and speed, rad/s, far above the rounding of the place of the jump.
    let (angle, speed) = (1e-9f64, 1e-7 * start.omega.abs().max(1.0));
    let at = |theta: f64, omega: f64| {
        let angle = Angle::new(step.turns, start.theta + theta);
        motion.acceleration(start.t, angle, start.omega + omega)
    };
    let angle = angle.copysign(start.omega);
    let speed = speed.copysign(before);
    let is_jump = |change: f64| (change - jump).abs() < 0.5 * jump.abs();
    if start.omega != 0.0 && is_jump(at(angle, 0.0) - at(-angle, 0.0)) {
        return Some(Transition::new(1.0, 0.0, jump / start.omega, 1.0));
    }
    let over_speed = before != 0.0 && is_jump(at(0.0, speed) - at(0.0, -speed));
    over_speed.then(|| Transition::new(1.0, 0.0, 0.0, start.alpha / before))
}
