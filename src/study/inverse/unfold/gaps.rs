//! Gaps between samples in which the crank turns too far for folded values to tell how far.

use std::f64::consts::TAU;

use crate::numeric::median::median;
use crate::scene::Measurement;

/// A time between samples that is so many times the usual one is a gap.
const GAP: f64 = 4.5;

/// Turn of the crank in a gap, rad, from which on turning points may be missed, and the shorter way be the wrong one.
const FAR: f64 = 0.4 * TAU;

/// Samples beside a gap that tell the speed there.
const BESIDE: usize = 8;

/// What is said of gaps in which the crank, at the speed beside them, turns that far. `theta`, rad, are the unfolded samples.
pub(super) fn too_far(measurement: &Measurement, theta: &[f64]) -> Option<String> {
    let times = measurement.elapsed();
    let usual = median(times.windows(2).map(|w| w[1] - w[0]))?;
    let last = theta.len() - 1;
    let speed = |from: usize, to: usize| {
        let time = times[to] - times[from];
        if time > 0.0 {
            (theta[to] - theta[from]).abs() / time
        } else {
            0.0
        }
    };
    // How far the crank turns before a sample.
    let turn = |i: usize| {
        let before = speed((i - 1).saturating_sub(BESIDE), i - 1);
        let after = speed(i, (i + BESIDE).min(last));
        before.max(after) * (times[i] - times[i - 1])
    };
    let is_far = |i: &usize| times[*i] - times[*i - 1] > GAP * usual && turn(*i) > FAR;
    let count = (1..=last).filter(is_far).count();
    let first = (1..=last).find(is_far)?;
    Some(format!(
        "{} too long to tell how far the crank turns there, the first before {} (t = {} s): at the speed beside it by {:.2} turns; all after it depends on that, so invert the parts apart",
        match count {
            1 => "a gap is".to_owned(),
            _ => format!("{count} gaps are"),
        },
        measurement.place(first),
        measurement.times()[first],
        turn(first) / TAU,
    ))
}
