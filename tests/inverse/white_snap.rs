//! Smoother for comparison: a Kalman filter and smoother whose fourth derivative is white noise, that is the smoothing
//! spline of degree 7 (Wahba, J. R. Statist. Soc. B 40 (1978) 364), with both variances by maximum likelihood.

type State = [f64; 4];
type Square = [[f64; 4]; 4];

/// Returns angle, speed and acceleration at each time, from angles that are known (weight 1) or not (0).
pub fn white_snap(t: &[f64], y: &[f64], known: &[bool]) -> Vec<[f64; 3]> {
    let step = (t[t.len() - 1] - t[0]) / (t.len() - 1) as f64;
    let scaled: Vec<f64> = t.iter().map(|time| (time - t[0]) / step).collect();
    let record = Record {
        t: &scaled,
        y,
        known,
    };
    let widths = (0..60).map(|i| 0.5 * 1.15f64.powi(i));
    let densities = widths.map(|width| width.powi(-8));
    let best = densities.min_by(|a, b| record.cost(*a).total_cmp(&record.cost(*b)));
    let states = record.smoothed(best.expect("densities"));
    states
        .into_iter()
        .map(|[a, b, c, _]| [a, b / step, c / (step * step)])
        .collect()
}

struct Record<'a> {
    t: &'a [f64],
    y: &'a [f64],
    known: &'a [bool],
}

/// Sample in the filter: prediction with its covariance, and prediction error with its variance.
struct Step {
    transition: Square,
    mean: State,
    covariance: Square,
    error: Option<(f64, f64)>,
}

fn transition(dt: f64) -> Square {
    let factors = [1.0, dt, dt * dt / 2.0, dt.powi(3) / 6.0];
    std::array::from_fn(|i| std::array::from_fn(|j| if j >= i { factors[j - i] } else { 0.0 }))
}

fn noise(dt: f64, density: f64) -> Square {
    let divisors = [6.0, 2.0, 1.0, 1.0];
    let entry = |i: usize, j: usize| {
        let power = 7 - i - j;
        density * dt.powi(power as i32) / (divisors[i] * divisors[j] * power as f64)
    };
    std::array::from_fn(|i| std::array::from_fn(|j| entry(i, j)))
}

fn product(a: &Square, b: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn transposed(a: &Square) -> Square {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

fn times(a: &Square, v: &State) -> State {
    std::array::from_fn(|i| (0..4).map(|k| a[i][k] * v[k]).sum())
}

impl Record<'_> {
    fn filtered(&self, density: f64) -> Vec<Step> {
        let mut mean = [self.y[0], self.y[1] - self.y[0], 0.0, 0.0];
        let mut covariance = [[0.0; 4]; 4];
        for (i, variance) in [1e2, 1e8, 1e8, 1e8].into_iter().enumerate() {
            covariance[i][i] = variance;
        }
        let mut steps = Vec::new();
        for k in 0..self.t.len() {
            let mut along = transition(0.0);
            if k > 0 {
                let dt = self.t[k] - self.t[k - 1];
                along = transition(dt);
                mean = times(&along, &mean);
                covariance = product(&product(&along, &covariance), &transposed(&along));
                let more = noise(dt, density);
                (0..16).for_each(|e| covariance[e / 4][e % 4] += more[e / 4][e % 4]);
            }
            let variance = covariance[0][0] + 1.0;
            let error = self.known[k].then(|| (self.y[k] - mean[0], variance));
            steps.push(Step {
                transition: along,
                mean,
                covariance,
                error,
            });
            if let Some((error, variance)) = error {
                let gain: State = std::array::from_fn(|i| covariance[i][0] / variance);
                (0..4).for_each(|i| mean[i] += gain[i] * error);
                let row = covariance[0];
                (0..16).for_each(|e| covariance[e / 4][e % 4] -= gain[e / 4] * row[e % 4]);
            }
        }
        steps
    }

    /// Returns −2 ln of the likelihood up to a constant, with the variance of the noise at its likeliest value.
    fn cost(&self, density: f64) -> f64 {
        let steps = self.filtered(density);
        let errors: Vec<(f64, f64)> = steps.iter().skip(8).filter_map(|step| step.error).collect();
        let squares: f64 = errors.iter().map(|(e, v)| e * e / v).sum();
        let logs: f64 = errors.iter().map(|(_, v)| v.ln()).sum();
        logs + errors.len() as f64 * squares.ln()
    }

    /// Smooths by de Jong's method (J. Am. Statist. Assoc. 84 (1989) 1085).
    fn smoothed(&self, density: f64) -> Vec<State> {
        let steps = self.filtered(density);
        let mut adjoint = [0.0; 4];
        let mut states = vec![[0.0; 4]; steps.len()];
        for k in (0..steps.len()).rev() {
            if let Some(next) = steps.get(k + 1) {
                adjoint = times(&transposed(&next.transition), &adjoint);
            }
            let step = &steps[k];
            if let Some((error, variance)) = step.error {
                let gained: f64 = (0..4)
                    .map(|i| step.covariance[i][0] / variance * adjoint[i])
                    .sum();
                adjoint[0] += error / variance - gained;
            }
            let moved = times(&step.covariance, &adjoint);
            states[k] = std::array::from_fn(|i| step.mean[i] + moved[i]);
        }
        states
    }
}

/// A cubic is its own smoothing spline.
#[test]
fn a_cubic_is_left_as_it_is() {
    let t: Vec<f64> = (0..50).map(|i| 0.1 * f64::from(i)).collect();
    let y: Vec<f64> = t.iter().map(|t| 1.0 - 2.0 * t + 0.3 * t.powi(3)).collect();
    for (t, state) in t.iter().zip(white_snap(&t, &y, &[true; 50])) {
        for (found, exact) in
            state
                .into_iter()
                .zip([1.0 - 2.0 * t + 0.3 * t.powi(3), -2.0 + 0.9 * t * t, 1.8 * t])
        {
            assert!((found - exact).abs() < 1e-4, "{t}: {found} for {exact}");
        }
    }
}
