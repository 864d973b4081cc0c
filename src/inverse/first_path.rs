//! Paths from which the iterations of the smoother set out.

use super::problem::Problem;
use super::record::Path;

/// A first path along measured crank angles: a straight line, of which the linear model knows how far the samples are off.
pub(super) fn straight(problem: &Problem<'_>) -> Path {
    let (times, record) = (&problem.grid.times, &problem.record);
    let (theta, last) = (&record.values, record.values.len() - 1);
    let speed = (theta[last] - theta[0]) / (record.times[last] - record.times[0]);
    let state = |t: &f64| [theta[0] + speed * (t - times[0]), speed, 0.0, 0.0];
    Path {
        states: times.iter().map(state).collect(),
        variances: None,
    }
}

/// A first path along crank angles, rad, with their slopes.
pub(super) fn coarse(problem: &Problem<'_>, theta: &[f64]) -> Path {
    let (times, record) = (&problem.grid.times, &problem.record);
    let last = theta.len() - 1;
    let states = times.iter().enumerate().map(|(node, t)| {
        let next = problem.grid.first[node].clamp(1, last);
        let (a, b) = (record.times[next - 1], record.times[next]);
        let slope = (theta[next] - theta[next - 1]) / (b - a);
        [theta[next - 1] + slope * (t - a), slope, 0.0, 0.0]
    });
    Path {
        states: states.collect(),
        variances: None,
    }
}
