//! Covariance of two quantities, carried along by transition matrices.

use nalgebra::{Matrix2, Vector2};

/// Matrix that maps perturbations of two quantities at the start to those at the end.
pub type Transition = Matrix2<f64>;

/// Standard deviations of two quantities as two independent perturbations of both, in columns. Where both point along one
/// direction for a while, a covariance matrix would lose the part across it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CovarianceFactor(Matrix2<f64>);

impl CovarianceFactor {
    /// Returns this covariance, or the one before if a number overflowed.
    fn or(self, before: &CovarianceFactor) -> CovarianceFactor {
        let finite = self.0.iter().all(|size| size.is_finite());
        if finite { self } else { *before }
    }

    /// Returns the standard deviations of both quantities.
    pub fn deviations(&self) -> [f64; 2] {
        [0, 1].map(|i| self.0[(i, 0)].hypot(self.0[(i, 1)]))
    }

    /// Adds independent errors of both quantities.
    pub fn plus_independent(self, first: f64, second: f64) -> CovarianceFactor {
        self.plus_error([first, 0.0]).plus_error([0.0, second])
    }

    /// Adds one error with components in both quantities.
    pub fn plus_error(self, error: [f64; 2]) -> CovarianceFactor {
        // Rotated until only the first has a first component, three perturbations become two.
        let [first, second] = self.perturbations();
        let [first, second] = rotated(first, second);
        let [first, third] = rotated(first, error);
        let rest = length([second[1], third[1]]);
        CovarianceFactor(Matrix2::new(first[0], 0.0, first[1], rest)).or(&self)
    }

    fn perturbations(&self) -> [[f64; 2]; 2] {
        self.0.data.0
    }

    /// Adds independent errors with this covariance.
    pub fn plus(self, other: CovarianceFactor) -> CovarianceFactor {
        let [first, second] = other.perturbations();
        self.plus_error(first).plus_error(second)
    }

    /// Multiplies the quantities by factors.
    pub fn scaled(self, [first, second]: [f64; 2]) -> CovarianceFactor {
        self.propagated(&Matrix2::from_diagonal(&Vector2::new(first, second)))
    }

    /// Applies a transition matrix.
    pub fn propagated(self, transition: &Transition) -> CovarianceFactor {
        CovarianceFactor(transition * self.0).or(&self)
    }
}

/// Returns the length of a vector of moderate size; faster than a hypotenuse without overflow.
fn length([a, b]: [f64; 2]) -> f64 {
    (a * a + b * b).sqrt()
}

/// Rotates two perturbations until the second has no first component.
fn rotated(a: [f64; 2], b: [f64; 2]) -> [[f64; 2]; 2] {
    let length = length([a[0], b[0]]);
    if length == 0.0 {
        return [a, b];
    }
    let (cos, sin) = (a[0] / length, b[0] / length);
    [
        [length, cos * a[1] + sin * b[1]],
        [0.0, cos * b[1] - sin * a[1]],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_close(value: f64, exact: f64) {
        assert!((value - exact).abs() < 1e-9 * exact, "{value}, not {exact}");
    }

    #[test]
    fn independent_errors_add_up_by_their_squares() {
        let covariance = CovarianceFactor::default()
            .plus_independent(3.0, 5.0)
            .plus_error([4.0, 12.0]);
        assert_close(covariance.deviations()[0], 5.0);
        assert_close(covariance.deviations()[1], 13.0);
        let faster = covariance.scaled([1.0, 2.0]);
        assert_close(faster.deviations()[1], 26.0);
    }

    /// A speed that changes much with the angle, and back again, as at a limit that is passed fast.
    #[test]
    fn what_is_small_beside_a_large_spread_is_kept() {
        let steep = |slope: f64| Matrix2::new(1.0, 0.0, slope, 1.0);
        let covariance = CovarianceFactor::default()
            .plus_independent(1.0, 3.0)
            .propagated(&steep(1e12));
        let back = covariance.plus_error([1e-3, 1e9]).propagated(&steep(-1e12));
        assert!((back.deviations()[1] - 3.0).abs() < 1e-3, "{back:?}");
        assert_close(back.deviations()[0], 1f64.hypot(1e-3));
    }
}
