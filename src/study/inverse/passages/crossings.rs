//! Where a motion goes from one step of its samples to the next.

use crate::numeric::median::median;
use crate::study::inverse::sensor::Sensor;

/// Fewest samples for each change from step to step, on average.
const DENSE: usize = 4;

/// Part of a step by which a change may differ from one: values are multiples of it but for the rounding of doubles. Half or
/// twice as much changes no fit of 54 records.
const ALIKE: f64 = 1e-3;

/// Times the usual time between samples from which on it is a gap.
const GAP: f64 = 1.5;

/// Part of the passages that noise may blur.
const BLURRED: f64 = 0.02;

/// Times the usual distance of passages from which on they are far apart, and the most samples between two of these.
const FAR: f64 = 3.0;
const MOST: usize = 32;

/// A passage over the border between two steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Passage {
    /// s
    pub t: f64,
    /// Time between two samples, s.
    pub between: f64,
    /// Value at the border, rad or m.
    border: f64,
    /// Crank angle there, rad.
    pub theta: f64,
    /// Changes from step to step that it has, forth and back.
    pub changes: usize,
}

/// The passages of times, values and crank angles; none where samples are few, values change by other than steps, or noise
/// blurs many of them.
pub(super) fn passages(
    sensor: &Sensor<'_>,
    [times, values, theta]: [&[f64]; 3],
    step: f64,
) -> Option<Vec<Passage>> {
    let changes = changes(sensor, [times, values, theta], step)?;
    let last = changes.len();
    let time = |i: usize| match i {
        0 => times[0],
        i if i > last => times[times.len() - 1],
        i => changes[i - 1].t,
    };
    let (mut found, mut blurred) = (Vec::new(), 0);
    let mut from = 0;
    for group in changes.chunk_by(|a, b| a.border == b.border) {
        let to = from + group.len();
        for (first, end) in parts(group) {
            let part = &group[first..end];
            let extent = part[part.len() - 1].t - part[0].t;
            let before = part[0].t - time(from + first);
            let after = time(from + end + 1) - part[part.len() - 1].t;
            // Which stroke samples next to a fold are on is not certain: those far from it tell.
            let theta = part[if first > 0 { part.len() - 1 } else { 0 }].theta;
            let sure = end < group.len() || first > 0 || part.iter().all(|c| c.theta == theta);
            if part.len() % 2 == 1 && sure && 2.0 * extent <= before.min(after) {
                found.push(Passage {
                    theta,
                    ..together(part)
                });
            } else {
                blurred += 1;
            }
        }
        from = to;
    }
    (blurred as f64 <= BLURRED * found.len() as f64).then_some(found)
}

/// The changes from one step to the next.
fn changes(
    sensor: &Sensor<'_>,
    [times, values, theta]: [&[f64]; 3],
    step: f64,
) -> Option<Vec<Passage>> {
    let usual = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
    let mut found = Vec::new();
    for i in 1..times.len() {
        let change = (values[i] - values[i - 1]).abs();
        if change < (1.0 - ALIKE) * step {
            continue;
        }
        let between = times[i] - times[i - 1];
        if change > (1.0 + ALIKE) * step {
            if between > GAP * usual {
                continue;
            }
            return None;
        }
        let border = 0.5 * (values[i - 1] + values[i]);
        let at_border = sensor.between(border, [theta[i - 1], theta[i]]);
        found.extend(at_border.map(|theta| Passage {
            t: times[i - 1] + 0.5 * between,
            between,
            border,
            theta,
            changes: 1,
        }));
        if DENSE * found.len() > values.len() {
            return None;
        }
    }
    Some(found)
}

/// Changes over the same border one after the other, where the motion turns back beyond it in two parts.
fn parts(group: &[Passage]) -> Vec<(usize, usize)> {
    let all = group.len();
    if all % 2 == 1 {
        return vec![(0, all)];
    }
    let time = |i: &usize| group[*i].t - group[*i - 1].t;
    let longest = (1..all).max_by(|a, b| time(a).total_cmp(&time(b)));
    let split = longest.unwrap_or(all);
    vec![(0, split), (split, all)]
}

/// One passage of an odd number of changes forth and back.
fn together(changes: &[Passage]) -> Passage {
    let back = changes[1..]
        .chunks_exact(2)
        .map(|pair| pair[1].t - pair[0].t);
    Passage {
        t: changes[0].t + back.sum::<f64>(),
        changes: changes.len(),
        ..changes[0]
    }
}

/// Speeds at passages, rad/s: those of the parabola through each and its neighbours, which a motion that turns back between
/// two of them asks for.
pub(super) fn speeds(passages: &[Passage]) -> Vec<f64> {
    let last = passages.len() - 1;
    let mean = |i: usize| {
        let [from, to] = [passages[i], passages[i + 1]];
        (to.theta - from.theta) / (to.t - from.t)
    };
    let speed = |i: usize| match i {
        0 => mean(0),
        i if i == last => mean(last - 1),
        i => {
            let [before, after] = [i - 1, i].map(|k| passages[k + 1].t - passages[k].t);
            (mean(i - 1) * after + mean(i) * before) / (before + after)
        }
    };
    (0..=last).map(|i| speed(i).abs()).collect()
}

/// Samples between passages that are far apart, about as close as passages are elsewhere, and the first and last one: they
/// hold a curve within their steps. The passages have their times first.
pub(super) fn far_between(times: &[f64], passages: &[[f64; 3]]) -> Option<Vec<usize>> {
    let last = times.len() - 1;
    let usual = median(passages.windows(2).map(|pair| pair[1][0] - pair[0][0]))?;
    let mut found = vec![0];
    let mut from = times[0];
    for to in passages.iter().map(|row| row[0]).chain([times[last]]) {
        let far = to - from > FAR * usual;
        let parts = if far {
            ((to - from) / usual) as usize
        } else {
            1
        };
        let places =
            (1..parts.min(MOST)).map(|k| from + (to - from) * k as f64 / parts.min(MOST) as f64);
        found.extend(places.map(|t| times.partition_point(|time| *time < t)));
        from = to;
    }
    found.push(last);
    found.dedup();
    Some(found)
}
