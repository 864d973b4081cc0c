//! One collocation step: sweeps to convergence, then error estimate and next length.

use super::super::resolution::{NodeCriterion, OnStep, Unresolved, unresolved};
use super::super::step::{Step, TERMS};
use super::super::time::Settings;
use super::super::{Batch, Counted, Motion, NODES};
use super::attempt::{Accepted, Failed, Try};
use super::newton::Newton;
use super::state::State;
use super::tableau::Tableau;
use crate::numeric::gauss::legendre_series;

/// Most sweeps per step; a step that needs more is too long.
const SWEEPS: usize = 14;
/// Sweeps of a step of suitable length.
const FEW_SWEEPS: usize = 9;
/// Fraction of the tolerance that unconverged sweeps may leave.
const LEFT_BY_SWEEPS: f64 = 1e-2;
/// Fraction of a step beyond which a corner is too near its end to shorten a failed step to the corner.
const WELL_INSIDE: f64 = 0.9;
/// Relative rounding error of a state.
const STATE_ROUNDING: f64 = 4.0 * f64::EPSILON;

/// Collocation method with the data that a step hands to the next.
pub struct Collocation<'a> {
    pub(super) motion: &'a Counted<'a>,
    pub(super) tableau: &'static Tableau,
    pub(super) tolerance: f64,
    /// Leading steps of another run from the same start.
    pub(super) guide: &'a [Step],
    varies_between_nodes: bool,
    has_power: bool,
    pub(super) batch: Batch,
    /// Length (s) and Legendre coefficients of the acceleration (rad/s²) of the last step.
    pub(super) last: Option<(f64, [f64; NODES])>,
    /// Acceleration at the start of the next step, rad/s².
    pub(super) alpha: f64,
    /// True if sweeps did not converge on the last step.
    steep: bool,
    /// Latest estimate of the rounding error of the acceleration due to rounded times, rad/s².
    pub(super) by_time: f64,
}

impl<'a> Collocation<'a> {
    pub fn new(motion: &'a Counted<'a>, settings: &Settings<'a>, alpha: f64) -> Collocation<'a> {
        Collocation {
            motion,
            tableau: Tableau::get(),
            tolerance: settings.tolerance,
            guide: settings.guide,
            varies_between_nodes: motion.varies_between_nodes(),
            has_power: motion.has_power(),
            batch: Batch::default(),
            last: None,
            alpha,
            steep: false,
            by_time: 0.0,
        }
    }

    /// Discards the last step as a guess for the next, which begins with this acceleration, rad/s².
    pub fn begin_anew(&mut self, alpha: f64) {
        self.last = None;
        self.alpha = alpha;
    }

    /// Tries a step from a state; a step that is too long because of a corner is to end there.
    pub fn attempt(&mut self, state: &State, step: Try) -> Result<Accepted, Failed> {
        let result = self.attempt_whole(state, step);
        match result {
            Err(Failed::TooLong(factor)) if self.varies_between_nodes => {
                match self.corner(state, step.h) {
                    Some(at) => Err(Failed::Meets { at, factor }),
                    None => result,
                }
            }
            _ => result,
        }
    }

    /// Returns the fraction at which a step that is too long seems to meet a corner.
    fn corner(&self, state: &State, h: f64) -> Option<f64> {
        let coefficients = self.coefficients();
        if !coefficients.iter().sum::<f64>().is_finite() {
            return None;
        }
        let (step, ..) = self.finish(state, h, &coefficients);
        let found = self.hides(state, &step, &coefficients)?;
        (found.is_corner && found.at < WELL_INSIDE).then_some(found.at)
    }

    /// Tries a step from a state without a search for corners.
    fn attempt_whole(
        &mut self,
        state: &State,
        Try { h, corners }: Try,
    ) -> Result<Accepted, Failed> {
        self.prepare(state, h);
        let mut before = f64::INFINITY;
        let mut sweeps = 0;
        let mut newton = None;
        loop {
            let guess = self.batch.alpha;
            self.motion.fill(&mut self.batch);
            sweeps += 1;
            if !self.batch.alpha.iter().sum::<f64>().is_finite() {
                return Err(Failed::TooLong(0.25));
            }
            if self.steep && newton.is_none() {
                newton = Newton::new(self.motion, &self.batch, self.tableau, h);
            }
            if let Some(newton) = &newton {
                newton.correct(&guess, &mut self.batch.alpha);
            }
            let change = self.update(state, h);
            let rate = change / before;
            // Change that the next sweep would make.
            let left = change * rate.min(1.0);
            if sweeps > 1 && left <= LEFT_BY_SWEEPS && change < 1.0 {
                break;
            }
            // Smaller changes are rounding.
            if change <= STATE_ROUNDING / self.tolerance {
                break;
            }
            if sweeps > 2 && rate > 0.3 {
                let noise = self.rounding(state, h, &self.coefficients());
                if change <= self.in_units(state, h * h * noise, h * noise) {
                    break;
                }
            }
            if sweeps == SWEEPS || (sweeps > 2 && rate > 0.7) {
                if self.steep {
                    // A steep slope due to a jump does not persist beyond it.
                    self.steep = false;
                    return Err(self.too_long(h, 0.5));
                }
                self.steep = true;
                self.prepare(state, h);
                (before, sweeps) = (f64::INFINITY, 0);
                continue;
            }
            if sweeps == 2 {
                let error = self.error(state, h, &self.coefficients());
                if error > 1e3 {
                    return Err(Failed::TooLong(0.8 * error.powf(-1.0 / NODES as f64)));
                }
            }
            before = change;
        }
        let coefficients = self.coefficients();
        let (step, next, alpha) = self.finish(state, h, &coefficients);
        // The nodes lie inside: a jump outside the outermost ones is visible only at the ends.
        let jumps = [step.start.alpha - self.alpha, step.end.alpha - alpha];
        let mut error = self.error(state, h, &coefficients);
        for (jump, at_corner) in jumps.into_iter().zip(corners) {
            if !jump.is_finite() {
                return Err(Failed::TooLong(0.25));
            } else if !at_corner {
                error = error.max(self.error_of(state, h, jump, &coefficients));
            }
        }
        let mut factor = 0.7 * error.max(1e-20).powf(-1.0 / NODES as f64);
        if error > 1.0 {
            return Err(self.too_long(h, factor));
        }
        if sweeps > FEW_SWEEPS {
            factor = factor.min(0.9);
        } else if sweeps == FEW_SWEEPS {
            factor = factor.min(1.0);
        }
        if let Some(hidden) = self.hides(state, &step, &coefficients) {
            return Err(Failed::Hides(hidden.at));
        }
        self.last = Some((h, coefficients));
        self.alpha = alpha;
        self.steep = newton.is_some();
        let next = match newton {
            Some(newton) if !corners[1] => self.settled(next, &step, newton.loss),
            _ => next,
        };
        Ok(Accepted { step, next, factor })
    }

    /// Corrects the speed at the end of a step under a steep loss (1/s) by the residual of the acceleration there: a
    /// component that the loss would damp at once persists in Gauss methods (A-stable, not L-stable).
    fn settled(&mut self, next: State, step: &Step, loss: f64) -> State {
        let settled = next.faster((step.end.alpha - self.alpha) / loss);
        self.alpha = self
            .motion
            .acceleration(settled.t, settled.angle(), settled.omega);
        settled
    }

    /// Updates angles and speeds from the accelerations; returns the largest change in units of the tolerance.
    pub(super) fn update(&mut self, state: &State, h: f64) -> f64 {
        let (batch, tableau) = (&mut self.batch, self.tableau);
        let (mut speed, mut angle) = ([0.0; NODES], [0.0; NODES]);
        for j in 0..NODES {
            let alpha = batch.alpha[j];
            for i in 0..NODES {
                speed[i] += tableau.speed[j][i] * alpha;
                angle[i] += tableau.angle[j][i] * alpha;
            }
        }
        let (mut angle_change, mut speed_change) = (0.0f64, 0.0f64);
        for i in 0..NODES {
            let omega = state.omega + (h * speed[i] + state.omega_low);
            let travel = h * (tableau.nodes[i] * state.omega + h * angle[i]);
            let theta = state.theta + (travel + state.theta_low);
            angle_change = angle_change.max((theta - batch.theta[i]).abs());
            speed_change = speed_change.max((omega - batch.omega[i]).abs());
            batch.theta[i] = theta;
            batch.omega[i] = omega;
        }
        self.in_units(state, angle_change, speed_change)
    }

    fn coefficients(&self) -> [f64; NODES] {
        let mut coefficients = [0.0; NODES];
        for (alpha, row) in self.batch.alpha.iter().zip(&self.tableau.legendre) {
            for k in 0..NODES {
                coefficients[k] += row[k] * alpha;
            }
        }
        coefficients
    }

    /// Returns the position at which the step has to end to resolve the loads; none if it does or cannot be shorter.
    fn hides(&self, state: &State, step: &Step, coefficients: &[f64; NODES]) -> Option<Unresolved> {
        if !self.varies_between_nodes {
            return None;
        }
        let h = step.length();
        let term = self.tolerance * (1.0 + state.omega.abs()) * (2 * NODES) as f64 / h;
        let allowed = term.max(self.rounding(state, h, coefficients));
        let (times, part) = ([state.t, state.t + h], LEFT_BY_SWEEPS * self.tolerance);
        let look = NodeCriterion {
            has_interpolant: true,
            ..NodeCriterion::at_step(times, NODES, part, allowed)
        };
        let way = OnStep {
            motion: self.motion,
            step,
            nodes: Some(coefficients),
        };
        unresolved(&way, look)
    }

    /// Returns the step, the state at its end, and the acceleration there, rad/s².
    fn finish(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> (Step, State, f64) {
        let (alpha, power) = (&self.batch.alpha, &self.batch.power);
        let tableau = self.tableau;
        let speed = h * dot(&tableau.end_speed, alpha);
        let angle = h * h * dot(&tableau.end_angle, alpha);
        let work = if self.has_power {
            h * dot(&tableau.end_speed, power)
        } else {
            0.0
        };
        let next = state.moved(h, [angle, speed, work]);
        let mut powers = [0.0; TERMS];
        for (coefficient, row) in coefficients.iter().zip(&tableau.powers).rev() {
            for i in 0..TERMS {
                powers[i] += h * h * coefficient * row[i];
            }
        }
        powers[0] += 0.5 * h * state.omega;
        powers[1] += 0.5 * h * state.omega;
        let [at_start, at_end] = legendre_series(coefficients, [-1.0, 1.0]);
        let (start, end) = (state.node(at_start), next.node(at_end));
        let step = Step::with_powers(state.turns, start, end, powers);
        let alpha = self.motion.acceleration(next.t, next.angle(), next.omega);
        (step, next.reduced(), alpha)
    }
}

fn dot(a: &[f64; NODES], b: &[f64; NODES]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
