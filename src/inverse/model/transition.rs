//! Transition of the deviations of θ and ω over a step.

use super::prior::{State, plain_state};

/// Derivatives of θ̈ by θ, ω and u.
pub(in crate::inverse) type Slopes = [f64; 3];

/// Returns the rows of θ and ω of the transition over h, s, of θ̈ with these derivatives in the mean, which change by others from
/// begin to end: the exponential of Magnus' series to h⁴ (Blanes, Casas, Oteo and Ros, Phys. Rep. 470 (2009) 151).
pub(in crate::inverse) fn transition(h: f64, mean: Slopes, change: Slopes) -> [State; 2] {
    let ([p, q, lever], [dp, dq, dl]) = (mean, change.map(|change| h * h / 12.0 * change));
    let of_theta = [-dp, h - dq, -dl];
    let of_omega = [
        h * p - q * dp + p * dq,
        h * q + dp,
        h * lever - q * dl + lever * dq,
    ];
    // Rows of Ω, to which u adds its derivatives.
    let mut top = [plain_state([1.0, 0.0, 0.0]), plain_state([0.0, 1.0, 0.0])];
    for row in &mut top {
        let mut term = *row;
        for share in [1.0, 1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0] {
            let [theta, omega, u, first, ..] = term.map(|value| share * value);
            let by = |k: usize| theta * of_theta[k] + omega * of_omega[k];
            term = plain_state([by(0), by(1), by(2)]);
            [term[3], term[4]] = [u * h + omega * dl, first * h];
            for (sum, term) in row.iter_mut().zip(term) {
                *sum += term;
            }
        }
    }
    top
}

#[cfg(test)]
mod tests {
    use super::{Slopes, transition};

    /// θ and ω after a time h by 10 000 steps of the midpoint rule, for u = 1 + 2 t and these derivatives of θ̈ with their rates.
    fn integrated(h: f64, begin: Slopes, rates: Slopes) -> [f64; 2] {
        let (mut theta, mut omega) = (0.4, -0.2);
        let count = 10_000;
        let dt = h / f64::from(count);
        let rate = |theta: f64, omega: f64, t: f64| {
            let [p, q, lever] = [0, 1, 2].map(|k| begin[k] + rates[k] * t);
            p * theta + q * omega + lever * (1.0 + 2.0 * t)
        };
        for k in 0..count {
            let t = f64::from(k) * dt;
            let half = omega + 0.5 * dt * rate(theta, omega, t);
            let there = theta + 0.5 * dt * omega;
            omega += dt * rate(there, half, t + 0.5 * dt);
            theta += dt * half;
        }
        [theta, omega]
    }

    /// The errors of θ and ω after a time h by the transition.
    fn errors(h: f64, begin: Slopes, rates: Slopes) -> [f64; 2] {
        let mean = [0, 1, 2].map(|k| begin[k] + 0.5 * h * rates[k]);
        let top = transition(h, mean, rates.map(|rate| h * rate));
        let found = top.map(|row| row[0] * 0.4 - row[1] * 0.2 + row[2] + 2.0 * row[3]);
        let exact = integrated(h, begin, rates);
        [0, 1].map(|k| (found[k] - exact[k]).abs())
    }

    /// θ̈ = −2 θ + 0.7 θ̇ + 1.7 u: the error is that of the series after h⁴, (‖A‖ h)⁵/5! of the state and of what u adds, with
    /// ‖A‖ = 2.7.
    #[test]
    fn the_transition_solves_the_linear_equation() {
        for h in [0.1, 0.03, 0.01] {
            let left_out = (2.7f64 * h).powi(5) / 120.0;
            for error in errors(h, [-2.0, 0.7, 1.7], [0.0; 3]) {
                assert!(error < left_out, "{h}: {error}");
            }
        }
    }

    /// With derivatives that change, what is left out goes with h⁵: half the time leaves 1/32, and a mean alone 1/8.
    #[test]
    fn the_transition_follows_derivatives_that_change() {
        let left = |h| errors(h, [-2.0, 0.7, 1.7], [30.0, -8.0, 9.0]);
        let halved = [0.2, 0.1, 0.05].map(left);
        for pair in halved.windows(2) {
            for (whole, half) in pair[0].into_iter().zip(pair[1]) {
                assert!(half < whole / 20.0, "{whole} {half}");
            }
        }
    }
}
