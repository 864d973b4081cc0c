//! Straight line through points by least squares, with standard errors.

/// Line y = intercept + slope x, with its statistics.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct LineFit {
    /// Value of y at x = 0.
    pub intercept: f64,
    /// Slope dy/dx.
    pub slope: f64,
    /// Standard error of the intercept; none with two points.
    pub intercept_se: Option<f64>,
    /// Standard error of the slope; none with two points.
    pub slope_se: Option<f64>,
    /// Standard deviation of the residuals with n − 2 degrees of freedom; none with two points.
    pub residual_sd: Option<f64>,
    /// 1 − residual sum of squares over the sum of squares about the mean; none if all y are equal.
    pub r_squared: Option<f64>,
    /// Number of points.
    pub points: usize,
    #[serde(skip)]
    mean: [f64; 2],
    #[serde(skip)]
    spread: f64,
}

/// Sums numbers and adds the rounding errors of the additions at the end (Neumaier, ZAMM 54 (1974) 39).
fn sum(values: impl Iterator<Item = f64>) -> f64 {
    let (mut total, mut lost) = (0.0, 0.0);
    for value in values {
        let (next, error) = super::exact::two_sum(total, value);
        (total, lost) = (next, lost + error);
    }
    total + lost
}

impl LineFit {
    /// Fits the line through the points (x, y); none with fewer than two, all x equal, or values that are not finite.
    ///
    /// The sums are those of the distances from the means, without loss in the additions.
    pub fn new(points: &[(f64, f64)]) -> Option<LineFit> {
        let n = points.len() as f64;
        let x_mean = sum(points.iter().map(|p| p.0)) / n;
        let y_mean = sum(points.iter().map(|p| p.1)) / n;
        let apart = || points.iter().map(|(x, y)| (x - x_mean, y - y_mean));
        let sxx = sum(apart().map(|(x, _)| x * x));
        let sxy = sum(apart().map(|(x, y)| x * y));
        let syy = sum(apart().map(|(_, y)| y * y));
        let slope = sxy / sxx;
        if points.len() < 2 || !slope.is_finite() {
            return None;
        }
        let rest = sum(apart().map(|(x, y)| (y - slope * x).powi(2)));
        let residual_sd = (points.len() > 2).then(|| (rest / (n - 2.0)).sqrt());
        Some(LineFit {
            intercept: y_mean - slope * x_mean,
            slope,
            intercept_se: residual_sd.map(|sd| sd * (1.0 / n + x_mean * x_mean / sxx).sqrt()),
            slope_se: residual_sd.map(|sd| sd / sxx.sqrt()),
            residual_sd,
            r_squared: (syy > 0.0).then(|| 1.0 - rest / syy),
            points: points.len(),
            mean: [x_mean, y_mean],
            spread: sxx,
        })
    }

    /// Returns R² of the line through the origin, with the sum of squares about zero: it cannot be compared with that of
    /// another line.
    pub fn r_squared_about_zero(points: &[(f64, f64)]) -> Option<f64> {
        let sxx = sum(points.iter().map(|(x, _)| x * x));
        let sxy = sum(points.iter().map(|(x, y)| x * y));
        let syy = sum(points.iter().map(|(_, y)| y * y));
        let slope = sxy / sxx;
        let rest = sum(points.iter().map(|(x, y)| (y - slope * x).powi(2)));
        slope.is_finite().then(|| 1.0 - rest / syy)
    }

    /// Returns the x of a single reading y, and its standard uncertainty from the scatter of the points and of the
    /// reading itself (Draper and Smith, Applied Regression Analysis, 3rd ed., section 3.2, to first order); no
    /// uncertainty with two points, none at all with a slope of zero.
    pub fn inverse(&self, y: f64) -> Option<(f64, Option<f64>)> {
        let x = self.mean[0] + (y - self.mean[1]) / self.slope;
        let from_mean = (x - self.mean[0]) / self.spread.sqrt();
        let of_reading = (1.0 + 1.0 / self.points as f64).sqrt();
        let uncertainty = self
            .residual_sd
            .map(|sd| sd / self.slope.abs() * of_reading.hypot(from_mean));
        let finite = x.is_finite() && uncertainty.is_none_or(f64::is_finite);
        finite.then_some((x, uncertainty))
    }
}
