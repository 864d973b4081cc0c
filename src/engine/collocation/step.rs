//! One collocation step: sweeps to convergence, then error estimate and next length.

use multiversion::multiversion;

use super::super::resolution::{Feature, Unresolved, unresolved_on};
use super::super::step::{Step, TERMS};
use super::super::time::Settings;
use super::super::{Batch, Counted, NODES};
use super::attempt::{Accepted, Rejection, last_term};
use super::newton::Newton;
use super::state::State;
use super::tableau::Tableau;
use crate::numeric::gauss::legendre_series;

/// Collocation method with the data that a step hands to the next.
pub struct Collocation<'a> {
    pub(super) motion: &'a Counted<'a>,
    pub(super) tableau: &'static Tableau,
    pub(super) tolerance: f64,
    /// Error that the sweeps may leave, as a fraction of the tolerance.
    sweep_error: f64,
    /// Leading steps of another run from the same start.
    pub(super) guide: &'a [Step],
    pub(super) batch: Batch,
    /// Length (s) and Legendre coefficients of the acceleration (rad/s²) of the last step.
    pub(super) last: Option<(f64, [f64; NODES])>,
    /// Acceleration at the start of the next step, rad/s².
    pub(super) alpha: f64,
    /// True if sweeps did not converge on the last step.
    pub(super) steep: bool,
    /// Rounding error of the acceleration due to rounded times, rad/s², where it was estimated for the step.
    pub(super) by_time: f64,
}

impl<'a> Collocation<'a> {
    pub fn new(motion: &'a Counted<'a>, settings: &Settings<'a>, alpha: f64) -> Collocation<'a> {
        Collocation {
            motion,
            tableau: Tableau::get(),
            tolerance: settings.tolerance,
            // The largest error at the end of a step, where the order is 2 NODES: a run for comparison leaves less.
            sweep_error: if settings.guide.is_empty() {
                1e-2
            } else {
                1e-3
            },
            guide: settings.guide,
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

    /// Tries a step of length h (s) from a state; a step that is too long because of a corner is to end there. `corners`:
    /// whether the step begins and ends at a corner, where the acceleration may jump.
    pub fn attempt(
        &mut self,
        state: &State,
        h: f64,
        corners: [bool; 2],
    ) -> Result<Accepted, Rejection> {
        let result = self.attempt_whole(state, h, corners);
        match result {
            Err(Rejection::TooLong(factor)) if self.motion.varies_between_nodes() => {
                match self.obstacle(state, h) {
                    Some(found) if found.feature == Feature::Corner => {
                        let at = found.at;
                        Err(Rejection::Corner { at, factor })
                    }
                    Some(pole) => Err(Rejection::Unresolved(pole)),
                    None => result,
                }
            }
            _ => result,
        }
    }

    /// Returns the corner or pole that a step that is too long seems to meet.
    fn obstacle(&self, state: &State, h: f64) -> Option<Unresolved> {
        let coefficients = self.coefficients();
        if !coefficients.iter().sum::<f64>().is_finite() {
            return None;
        }
        let (step, ..) = self.finish(state, h, &coefficients);
        let found = self.hides(state, &step, &coefficients)?;
        // Nearer to the end, a corner is not the reason why the step is too long.
        let last_position = 0.9;
        let is_corner = found.feature == Feature::Corner && found.at < last_position;
        (is_corner || found.feature == Feature::Pole).then_some(found)
    }

    /// Tries a step from a state without a search for corners.
    fn attempt_whole(
        &mut self,
        state: &State,
        h: f64,
        corners: [bool; 2],
    ) -> Result<Accepted, Rejection> {
        self.by_time = 0.0;
        let (sweeps, newton) = self.converge(state, h)?;
        let coefficients = self.coefficients();
        let (step, next, alpha) = self.finish(state, h, &coefficients);
        if let Some(part) = step.part_of_one_turn() {
            return Err(Rejection::TooLong(part));
        }
        // The nodes lie inside: a jump outside the outermost ones is visible only at the ends.
        let jumps = [step.start.alpha - self.alpha, step.end.alpha - alpha];
        if !jumps.iter().sum::<f64>().is_finite() {
            return Err(Rejection::NOT_FINITE);
        }
        // Under a steep loss the speed errs by jump/loss, and not by h jump/(2 NODES).
        let steepness = newton.as_ref().map_or(1.0, |newton| newton.steepness(h));
        let share = (2.0 * NODES as f64 / steepness).min(1.0);
        let ends = jumps.into_iter().zip(corners);
        let jump = ends.filter_map(|(jump, at_corner)| (!at_corner).then_some(share * jump.abs()));
        let last_term = jump.fold(last_term(&coefficients), f64::max);
        let (error, mut factor) = self.judged(state, h, last_term, &coefficients);
        if error > 1.0 {
            return Err(Rejection::TooLong(factor));
        }
        // Sweeps of a step of suitable length.
        let few_sweeps = 9;
        if sweeps > few_sweeps {
            factor = factor.min(0.9);
        } else if sweeps == few_sweeps {
            factor = factor.min(1.0);
        }
        if let Some(hidden) = self.hides(state, &step, &coefficients) {
            return Err(Rejection::Unresolved(hidden));
        }
        self.last = Some((h, coefficients));
        self.alpha = alpha;
        self.steep = newton.is_some() || factor <= 1.0 && self.is_steep_at(&next, h);
        let next = match newton {
            Some(newton) if !corners[1] => self.with_loss(next, &step, newton.loss),
            _ => next,
        };
        Ok(Accepted { step, next, factor })
    }

    /// Sweeps until the accelerations at the nodes converge, with Newton's method where sweeps alone fail. Returns the
    /// number of sweeps and the factors of Newton's method, if it was used.
    fn converge(&mut self, state: &State, h: f64) -> Result<(u32, Option<Newton>), Rejection> {
        // Relative rounding error of a state.
        let state_rounding = 4.0 * f64::EPSILON;
        // Convergence factor below which the change is no rounding, and one with which the sweeps would be too many.
        let (fast, slow, most_sweeps) = (0.3, 0.7, 14);
        self.prepare(state, h);
        let mut before = f64::INFINITY;
        let mut sweeps = 0;
        let mut newton = None;
        loop {
            let guess = self.batch.alpha;
            self.motion.fill(&mut self.batch);
            sweeps += 1;
            if !self.batch.alpha.iter().sum::<f64>().is_finite() {
                return Err(Rejection::NOT_FINITE);
            }
            if self.steep && newton.is_none() && sweeps <= 2 {
                newton = Newton::new(self.motion, &self.batch, self.tableau, h);
            }
            if let Some(newton) = &newton {
                newton.correct(&guess, &mut self.batch.alpha);
            }
            let change = self.update(state, h);
            let rate = change / before;
            // Change that the next sweep would make, in the speed at the end of the step: a steep loss magnifies it.
            let steepness = newton.as_ref().map_or(1.0, |newton| newton.steepness(h));
            let left = steepness * change * rate.min(1.0);
            // The next sweep would change little, or this one changed no more than the rounding.
            if sweeps > 1 && left <= self.sweep_error && steepness * change < 1.0
                || change <= state_rounding / self.tolerance
            {
                return Ok((sweeps, newton));
            }
            if sweeps > 2 && rate > fast {
                let noise = self.rounding(state, h, &self.coefficients());
                if change <= self.in_units(state, h * h * noise, h * noise) {
                    return Ok((sweeps, newton));
                }
            }
            if sweeps == most_sweeps || (sweeps > 2 && rate > slow) {
                if self.steep {
                    // A steep slope due to a jump does not persist beyond it.
                    self.steep = false;
                    return Err(Rejection::TooLong(0.5));
                }
                self.steep = true;
                self.prepare(state, h);
                (before, sweeps) = (f64::INFINITY, 0);
                continue;
            }
            if sweeps == 2 {
                let coefficients = self.coefficients();
                let error = self.error(state, h, last_term(&coefficients), &coefficients);
                // Beyond hope, in units of the tolerance.
                if error > 1e3 {
                    return Err(Rejection::TooLong(0.8 * error.powf(-1.0 / NODES as f64)));
                }
            }
            before = change;
        }
    }

    /// Updates angles and speeds from the accelerations; returns the largest change in units of the tolerance.
    pub(super) fn update(&mut self, state: &State, h: f64) -> f64 {
        let (batch, tableau) = (&mut self.batch, self.tableau);
        let [speed, angle] =
            [&tableau.speed, &tableau.angle].map(|rows| product(rows, &batch.alpha));
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
        product(&self.tableau.legendre, &self.batch.alpha)
    }

    /// Returns the position at which the step has to end to resolve the loads; none if it does or cannot be shorter.
    fn hides(&self, state: &State, step: &Step, coefficients: &[f64; NODES]) -> Option<Unresolved> {
        if !self.motion.varies_between_nodes() {
            return None;
        }
        let h = step.length();
        let term = self.tolerance * (1.0 + state.omega.abs()) * (2 * NODES) as f64 / h;
        let allowed = term.max(self.rounding(state, h, coefficients));
        // Fraction of the tolerance to which the terms of a load that the nodes resolve have decayed.
        let part = 1e-2 * self.tolerance;
        let nodes = (NODES, Some(coefficients));
        unresolved_on(self.motion, step, nodes, part, allowed)
    }

    /// Returns the step, the state at its end, and the acceleration there, rad/s².
    fn finish(&self, state: &State, h: f64, coefficients: &[f64; NODES]) -> (Step, State, f64) {
        let (alpha, power) = (&self.batch.alpha, &self.batch.power);
        let tableau = self.tableau;
        let speed = h * dot(&tableau.end_speed, alpha);
        let angle = h * h * dot(&tableau.end_angle, alpha);
        let work = match self.motion.has_power() {
            true => h * dot(&tableau.end_speed, power),
            false => 0.0,
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

/// Returns the product of a matrix, given by its columns, and a vector.
#[multiversion(targets("x86_64+avx2"))]
fn product(columns: &[[f64; NODES]; NODES], vector: &[f64; NODES]) -> [f64; NODES] {
    let mut sums = [0.0; NODES];
    for j in 0..NODES {
        for i in 0..NODES {
            sums[i] += columns[j][i] * vector[j];
        }
    }
    sums
}
