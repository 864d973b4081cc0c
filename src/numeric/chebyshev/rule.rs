//! Points, weights and matrices of one degree.
//!
//! The points are symmetric, so even and odd parts of a function are transformed apart, with half the
//! points each.

use std::f64::consts::PI;
use std::fmt;
use std::sync::OnceLock;

use super::{MOST, Series, Values};
use crate::numeric::exact;

/// Half of the largest degree, and the middle point.
const HALF: usize = MOST / 2 + 1;

type Half = [f64; HALF];
type Matrix = [Half; HALF];

/// The Lobatto points x₀ = −1, …, x_n = 1 of a degree n and what belongs to them.
pub struct Rule {
    degree: usize,
    points: Values,
    /// Clenshaw-Curtis weights.
    weights: Values,
    /// Coefficients 2k from the even part at the points, by columns.
    even: Matrix,
    /// Coefficients 2k + 1 from the odd part.
    odd: Matrix,
    /// Integrals from 0 of the even part to the points, by columns.
    even_integrals: Matrix,
    /// The same of the odd part.
    odd_integrals: Matrix,
    /// The matrix of integration, once it is asked for.
    integration: OnceLock<Vec<Values>>,
}

impl fmt::Debug for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Rule({})", self.degree)
    }
}

impl Rule {
    /// The degrees there are.
    pub const DEGREES: [usize; 4] = [12, 16, 24, 32];

    /// The rule of one of the degrees [`Self::DEGREES`]; of the largest for any other.
    pub fn of(degree: usize) -> &'static Rule {
        static RULES: [OnceLock<Box<Rule>>; 4] = [const { OnceLock::new() }; 4];
        let index = Rule::DEGREES.iter().position(|d| *d == degree).unwrap_or(3);
        RULES[index].get_or_init(|| Box::new(Rule::new(Rule::DEGREES[index])))
    }

    fn new(degree: usize) -> Rule {
        let mut rule = Rule {
            degree,
            points: [0.0; MOST + 1],
            weights: [0.0; MOST + 1],
            even: [[0.0; HALF]; HALF],
            odd: [[0.0; HALF]; HALF],
            even_integrals: [[0.0; HALF]; HALF],
            odd_integrals: [[0.0; HALF]; HALF],
            integration: OnceLock::new(),
        };
        let n = degree as f64;
        let cosines = cosines(degree);
        for j in 0..=degree {
            // From the sine of a symmetric argument, so that the points are symmetric to the last bit.
            rule.points[j] = (PI * (2.0 * j as f64 - n) / (2.0 * n)).sin();
            rule.weights[j] = weight(&cosines, j);
        }
        let half = degree / 2;
        for j in 0..=half {
            let at_end = if j == 0 { 0.5 } else { 1.0 };
            for k in 0..=half {
                let last = if k == 0 || k == half { 1.0 } else { 2.0 };
                rule.even[j][k] = last / n * at_end * cosine(&cosines, 2 * k * j);
                if k < half && j < half {
                    rule.odd[j][k] = 2.0 / n * at_end * cosine(&cosines, (2 * k + 1) * j);
                }
            }
        }
        rule.fill_integrals(&cosines);
        rule
    }

    /// Integrals of the even and the odd functions that are one at one pair of points and zero at the others.
    fn fill_integrals(&mut self, cosines: &[f64]) {
        let half = self.degree / 2;
        let primitives: Vec<Half> = (0..=self.degree)
            .map(|k| self.primitives(cosines, k))
            .collect();
        for j in 0..=half {
            for (k, primitive) in primitives.iter().enumerate() {
                let (factor, sums) = if k % 2 == 0 {
                    (self.even[j][k / 2], &mut self.even_integrals[j])
                } else {
                    (self.odd[j][k / 2], &mut self.odd_integrals[j])
                };
                for (sum, value) in sums.iter_mut().zip(primitive) {
                    *sum += factor * value;
                }
            }
        }
    }

    /// Integrals of T_k from 0 to the points: of T_1, T_2/4 and (T_(k+1)/(k+1) − T_(k−1)/(k−1))/2 for k = 0, 1
    /// and more.
    fn primitives(&self, cosines: &[f64], k: usize) -> Half {
        let half = self.degree / 2;
        let primitive = |i: usize| {
            let t = |k: usize| cosine(cosines, k * i);
            match k {
                0 => t(1),
                1 => 0.25 * t(2),
                _ => 0.5 * (t(k + 1) / (k + 1) as f64 - t(k - 1) / (k - 1) as f64),
            }
        };
        let mut result = [0.0; HALF];
        for (i, value) in result.iter_mut().enumerate().take(half + 1) {
            *value = primitive(i) - primitive(half);
        }
        result
    }

    /// The degree n.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The points, rising from −1 to 1.
    pub fn points(&self) -> &[f64] {
        &self.points[..=self.degree]
    }

    /// Values of a function at the points.
    pub fn values(&self, mut f: impl FnMut(f64) -> f64) -> Values {
        let mut values = [0.0; MOST + 1];
        for (value, x) in values.iter_mut().zip(self.points()) {
            *value = f(*x);
        }
        values
    }

    /// The series through values at the points.
    pub fn series(&self, values: &Values) -> Series {
        let (even, odd) = self.parts(values);
        let even = self.product(&self.even, &even);
        let odd = self.product(&self.odd, &odd);
        let mut coefficients = [0.0; MOST + 1];
        for k in 0..HALF - 1 {
            coefficients[2 * k] = even[k];
            coefficients[2 * k + 1] = odd[k];
        }
        coefficients[MOST] = even[HALF - 1];
        Series::new(self.degree, coefficients)
    }

    /// Integrals from −1 to each point of the series through values at the points.
    pub fn integrals(&self, values: &Values) -> Values {
        let (even, odd) = self.parts(values);
        // The even part has an odd integral, and the other way round.
        let odd_integral = self.product(&self.even_integrals, &even);
        let even_integral = self.product(&self.odd_integrals, &odd);
        let from_start = odd_integral[0] - even_integral[0];
        let mut result = [0.0; MOST + 1];
        for j in 0..=self.degree / 2 {
            result[j] = from_start + even_integral[j] - odd_integral[j];
            result[self.degree - j] = from_start + even_integral[j] + odd_integral[j];
        }
        result[0] = 0.0;
        result
    }

    /// The matrix of [`Self::integrals`], by rows.
    pub fn integration(&self) -> &[Values] {
        self.integration.get_or_init(|| {
            let mut rows = vec![[0.0; MOST + 1]; self.degree + 1];
            for j in 0..=self.degree {
                let mut unit = [0.0; MOST + 1];
                unit[j] = 1.0;
                let column = self.integrals(&unit);
                for (row, value) in rows.iter_mut().zip(column) {
                    row[j] = value;
                }
            }
            rows
        })
    }

    /// Integral over [−1, 1] of the series through values at the points (Clenshaw and Curtis), as a rounded
    /// value and its rest.
    pub fn integral(&self, values: &Values) -> (f64, f64) {
        let (mut sum, mut rest) = (0.0, 0.0);
        let terms = self.weights.iter().zip(values).take(self.degree + 1);
        for (weight, value) in terms {
            let (next, lost) = exact::two_sum(sum, weight * value);
            sum = next;
            rest += lost;
        }
        exact::two_sum(sum, rest)
    }

    /// Shares of the values at the points in the value at `x` of the polynomial through them (barycentric
    /// formula; Trefethen, theorem 5.2).
    pub fn shares(&self, x: f64) -> Values {
        let mut shares = [0.0; MOST + 1];
        let mut sum = 0.0;
        for (j, point) in self.points().iter().enumerate() {
            if x == *point {
                shares = [0.0; MOST + 1];
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

    /// The same, simply rounded.
    pub fn rounded_integral(&self, values: &Values) -> f64 {
        // Sums apart from each other, for the processor to add side by side.
        let mut sums = [0.0; 4];
        let weights = self.weights[..MOST].chunks_exact(4);
        for (weights, values) in weights.zip(values.chunks_exact(4)) {
            for k in 0..4 {
                sums[k] += weights[k] * values[k];
            }
        }
        let last = self.weights[MOST] * values[MOST];
        (sums[0] + sums[1]) + (sums[2] + sums[3]) + last
    }

    /// Sum and difference of the values at the pairs of points, from the ends to the middle.
    fn parts(&self, values: &Values) -> (Half, Half) {
        let (mut even, mut odd) = ([0.0; HALF], [0.0; HALF]);
        let half = self.degree / 2;
        for j in 0..half {
            let (minus, plus) = (values[j], values[self.degree - j]);
            even[j] = plus + minus;
            odd[j] = plus - minus;
        }
        even[half] = values[half];
        (even, odd)
    }

    fn product(&self, matrix: &Matrix, vector: &Half) -> Half {
        match self.degree {
            12 => product::<7>(matrix, vector),
            16 => product::<9>(matrix, vector),
            24 => product::<13>(matrix, vector),
            _ => product::<17>(matrix, vector),
        }
    }
}

/// Matrix times vector, of which the first `N` entries count: a constant, so that the loops unroll.
fn product<const N: usize>(matrix: &Matrix, vector: &Half) -> Half {
    let mut sums = [0.0; N];
    for (column, factor) in matrix.iter().zip(vector).take(N) {
        for k in 0..N {
            sums[k] += column[k] * factor;
        }
    }
    let mut result = [0.0; HALF];
    result[..N].copy_from_slice(&sums);
    result
}

/// cos(π m/degree) for m from 0 to 2·degree − 1, exactly symmetric.
fn cosines(degree: usize) -> Vec<f64> {
    let n = degree as f64;
    let cosine = |m: usize| (PI * (n - 2.0 * m as f64) / (2.0 * n)).sin();
    (0..2 * degree).map(cosine).collect()
}

/// cos(π m/degree) of any m.
fn cosine(cosines: &[f64], m: usize) -> f64 {
    cosines[m % cosines.len()]
}

/// Weight of the point `j` in the rule of Clenshaw and Curtis.
fn weight(cosines: &[f64], j: usize) -> f64 {
    let degree = cosines.len() / 2;
    let end = j == 0 || j == degree;
    let sum: f64 = (1..=degree / 2)
        .map(|k| {
            let last = if 2 * k == degree { 1.0 } else { 2.0 };
            last * cosine(cosines, 2 * k * j) / (4.0 * (k * k) as f64 - 1.0)
        })
        .sum();
    (1.0 - sum) * if end { 1.0 } else { 2.0 } / degree as f64
}
