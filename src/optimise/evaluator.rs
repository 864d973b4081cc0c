//! Computes designs of the unit box and ranks them by Deb's rules, by goal and by scaled margins of the limits.

use std::cmp::Ordering;
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU64, Ordering as Memory};

use super::{AGREEMENT, LEAST_IMPROVEMENT, Problem};
use crate::numeric::stop::Stop;
use crate::sweep::{Design, Goal, Outcome, Source, Sweep};

/// Objective and constraints over the unit box: coordinate 0 is the lower bound of a key, 1 the upper one.
pub(super) struct Evaluator<'a> {
    pub sweep: &'a Sweep,
    pub problem: &'a Problem,
    pub stop: &'a Stop,
    /// Number of designs computed.
    pub computed: AtomicU64,
    /// Scale of the goal: its interquartile range in the sample, on which outliers have little influence.
    goal_scale: f64,
    /// Scale of each limited figure: its interquartile range in the sample.
    scales: Vec<f64>,
    /// Worst scaled goal in the sample, which replaces a missing one.
    worst: f64,
}

/// A design with its goal and its violation of the limits.
#[derive(Clone, Debug)]
pub(super) struct Evaluation {
    /// Point of the unit box, one coordinate per key.
    pub at: Vec<f64>,
    /// Goal, to be minimised (sign reversed for a maximum); none if the design or a figure could not be computed.
    pub objective: Option<f64>,
    /// Margin to each limit, positive if met, in the unit of the figure; empty without goal and limited figures.
    pub margins: Vec<f64>,
    /// Largest scaled violation of a limit, 0 if all are met; infinite for a design without goal.
    pub violation: f64,
}

impl Evaluation {
    /// Returns the goal figure with its own sign.
    pub fn value(&self, goal: Goal) -> Option<f64> {
        self.objective
            .map(|value| if goal.maximise { -value } else { value })
    }

    /// Orders by Deb's rules, better designs first: by violation, then by goal.
    pub fn order(&self, other: &Evaluation) -> Ordering {
        let objective = |one: &Evaluation| one.objective.unwrap_or(f64::INFINITY);
        let violation = self.violation.total_cmp(&other.violation);
        violation.then(objective(self).total_cmp(&objective(other)))
    }
}

impl<'a> Evaluator<'a> {
    pub fn new(sweep: &'a Sweep, problem: &'a Problem, stop: &'a Stop) -> Evaluator<'a> {
        Evaluator {
            sweep,
            problem,
            stop,
            computed: AtomicU64::new(0),
            goal_scale: 1.0,
            scales: vec![1.0; problem.constraints.len()],
            worst: f64::NEG_INFINITY,
        }
    }

    /// Computes the design at a point of the unit box.
    pub fn design(&self, at: &[f64]) -> Design {
        design(self.sweep, at)
    }

    /// Computes the design at a point of the unit box, with error estimates of its motion.
    pub fn vouched(&self, at: &[f64]) -> Design {
        design(&self.sweep.with_estimates(), at)
    }

    /// Computes and ranks a design; returns one without figures after a request to stop.
    pub fn evaluate(&self, at: Vec<f64>) -> Evaluation {
        if self.stop.is_requested() {
            return self.ranked(at, None, Vec::new());
        }
        self.computed.fetch_add(1, Memory::Relaxed);
        let design = self.design(&at);
        let goal = self.problem.goal;
        let margins = self.problem.constraints.iter().map(|constraint| {
            let value = constraint.figure.number(&design)?;
            Some(constraint.margin(value)).filter(|margin| margin.is_finite())
        });
        let margins: Option<Vec<f64>> = margins.collect();
        let is_whole = margins.is_some() && design.outcome == Outcome::Done;
        let value = goal.figure.number(&design);
        let value = value.filter(|value| value.is_finite() && is_whole);
        let objective = value.map(|value| if goal.maximise { -value } else { value });
        self.ranked(at, objective, margins.unwrap_or_default())
    }

    fn ranked(&self, at: Vec<f64>, objective: Option<f64>, margins: Vec<f64>) -> Evaluation {
        let scaled = margins.iter().zip(&self.scales);
        let missed = scaled.map(|(margin, scale)| -margin / scale);
        let violation = match objective {
            Some(_) => missed.fold(0.0, f64::max),
            None => f64::INFINITY,
        };
        Evaluation {
            at,
            objective,
            margins,
            violation,
        }
    }

    /// Sets the scales from a sample and ranks the sample again with them.
    pub fn calibrate(&mut self, sample: Vec<Evaluation>) -> Vec<Evaluation> {
        let of = |value: &dyn Fn(&Evaluation) -> f64| {
            let computed = sample.iter().filter(|one| one.objective.is_some());
            interquartile_range(computed.map(value).collect())
        };
        let constraints = 0..self.problem.constraints.len();
        self.scales = constraints.map(|i| of(&|one| one.margins[i])).collect();
        self.goal_scale = of(&|one| one.objective.unwrap_or_default());
        let scaled = sample.iter().map(|one| self.scaled_objective(one));
        self.worst = scaled.fold(f64::NEG_INFINITY, f64::max);
        let sample = sample.into_iter();
        let ranked = sample.map(|one| self.ranked(one.at, one.objective, one.margins));
        ranked.collect()
    }

    /// Returns the scaled goal, the worst one of the sample for a design without goal.
    pub fn scaled_objective(&self, one: &Evaluation) -> f64 {
        let scaled = one.objective.map(|value| value / self.goal_scale);
        scaled.unwrap_or(self.worst)
    }

    /// Returns the scaled margin to a limit, positive if met; -1, a violation by one scale, without figures.
    pub fn scaled_margin(&self, one: &Evaluation, constraint: usize) -> f64 {
        let margin = one.margins.get(constraint).copied();
        margin.map_or(-1.0, |margin| margin / self.scales[constraint])
    }

    /// Whether a figure equals its limit to [`AGREEMENT`] of its scale.
    pub fn is_active(&self, constraint: usize, value: f64) -> bool {
        let margin = self.problem.constraints[constraint].margin(value);
        margin.abs() <= AGREEMENT * self.scales[constraint]
    }

    /// Whether goals (scaled) and violations of two designs agree to [`AGREEMENT`].
    pub fn agree(&self, one: &Evaluation, other: &Evaluation) -> bool {
        let objectives = one.objective.zip(other.objective);
        let near = objectives.is_some_and(|(a, b)| (a - b).abs() <= AGREEMENT * self.goal_scale);
        near && (one.violation - other.violation).abs() <= AGREEMENT
    }

    /// Returns the least significant difference of the goal: |goal| times the relative error of the motion (speed error
    /// to fastest speed, angle error to angle travelled) or of the steady fluctuation; at least [`LEAST_IMPROVEMENT`] of the scale.
    pub fn resolution(&self, one: &Evaluation) -> f64 {
        let objective = one.objective.map_or(0.0, f64::abs);
        let least = LEAST_IMPROVEMENT * self.goal_scale;
        if self.problem.goal.figure.source <= Source::Diagrams || self.stop.is_requested() {
            return least;
        }
        let design = self.vouched(&one.at);
        let motion = design.motion.as_ref().and_then(|run| {
            let error = run.error_estimate?;
            let fastest = run.omega_max.abs().max(run.omega_min.abs());
            let way = run.revolutions.abs() * TAU;
            Some((error.omega_rad_per_s / fastest).max(error.theta_rad / way))
        });
        let steady = design.steady.as_ref();
        let steady = steady.map(|cycle| cycle.fluctuation.error / cycle.fluctuation.value);
        let errors = motion.into_iter().chain(steady);
        let errors = errors.map(|error| error * objective);
        errors
            .filter(|error| error.is_finite())
            .fold(least, f64::max)
    }

    /// Whether `one` beats `other`: by more than `resolution` in goal at equal violation, else [`LEAST_IMPROVEMENT`] in violation.
    pub fn improves(&self, one: &Evaluation, other: &Evaluation, resolution: f64) -> bool {
        if one.order(other) != Ordering::Less {
            return false;
        }
        match (one.objective, other.objective) {
            (Some(a), Some(b)) if one.violation == other.violation => b - a > resolution,
            _ => other.violation - one.violation > LEAST_IMPROVEMENT,
        }
    }
}

fn design(sweep: &Sweep, at: &[f64]) -> Design {
    let varied = sweep.varied.iter().zip(at);
    sweep.design_of(0, varied.map(|(one, at)| one.quantile(*at)).collect())
}

/// Returns the interquartile range of at least one value; the full range if that is zero, 1 if both are zero or not finite.
fn interquartile_range(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    let spreads = [
        values[last - last / 4] - values[last / 4],
        values[last] - values[0],
    ];
    let is_scale = |spread: &f64| *spread > 0.0 && spread.is_finite();
    spreads.into_iter().find(is_scale).unwrap_or(1.0)
}
