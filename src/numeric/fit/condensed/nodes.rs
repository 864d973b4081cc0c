//! The Gauss nodes of blocks of samples.

use nalgebra::{SMatrix, SymmetricEigen};

use super::NODES;
use crate::numeric::fit::Samples;
use crate::numeric::orthogonal;

/// What stands for some blocks.
#[derive(Debug, Default)]
pub(super) struct Part {
    /// Argument, weight and target.
    pub rows: Vec<[f64; 3]>,
    /// Where the rows of each block end.
    pub ends: Vec<usize>,
    /// Squares that are in no row.
    pub left: f64,
}

impl Part {
    /// Adds what stands for the samples of a block.
    pub fn take(&mut self, block: &Samples<'_>) {
        let weight = |i: usize| block.weight.map_or(1.0, |weight| weight[i]);
        let counting = || (0..block.t.len()).filter(|i| weight(*i) != 0.0);
        let found = (counting().count() > NODES).then(|| {
            let enough = |squares: &[f64]| squares.len() < NODES;
            orthogonal::fit::<f64>(block.t, block.target, block.weight, enough)
        });
        let Some(found) = found.filter(|found| found.coefficients.len() == NODES) else {
            let nothing = (0..block.t.len()).filter(|i| weight(*i) == 0.0);
            self.left += nothing.map(|i| block.target[i].powi(2)).sum::<f64>();
            for i in counting() {
                self.rows.push([block.t[i], weight(i), block.target[i]]);
            }
            return;
        };
        self.left += found.squares[NODES - 1];
        let jacobi = SMatrix::<f64, NODES, NODES>::from_fn(|i, j| match i.abs_diff(j) {
            0 => found.centres[i],
            1 => found.norms[i.max(j)],
            _ => 0.0,
        });
        let SymmetricEigen {
            eigenvalues,
            eigenvectors,
        } = jacobi.symmetric_eigen();
        let mut order: [usize; NODES] = std::array::from_fn(|i| i);
        order.sort_by(|a, b| eigenvalues[*a].total_cmp(&eigenvalues[*b]));
        for node in order {
            let vector = eigenvectors.column(node);
            let values = found.coefficients.iter().zip(vector.iter());
            self.rows.push([
                found.middle + found.half * eigenvalues[node],
                found.norms[0] * vector[0],
                values.map(|(c, v)| c * v).sum(),
            ]);
        }
    }
}
