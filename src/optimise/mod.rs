//! Optimum design: takes bounds of scene keys, a goal figure and limits of others, and returns the best values, by
//! multi-start COBYLA with Deb's constraint rules.

mod constraint;
mod evaluator;
mod local;
mod search;

use std::sync::atomic::Ordering;

use serde::Serialize;

use crate::error::Error;
use crate::scene::{Draft, Varied};
use crate::sweep::{Design, Goal, LatinHypercube, Sweep, SweepOptions};

pub use constraint::{Constraint, Sense};
use evaluator::Evaluator;

/// Optimisation problem: goal, limits and seed.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Figure to minimise or maximise.
    pub goal: Goal,
    /// Inequality constraints.
    pub constraints: Vec<Constraint>,
    /// Seed of the Latin hypercube samples.
    pub seed: u64,
}

/// Result of an optimisation: best design, local searches and final sweeps.
#[derive(Clone, Debug, Serialize)]
pub struct Optimum {
    /// Title of the scene.
    pub scene: String,
    /// Goal figure, as its column of a sweep.
    pub figure: String,
    /// `"least"` or `"most"`.
    pub sense: &'static str,
    /// Value of the goal figure, in SI units and radians; none if no design has it.
    pub value: Option<f64>,
    /// Least significant difference of the goal figure: its error, at least [`LEAST_IMPROVEMENT`] of its scale in the sample.
    pub resolution: f64,
    /// Optimum values of the varied keys.
    pub values: Vec<OptimumValue>,
    /// Limits, and the values of their figures at the optimum.
    pub subjects: Vec<EvaluatedConstraint>,
    /// Whether the design meets all limits; if not, it is the design with the least violation.
    pub meets_subjects: bool,
    /// Local searches.
    pub starts: Vec<LocalSearch>,
    /// Sweeps round the optimum, in search of a better design.
    pub proof: FinalSweeps,
    /// Number of designs computed.
    pub designs: u64,
    /// Whether a request to stop ended the search early.
    pub interrupted: bool,
    /// Notes on the optimum design, as in a row of a sweep.
    pub notes: Vec<String>,
}

/// Optimum value of one varied key.
#[derive(Clone, Debug, Serialize)]
pub struct OptimumValue {
    /// Key of the scene, like `geometry.offset`.
    pub key: String,
    /// Column of the key in a sweep.
    pub column: String,
    /// Value as written in a scene file.
    pub text: String,
    /// Value in SI units and radians.
    pub value: f64,
    /// SI unit; empty for dimensionless values.
    pub unit: &'static str,
    /// Lower and upper bound, in SI units and radians.
    pub bounds: [f64; 2],
    /// `"low"` or `"high"` if the value is that bound.
    pub at_bound: Option<&'static str>,
}

/// One limit, evaluated at the optimum.
#[derive(Clone, Debug, Serialize)]
pub struct EvaluatedConstraint {
    /// Limited figure, as its column of a sweep.
    pub figure: String,
    /// `">="` or `"<="`.
    pub sense: &'static str,
    /// Limit, in SI units and radians.
    pub limit: f64,
    /// Figure at the optimum, in SI units and radians; none if the design lacks it.
    pub value: Option<f64>,
    /// Whether the design meets the limit.
    pub is_met: bool,
    /// Whether the constraint is active: the figure equals the limit to [`AGREEMENT`] of its scale.
    pub is_active: bool,
}

/// Start and end of one local search.
#[derive(Clone, Debug, Serialize)]
pub struct LocalSearch {
    /// Values of the varied keys at the start, in SI units and radians.
    pub from: Vec<f64>,
    /// Values of the varied keys at the end, in SI units and radians.
    pub to: Vec<f64>,
    /// Goal figure at the end, in SI units and radians; none if no design of this search has it.
    pub value: Option<f64>,
    /// Whether the design at the end meets all limits.
    pub meets_subjects: bool,
    /// Whether goal and violation agree with the optimum to [`AGREEMENT`] of their scales.
    pub agrees: bool,
    /// Number of designs computed by this search.
    pub designs: u64,
}

/// Sweeps of nested boxes round the optimum, which found no better design if complete.
#[derive(Clone, Debug, Default, Serialize)]
pub struct FinalSweeps {
    /// Whether all sweeps ran and none found a better design.
    pub is_complete: bool,
    /// Half-widths of the boxes, in parts of the ranges between the bounds.
    pub half_widths: Vec<f64>,
    /// Number of designs of each sweep.
    pub designs_each: u64,
    /// Number of restarts of the search from a better design of a sweep.
    pub improvements: u32,
}

/// Tolerance of agreement between local searches, in interquartile ranges of the figure in the sample.
pub const AGREEMENT: f64 = 1e-6;

/// Least significant improvement of a design, in interquartile ranges of the figure in the sample.
pub const LEAST_IMPROVEMENT: f64 = 1e-9;

/// Finds the best design between the bounds of the varied keys.
///
/// A Latin hypercube explores the box. COBYLA (Powell 1994) searches from each design without a better one within the
/// critical distance of multi-level single linkage (Rinnooy Kan and Timmer, Mathematical Programming 39 (1987) 57).
/// Deb's rules compare designs (Computer Methods in Applied Mechanics and Engineering 186 (2000) 311): feasible ones by
/// the goal, others by their violation of the limits. Ever narrower sweeps round the best design restart the search
/// until none finds a better one.
///
/// ```
/// use slider_crank::optimise::{Problem, optimise};
/// use slider_crank::scene::Draft;
/// use slider_crank::sweep::{Goal, SweepOptions};
///
/// // The longest rod swings least; the stroke is 94 mm with any, as there is no offset.
/// let problem = Problem {
///     goal: Goal::most("transmission_min".parse().unwrap()),
///     constraints: vec!["stroke <= 100 mm".parse().unwrap()],
///     seed: 1,
/// };
/// let varied = vec!["geometry.rod=100mm:200mm".parse().unwrap()];
/// let best = optimise(Draft::duarte(), varied, &problem, SweepOptions::default())?;
/// assert_eq!(best.values[0].value, 0.2);
/// assert_eq!(best.values[0].at_bound, Some("high"));
/// assert!(best.proof.is_complete);
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
///
/// # Errors
/// Errors of [`Sweep::new`]; [`Error::Refused`] if a key has no two bounds, or no design has the figures;
/// [`Error::Incomplete`] if no design has them because its motion ends early.
pub fn optimise(
    draft: Draft,
    varied: Vec<Varied>,
    problem: &Problem,
    options: SweepOptions,
) -> Result<Optimum, Error> {
    let bounds = bounds(&varied)?;
    let mut figures = vec![problem.goal.figure];
    for one in problem.constraints.iter().map(|one| one.figure) {
        if !figures.contains(&one) {
            figures.push(one);
        }
    }
    let sample = LatinHypercube {
        count: search::DESIGNS_PER_KEY * varied.len() as u64,
        seed: problem.seed,
    };
    let mut options = SweepOptions {
        figures,
        sample: Some(sample),
        ..options
    };
    options.run.estimate = false;
    let stop = options.run.stop.clone().unwrap_or_default();
    let sweep = Sweep::new(draft, varied, options)?;
    let mut evaluator = Evaluator::new(&sweep, problem, &stop);
    let found = search::run(&mut evaluator, sample)?;
    Ok(report(&evaluator, &bounds, found))
}

fn bounds(varied: &[Varied]) -> Result<Vec<[f64; 2]>, Error> {
    let of = |one: &Varied| {
        one.bounds().ok_or_else(|| {
            let what = format!("`{} = {one}` are no bounds", one.key());
            let help = "write the least and the largest value, like geometry.rod=100mm:200mm";
            Error::refused(what, help)
        })
    };
    varied.iter().map(of).collect()
}

/// Converts a search result from the unit box to the units of the keys.
fn report(evaluator: &Evaluator, bounds: &[[f64; 2]], found: search::SearchResult) -> Optimum {
    let (problem, varied) = (evaluator.problem, &evaluator.sweep.varied);
    let best = &found.best;
    // Computed once more, with error estimates of the motion.
    let design = evaluator.vouched(&best.at);
    let number = |one: &Varied, at: f64| one.quantile(at).number.unwrap_or(f64::NAN);
    let numbers = |at: &[f64]| {
        let pairs = varied.iter().zip(at);
        pairs.map(|(one, at)| number(one, *at)).collect::<Vec<_>>()
    };
    let values = varied.iter().zip(bounds).zip(&best.at);
    let values = values.map(|((one, bounds), at)| OptimumValue {
        key: one.key(),
        column: one.column(),
        text: one.quantile(*at).text,
        value: number(one, *at),
        bounds: *bounds,
        unit: one.unit(),
        at_bound: match *at {
            at if at <= LEAST_IMPROVEMENT => Some("low"),
            at if at >= 1.0 - LEAST_IMPROVEMENT => Some("high"),
            _ => None,
        },
    });
    let starts = found.starts.iter().map(|start| LocalSearch {
        from: numbers(&start.from),
        to: numbers(&start.end.at),
        value: start.end.value(problem.goal),
        meets_subjects: start.end.violation == 0.0,
        agrees: evaluator.agree(&start.end, best),
        designs: start.designs,
    });
    Optimum {
        scene: evaluator.sweep.title.clone(),
        figure: problem.goal.figure.to_string(),
        sense: if problem.goal.maximise {
            "most"
        } else {
            "least"
        },
        value: best.value(problem.goal),
        resolution: found.resolution,
        values: values.collect(),
        subjects: constraints(evaluator, &design),
        meets_subjects: best.violation == 0.0,
        starts: starts.collect(),
        proof: found.proof,
        designs: evaluator.computed.load(Ordering::Relaxed),
        interrupted: evaluator.stop.is_requested(),
        notes: design.notes,
    }
}

fn constraints(evaluator: &Evaluator, design: &Design) -> Vec<EvaluatedConstraint> {
    let evaluated = |(i, constraint): (usize, &Constraint)| {
        let value = constraint.figure.number(design);
        EvaluatedConstraint {
            figure: constraint.figure.to_string(),
            sense: constraint.sense.name(),
            limit: constraint.limit,
            value,
            is_met: value.is_some_and(|value| constraint.margin(value) >= 0.0),
            is_active: value.is_some_and(|value| evaluator.is_active(i, value)),
        }
    };
    let constraints = evaluator.problem.constraints.iter().enumerate();
    constraints.map(evaluated).collect()
}
