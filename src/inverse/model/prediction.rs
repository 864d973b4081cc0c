//! Prediction of a step by the equation of motion, and what it leaves out.

use super::linearised::{Motion, Node, Rates};
use super::prior::{State, Unknown};
use super::repeating::Repeating;
use crate::numeric::gauss::LOBATTO;
use crate::numeric::hermite::Quintic;

impl Motion<'_> {
    /// Returns a state whose entries from the first on, each the derivative of the one before, are advanced by a time h, s.
    fn later(&self, first: usize, h: f64, from: &State) -> State {
        let mut state = *from;
        let last = self.prior.diffuse();
        for (i, value) in state[..last].iter_mut().enumerate().skip(first) {
            let mut factor = 1.0;
            for (k, derivative) in from[..last].iter().enumerate().skip(i + 1) {
                factor *= h / (k - i) as f64;
                *value += factor * derivative;
            }
        }
        state
    }

    /// Returns the state that follows from a node at a place of its step, if the noise of u is left out.
    fn followed(
        &self,
        a: &Node<'_>,
        torque: Option<&Repeating>,
        h: f64,
        [theta, omega]: [f64; 2],
    ) -> State {
        let mut state = self.later(2, h, a.state);
        let of_speed = |omega: f64| self.prior.of_speed(a.state, omega)[0];
        let repeated = torque.map_or(0.0, |torque| torque.at(theta, omega)[0]) - a.repeated;
        state[2] += of_speed(omega) - of_speed(a.state[1]) + repeated;
        [state[0], state[1]] = [theta, omega];
        state
    }

    /// Returns the rates at the inner nodes of Lobatto's rule along the quintic between two nodes.
    pub fn inner(&self, a: &Node<'_>, b: &Node<'_>, torque: Option<&Repeating>) -> [Rates; 2] {
        if self.prior.unknown == Unknown::Acceleration {
            return [a.rates; 2];
        }
        let (h, way) = (b.t - a.t, way(a, b));
        LOBATTO.map(|part| {
            let [way, rate, _] = way.at(part);
            let state = self.followed(a, torque, part * h, [a.state[0] + way, rate / h]);
            self.rates_following(torque, a.t + part * h, &state)
        })
    }

    /// Returns the state that follows from node a at node b, by Lobatto's rule from the inner θ̈: θ and ω to h⁷. The noise of u is
    /// no part of it.
    pub fn predicted(
        &self,
        a: &Node<'_>,
        b: &Node<'_>,
        torque: Option<&Repeating>,
        [early, late]: [f64; 2],
    ) -> State {
        let h = b.t - a.t;
        if self.prior.unknown == Unknown::Acceleration {
            return self.later(0, h, a.state);
        }
        let mut after = self.followed(a, torque, h, [b.state[0], b.state[1]]);
        let first = a.rates.alpha;
        let last = b.rates.alpha - b.rates.by_unknown * (b.state[2] - after[2]);
        let moment = LOBATTO[1] * early + LOBATTO[0] * late;
        after[0] = a.state[0] + h * a.state[1] + h * h * (first + 5.0 * moment) / 12.0;
        after[1] = a.state[1] + h * (first + 5.0 * (early + late) + last) / 12.0;
        after
    }

    /// Returns what a step leaves out of θ, rad, and ω, rad/s: the end by two steps of half the time less that by one (Richardson);
    /// the two leave 1/64 of it.
    pub fn left_out(&self, a: &Node<'_>, b: &Node<'_>, torque: Option<&Repeating>) -> [f64; 2] {
        if self.prior.unknown == Unknown::Acceleration {
            return [0.0; 2];
        }
        let (h, t) = (0.5 * (b.t - a.t), 0.5 * (a.t + b.t));
        let state = |place: [f64; 2]| self.followed(a, torque, h, place);
        let predicted = |a: &Node<'_>, b: &Node<'_>| {
            let inner = self.inner(a, b, torque);
            self.predicted(a, b, torque, inner.map(|rates| rates.alpha))
        };
        let [turned, rate, _] = way(a, b).at(0.5);
        // The middle by fixed-point iteration from the quintic.
        let mut middle = state([a.state[0] + turned, 0.5 * rate / h]);
        for _ in 0..3 {
            let [theta, omega, ..] = predicted(a, &self.node(t, &middle, torque));
            middle = state([theta, omega]);
        }
        let halves = predicted(&self.node(t, &middle, torque), b);
        let whole = predicted(a, b);
        [0, 1].map(|k| halves[k] - whole[k])
    }

    /// Returns a node of a path without the derivatives by θ and ω.
    pub fn node<'a>(&self, t: f64, state: &'a State, torque: Option<&Repeating>) -> Node<'a> {
        let [theta, omega, unknown, ..] = *state;
        let [alpha, by_unknown] = self.acceleration(t, theta, omega, unknown);
        Node {
            t,
            state,
            rates: Rates {
                alpha,
                by_unknown,
                ..Rates::default()
            },
            repeated: torque.map_or(0.0, |torque| torque.at(theta, omega)[0]),
        }
    }
}

/// Returns the quintic of θ between two nodes.
fn way(a: &Node<'_>, b: &Node<'_>) -> Quintic {
    let h = b.t - a.t;
    let end = |node: &Node<'_>| [h * node.state[1], 0.5 * h * h * node.rates.alpha];
    Quintic::new(end(a), end(b), b.state[0] - a.state[0])
}
