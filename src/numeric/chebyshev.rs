//! Chebyshev series of fixed degree on [−1, 1]: through values at the Lobatto points, evaluated,
//! integrated (Trefethen, Approximation Theory and Approximation Practice, ch. 3 and 19).

use std::f64::consts::PI;
use std::sync::OnceLock;

/// Degree of every series.
pub const DEGREE: usize = 24;
/// Number of points and coefficients.
pub const POINTS: usize = DEGREE + 1;

/// Values at the points, or coefficients.
pub type Values = [f64; POINTS];

struct Tables {
    points: Values,
    /// cos(π j k/DEGREE)
    cosines: Values,
    /// Clenshaw-Curtis weights.
    weights: Values,
}

fn tables() -> &'static Tables {
    static TABLES: OnceLock<Tables> = OnceLock::new();
    TABLES.get_or_init(|| {
        let n = DEGREE as f64;
        // From the sine of a symmetric argument, so that the points are symmetric to the last bit.
        let points = std::array::from_fn(|j| (PI * (2.0 * j as f64 - n) / (2.0 * n)).sin());
        let cosines = std::array::from_fn(|j| (PI * (n - 2.0 * j as f64) / (2.0 * n)).sin());
        let weights = std::array::from_fn(|j| {
            let end = j == 0 || j == DEGREE;
            let sum: f64 = (1..=DEGREE / 2)
                .map(|k| {
                    let last = if 2 * k == DEGREE { 1.0 } else { 2.0 };
                    let angle = 2.0 * PI * (k * j % DEGREE) as f64 / n;
                    last * angle.cos() / (4.0 * (k * k) as f64 - 1.0)
                })
                .sum();
            (1.0 - sum) * if end { 1.0 } else { 2.0 } / n
        });
        Tables {
            points,
            cosines,
            weights,
        }
    })
}

/// The points, rising from −1 to 1.
pub fn points() -> &'static Values {
    &tables().points
}

/// Weights of the Clenshaw-Curtis rule at the points.
pub fn weights() -> &'static Values {
    &tables().weights
}

/// Coefficients of the series through `values` at the points.
pub fn coefficients(values: &Values) -> Values {
    let cosines = &tables().cosines;
    // Point j lies at angle π − πj/DEGREE, so odd coefficients change their sign.
    std::array::from_fn(|k| {
        let mut sum = 0.5 * values[0];
        let mut index = 0;
        for value in &values[1..DEGREE] {
            index += k;
            if index >= 2 * DEGREE {
                index -= 2 * DEGREE;
            }
            let folded = if index > DEGREE {
                2 * DEGREE - index
            } else {
                index
            };
            sum += value * cosines[folded];
        }
        let last = 0.5 * values[DEGREE];
        sum += if k % 2 == 0 { last } else { -last };
        let scale = if k == 0 || k == DEGREE { 1.0 } else { 2.0 } / DEGREE as f64;
        if k % 2 == 0 {
            scale * sum
        } else {
            -scale * sum
        }
    })
}

/// The series at `x` in [−1, 1], by Clenshaw's recurrence.
pub fn value(coefficients: &Values, x: f64) -> f64 {
    let twice = 2.0 * x;
    let (mut b1, mut b2) = (0.0, 0.0);
    for c in coefficients[1..].iter().rev() {
        (b1, b2) = (c + twice * b1 - b2, b1);
    }
    coefficients[0] + x * b1 - b2
}

/// The integral of a series from −1, as a series; the term of degree `DEGREE + 1` is left out, for it is as
/// small as the tail.
pub fn integral(coefficients: &Values) -> Values {
    let c = |k: usize| coefficients.get(k).copied().unwrap_or(0.0);
    let mut result = [0.0; POINTS];
    for (k, term) in result.iter_mut().enumerate().skip(1) {
        let before = if k == 1 { 2.0 * c(0) } else { c(k - 1) };
        *term = (before - c(k + 1)) / (2.0 * k as f64);
    }
    let at_start: f64 = result
        .iter()
        .enumerate()
        .skip(1)
        .map(|(k, term)| if k % 2 == 0 { *term } else { -term })
        .sum();
    result[0] = -at_start;
    result
}

/// The derivative of a series.
pub fn derivative(coefficients: &Values) -> Values {
    let mut result = [0.0; POINTS];
    for k in (0..DEGREE).rev() {
        let after = if k + 2 < POINTS { result[k + 2] } else { 0.0 };
        result[k] = after + 2.0 * (k + 1) as f64 * coefficients[k + 1];
    }
    result[0] *= 0.5;
    result
}

/// Integrals from −1 to each point of the series through `values`: the matrix of integration, row by row.
pub fn integrals(values: &Values) -> Values {
    static MATRIX: OnceLock<Vec<Values>> = OnceLock::new();
    let columns = MATRIX.get_or_init(|| {
        (0..POINTS)
            .map(|k| {
                let unit = std::array::from_fn(|j| if j == k { 1.0 } else { 0.0 });
                let series = integral(&coefficients(&unit));
                points().map(|x| value(&series, x))
            })
            .collect()
    });
    let mut sums = [0.0; POINTS];
    for (column, factor) in columns.iter().zip(values) {
        for (sum, entry) in sums.iter_mut().zip(column) {
            *sum += entry * factor;
        }
    }
    sums
}

/// How far the coefficients have not yet decayed, relative to the largest: the last two of them.
pub fn tail(coefficients: &Values) -> f64 {
    let largest = coefficients.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    (coefficients[DEGREE].abs() + coefficients[DEGREE - 1].abs()) / largest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_smooth_function_is_right_to_rounding() {
        let values = points().map(|x| (3.0 * x + 0.2).exp());
        let series = coefficients(&values);
        let primitive = integral(&series);
        let slope = derivative(&series);
        for x in [-0.9f64, 0.1, 0.8] {
            let exact = 3.0 * (3.0 * x + 0.2).exp();
            assert!((value(&slope, x) / exact - 1.0).abs() < 1e-12, "{x}");
        }
        assert!(tail(&series) < 1e-15);
        for x in [-1.0f64, -0.7, 0.0, 0.3, 1.0] {
            let exact = (3.0 * x + 0.2).exp();
            assert!((value(&series, x) / exact - 1.0).abs() < 1e-13);
            let exact = ((3.0 * x + 0.2).exp() - (-2.8f64).exp()) / 3.0;
            assert!((value(&primitive, x) - exact).abs() < 1e-14, "{x}");
        }
        let sum: f64 = weights().iter().zip(&values).map(|(w, v)| w * v).sum();
        assert!((sum - ((3.2f64).exp() - (-2.8f64).exp()) / 3.0).abs() < 2e-14);
    }

    #[test]
    fn integrals_at_the_points_are_those_of_the_series() {
        let values = points().map(|x| (2.0 * x).cos());
        for (sum, x) in integrals(&values).iter().zip(points()) {
            let exact = 0.5 * ((2.0 * x).sin() + 2f64.sin());
            assert!((sum - exact).abs() < 1e-15, "{x}: {sum} {exact}");
        }
    }

    #[test]
    fn a_corner_is_not_taken_for_smooth() {
        let values = points().map(|x| (x - 0.1).abs());
        assert!(tail(&coefficients(&values)) > 1e-5);
    }
}
