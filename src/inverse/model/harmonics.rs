//! Harmonics of the crank angle in each step of a path.

use super::linearised::Linearised;
use super::prior::{Prior, State};
use super::repeating::{dot, waves};
use crate::numeric::gauss::LOBATTO;
use crate::numeric::hermite::cubic;

/// Responses of θ, ω and u at the end of a step h to torques at its inner nodes and its end, by Lobatto's rule for θ̈.
pub(in crate::inverse) fn responses(step: &Linearised) -> [AtNodes<f64>; 3] {
    let h = step.h;
    let [early, late, last] = step.levers.map(|lever| h * lever / 12.0);
    let after = LOBATTO.map(|part| 5.0 * h * (1.0 - part));
    [
        [after[0] * early, after[1] * late, 0.0],
        [5.0 * early, 5.0 * late, last],
        [0.0, 0.0, 1.0],
    ]
}

/// Crank angles, rad, and speeds, in units of one, at begin, inner nodes and end of each step.
pub(in crate::inverse) fn ways(
    states: &[State],
    steps: &[Linearised],
    speed: f64,
) -> impl ExactSizeIterator<Item = [[f64; 2]; 4]> {
    let pairs = states.windows(2).zip(steps);
    pairs.map(move |(ends, step)| {
        let [a, b] = [0, 1].map(|k| [ends[k][0], ends[k][1]]);
        let [early, late] = LOBATTO.map(|part| cubic([0.0, step.h], [a, b], part * step.h));
        [a, early, late, b].map(|[theta, omega]| [theta, omega / speed])
    })
}

/// Values at the inner nodes of a step and at its end.
pub(in crate::inverse) type AtNodes<T> = [T; 3];

/// Harmonics at inner nodes and end of each step less those at its begin.
#[derive(Clone, Debug, Default)]
pub(in crate::inverse) struct Increments {
    /// Number of coefficients.
    pub count: usize,
    /// Rows of inner nodes and end of each step, one after the other.
    values: Vec<f64>,
}

impl Increments {
    /// Of a prior along a path with these crank angles, rad, and speeds, over their unit, at begins, inner nodes and ends.
    pub fn new(ways: impl ExactSizeIterator<Item = [[f64; 2]; 4]>, prior: Prior) -> Increments {
        let count = prior.coefficients();
        let fill = |row: &mut [f64], [angle, speed]: [f64; 2]| {
            let pairs = waves(angle / f64::from(prior.cycle), prior);
            for (to, [cos, sin]) in row.chunks_exact_mut(prior.of_harmonic()).zip(pairs) {
                let values = [cos, sin, speed * cos, speed * sin];
                let pairs = to.iter_mut().zip(values);
                pairs.for_each(|(to, value)| *to = value);
            }
        };
        let mut values = Vec::with_capacity(3 * ways.len() * count);
        let (mut begin, mut now) = (vec![0.0; count], vec![0.0; count]);
        for (k, [first, rest @ ..]) in ways.enumerate() {
            if k == 0 {
                fill(&mut begin, first);
            }
            for place in rest {
                fill(&mut now, place);
                let pairs = now.iter().zip(&begin);
                values.extend(pairs.map(|(now, before)| now - before));
            }
            // Its end is the begin of the next step.
            std::mem::swap(&mut begin, &mut now);
        }
        Increments { count, values }
    }

    /// Returns the rows of inner nodes and end of a step.
    pub fn of(&self, step: usize) -> AtNodes<&[f64]> {
        [0, 1, 2].map(|k| &self.values[(3 * step + k) * self.count..][..self.count])
    }

    /// Takes what these coefficients do out of the steps' predictions: what is left is linear in all of the coefficients.
    pub fn take_out(&self, coefficients: &[f64], steps: &mut [Linearised]) {
        for (k, step) in steps.iter_mut().enumerate() {
            let torques = self.of(k).map(|row| dot(row, coefficients));
            let responses = responses(step);
            for (to, response) in step.defect.iter_mut().zip(responses) {
                *to -= dot(&response, &torques);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::inverse::model::prior::FOLLOWING;
    use crate::inverse::model::repeating::Repeating;

    /// A torque s + s² beside ∂θ̈/∂u = 2 − 3 s + 4 s² at a time s from the begin of a step: Lobatto's rule is exact for the speed,
    /// of s⁴, and for the angle, of s⁵.
    #[test]
    fn responses_are_those_of_a_lever_that_changes() {
        let h = 0.3;
        let places = [LOBATTO[0], LOBATTO[1], 1.0].map(|part| part * h);
        let step = Linearised {
            h,
            levers: places.map(|s| 2.0 - 3.0 * s + 4.0 * s * s),
            ..Linearised::default()
        };
        let torques = places.map(|s| s + s * s);
        // The acceleration 2 s − s² + s³ + 4 s⁴, integrated once and twice.
        let terms = [(1, 2.0), (2, -1.0), (3, 1.0), (4, 4.0)];
        let integrated = |often: i32| {
            let term = |(power, factor): (i32, f64)| {
                let per: i32 = (1..=often).map(|k| power + k).product();
                factor * h.powi(power + often) / f64::from(per)
            };
            terms.map(term).iter().sum::<f64>()
        };
        let expected = [integrated(2), integrated(1), h + h * h];
        let found = responses(&step).map(|response| dot(&response, &torques));
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-15, "{found}: {expected}");
        }
    }

    /// The table of a torque has the sum of its harmonics, and the slopes of that sum by differences.
    #[test]
    fn a_tabulated_torque_is_the_sum_of_its_harmonics() {
        let prior = Prior {
            cycle: 2,
            harmonics: 5,
            ..FOLLOWING
        };
        let coefficients: Vec<f64> = (0..prior.coefficients())
            .map(|j| (1.7 * j as f64).sin())
            .collect();
        let table = Repeating::new(prior, coefficients.clone(), 3.0, 5, [[0.0; 3]; 3]);
        let ends = [[-40.0, 2.0], [17.3, 4.0]];
        let [a, b] = ends.map(|[theta, omega]| [theta, omega / 3.0]);
        let increments = Increments::new(std::iter::once([a, a, a, b]), prior);
        let [from, to] = ends.map(|[theta, omega]| table.at(theta, omega));
        let sum = dot(increments.of(0)[2], &coefficients);
        assert!(
            (to[0] - from[0] - sum).abs() < 1e-6,
            "{from:?} {to:?}: {sum}"
        );
        let [theta, omega] = ends[1];
        let slope = |d: [f64; 2]| {
            let [low, high] = [-1.0, 1.0].map(|s| table.at(theta + s * d[0], omega + s * d[1])[0]);
            (high - low) / 2e-3
        };
        assert!((to[1] - slope([1e-3, 0.0])).abs() < 1e-4);
        assert!((to[2] - slope([0.0, 1e-3])).abs() < 1e-9);
    }
}
