//! A sensor at the end of its range: it shows one largest or smallest value, sample after sample, of a motion that is fast.

use super::Measurement;
use crate::numeric::median::median;

/// Fewest equal values in a row.
const FEWEST: usize = 4;

/// A motion is fast that changes by this part of the usual change from one sample to the next...
const USUAL: f64 = 0.25;

/// ... and by more than it does beside a smooth turn. A parabola a k² that is rounded to n equal values has a (n/2)² at
/// most as large as the step of rounding, and beside them it changes by a (n + 3); this is four times as much.
const TURN: f64 = 16.0;

/// Says where the largest or the smallest values are equal between samples of a fast motion.
pub(super) fn saturated(measurement: &Measurement) -> Option<String> {
    let values = &measurement.values;
    let ends = (f64::INFINITY, f64::NEG_INFINITY);
    let ends = values.iter().fold(ends, |(a, b), v| (a.min(*v), b.max(*v)));
    let runs = |end: f64| values.chunk_by(move |a, b| *a == end && *b == end);
    let is_long = |run: &&[f64]| run.len() >= FEWEST;
    if ![ends.0, ends.1]
        .iter()
        .any(|end| runs(*end).any(|run| is_long(&run)))
    {
        return None;
    }
    let mut steps: Vec<f64> = values.windows(2).map(|w| (w[1] - w[0]).abs()).collect();
    steps.retain(|step| *step > 0.0);
    let smallest = steps.iter().copied().reduce(f64::min)?;
    let usual = median(steps)?;
    let fast = |count: usize| {
        let n = count as f64;
        let turn = TURN * (n + 3.0) / (n * n) * smallest.max(measurement.resolution);
        turn.max(USUAL * usual)
    };
    let mut found: Vec<[usize; 2]> = Vec::new();
    for end in [ends.0, ends.1] {
        let mut start = 0;
        for run in runs(end) {
            let stretch = [start, start + run.len() - 1];
            start += run.len();
            if is_long(&run) && is_cut(values, stretch, fast(run.len())) {
                found.push(stretch);
            }
        }
    }
    let [from, to] = *found.iter().min()?;
    Some(format!(
        "{}, the first from {} to {} ({} = {}), while the motion before and after is fast: a sensor at the end of its range shows that, and what comes of it there is not the motion",
        match found.len() {
            1 => "equal extreme values follow each other".to_owned(),
            more => format!("equal extreme values follow each other {more} times"),
        },
        measurement.place(from),
        measurement.place(to),
        measurement.measured.name(),
        measurement.shown(values[from])
    ))
}

/// Whether a motion is fast before and after a stretch: from the sample beside it on, which may be just before the end.
fn is_cut(values: &[f64], [from, to]: [usize; 2], fast: f64) -> bool {
    let step = |a: usize, b: usize| (values[a] - values[b]).abs();
    let before = from.checked_sub(2).map(|far| step(far, from - 1));
    let after = values.get(to + 2).map(|_| step(to + 2, to + 1));
    let list = [before, after];
    list.iter().any(Option::is_some) && list.into_iter().flatten().all(|step| step >= fast)
}
