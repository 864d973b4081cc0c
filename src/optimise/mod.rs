//! The best design: values of scene keys between bounds for which a key figure is least or most, subject to limits of
//! others.

mod judge;
mod local;
mod search;
mod subject;

use std::sync::atomic::Ordering;

use serde::Serialize;

use crate::error::Error;
use crate::scene::{Draft, Varied};
use crate::sweep::{Design, Goal, LatinHypercube, Sweep, SweepOptions};

use judge::Judge;
pub use subject::{Limit, Subject};

/// What is looked for.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The figure that is to be least or most.
    pub goal: Goal,
    /// Limits of figures.
    pub subjects: Vec<Subject>,
    /// Seed of the samples.
    pub seed: u64,
}

/// The best design that was found.
#[derive(Clone, Debug, Serialize)]
pub struct Optimum {
    /// Title of the scene.
    pub scene: String,
    /// The figure that is to be least or most, as the column of a sweep.
    pub figure: String,
    /// `"least"` or `"most"`.
    pub sense: &'static str,
    /// The figure, in SI units and radians; none if no design has it.
    pub value: Option<f64>,
    /// Designs whose figures differ by less are not told apart: the error of the figure, or [`GAIN`] of its spread.
    pub resolution: f64,
    /// The values of the varied keys.
    pub values: Vec<OptimumValue>,
    /// Limits, and how far the design keeps from them.
    pub subjects: Vec<SubjectMet>,
    /// Whether it meets all limits; else it is the design that misses them least.
    pub meets_subjects: bool,
    /// The local searches.
    pub starts: Vec<Start>,
    /// The sweeps round the optimum.
    pub proof: Proof,
    /// Number of designs computed.
    pub designs: u64,
    /// Whether somebody asked to stop before the search was over.
    pub interrupted: bool,
    /// What the reader should know of the design.
    pub notes: Vec<String>,
}

/// The value of a varied key.
#[derive(Clone, Debug, Serialize)]
pub struct OptimumValue {
    /// The key, as `geometry.offset`.
    pub key: String,
    /// The key as the column of a sweep.
    pub column: String,
    /// As a scene file has it.
    pub text: String,
    /// In SI units and radians.
    pub value: f64,
    /// The SI unit; empty for numbers.
    pub unit: &'static str,
    /// The bounds, in the same unit.
    pub bounds: [f64; 2],
    /// `"low"` or `"high"` if the value is that bound.
    pub at_bound: Option<&'static str>,
}

/// How a design stands to a limit.
#[derive(Clone, Debug, Serialize)]
pub struct SubjectMet {
    /// The figure, as the column of a sweep.
    pub figure: String,
    /// `">="` or `"<="`.
    pub sense: &'static str,
    /// The limit, in SI units and radians.
    pub limit: f64,
    /// The figure of the design; none if it has none.
    pub value: Option<f64>,
    /// Whether the design keeps it.
    pub is_met: bool,
    /// Whether the design lies on it.
    pub is_active: bool,
}

/// Where a local search ended.
#[derive(Clone, Debug, Serialize)]
pub struct Start {
    /// The values of the varied keys at the start, in SI units and radians.
    pub from: Vec<f64>,
    /// At the end.
    pub to: Vec<f64>,
    /// The figure at the end; none if no design of this search has it.
    pub value: Option<f64>,
    /// Whether the design at the end meets all limits.
    pub meets_subjects: bool,
    /// Whether the figure agrees with that of the optimum to [`AGREEMENT`] of its spread.
    pub agrees: bool,
    /// Number of designs computed.
    pub designs: u64,
}

/// Sweeps round the optimum, each in a box of its own size, in which no design was better.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Proof {
    /// Whether such sweeps were made and none of their designs is better.
    pub is_complete: bool,
    /// Half widths of the boxes, in parts of the ranges between the bounds.
    pub half_widths: Vec<f64>,
    /// Designs of each sweep.
    pub designs_each: u64,
    /// How many times a better design was found and the search went on from it.
    pub improvements: u32,
}

/// Local searches agree within this part of the middle half of the figure's sample.
pub const AGREEMENT: f64 = 1e-6;

/// A design is no better for less than this part of the middle half of the figure's sample.
pub const GAIN: f64 = 1e-9;

/// Looks for the best design between the bounds of the varied keys.
///
/// A Latin hypercube explores the box. Local searches set out from those of its designs that have no better one within the
/// critical distance of multi-level single linkage (Rinnooy Kan and Timmer, Mathematical Programming 39 (1987) 57), by
/// COBYLA (Powell 1994). Designs are compared by Deb's rules (Computer Methods in Applied Mechanics and Engineering 186
/// (2000) 311): those that meet all limits by the figure, others by how far they miss. Finer and finer sweeps round
/// the best one go on until none finds a better one.
///
/// ```
/// use slider_crank::optimise::{Asked, optimise};
/// use slider_crank::scene::Draft;
/// use slider_crank::sweep::{Goal, SweepOptions};
///
/// // The longest rod swings least; the stroke is 94 mm with any, as there is no offset.
/// let asked = Asked {
///     goal: Goal { figure: "transmission_min".parse().unwrap(), most: true },
///     subjects: vec!["stroke <= 100 mm".parse().unwrap()],
///     seed: 1,
/// };
/// let varied = vec!["geometry.rod=100mm:200mm".parse().unwrap()];
/// let best = optimise(Draft::duarte(), varied, &asked, SweepOptions::default())?;
/// assert_eq!(best.values[0].value, 0.2);
/// assert_eq!(best.values[0].at_bound, Some("high"));
/// assert!(best.proof.is_complete);
/// # Ok::<(), slider_crank::error::Error>(())
/// ```
///
/// # Errors
/// The errors of [`Sweep::new`]; [`Error::Refused`] if a key is not varied between two bounds, or no design has the figures.
pub fn optimise(
    draft: Draft,
    varied: Vec<Varied>,
    asked: &Asked,
    options: SweepOptions,
) -> Result<Optimum, Error> {
    let bounds = bounds(&varied)?;
    let mut figures = vec![asked.goal.figure];
    for one in asked.subjects.iter().map(|subject| subject.figure) {
        if !figures.contains(&one) {
            figures.push(one);
        }
    }
    let sample = LatinHypercube {
        count: search::EXPLORED * varied.len() as u64,
        seed: asked.seed,
    };
    let options = SweepOptions {
        figures,
        sample: Some(sample),
        estimate: false,
        ..options
    };
    let stop = options.stop.clone().unwrap_or_default();
    let sweep = Sweep::new(draft, varied, options)?;
    let mut judge = Judge::new(&sweep, asked, &stop);
    let found = search::run(&mut judge, asked.seed)?;
    Ok(report(&judge, &bounds, found))
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

/// What was found, in the units of the keys.
fn report(judge: &Judge, bounds: &[[f64; 2]], found: search::SearchResult) -> Optimum {
    let (asked, varied) = (judge.asked, judge.sweep.varied());
    let best = &found.best;
    // With what there is to say of the errors of its motion.
    let vouched = judge.sweep.with_estimates();
    let design = vouched.design_of(0, judge.values(&best.at));
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
            at if at <= GAIN => Some("low"),
            at if at >= 1.0 - GAIN => Some("high"),
            _ => None,
        },
    });
    let starts = found.starts.iter().map(|start| Start {
        from: numbers(&start.from),
        to: numbers(&start.end.at),
        value: start.end.value(asked.goal),
        meets_subjects: start.end.violation == 0.0,
        agrees: judge.agree(&start.end, best),
        designs: start.designs,
    });
    Optimum {
        scene: judge.sweep.title().to_owned(),
        figure: asked.goal.figure.to_string(),
        sense: if asked.goal.most { "most" } else { "least" },
        value: best.value(asked.goal),
        resolution: found.resolution,
        values: values.collect(),
        subjects: subjects(judge, &design),
        meets_subjects: best.violation == 0.0,
        starts: starts.collect(),
        proof: found.proof,
        designs: judge.computed.load(Ordering::Relaxed),
        interrupted: judge.stop.is_requested(),
        notes: design.notes,
    }
}

fn subjects(judge: &Judge, design: &Design) -> Vec<SubjectMet> {
    let met = |(i, subject): (usize, &Subject)| {
        let value = subject.figure.number(design);
        SubjectMet {
            figure: subject.figure.to_string(),
            sense: subject.limit.sign(),
            limit: subject.value,
            value,
            is_met: value.is_some_and(|value| subject.margin(value) >= 0.0),
            is_active: value.is_some_and(|value| judge.is_active(i, value)),
        }
    };
    judge.asked.subjects.iter().enumerate().map(met).collect()
}
