//! Transition of the deviations of θ and ω over a step.

use super::prior::State;

/// Returns the rows of θ and ω of the transition over h, s, for constant derivatives of θ̈: exponential series to h⁴.
pub(super) fn exponential(h: f64, by_theta: f64, by_omega: f64, lever: f64) -> [State; 2] {
    // Columns of Aⁿ/n! hⁿ for A = [[0, 1], [by_theta, by_omega]].
    let mut power = [[1.0, 0.0], [0.0, 1.0]];
    let mut top = [State::default(); 2];
    for n in 0..5 {
        for row in 0..2 {
            top[row][0] += power[row][0];
            top[row][1] += power[row][1];
            let mut share = power[row][1] * lever;
            for (k, value) in top[row].iter_mut().enumerate().skip(2) {
                share *= h / (n + k - 1) as f64;
                *value += share;
            }
        }
        let scale = h / (n + 1) as f64;
        power = power.map(|[p, q]| [scale * q * by_theta, scale * (p + q * by_omega)]);
    }
    top
}

#[cfg(test)]
mod tests {
    use super::exponential;

    /// θ and ω after a time h by 10 000 steps of the midpoint rule.
    fn integrated(h: f64) -> [f64; 2] {
        let (mut theta, mut omega) = (0.4, -0.2);
        let count = 10_000;
        let dt = h / f64::from(count);
        let rate =
            |theta: f64, omega: f64, t: f64| -2.0 * theta + 0.7 * omega + 1.7 * (1.0 + 2.0 * t);
        for k in 0..count {
            let t = f64::from(k) * dt;
            let half = omega + 0.5 * dt * rate(theta, omega, t);
            let there = theta + 0.5 * dt * omega;
            omega += dt * rate(there, half, t + 0.5 * dt);
            theta += dt * half;
        }
        [theta, omega]
    }

    /// θ̈ = −2 θ + 0.7 θ̇ + 1.7 u for u = 1 + 2 t: the error is that of the series after h⁴, (‖A‖ h)⁵/5! of the state and of
    /// what u adds, with ‖A‖ = 2.7.
    #[test]
    fn the_transition_solves_the_linear_equation() {
        for h in [0.1, 0.03, 0.01] {
            let top = exponential(h, -2.0, 0.7, 1.7);
            let found = top.map(|row| row[0] * 0.4 - row[1] * 0.2 + row[2] + 2.0 * row[3]);
            let left_out = (2.7f64 * h).powi(5) / 120.0;
            for (found, exact) in found.iter().zip(integrated(h)) {
                assert!((found - exact).abs() < left_out, "{h}: {found}, {exact}");
            }
        }
    }
}
