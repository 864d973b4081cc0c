//! Lobatto points of one degree, with Clenshaw-Curtis weights and the matrices of transform and integration.

use std::f64::consts::PI;
use std::fmt;
use std::sync::OnceLock;

use super::transform::{HALF_LENGTH, HalfVector, Matrices};
use super::{MAX_DEGREE, Series, Values};
use crate::numeric::LANES;
use crate::numeric::exact::two_sum;

/// Lobatto points x₀ = −1, …, x_n = 1 of a degree n, with their weights and matrices.
pub struct Rule {
    degree: usize,
    points: Values,
    /// Clenshaw-Curtis weights.
    weights: Values,
    /// Matrices from values to coefficients: 2k from the even part at the points, 2k + 1 from the odd part.
    series: Matrices,
    /// Matrices from values to integrals from 0 to the points.
    integrals: Matrices,
    /// Weights of the values in the last two coefficients.
    last: [Values; 2],
    /// Matrix of integration, built on first use.
    integration: OnceLock<Vec<Values>>,
}

impl fmt::Debug for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Rule({})", self.degree)
    }
}

impl Rule {
    /// Available degrees.
    pub const DEGREES: [usize; 5] = [12, 16, 20, 24, 32];

    /// Returns the least of the degrees above one; none beyond the largest.
    pub fn next_degree(degree: usize) -> Option<usize> {
        Rule::DEGREES.into_iter().find(|next| *next > degree)
    }

    /// Returns the rule of one of the degrees [`Self::DEGREES`]; the rule of the largest for any other.
    pub fn of(degree: usize) -> &'static Rule {
        static RULES: [OnceLock<Box<Rule>>; Rule::DEGREES.len()] =
            [const { OnceLock::new() }; Rule::DEGREES.len()];
        let index = Rule::DEGREES.iter().position(|d| *d == degree);
        let index = index.unwrap_or(RULES.len() - 1);
        RULES[index].get_or_init(|| Box::new(Rule::new(Rule::DEGREES[index])))
    }

    fn new(degree: usize) -> Rule {
        let mut rule = Rule {
            degree,
            points: [0.0; MAX_DEGREE + 1],
            weights: [0.0; MAX_DEGREE + 1],
            series: Matrices::new(),
            integrals: Matrices::new(),
            last: [[0.0; MAX_DEGREE + 1]; 2],
            integration: OnceLock::new(),
        };
        let n = degree as f64;
        let cosines = cosines(degree);
        for j in 0..=degree {
            // Sine of a symmetric argument: the points are symmetric to the last bit.
            rule.points[j] = (PI * (2.0 * j as f64 - n) / (2.0 * n)).sin();
        }
        let half = degree / 2;
        for j in 0..=half {
            let at_end = if j == 0 { 0.5 } else { 1.0 };
            for k in 0..=half {
                let last = if k == 0 || k == half { 1.0 } else { 2.0 };
                rule.series.even[j][k] = last / n * at_end * cosine(&cosines, 2 * k * j);
                if k < half && j < half {
                    rule.series.odd[j][k] = 2.0 / n * at_end * cosine(&cosines, (2 * k + 1) * j);
                }
            }
        }
        rule.fill_integrals(&cosines);
        for j in 0..=degree {
            let mut unit = [0.0; MAX_DEGREE + 1];
            unit[j] = 1.0;
            let series = rule.series(&unit);
            for (k, last) in rule.last.iter_mut().enumerate() {
                last[j] = series.coefficient(degree - 1 + k);
            }
            // ∫ T_k over [−1, 1] is 2/(1 − k²) for even k.
            let integral = |k: usize| 2.0 * series.coefficient(k) / (1.0 - (k * k) as f64);
            rule.weights[j] = (0..=degree).step_by(2).map(integral).sum();
        }
        rule
    }

    /// Computes integrals of the even and the odd functions that are one at one pair of points and zero at the others.
    fn fill_integrals(&mut self, cosines: &[f64]) {
        let half = self.degree / 2;
        let primitives: Vec<HalfVector> = (0..=self.degree)
            .map(|k| self.primitives(cosines, k))
            .collect();
        for j in 0..=half {
            for (k, primitive) in primitives.iter().enumerate() {
                let (factor, sums) = if k % 2 == 0 {
                    (self.series.even[j][k / 2], &mut self.integrals.even[j])
                } else {
                    (self.series.odd[j][k / 2], &mut self.integrals.odd[j])
                };
                for (sum, value) in sums.iter_mut().zip(primitive) {
                    *sum += factor * value;
                }
            }
        }
    }

    /// Returns the integrals of T_k from 0 to the points, by the primitives T_1, T_2/4 and
    /// (T_(k+1)/(k+1) − T_(k−1)/(k−1))/2 for k = 0, 1 and more.
    fn primitives(&self, cosines: &[f64], k: usize) -> HalfVector {
        let half = self.degree / 2;
        let primitive = |i: usize| {
            let t = |k: usize| cosine(cosines, k * i);
            match k {
                0 => t(1),
                1 => 0.25 * t(2),
                _ => 0.5 * (t(k + 1) / (k + 1) as f64 - t(k - 1) / (k - 1) as f64),
            }
        };
        let mut result = [0.0; HALF_LENGTH];
        for (i, value) in result.iter_mut().enumerate().take(half + 1) {
            *value = primitive(i) - primitive(half);
        }
        result
    }

    /// Returns the degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// Returns the points, rising from −1 to 1.
    pub fn points(&self) -> &[f64] {
        &self.points[..=self.degree]
    }

    /// Evaluates a function at the points.
    pub fn values(&self, mut f: impl FnMut(f64) -> f64) -> Values {
        let mut values = [0.0; MAX_DEGREE + 1];
        for (value, x) in values.iter_mut().zip(self.points()) {
            *value = f(*x);
        }
        values
    }

    /// Returns the series through values at the points.
    pub fn series(&self, values: &Values) -> Series {
        let matrices = &self.series;
        let coefficients = match self.degree {
            12 => matrices.coefficients::<12, 8>(values),
            16 => matrices.coefficients::<16, 10>(values),
            20 => matrices.coefficients::<20, 12>(values),
            24 => matrices.coefficients::<24, 14>(values),
            _ => matrices.coefficients::<32, 18>(values),
        };
        Series::new(self.degree, coefficients)
    }

    /// Returns integrals from −1 to each point of the series through values at the points.
    pub fn integrals(&self, values: &Values) -> Values {
        let matrices = &self.integrals;
        match self.degree {
            12 => matrices.integrals::<12, 8>(values),
            16 => matrices.integrals::<16, 10>(values),
            20 => matrices.integrals::<20, 12>(values),
            24 => matrices.integrals::<24, 14>(values),
            _ => matrices.integrals::<32, 18>(values),
        }
    }

    /// Returns the sum of the magnitudes of the last two coefficients of the series through values at the points.
    pub fn last_terms(&self, values: &Values) -> f64 {
        let [a, b] = [0, 1].map(|k| self.sum(&self.last[k], values));
        a.abs() + b.abs()
    }

    /// Returns the matrix of [`Self::integrals`], by rows.
    pub fn integration(&self) -> &[Values] {
        self.integration.get_or_init(|| {
            let mut rows = vec![[0.0; MAX_DEGREE + 1]; self.degree + 1];
            for j in 0..=self.degree {
                let mut unit = [0.0; MAX_DEGREE + 1];
                unit[j] = 1.0;
                let column = self.integrals(&unit);
                for (row, value) in rows.iter_mut().zip(column) {
                    row[j] = value;
                }
            }
            rows
        })
    }

    /// Integrates the series through values at the points over [−1, 1] (Clenshaw and Curtis): value and remainder.
    pub fn integral(&self, values: &Values) -> (f64, f64) {
        // Separate partial sums, for the processor to add side by side.
        let (mut sums, mut rests) = ([0.0; LANES], [0.0; LANES]);
        let weights = self.weights[..self.degree].chunks_exact(LANES);
        for (weights, values) in weights.zip(values.chunks_exact(LANES)) {
            for k in 0..LANES {
                let (sum, lost) = two_sum(sums[k], weights[k] * values[k]);
                sums[k] = sum;
                rests[k] += lost;
            }
        }
        let mut sum = self.weights[self.degree] * values[self.degree];
        let mut rest = 0.0;
        for k in 0..LANES {
            let (next, lost) = two_sum(sum, sums[k]);
            sum = next;
            rest += lost + rests[k];
        }
        two_sum(sum, rest)
    }

    /// Returns the weights of the values at the points in the value at `x` of the polynomial through them (barycentric
    /// formula; Trefethen, theorem 5.2).
    pub fn shares(&self, x: f64) -> Values {
        let mut shares = [0.0; MAX_DEGREE + 1];
        let mut sum = 0.0;
        for (j, point) in self.points().iter().enumerate() {
            if x == *point {
                shares = [0.0; MAX_DEGREE + 1];
                shares[j] = 1.0;
                return shares;
            }
            let end = if j == 0 || j == self.degree { 0.5 } else { 1.0 };
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            shares[j] = sign * end / (x - point);
            sum += shares[j];
        }
        shares.map(|share| share / sum)
    }

    /// Integrates as [`Self::integral`], simply rounded.
    pub fn rounded_integral(&self, values: &Values) -> f64 {
        self.sum(&self.weights, values)
    }

    /// Returns the sum of the products of weights and values at the points.
    fn sum(&self, weights: &Values, values: &Values) -> f64 {
        let mut sums = [0.0; LANES];
        let weighted = weights[..self.degree].chunks_exact(LANES);
        for (weights, values) in weighted.zip(values.chunks_exact(LANES)) {
            for k in 0..LANES {
                sums[k] += weights[k] * values[k];
            }
        }
        let last = weights[self.degree] * values[self.degree];
        (sums[0] + sums[1]) + (sums[2] + sums[3]) + last
    }
}

/// Returns cos(π m/degree) for m from 0 to 2·degree − 1, exactly symmetric.
fn cosines(degree: usize) -> Vec<f64> {
    let n = degree as f64;
    let cosine = |m: usize| (PI * (n - 2.0 * m as f64) / (2.0 * n)).sin();
    (0..2 * degree).map(cosine).collect()
}

/// Returns cos(π m/degree) of any m.
fn cosine(cosines: &[f64], m: usize) -> f64 {
    cosines[m % cosines.len()]
}
