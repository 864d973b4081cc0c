//! Equation of motion with an unknown torque or force, and its linearisation about a nominal path.
//!
//! State: θ (rad), ω (rad/s), u and its derivatives below the order. θ̈ = (Q − V' − ½ M' ω² + a u)/M with the arm a = 1
//! for a torque (N m) and x' for a force (N); without mechanics θ̈ = u.

use super::harmonics::AtNodes;
use super::prior::{Prior, State, Unknown, powers_of};
use super::repeating::Repeating;
use super::tone::{self, Carrier, Tone};
use super::transition::{Slopes, transition};
use crate::mechanism::{Equation, Terms};

/// θ̈ and its partial derivatives at a state.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::inverse) struct Rates {
    /// θ̈, rad/s²
    pub alpha: f64,
    /// ∂θ̈/∂θ, 1/s²
    pub by_theta: f64,
    /// ∂θ̈/∂ω, 1/s
    pub by_omega: f64,
    /// ∂θ̈/∂u
    pub by_unknown: f64,
}

impl Rates {
    fn slopes(self) -> Slopes {
        [self.by_theta, self.by_omega, self.by_unknown]
    }
}

/// Node of a nominal path.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Node<'a> {
    /// Time, s.
    pub t: f64,
    pub state: &'a State,
    pub rates: Rates,
    /// Torque that repeats, N m.
    pub repeated: f64,
}

impl Node<'_> {
    /// Returns θ (rad), ω (rad/s), θ̈ (rad/s²).
    pub fn motion(&self) -> [f64; 3] {
        [self.state[0], self.state[1], self.rates.alpha]
    }
}

/// Equation of motion with its unknown.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Motion<'a> {
    pub equation: &'a Equation,
    pub prior: Prior,
    /// Time of the scene at time 0 of the record, s.
    pub origin: f64,
    /// Tones of the record, of which those of the torque act beside u.
    pub tones: &'a [Tone],
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
        let known = load.generalized(terms.pose.dx) - terms.dv - terms.half_dm * omega * omega;
        let tones = tone::sum(self.tones, Carrier::Torque, t);
        let m = terms.m;
        [(known + tones + arm * unknown) / m, arm / m]
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

    /// Returns the derivatives of the torque that follows a state by θ and ω: of what repeats, and of what follows the speed.
    pub fn slopes(&self, torque: Option<&Repeating>, state: &State) -> [f64; 2] {
        let at = |torque: &Repeating| torque.at(state[0], state[1]);
        let [_, by_theta, by_omega] = torque.map_or([0.0; 3], at);
        [by_theta, by_omega + self.prior.of_speed(state, state[1])[1]]
    }

    /// Returns θ̈ and its partial derivatives at a state whose torque follows θ and ω.
    pub fn rates_following(&self, torque: Option<&Repeating>, t: f64, state: &State) -> Rates {
        let rates = self.rates(t, state);
        let [by_theta, by_omega] = self.slopes(torque, state);
        Rates {
            by_theta: rates.by_theta + rates.by_unknown * by_theta,
            by_omega: rates.by_omega + rates.by_unknown * by_omega,
            ..rates
        }
    }

    /// Returns one step of the linear model of the deviations from a nominal path, from node to node. The torque that
    /// repeats is part of u.
    pub fn linearised(&self, a: &Node<'_>, b: &Node<'_>, torque: Option<&Repeating>) -> Linearised {
        let h = b.t - a.t;
        let inner = self.inner(a, b, torque);
        let [first, early, late, last] = [a.rates, inner[0], inner[1], b.rates].map(Rates::slopes);
        let mean = [0, 1, 2].map(|k| (first[k] + 5.0 * (early[k] + late[k]) + last[k]) / 12.0);
        let change = [0, 1, 2].map(|k| last[k] - first[k]);
        let [before, after] = [a, b].map(|node| powers_of(node.state[1]));
        let tilt = std::array::from_fn(|k| (after[k] - before[k]) / h);
        let mut defect = self.predicted(a, b, torque, inner.map(|rates| rates.alpha));
        for (value, end) in defect.iter_mut().zip(b.state) {
            *value -= end;
        }
        Linearised {
            h,
            top: transition(h, mean, change),
            defect,
            lever: mean[2],
            levers: [early[2], late[2], last[2]],
            tilt,
        }
    }
}

/// Step of the linear model of deviations from a nominal path.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::inverse) struct Linearised {
    /// Duration, s.
    pub h: f64,
    /// Transition rows of θ and ω, from θ, ω, u and its derivatives.
    pub top: [State; 2],
    /// Prediction from the nominal path's begin minus its end.
    pub defect: State,
    /// Mean ∂θ̈/∂u of the step.
    pub lever: f64,
    /// ∂θ̈/∂u at the inner nodes and the end of the step.
    pub levers: AtNodes<f64>,
    /// Mean rates of ω, rad/s², and of ω|ω|, rad²/s³: those at which g₁ and g₂ add to u.
    pub tilt: [f64; 2],
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::prior::{QUADRATIC, plain_state};
    use crate::scene::{Crank, Scene, Slider};

    /// A loss by the speed and its square and a constant torque on an offset slider-crank: along the motion by 2000 steps of
    /// the midpoint rule a step of the model leaves h⁷ of the motion's series, as it states, and the error of that rule.
    #[test]
    fn a_step_follows_the_equation_of_motion() {
        let scene = Scene::new(0.05, 0.15)
            .offset(0.02)
            .slider(Slider { mass: 1.5 });
        let equation = Equation::new(&scene.crank(Crank {
            inertia: 0.01,
            ..Crank::default()
        }));
        let motion = Motion {
            equation: &equation,
            prior: QUADRATIC,
            origin: 0.0,
            tones: &[],
        };
        let (g, rest, first) = ([-0.3, -0.002], 4.0, [0.7, 20.0]);
        let driven = |omega: f64| rest + g[0] * omega + g[1] * omega * omega.abs();
        let rates = |[theta, omega]: [f64; 2]| {
            [
                omega,
                motion.acceleration(0.0, theta, omega, driven(omega))[0],
            ]
        };
        let node = |t: f64| {
            let (h, mut now) = (t / 2000.0, first);
            for _ in 0..2000 {
                let begin = rates(now);
                let middle = rates([0, 1].map(|k| now[k] + 0.5 * h * begin[k]));
                now = [0, 1].map(|k| now[k] + h * middle[k]);
            }
            let mut state = plain_state([now[0], now[1], driven(now[1])]);
            [state[3], state[4]] = g;
            state
        };
        let left = |h: f64| {
            let [begin, end] = [node(0.0), node(h)];
            let of = |t, state| Node {
                t,
                state,
                rates: motion.rates(t, state),
                repeated: 0.0,
            };
            let nodes = [of(0.0, &begin), of(h, &end)];
            let step = motion.linearised(&nodes[0], &nodes[1], None);
            let stated = motion.left_out(&nodes[0], &nodes[1], None);
            (step.defect, stated)
        };
        for h in [0.006, 0.003] {
            let (defect, _) = left(h);
            for (k, unit) in [1.0, h, h * h].into_iter().enumerate() {
                assert!((unit * defect[k]).abs() < 1e-9, "{h}: {defect:?}");
            }
        }
        let (defect, stated) = left(0.01);
        for (left, stated) in defect.iter().zip(stated) {
            assert!(
                (left + stated).abs() < 0.1 * stated.abs(),
                "{left}: {stated}"
            );
        }
    }
}
