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
        for j in 0..=degree {
            // From the sine of a symmetric argument, so that the points are symmetric to the last bit.
            rule.points[j] = (PI * (2.0 * j as f64 - n) / (2.0 * n)).sin();
            rule.weights[j] = weight(degree, j);
        }
        let half = degree / 2;
        for j in 0..=half {
            let at_end = if j == 0 { 0.5 } else { 1.0 };
            for k in 0..=half {
                let last = if k == 0 || k == half { 1.0 } else { 2.0 };
                rule.even[j][k] = last / n * at_end * cosine(degree, 2 * k * j);
                if k < half && j < half {
                    rule.odd[j][k] = 2.0 / n * at_end * cosine(degree, (2 * k + 1) * j);
                }
            }
        }
        for j in 0..=half {
            rule.fill_integrals(j);
        }
        rule
    }

    /// Integrals of the even and the odd function that are one at the pair of points `j` from the ends.
    fn fill_integrals(&mut self, j: usize) {
        let half = self.degree / 2;
        let (mut even, mut odd) = ([0.0; MOST + 1], [0.0; MOST + 1]);
        for k in 0..=half {
            even[2 * k] = self.even[j][k];
            if k < half {
                odd[2 * k + 1] = self.odd[j][k];
            }
        }
        let primitive = |c: &Values, i: usize| {
            let t = |k: usize| cosine(self.degree, k * i);
            let term = |k: usize| match k {
                0 => c[0] * t(1),
                1 => c[1] * 0.25 * t(2),
                _ => 0.5 * c[k] * (t(k + 1) / (k + 1) as f64 - t(k - 1) / (k - 1) as f64),
            };
            (0..=self.degree).map(term).sum::<f64>()
        };
        let (even_at_middle, odd_at_middle) = (primitive(&even, half), primitive(&odd, half));
        for i in 0..=half {
            self.even_integrals[j][i] = primitive(&even, i) - even_at_middle;
            self.odd_integrals[j][i] = primitive(&odd, i) - odd_at_middle;
        }
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

/// cos(π m/degree), exactly symmetric.
fn cosine(degree: usize, m: usize) -> f64 {
    let n = degree as f64;
    let m = (m % (2 * degree)) as f64;
    (PI * (n - 2.0 * m) / (2.0 * n)).sin()
}

/// Weight of the point `j` in the rule of Clenshaw and Curtis.
fn weight(degree: usize, j: usize) -> f64 {
    let end = j == 0 || j == degree;
    let sum: f64 = (1..=degree / 2)
        .map(|k| {
            let last = if 2 * k == degree { 1.0 } else { 2.0 };
            last * cosine(degree, 2 * k * j) / (4.0 * (k * k) as f64 - 1.0)
        })
        .sum();
    (1.0 - sum) * if end { 1.0 } else { 2.0 } / degree as f64
}
