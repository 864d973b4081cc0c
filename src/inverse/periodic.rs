//! A part of the torque that repeats from cycle to cycle: harmonics of the crank angle whose coefficients all cycles share.
//!
//! du = √q dW + dp,   p(θ) = Σ βⱼ φⱼ(θ),   βⱼ ~ N(0, σ² s²/k²ᵐ)   for cos kθ and sin kθ: a periodic Wiener process of order m.
//!
//! The force of a loss grows with the speed: the φⱼ may be ω cos kθ and ω sin kθ too, ω in units of its root mean square.
//!
//! The filter runs once for β = 0, and beside it the derivatives of its state by β follow the same recursion (augmented Kalman
//! filter; de Jong, Ann. Statist. 19 (1991) 1073). A prediction error is then e + E β with the variance that it has without β, and
//! what is left is a linear regression with the information Σ EᵀE/S. The derivatives of p by θ and ω, with the β of the last
//! iteration, are those of the equation of motion, too: u less p is the state of the linear model.

use nalgebra::{DMatrix, DMatrixView};

use super::columns::{Lanes, add_product, blocks, correct, respond, transform, update};
use super::fixed_interval::{Companion, Later};
use super::harmonics::responses;
use super::kalman::{Filtered, Gaussian};
use super::linearised::Linearised;
use super::matrix::transposed;
use super::regression::{ROWS_AT_ONCE, Regression};
use super::repeating::dot;
use super::state_space::{Deviations, Stretch};
use crate::numeric::LANES;

/// Companion of filter and smoother that fills the normal equations.
pub(super) struct Regressed<'a, const N: usize> {
    stretch: &'a Stretch,
    /// Derivatives of the state by the coefficients.
    of: Vec<[Lanes; N]>,
    /// E
    errors: Vec<Lanes>,
    to: Regression,
    /// The smoother's derivatives, if there is one.
    found: Option<Derivatives<N>>,
}

/// Derivatives of smoothed states and prediction errors by the coefficients.
pub(super) struct Derivatives<const N: usize> {
    /// Those of the states, node by node.
    list: Vec<[Lanes; N]>,
    /// Those of the prediction errors over their standard deviations, sample by sample.
    errors: Vec<Lanes>,
    /// Samples that are not on the way back yet.
    left: usize,
}

impl<'a, const N: usize> Regressed<'a, N> {
    /// A companion of the filter along a model, or of the smoother.
    pub fn new(model: &Deviations<'a>, is_smoother: bool) -> Self {
        let blocks = model.stretch.increments.count / LANES;
        let all = model.stretch.observed.len() * blocks;
        Regressed {
            stretch: model.stretch,
            of: vec![[[0.0; LANES]; N]; blocks],
            errors: vec![[0.0; LANES]; blocks],
            to: Regression::new(model.prior),
            found: (is_smoother && blocks > 0).then(|| Derivatives {
                list: Vec::with_capacity(all),
                errors: Vec::with_capacity(all),
                left: 0,
            }),
        }
    }

    /// Returns the normal equations, and the smoother's derivatives if there is one.
    pub fn into_parts(mut self) -> (Regression, Option<Derivatives<N>>) {
        self.to.multiply();
        (self.to, self.found)
    }

    /// Takes the derivatives to a node, and its sample into the normal equations.
    fn regress(&mut self, node: usize, at: &Filtered<'_, N>) {
        if let Some(step) = at.step {
            let Linearised { h, lever, .. } = self.stretch.steps[node - 1];
            let torques = self.stretch.increments.of(node - 1).map(blocks);
            transform(&mut self.of, &step.transition);
            respond(&mut self.of, &responses(h, lever), torques);
        }
        if let Some(derivatives) = &mut self.found {
            derivatives.list.extend_from_slice(&self.of);
        }
        if let Some((sample, found)) = at.sample {
            update(&mut self.of, &mut self.errors, &sample.row(), &found.gain);
            let (errors, per) = (&self.errors, 1.0 / found.variance.sqrt());
            self.to.take(errors.as_flattened(), found.error, per);
            if let Some(derivatives) = &mut self.found {
                derivatives.left += 1;
                let scaled = errors.iter().map(|lanes| lanes.map(|value| value * per));
                derivatives.errors.extend(scaled);
            }
        }
    }
}

impl<const N: usize> Derivatives<N> {
    /// Adds what coefficients do to the smoothed states and prediction errors, with a factor A of their covariance Aᵀ A.
    pub fn add(
        self,
        coefficients: &[f64],
        factor: &DMatrix<f64>,
        path: &mut [Gaussian<N>],
        innovations: &mut [Option<f64>],
    ) {
        let Derivatives { list, errors, .. } = self;
        let count = coefficients.len();
        let blocks = count / LANES;
        let known = innovations.iter_mut().flatten();
        for (row, innovation) in errors.chunks_exact(blocks).zip(known) {
            *innovation += dot(row.as_flattened(), coefficients);
        }
        let mut rows = Vec::with_capacity(ROWS_AT_ONCE * N * count);
        for (nodes, states) in list
            .chunks(ROWS_AT_ONCE * blocks)
            .zip(path.chunks_mut(ROWS_AT_ONCE))
        {
            rows.clear();
            for node in nodes.chunks_exact(blocks) {
                (0..N).for_each(|k| rows.extend(node.iter().flat_map(|block| block[k])));
            }
            let spread = factor * DMatrixView::from_slice(&rows, count, rows.len() / count);
            let rows: Vec<&[f64]> = rows.chunks_exact(count).collect();
            for (k, state) in states.iter_mut().enumerate() {
                let spread = spread.columns(N * k, N);
                for i in 0..N {
                    state.mean[i] += dot(rows[N * k + i], coefficients);
                    for j in 0..N {
                        state.covariance[i][j] += spread.column(i).dot(&spread.column(j));
                    }
                }
            }
        }
    }
}

impl<const N: usize> Companion<N> for Regressed<'_, N> {
    #[inline(always)]
    fn filtered(&mut self, node: usize, at: &Filtered<'_, N>) {
        self.to.evidence.add(at);
        if !self.errors.is_empty() {
            self.regress(node, at);
        }
    }

    /// The derivatives follow the recursion of the smoother's correction.
    fn returned(&mut self, node: usize, at: &Filtered<'_, N>, _: &Later<N>, _: &Gaussian<N>) {
        let Some(derivatives) = &mut self.found else {
            return;
        };
        let of = &mut self.of;
        let blocks = of.len();
        if (node + 1) * blocks == derivatives.list.len() {
            of.fill([[0.0; LANES]; N]);
        }
        if let Some((sample, found)) = at.sample {
            derivatives.left -= 1;
            let errors = &derivatives.errors[derivatives.left * blocks..][..blocks];
            let per = 1.0 / found.variance.sqrt();
            correct(of, errors, per, &sample.row(), &found.gain);
        }
        let smoothed = &mut derivatives.list[node * blocks..][..blocks];
        add_product(smoothed, &at.predicted.covariance, of);
        if let Some(step) = at.step {
            transform(of, &transposed(&step.transition));
        }
    }
}
