//! Samples checked against each other.

use super::listed::{MOST_LISTED, more};
use super::{LEAST_ROWS, Measured, Measurement};
use crate::numeric::median::median;
use crate::scene::number::{apart, computed, counted, show};
use crate::scene::{Problem, Problems};

/// A step of time this many times the usual one is a gap.
const GAP: f64 = 4.5;

/// Larger values leave no digits for what is computed from them.
const LARGEST: f64 = 1e12;

/// No motion of a mechanism is over in a shorter time, s: powers of a rate of change have no range left.
const SHORTEST: f64 = 1e-12;

/// Says what is wrong with the samples, and notes gaps between them.
pub(super) fn check_rows(measurement: &mut Measurement) -> Result<(), Problems> {
    let (times, values) = (&measurement.times, &measurement.values);
    let mut problems = Vec::new();
    if times.len() != values.len() {
        let what = format!("{} times but {} values", times.len(), values.len());
        let help = "give one value for each time";
        return Err(Problems::in_code(vec![Problem::new("samples", what, help)]));
    }
    for (name, list) in [("time", times), (measurement.measured.name(), values)] {
        if let Some(at) = list.iter().position(|v| v.is_nan() || v.abs() > LARGEST) {
            let what = format!("{} is not a usable number", show(list[at]));
            let help = format!("give finite values below {LARGEST:e} in SI units");
            problems.push(place(measurement, at, name, what, help));
        }
    }
    let factor = measurement
        .source
        .as_ref()
        .map_or(1.0, |source| source.time.factor);
    let faults = measurement.elapsed().windows(2).enumerate();
    let faults = faults.filter(|(_, w)| w[1] <= w[0]);
    let text = measurement.source.as_ref().map_or("", |s| s.text.as_str());
    let rest = faults.clone().count().saturating_sub(MOST_LISTED);
    for (i, w) in faults.take(MOST_LISTED) {
        let (now, before) = apart(times[i + 1] / factor, times[i] / factor);
        let what = if w[1] == w[0] {
            format!("the time {now} is repeated")
        } else {
            format!("the time {now} follows {before}")
        };
        let help = "times must rise strictly; take out or put right the row".to_owned();
        problems.push(place(measurement, i + 1, "time", what, help));
    }
    problems.extend(more(rest, text));
    if problems.is_empty() && times.len() < LEAST_ROWS {
        let rows = counted(times.len(), "sample");
        let what = format!("{rows} where at least {LEAST_ROWS} are needed");
        let help = "give more of the motion";
        let mut problem = Problem::new("samples", what, help);
        let end = |text: &str| text.trim_end().len()..text.trim_end().len();
        problem.span = measurement.source.as_ref().map(|s| end(&s.text));
        problems.push(problem);
    }
    problems.extend(too_short(measurement).filter(|_| problems.is_empty()));
    if problems.is_empty() {
        let spaced = measurement.space_evenly();
        let notes = [gaps, far_from_zero, at_rest].map(|noted| noted(measurement));
        let notes = notes.into_iter().chain([spaced]).flatten();
        measurement.notes.extend(notes);
        return Ok(());
    }
    Err(match &measurement.source {
        Some(source) => Problems::in_file(&source.file, &source.text, problems),
        None => Problems::in_code(problems),
    })
}

fn place(
    measurement: &Measurement,
    sample: usize,
    name: &str,
    what: String,
    help: String,
) -> Problem {
    let mut problem = Problem::new(name, what, help);
    match &measurement.source {
        Some(source) if name == "time" => problem.span = Some(source.time_span(sample)),
        Some(source) => problem.span = Some(source.value_span(sample)),
        None => problem.field = format!("{name}, sample {}", sample + 1),
    }
    problem
}

/// Times so close to each other that their unit is wrong.
fn too_short(measurement: &Measurement) -> Option<Problem> {
    let times = measurement.elapsed();
    let (first, last) = (times.first()?, times.last()?);
    (last - first < SHORTEST).then(|| {
        let what = format!("all samples lie within {} s", show(last - first));
        let help = format!("give times over more than {SHORTEST:e} s: check their unit");
        place(measurement, times.len() - 1, "time", what, help)
    })
}

/// Samples that are all equal.
fn at_rest(measurement: &Measurement) -> Option<String> {
    let first = *measurement.values.first()?;
    let is_same = measurement.values.iter().all(|value| *value == first);
    is_same.then(|| {
        format!(
            "all values of {} are {}: the samples show no motion, and force and torque are those that hold the crank at rest",
            measurement.measured.name(),
            measurement.shown(first)
        )
    })
}

/// Steps of time far above the usual one.
fn gaps(measurement: &Measurement) -> Option<String> {
    let times = measurement.elapsed();
    let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    let ends = (f64::INFINITY, 0.0f64);
    let (least, most) = (steps.iter()).fold(ends, |(a, b), step| (a.min(*step), b.max(*step)));
    if most <= GAP * least {
        return None;
    }
    let usual = median(steps)?;
    let wide = |w: &[f64]| w[1] - w[0] > GAP * usual;
    let count = times.windows(2).filter(|w| wide(w)).count();
    let first = times.windows(2).position(wide)?;
    let factor = measurement
        .source
        .as_ref()
        .map_or(1.0, |source| source.time.factor);
    Some(format!(
        "{}, the first before {} (time {}), where {} passes without a sample and {} is usual: nothing is known of the motion there but what the fit assumes",
        counted(count, "gap"),
        measurement.place(first + 1),
        show(measurement.times[first + 1] / factor),
        show((times[first + 1] - times[first]) / factor),
        show(usual / factor)
    ))
}

/// Times with so many digits before the point that doubles lose those behind it.
fn far_from_zero(measurement: &Measurement) -> Option<String> {
    let known = measurement.lost()?;
    let times = measurement.elapsed();
    let step = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    if measurement.elapsed.is_some() {
        return Some(format!(
            "times so far from zero are counted from the first row: the coefficients of the fit refer to the time since t = {} s, which as t_s in the rows is rounded to {} s",
            measurement.origin(),
            computed(known)
        ));
    }
    Some(format!(
        "so far from zero, times are known to {} s only, where samples are {} s apart, and forces to as little: let the time begin near 0",
        computed(known),
        computed(step)
    ))
}

impl Measured {
    /// Whether several crank angles have the same measured value.
    pub fn folds(self) -> bool {
        self != Measured::Theta
    }
}
