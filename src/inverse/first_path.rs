//! Paths from which the iterations of the smoother set out.

use super::problem::Problem;
use super::record::Path;
use super::state_space::State;

/// A first path along measured crank angles: a straight line, of which the linear model knows how far the samples are off.
pub(super) fn straight(problem: &Problem<'_>) -> Path {
    let (times, record) = (&problem.grid.times, &problem.record);
    let (theta, last) = (&record.values, record.values.len() - 1);
    let speed = (theta[last] - theta[0]) / (record.times[last] - record.times[0]);
    let state = |t: &f64| [theta[0] + speed * (t - times[0]), speed, 0.0, 0.0];
    let mut states: Vec<State> = times.iter().map(state).collect();
    // The prior of the start is narrow beside what samples without noise tell.
    let told: Vec<usize> = (0..theta.len())
        .filter(|i| record.weights[*i] > 0.0)
        .take(4)
        .collect();
    if let [a, b, c, d] = told[..] {
        states[0] = cubic(
            [a, b, c, d].map(|i| record.times[i] - record.times[0]),
            [a, b, c, d].map(|i| theta[i]),
        );
    }
    Path {
        states,
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

/// Value and three derivatives at time 0 of the cubic through values at four times (Newton's divided differences).
fn cubic(t: [f64; 4], values: [f64; 4]) -> State {
    let mut table = values;
    for order in 1..4 {
        for k in (order..4).rev() {
            table[k] = (table[k] - table[k - 1]) / (t[k] - t[k - order]);
        }
    }
    let [value, first, second, third] = table;
    let [a, b, c, _] = t;
    [
        value - a * (first - b * (second - c * third)),
        first - (a + b) * second + (a * b + b * c + c * a) * third,
        2.0 * (second - (a + b + c) * third),
        6.0 * third,
    ]
}

#[cfg(test)]
mod tests {
    use super::cubic;

    #[test]
    fn a_cubic_is_its_own() {
        let t = [0.5, 0.7, 1.1, 1.2];
        let values = t.map(|t: f64| 1.0 + 2.0 * t - 3.0 * t * t + 0.5 * t * t * t);
        let found = cubic(t, values);
        for (found, expected) in found.iter().zip([1.0, 2.0, -6.0, 3.0]) {
            assert!((found - expected).abs() < 1e-11);
        }
    }
}
