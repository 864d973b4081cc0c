//! What rounding does to a run on the curve: the spread of angle and speed, carried along with the motion.

use std::cell::Cell;

use super::super::error_estimate::ONE_ROUNDING;
use super::super::roundoff_propagation::Spread;
use super::super::state_transition::Slopes;
use super::arrived::Observer;
use super::stick_slip::{InPhase, Phase};
use crate::engine::Counted;
use crate::engine::step::Step;
use crate::mechanism::CurveEquation;
use crate::numeric::angle::Angle;

/// Rounding of one evaluation of the acceleration, in units of the last place.
const EVALUATION: f64 = 8.0;

/// Rounding of the acceleration by that of the angle, in units.
const PLACE: f64 = 4.0;

/// Follows a run.
pub(in crate::simulate) struct Noise<'a> {
    pub equation: &'a CurveEquation,
    pub spread: Spread,
    /// Evaluations for the slopes.
    pub evaluations: Cell<u64>,
    /// Acceleration at the end of the last step, and its phase.
    before: Option<(f64, Phase)>,
}

impl<'a> Noise<'a> {
    /// Nothing yet.
    pub fn new(equation: &'a CurveEquation) -> Noise<'a> {
        Noise {
            equation,
            spread: Spread::default(),
            evaluations: Cell::new(0),
            before: None,
        }
    }
}

impl Observer for Noise<'_> {
    fn step(&mut self, step: &Step, phase: Phase) -> bool {
        if phase == Phase::Sticking {
            // What it is off in speed is lost at rest.
            self.spread = self.spread.with_speed_times(0.0);
            self.before = None;
            return false;
        }
        let (start, end, h) = (&step.start, &step.end, step.length());
        let turned = start.omega == 0.0;
        if let Some((before, _)) = self.before.filter(|(before, _)| turned && *before != 0.0) {
            // Turned back later or sooner, under another friction than before.
            self.spread = self.spread.with_speed_times(start.alpha / before);
        }
        if turned || self.before.is_none_or(|(_, before)| before != phase) {
            // A piece begins at a rounded time.
            let late = ONE_ROUNDING * start.t.abs();
            self.spread = self.spread.along(late * start.omega, late * start.alpha);
        }
        self.before = Some((end.alpha, phase));
        let motion = InPhase {
            equation: self.equation,
            phase,
        };
        let motion = Counted::new(&motion);
        let slopes = Slopes::of(&motion, step);
        self.evaluations
            .set(self.evaluations.get() + motion.evaluations());
        let transition = slopes.transition(step);
        // Accelerations from rounded angles.
        let place = PLACE * end.theta.abs() * slopes.by_angle();
        let within = place.abs() + EVALUATION * start.alpha.abs().max(end.alpha.abs());
        // States at the ends of the steps are rounded.
        let [angle, speed] = [1.0 + end.theta.abs(), end.omega.abs()].map(|size| 0.5 * size);
        let carried = self.spread.carried(&transition);
        self.spread = carried.pushed(within, &transition, h).plus(angle, speed);
        false
    }

    fn event(&mut self, _: &'static str, _: f64, _: Angle, _: f64) {}
}
