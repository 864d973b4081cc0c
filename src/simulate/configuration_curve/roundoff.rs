//! What rounding does to a run on the curve: the spread of angle and speed, carried along with the motion.

use super::super::error_estimate::ONE_ROUNDING;
use super::super::roundoff_propagation::Spread;
use super::super::state_transition::Slopes;
use super::super::stick_slip::{InPhase, Phase};
use crate::engine::Counted;
use crate::engine::step::Step;
use crate::mechanism::CurveEquation;

/// Rounding of one evaluation of the acceleration, in units of the last place.
const EVALUATION: f64 = 8.0;

/// Rounding of the acceleration by that of the angle, in units.
const PLACE: f64 = 4.0;

/// Carries it from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Noise {
    /// Evaluations for the slopes.
    pub evaluations: u64,
    /// Acceleration at the end of the last step, and its phase.
    before: Option<(f64, Phase)>,
}

impl Noise {
    /// The spread after a step in one phase.
    pub fn step(
        &mut self,
        spread: Spread,
        equation: &CurveEquation,
        step: &Step,
        phase: Phase,
    ) -> Spread {
        if phase == Phase::Sticking {
            // What it is off in speed is lost at rest.
            self.before = None;
            return spread.with_speed_times(0.0);
        }
        let mut spread = spread;
        let (start, end, h) = (&step.start, &step.end, step.length());
        let turned = start.omega == 0.0;
        if let Some((before, _)) = self.before.filter(|(before, _)| turned && *before != 0.0) {
            // Turned back later or sooner, under another friction than before.
            spread = spread.with_speed_times(start.alpha / before);
        }
        if turned || self.before.is_none_or(|(_, before)| before != phase) {
            // A piece begins at a rounded time.
            let late = ONE_ROUNDING * start.t.abs();
            spread = spread.along(late * start.omega, late * start.alpha);
        }
        self.before = Some((end.alpha, phase));
        let motion = InPhase { equation, phase };
        let motion = Counted::new(&motion);
        let slopes = Slopes::of(&motion, step);
        self.evaluations += motion.evaluations();
        let transition = slopes.transition(step);
        // Accelerations from rounded angles.
        let place = PLACE * end.theta.abs() * slopes.by_angle();
        let within = place.abs() + EVALUATION * start.alpha.abs().max(end.alpha.abs());
        // States at the ends of the steps are rounded.
        let [angle, speed] = [1.0 + end.theta.abs(), end.omega.abs()].map(|size| 0.5 * size);
        let carried = spread.carried(&transition);
        carried.pushed(within, &transition, h).plus(angle, speed)
    }
}
