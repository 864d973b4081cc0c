//! Gauss collocation of order 2 STAGES in double-double arithmetic, A-stable, written for accuracy and not for speed
//! (Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, II.7; II, IV.8).

use nalgebra::{DMatrix, DVector};

use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::numeric::gauss::legendre;

/// Number of collocation points of a step.
const STAGES: usize = 16;

/// Largest number of Newton iterations: quadratic convergence needs fewer.
pub(super) const ITERATIONS: usize = 25;

/// Shortest step relative to the run; shorter ones count as failure.
const SHORTEST_STEP: f64 = 1e-14;

/// Distance within which a step must end at an angle where the acceleration is not smooth, rad: the error of the
/// remaining kink is proportional to its square.
pub(super) const CORNER: f64 = 1e-10;

/// Angular acceleration θ̈ of a motion.
pub(super) trait Acceleration {
    /// Returns θ̈ at time t, angle and speed.
    fn exactly(&self, t: DoubleDouble, theta: DoubleDouble, omega: DoubleDouble) -> DoubleDouble;

    /// Returns approximate ∂θ̈/∂θ and ∂θ̈/∂θ̇.
    fn slopes(&self, t: f64, theta: f64, omega: f64) -> (f64, f64);

    /// Returns the first time after `t` at which the acceleration is not smooth.
    fn next_time(&self, t: f64) -> f64;

    /// Returns the first angle between `theta` and `towards` at which the acceleration is not smooth, if any.
    fn corner_between(&self, theta: f64, towards: f64) -> Option<f64>;
}

/// Resolution and work limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resolution {
    /// Bound of the last series terms of the acceleration over a step, relative to the largest term.
    pub tail: f64,
    /// Relative change of the acceleration below which Newton iterations end.
    pub settled: f64,
    /// Largest number of evaluations.
    pub evaluations: u64,
}

/// Time, angle and speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub t: DoubleDouble,
    pub theta: DoubleDouble,
    pub omega: DoubleDouble,
}

/// Coefficients of the method.
struct Tableau {
    nodes: [DoubleDouble; STAGES],
    weights: [DoubleDouble; STAGES],
    /// Integrals (`once`) and repeated integrals (`twice`) of the Lagrange polynomials up to each node.
    once: [[DoubleDouble; STAGES]; STAGES],
    twice: [[DoubleDouble; STAGES]; STAGES],
    /// Matrix from values at the nodes to coefficients of Legendre polynomials.
    series: [[DoubleDouble; STAGES]; STAGES],
}

/// Returns the Legendre polynomials of degree 0 to `degrees` − 1 on [0, 1].
fn polynomials(x: DoubleDouble, degrees: usize) -> Vec<DoubleDouble> {
    let y = x * 2.0 - 1.0;
    let mut values = vec![DoubleDouble::ONE, y];
    for k in 2..degrees {
        let n = k as f64;
        let next = (y * values[k - 1] * (2.0 * n - 1.0) - values[k - 2] * (n - 1.0)) / n;
        values.push(next);
    }
    values
}

impl Tableau {
    fn new() -> Tableau {
        let zero = DoubleDouble::ZERO;
        let mut nodes = [zero; STAGES];
        let mut weights = [zero; STAGES];
        for i in 0..STAGES {
            let mut x = DoubleDouble::from(legendre(STAGES as u32, i).0);
            let mut slope = zero;
            // From (1 − y²) P' = n (P_{n−1} − y P) with y = 2 x − 1.
            for _ in 0..3 {
                let p = polynomials(x, STAGES + 1);
                let y = x * 2.0 - 1.0;
                let rest = x * (DoubleDouble::ONE - x) * 2.0;
                slope = (p[STAGES - 1] - y * p[STAGES]) * (STAGES as f64) / rest;
                x = x - p[STAGES] / slope;
            }
            nodes[i] = x;
            weights[i] = DoubleDouble::ONE / (x * (DoubleDouble::ONE - x) * slope * slope);
        }
        let values: Vec<_> = nodes.iter().map(|x| polynomials(*x, STAGES + 1)).collect();
        let integral = |i: usize, j: usize| {
            let sum = (1..STAGES).fold(nodes[i], |sum, k| {
                sum + values[j][k] * (values[i][k + 1] - values[i][k - 1]) * 0.5
            });
            weights[j] * sum
        };
        let square = |f: &dyn Fn(usize, usize) -> DoubleDouble| {
            std::array::from_fn(|i| std::array::from_fn(|j| f(i, j)))
        };
        let once: [[DoubleDouble; STAGES]; STAGES] = square(&integral);
        let twice = square(&|i, j| (0..STAGES).fold(zero, |sum, k| sum + once[i][k] * once[k][j]));
        let series = square(&|k, j| weights[j] * values[j][k] * (2 * k + 1) as f64);
        Tableau {
            nodes,
            weights,
            once,
            twice,
            series,
        }
    }
}

/// Returns the state at time `t_end` and the number of evaluations; none if the motion does not get there.
pub(super) fn integrate(
    motion: &dyn Acceleration,
    start: Place,
    t_end: f64,
    resolution: Resolution,
) -> Option<Place> {
    let mut run = Run {
        tableau: Tableau::new(),
        motion,
        resolution,
        evaluations: 0,
    };
    let length = t_end - start.t.value();
    let mut place = start;
    let mut h = length * 1e-3;
    // Tails of the last three rejected steps, the oldest first.
    let mut refused = [f64::INFINITY; 3];
    while place.t.value() < t_end {
        let stop = motion.next_time(place.t.value()).min(t_end);
        let left = (DoubleDouble::from(stop) - place.t).value();
        let last = h >= left * (1.0 - 1e-9);
        let mut step = if last { left } else { h };
        if step < SHORTEST_STEP * length && !last || run.evaluations > resolution.evaluations {
            return None;
        }
        let Some(mut found) = run.step(place, step) else {
            h = 0.3 * step;
            continue;
        };
        let (from, to) = (place.theta.value(), found.0.theta.value());
        let corner = motion.corner_between(from, to);
        if let Some(corner) = corner {
            (found, step) = run.up_to(place, corner, found, step)?;
        }
        let (mut next, tail) = found;
        let growth = 0.9 * (resolution.tail / tail.max(1e-300)).powf(1.0 / (STAGES as f64 - 1.0));
        // A tail that shorter steps do not reduce is rounding.
        let rounding = tail < 1e-7 && tail > 0.5 * refused[0];
        if tail > 10.0 * resolution.tail && !rounding {
            h = step * growth.clamp(0.1, 0.6);
            refused = [refused[1], refused[2], tail];
            continue;
        }
        h = step
            * if rounding {
                2.0
            } else {
                growth.clamp(0.3, 2.0)
            };
        refused = [f64::INFINITY; 3];
        if last && corner.is_none() {
            // The step is a float; its remainder in time is so short that the first term suffices.
            let end = DoubleDouble::from(stop);
            let rest = end - next.t;
            let alpha = motion.exactly(next.t, next.theta, next.omega);
            next.theta += next.omega * rest;
            next.omega += alpha * rest;
            next.t = end;
        }
        place = next;
    }
    Some(place)
}

fn combined(factors: &[DoubleDouble; STAGES], values: &[DoubleDouble; STAGES]) -> DoubleDouble {
    let terms = factors.iter().zip(values);
    terms.fold(DoubleDouble::ZERO, |sum, (a, b)| sum + *a * *b)
}

struct Run<'a> {
    tableau: Tableau,
    motion: &'a dyn Acceleration,
    resolution: Resolution,
    evaluations: u64,
}

impl Run<'_> {
    /// Shortens a step that passes an angle so that it ends there; returns the length as well.
    fn up_to(
        &mut self,
        place: Place,
        corner: f64,
        mut found: (Place, f64),
        mut h: f64,
    ) -> Option<((Place, f64), f64)> {
        for _ in 0..30 {
            let end = found.0;
            let missing = (DoubleDouble::from(corner) - end.theta).value();
            if missing.abs() <= CORNER {
                break;
            }
            let newton = h + missing / end.omega.value();
            // Where Newton's step misleads, use the chord.
            h = if newton > 0.0 && newton < 1.5 * h {
                newton
            } else {
                h * (1.0 + missing / (end.theta - place.theta).value()).clamp(0.05, 1.2)
            };
            found = self.step(place, h)?;
        }
        Some((found, h))
    }

    /// Makes one step; returns the size of the last series terms as well.
    fn step(&mut self, place: Place, h: f64) -> Option<(Place, f64)> {
        let Place { t, theta, omega } = place;
        let start = self.motion.exactly(t, theta, omega);
        let mut alpha = [start; STAGES];
        let squared = DoubleDouble::from(h) * h;
        let mut before = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            let mut matrix = DMatrix::<f64>::identity(STAGES, STAGES);
            let mut residual = DVector::<f64>::zeros(STAGES);
            for i in 0..STAGES {
                let table = &self.tableau;
                let node = table.nodes[i] * h;
                let at = Place {
                    t: t + node,
                    theta: theta + omega * node + combined(&table.twice[i], &alpha) * squared,
                    omega: omega + combined(&table.once[i], &alpha) * h,
                };
                let found = self.motion.exactly(at.t, at.theta, at.omega);
                residual[i] = (found - alpha[i]).value();
                let (theta, omega) = (at.theta.value(), at.omega.value());
                let (by_angle, by_speed) = self.motion.slopes(at.t.value(), theta, omega);
                for j in 0..STAGES {
                    matrix[(i, j)] -= h * h * by_angle * (table.twice[i][j]).value()
                        + h * by_speed * (table.once[i][j]).value();
                }
            }
            self.evaluations += STAGES as u64;
            let change = matrix.lu().solve(&residual)?;
            if change.iter().any(|change| !change.is_finite()) {
                return None;
            }
            for (alpha, change) in alpha.iter_mut().zip(&change) {
                *alpha += *change;
            }
            let size = alpha.iter().map(|a| (*a).value().abs());
            let size = size.fold(f64::MIN_POSITIVE, f64::max);
            let moved = change.amax() / size;
            // Loads in floats leave a residual that does not decrease.
            let stuck = iteration > 3 && moved < 1e-12 && moved > 0.25 * before;
            if moved <= self.resolution.settled || stuck {
                let next = Place {
                    t: t + h,
                    theta: theta + omega * h + self.ends(&alpha) * squared,
                    omega: omega + combined(&self.tableau.weights, &alpha) * h,
                };
                return Some((next, self.tail(&alpha)));
            }
            before = moved;
        }
        None
    }

    /// Returns the double integral of the acceleration over a step of length 1.
    fn ends(&self, alpha: &[DoubleDouble; STAGES]) -> DoubleDouble {
        let Tableau { nodes, weights, .. } = &self.tableau;
        (0..STAGES).fold(DoubleDouble::ZERO, |sum, i| {
            sum + weights[i] * (DoubleDouble::ONE - nodes[i]) * alpha[i]
        })
    }

    fn tail(&self, alpha: &[DoubleDouble; STAGES]) -> f64 {
        let coefficient = |k: usize| (combined(&self.tableau.series[k], alpha)).value().abs();
        let largest = (0..STAGES).map(coefficient).fold(0.0, f64::max);
        if largest == 0.0 {
            return 0.0;
        }
        coefficient(STAGES - 1).max(coefficient(STAGES - 2)) / largest
    }
}
