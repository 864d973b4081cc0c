//! Roundoff propagation: standard deviations of angle and speed, carried along a motion in time by state transitions.

use super::saltation::saltation;
use super::state_transition::{AccelerationSlopes, StateTransition};
use super::stick_slip::{CurveMotion, StickSlipPhase};
use crate::engine::step::Step;
use crate::engine::time::Method;
use crate::engine::{Counted, Motion, NODES};
use crate::mechanism::Equation;
use crate::numeric::ROUNDING_DEVIATION;

/// Roundoff of a run in time.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoundoffPropagation {
    /// Standard deviations at the last step, in units of the last place.
    pub covariance: CovarianceFactor,
    /// Whether the states at the ends of steps are rounded: collocation carries the digits below the last place.
    rounds_states: bool,
    /// Number of evaluations for slopes on the configuration curve.
    pub evaluations: u64,
    before: Option<StepEnd>,
}

/// End of the last step.
#[derive(Clone, Copy, Debug)]
struct StepEnd {
    /// Acceleration, rad/s².
    alpha: f64,
    phase: StickSlipPhase,
}

impl RoundoffPropagation {
    /// Starts without roundoff, as in a balance.
    pub fn new(method: Method) -> RoundoffPropagation {
        RoundoffPropagation {
            covariance: CovarianceFactor::default(),
            rounds_states: !matches!(method, Method::Picard),
            evaluations: 0,
            before: None,
        }
    }

    /// Adds the rounding of a state: angle, rad, and speed, rad/s.
    pub fn round(&mut self, theta: f64, omega: f64) {
        let [angle, speed] = [theta, omega].map(|size| ROUNDING_DEVIATION * size.abs());
        self.covariance = self.covariance.plus_independent(angle, speed);
    }

    /// Carries the covariance over a step of the crank angle; adds a unit of the end acceleration, the rounded angle
    /// and the rounded times at which loads are evaluated.
    pub fn step(&mut self, equation: &Equation, motion: &dyn Motion, step: &Step) {
        let slopes = AccelerationSlopes::of(motion, step);
        let transition = slopes.transition(step);
        let end = &step.end;
        let phase = StickSlipPhase::FREE;
        let last = StepEnd {
            alpha: end.alpha,
            phase,
        };
        if let Some(before) = self.before.replace(last) {
            self.pass_jump(motion, step, before.alpha);
        }
        let place = ROUNDING_DEVIATION * end.theta.abs() * slopes.by_angle();
        let clock = by_rounded_times(end.t, &slopes);
        let mut size = end.alpha.abs();
        // Angle change, rad, up to whose effect an acceleration may be a difference of larger terms. Half or twice as
        // much changes the stated errors of 200 random runs by 1 % at most.
        let balanced_within = 0.1;
        if size < balanced_within * slopes.by_angle().abs() {
            let angle = step.angle(end.theta);
            let inertia = equation.terms(end.theta).m;
            let terms = equation.size_of_terms(end.t, angle, end.omega);
            // Several steps round in the same way.
            let correlation = 2.0;
            size = size.max(correlation * terms / inertia);
        }
        let carried = self.covariance.propagated(&transition);
        self.covariance = carried.plus_acceleration_error(
            place.hypot(size).hypot(clock),
            &transition,
            step.length(),
        );
        if self.rounds_states {
            self.round(end.theta, end.omega);
        }
    }

    /// Carries the covariance over a step on the configuration curve in one phase and adds the roundoff of the step.
    pub fn step_on_curve(&mut self, motion: CurveMotion<'_>, step: &Step) {
        let phase = motion.phase;
        let before = self.before.take();
        let motion = Counted::new(&motion);
        if phase == StickSlipPhase::Sticking {
            // At rest an error of the speed is lost.
            self.covariance = self.covariance.with_speed_times(0.0);
            return;
        }
        let (start, end) = (&step.start, &step.end);
        let turned = start.omega == 0.0;
        match before {
            // An early or late turning point: the acceleration before and after it differs by the friction.
            Some(StepEnd { alpha, .. }) if turned && alpha != 0.0 => {
                self.covariance = self.covariance.with_speed_times(start.alpha / alpha);
            }
            Some(before) if before.phase == phase => self.pass_jump(&motion, step, before.alpha),
            _ => {}
        }
        if turned || before.is_none_or(|before| before.phase != phase) {
            // A piece begins at a rounded time.
            let late = ROUNDING_DEVIATION * start.t.abs();
            let [angle, speed] = [start.omega, start.alpha].map(|rate| late * rate);
            self.covariance = self.covariance.plus_error(angle, speed);
        }
        self.before = Some(StepEnd {
            alpha: end.alpha,
            phase,
        });
        let slopes = AccelerationSlopes::of(&motion, step);
        self.evaluations += motion.evaluations();
        let transition = slopes.transition(step);
        // Roundings of coordinate and acceleration, evaluated on the curve, in units of the last place.
        let (place_rounding, evaluation_rounding) = (4.0, 8.0);
        let place = place_rounding * end.theta.abs() * slopes.by_angle();
        let clock = by_rounded_times(end.t, &slopes);
        let within =
            place.abs() + clock + evaluation_rounding * start.alpha.abs().max(end.alpha.abs());
        // States at the ends of the steps are rounded.
        let [angle, speed] = [1.0 + end.theta.abs(), end.omega.abs()].map(|size| 0.5 * size);
        let carried = self.covariance.propagated(&transition);
        let pushed = carried.plus_acceleration_error(within, &transition, step.length());
        self.covariance = pushed.plus_independent(angle, speed);
    }

    /// Carries the covariance over a jump of the acceleration at the start of a step, from that `before`, rad/s².
    fn pass_jump(&mut self, motion: &dyn Motion, step: &Step, before: f64) {
        if let Some(saltation) = saltation(motion, step, before) {
            self.covariance = self.covariance.propagated(&saltation);
        }
    }
}

/// Returns the standard deviation of the mean acceleration of a step near the time t (s) by the rounded times of its
/// nodes, and by the rounding of products with them, in units of the last place.
fn by_rounded_times(t: f64, slopes: &AccelerationSlopes) -> f64 {
    // Both are independent from node to node.
    ROUNDING_DEVIATION * t.abs() * slopes.by_time() * (2.0 / NODES as f64).sqrt()
}

/// Standard deviations of angle (rad) and speed (rad/s) in units of the last place, as two independent perturbations
/// (angle, speed). Near a limit both point along the motion for a while: a covariance matrix would lose the part across
/// it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct CovarianceFactor([[f64; 2]; 2]);

impl CovarianceFactor {
    /// Returns this covariance, or the one before if a number overflowed.
    fn or(self, before: &CovarianceFactor) -> CovarianceFactor {
        let finite = self.0.iter().flatten().all(|size| size.is_finite());
        if finite { self } else { *before }
    }

    /// Returns the standard deviations of angle (rad) and speed (rad/s).
    pub fn deviations(&self) -> [f64; 2] {
        [0, 1].map(|i| self.0[0][i].hypot(self.0[1][i]))
    }

    /// Adds independent errors of angle (rad) and speed (rad/s).
    pub fn plus_independent(self, angle: f64, speed: f64) -> CovarianceFactor {
        self.plus_error(angle, 0.0).plus_error(0.0, speed)
    }

    /// Adds an error of the acceleration (rad/s²) that lasts over a step of length h (s), seen at the end of the step.
    pub fn plus_acceleration_error(
        self,
        acceleration: f64,
        transition: &StateTransition,
        h: f64,
    ) -> CovarianceFactor {
        let speed = transition[0][1] * acceleration;
        self.plus_error(0.5 * h * speed, speed)
    }

    /// Adds one error with components in angle (rad) and speed (rad/s).
    pub fn plus_error(self, angle: f64, speed: f64) -> CovarianceFactor {
        // Rotated until only the first has an angle, three perturbations become two.
        let [first, second] = self.0;
        let [first, second] = rotated(first, second);
        let [first, third] = rotated(first, [angle, speed]);
        CovarianceFactor([first, [0.0, second[1].hypot(third[1])]]).or(&self)
    }

    /// Multiplies the speed of both perturbations by a factor.
    pub fn with_speed_times(self, factor: f64) -> CovarianceFactor {
        CovarianceFactor(self.0.map(|[angle, speed]| [angle, factor * speed])).or(&self)
    }

    /// Applies a transition matrix.
    pub fn propagated(self, [[c11, c12], [c21, c22]]: &StateTransition) -> CovarianceFactor {
        let carried =
            |[angle, speed]: [f64; 2]| [c11 * angle + c12 * speed, c21 * angle + c22 * speed];
        CovarianceFactor(self.0.map(carried)).or(&self)
    }
}

/// Rotates two perturbations until the second has no angle.
fn rotated(a: [f64; 2], b: [f64; 2]) -> [[f64; 2]; 2] {
    let angle = a[0].hypot(b[0]);
    if angle == 0.0 {
        return [a, b];
    }
    let (cos, sin) = (a[0] / angle, b[0] / angle);
    [
        [angle, cos * a[1] + sin * b[1]],
        [0.0, cos * b[1] - sin * a[1]],
    ]
}

#[cfg(test)]
mod tests {
    use super::CovarianceFactor;

    fn assert_close(value: f64, exact: f64) {
        assert!((value - exact).abs() < 1e-9 * exact, "{value}, not {exact}");
    }

    #[test]
    fn independent_errors_add_up_by_their_squares() {
        let covariance = CovarianceFactor::default()
            .plus_independent(3.0, 5.0)
            .plus_error(4.0, 12.0);
        assert_close(covariance.deviations()[0], 5.0);
        assert_close(covariance.deviations()[1], 13.0);
        let faster = covariance.with_speed_times(2.0);
        assert_close(faster.deviations()[1], 26.0);
    }

    /// A limit that is passed fast changes the speed much with the angle, and back again.
    #[test]
    fn what_is_small_beside_a_large_spread_is_kept() {
        let steep = |slope: f64| [[1.0, 0.0], [slope, 1.0]];
        let covariance = CovarianceFactor::default()
            .plus_independent(1.0, 3.0)
            .propagated(&steep(1e12));
        let back = covariance.plus_error(1e-3, 1e9).propagated(&steep(-1e12));
        assert!((back.deviations()[1] - 3.0).abs() < 1e-3, "{back:?}");
        assert_close(back.deviations()[0], 1f64.hypot(1e-3));
    }
}
