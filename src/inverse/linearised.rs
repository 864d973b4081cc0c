//! Equation of motion with an unknown torque or force, and its linearisation about a nominal path.
//!
//! State: θ (rad), ω (rad/s), u and its derivatives below the order. θ̈ = (Q − V' − ½ M' ω² + a u)/M with the arm a = 1
//! for a torque (N m) and x' for a force (N); without mechanics θ̈ = u.

use super::prior::{Prior, Unknown};
use crate::mechanism::{Equation, Terms};

/// Largest order of a prior.
pub(super) const ORDERS: usize = 3;

/// State: θ, ω, u, then the derivatives of u, or g.
pub(super) type State = [f64; 2 + ORDERS];

/// θ̈ and its partial derivatives at a state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rates {
    /// θ̈, rad/s²
    pub alpha: f64,
    /// ∂θ̈/∂θ, 1/s²
    pub by_theta: f64,
    /// ∂θ̈/∂ω, 1/s
    pub by_omega: f64,
    /// ∂θ̈/∂u
    pub by_unknown: f64,
}

/// Equation of motion with its unknown.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion<'a> {
    pub equation: &'a Equation,
    pub prior: Prior,
    /// Time of the scene at time 0 of the record, s.
    pub origin: f64,
}

/// Difference step of the crank angle, rad, and relative step of the speed, right to about 1e-9 of the terms.
const STEP: f64 = 1e-6;

impl Motion<'_> {
    /// Returns θ̈ and ∂θ̈/∂u.
    pub fn acceleration(&self, t: f64, theta: f64, omega: f64, unknown: f64) -> [f64; 2] {
        if self.prior.unknown == Unknown::Acceleration {
            return [unknown, 1.0];
        }
        self.at(&self.equation.terms(theta), t, theta, omega, unknown)
    }

    /// Returns θ̈ and ∂θ̈/∂u by the terms of the equation at θ.
    fn at(&self, terms: &Terms, t: f64, theta: f64, omega: f64, unknown: f64) -> [f64; 2] {
        let load = self
            .equation
            .loads()
            .value(self.origin + t, theta, omega, &terms.pose);
        let arm = match self.prior.unknown {
            Unknown::Force => terms.pose.dx,
            _ => 1.0,
        };
        let known =
            load.generalized(terms.pose.dx) - terms.dv - terms.inertia.half_dm * omega * omega;
        let m = terms.inertia.m;
        [(known + arm * unknown) / m, arm / m]
    }

    /// Returns θ̈ and its partial derivatives at a state.
    pub fn rates(&self, t: f64, state: &State) -> Rates {
        let [theta, omega, unknown, ..] = *state;
        if self.prior.unknown == Unknown::Acceleration {
            return Rates {
                alpha: unknown,
                by_unknown: 1.0,
                ..Rates::default()
            };
        }
        let terms = self.equation.terms(theta);
        let [alpha, by_unknown] = self.at(&terms, t, theta, omega, unknown);
        let [mut turned, _] = self.acceleration(t, theta + STEP, omega, unknown);
        let mut step = STEP;
        if !turned.is_finite() {
            // At the limit of a rocker.
            step = -STEP;
            [turned, _] = self.acceleration(t, theta + step, omega, unknown);
        }
        let faster = STEP * omega.abs().max(1e-3);
        let [quick, _] = self.at(&terms, t, theta, omega + faster, unknown);
        Rates {
            alpha,
            by_theta: (turned - alpha) / step,
            by_omega: (quick - alpha) / faster,
            by_unknown,
        }
    }

    /// Returns θ̈ and its partial derivatives at a state whose torque follows θ and ω with these slopes.
    pub fn rates_following(&self, [by_theta, by_omega]: [f64; 2], t: f64, state: &State) -> Rates {
        let rates = self.rates(t, state);
        Rates {
            by_theta: rates.by_theta + rates.by_unknown * by_theta,
            by_omega: rates.by_omega + rates.by_unknown * by_omega,
            ..rates
        }
    }

    /// Returns the mean acceleration of a step, rad/s², the rate at which g adds to u; 0 without g.
    fn tilt(&self, h: f64, ends: [&State; 2]) -> f64 {
        match self.prior.follows_speed {
            true => (ends[1][1] - ends[0][1]) / h,
            false => 0.0,
        }
    }

    /// Returns a state with u and its derivatives advanced by a time h, s; θ and ω stay.
    fn later(&self, h: f64, tilt: f64, from: &State) -> State {
        let mut state = *from;
        let last = 2 + self.prior.order;
        for (i, value) in state[..last].iter_mut().enumerate().skip(2) {
            let mut factor = 1.0;
            for (k, derivative) in from[..last].iter().enumerate().skip(i + 1) {
                factor *= h / (k - i) as f64;
                *value += factor * derivative;
            }
        }
        if self.prior.follows_speed {
            state[2] += h * tilt * from[last];
        }
        state
    }

    /// Returns θ̈ in the middle of a step with known ends, where the prior predicts u from the begin.
    fn in_the_middle(&self, t: [f64; 2], ends: [&State; 2], rates: [&Rates; 2]) -> f64 {
        let h = t[1] - t[0];
        let [a, b] = ends;
        let theta = 0.5 * (a[0] + b[0])
            + h * (a[1] - b[1]) * (5.0 / 32.0)
            + h * h * (rates[0].alpha + rates[1].alpha) / 64.0;
        let omega = 0.5 * (a[1] + b[1]) + h * (rates[0].alpha - rates[1].alpha) / 8.0;
        let unknown = self.later(0.5 * h, self.tilt(h, ends), a)[2];
        self.acceleration(0.5 * (t[0] + t[1]), theta, omega, unknown)[0]
    }

    /// Returns one step of the linear model of the deviations from a nominal path.
    pub fn linearised(&self, t: [f64; 2], ends: [&State; 2], rates: [&Rates; 2]) -> Linearised {
        let h = t[1] - t[0];
        let [a, b] = ends;
        let mean = |f: fn(&Rates) -> f64| 0.5 * (f(rates[0]) + f(rates[1]));
        let lever = mean(|r| r.by_unknown);
        let tilt = self.tilt(h, ends);
        let mut top = exponential(h, mean(|r| r.by_theta), mean(|r| r.by_omega), lever);
        if self.prior.follows_speed {
            for row in &mut top {
                row[2 + self.prior.order] = row[3] * tilt;
            }
        }
        let mut defect = self.later(h, tilt, a);
        let after = if self.prior.unknown == Unknown::Acceleration {
            [0, 1].map(|row| a.iter().zip(&top[row]).map(|(a, top)| a * top).sum::<f64>())
        } else {
            // Simpson's rule for ω and θ; the noise of u is not part of the prediction.
            let first = rates[0].alpha;
            let middle = self.in_the_middle(t, ends, rates);
            let last = rates[1].alpha - rates[1].by_unknown * (b[2] - defect[2]);
            [
                a[0] + h * a[1] + h * h * (first + 2.0 * middle) / 6.0,
                a[1] + h * (first + 4.0 * middle + last) / 6.0,
            ]
        };
        defect[..2].copy_from_slice(&after);
        for (value, end) in defect.iter_mut().zip(b) {
            *value -= end;
        }
        Linearised {
            h,
            top,
            defect,
            lever,
            tilt,
            intensity: 1.0,
        }
    }
}

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

/// Step of the linear model of deviations from a nominal path.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Linearised {
    /// Duration, s.
    pub h: f64,
    /// Transition rows of θ and ω.
    pub top: [State; 2],
    /// Prediction from the nominal path's begin minus its end.
    pub defect: State,
    /// Mean ∂θ̈/∂u of the step.
    pub lever: f64,
    /// Mean acceleration of the step, rad/s²: the rate at which g adds to u.
    pub tilt: f64,
    /// Intensity of the process noise over the usual one.
    pub intensity: f64,
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
