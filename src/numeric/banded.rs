//! Symmetric positive definite matrices with few diagonals.

/// Diagonals of the lower triangle that are stored: the main one and seven below it.
pub const DIAGONALS: usize = 8;

/// The lower triangle of a symmetric matrix, or a lower triangular one: row i holds (i, i), (i, i−1), ...
#[derive(Clone, Debug)]
pub struct Banded(Vec<[f64; DIAGONALS]>);

impl Banded {
    /// Zeros.
    pub fn new(size: usize) -> Banded {
        Banded(vec![[0.0; DIAGONALS]; size])
    }

    /// Rows and columns.
    pub fn size(&self) -> usize {
        self.0.len()
    }

    /// Row i of the lower triangle, from the diagonal back.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[f64; DIAGONALS] {
        &self.0[i]
    }

    /// The element of row i and column j of a symmetric matrix, which must be inside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.max(j), i.min(j));
        self.0[i][i - j]
    }

    /// Adds to the element of row i and column j ≤ i.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        self.0[i][i - j] += value;
    }

    /// Adds a smaller matrix to the rows and columns from `first` on.
    pub fn add_from(&mut self, first: usize, part: &Banded) {
        for (sum, part) in self.0[first..].iter_mut().zip(&part.0) {
            sum.iter_mut().zip(part).for_each(|(sum, p)| *sum += p);
        }
    }

    /// This matrix plus `factor` times another.
    pub fn plus(&self, factor: f64, other: &Banded) -> Banded {
        let rows = self.0.iter().zip(&other.0);
        Banded(
            rows.map(|(a, b)| std::array::from_fn(|k| a[k] + factor * b[k]))
                .collect(),
        )
    }

    /// This symmetric matrix times a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for (i, row) in self.0.iter().enumerate() {
            y[i] += row[0] * x[i];
            for (k, value) in row.iter().enumerate().take(i + 1).skip(1) {
                y[i] += value * x[i - k];
                y[i - k] += value * x[i];
            }
        }
        y
    }

    /// The block of this symmetric matrix that begins at row and column `from`, as wide as the band, times a vector.
    pub fn times_part(&self, from: usize, x: &[f64; DIAGONALS]) -> [f64; DIAGONALS] {
        let mut y = [0.0; DIAGONALS];
        for (i, row) in self.0[from..from + DIAGONALS].iter().enumerate() {
            y[i] += row[0] * x[i];
            for k in 1..=i {
                y[i] += row[k] * x[i - k];
                y[i - k] += row[k] * x[i];
            }
        }
        y
    }

    /// The factor L of this matrix = L Lᵀ (Cholesky); none if it is not positive definite.
    pub fn cholesky(self) -> Option<Banded> {
        let mut l = self;
        for i in 0..l.size() {
            for k in (0..DIAGONALS.min(i + 1)).rev() {
                let j = i - k;
                let mut sum = l.0[i][k];
                for m in k + 1..DIAGONALS.min(i + 1) {
                    if m - k < DIAGONALS {
                        sum -= l.0[i][m] * l.0[j][m - k];
                    }
                }
                l.0[i][k] = if k > 0 {
                    sum / l.0[j][0]
                } else if sum > 0.0 {
                    sum.sqrt()
                } else {
                    return None;
                };
            }
        }
        Some(l)
    }

    /// Solves L Lᵀ x = b for this factor L.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        for i in 0..x.len() {
            for k in 1..DIAGONALS.min(i + 1) {
                x[i] -= self.0[i][k] * x[i - k];
            }
            x[i] /= self.0[i][0];
        }
        for i in (0..x.len()).rev() {
            x[i] /= self.0[i][0];
            for k in 1..DIAGONALS.min(i + 1) {
                x[i - k] -= self.0[i][k] * x[i];
            }
        }
        x
    }

    /// Logarithm of the determinant of L Lᵀ for this factor L.
    pub fn log_determinant(&self) -> f64 {
        2.0 * self.0.iter().map(|row| row[0].ln()).sum::<f64>()
    }

    /// Largest over smallest diagonal element.
    pub fn diagonal_ratio(&self) -> f64 {
        let (least, most) = self.0.iter().fold((f64::INFINITY, 0.0f64), |(a, b), row| {
            (a.min(row[0]), b.max(row[0]))
        });
        most / least
    }

    /// The elements of (L Lᵀ)⁻¹ inside the band, for this factor L, from its last row upwards (Takahashi, Fagan and Chin
    /// 1973; Hutchinson and de Hoog, Numer. Math. 47 (1985) 99).
    pub fn inverse_band(&self) -> Banded {
        let size = self.size();
        let mut inverse = Banded::new(size);
        for i in (0..size).rev() {
            let below = (size - 1 - i).min(DIAGONALS - 1);
            let diagonal = self.0[i][0];
            for j in (i..=i + below).rev() {
                let mut sum = 0.0;
                for k in i + 1..=i + below {
                    sum -= self.0[k][k - i] * inverse.get(k, j);
                }
                let value = if j == i {
                    (1.0 / diagonal + sum) / diagonal
                } else {
                    sum / diagonal
                };
                inverse.0[j][j - i] = value;
            }
        }
        inverse
    }

    /// Trace of the product of this symmetric matrix with another.
    pub fn trace_of_product(&self, other: &Banded) -> f64 {
        let row = |(a, b): (&[f64; DIAGONALS], &[f64; DIAGONALS])| {
            let off: f64 = (1..DIAGONALS).map(|k| a[k] * b[k]).sum();
            a[0] * b[0] + 2.0 * off
        };
        self.0.iter().zip(&other.0).map(row).sum()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::*;

    #[test]
    fn as_a_full_matrix_has_it() {
        let size = 12;
        let mut banded = Banded::new(size);
        let mut full = DMatrix::zeros(size, size);
        for i in 0..size {
            for k in 0..DIAGONALS.min(i + 1) {
                let value = if k == 0 {
                    9.0
                } else {
                    ((i * 7 + k * 3) % 5) as f64 / 4.0 - 0.5
                };
                banded.add(i, i - k, value);
                full[(i, i - k)] = value;
                full[(i - k, i)] = value;
            }
        }
        let factor = banded.clone().cholesky().expect("positive definite");
        let inverse = full.clone().try_inverse().expect("regular");
        let found = factor.inverse_band();
        for i in 0..size {
            for k in 0..DIAGONALS.min(i + 1) {
                assert!((found.get(i, i - k) - inverse[(i, i - k)]).abs() < 1e-14);
            }
        }
        let part = full.fixed_view::<DIAGONALS, DIAGONALS>(3, 3);
        let vector: [f64; DIAGONALS] = std::array::from_fn(|i| i as f64 - 2.5);
        let expected = part * nalgebra::SVector::from(vector);
        let found = banded.times_part(3, &vector);
        assert!((0..DIAGONALS).all(|i| (found[i] - expected[i]).abs() < 1e-13));
        assert!((factor.log_determinant() - full.determinant().ln()).abs() < 1e-12);
        let b: Vec<f64> = (0..size).map(|i| i as f64).collect();
        let back = banded.times(&factor.solve(&b));
        assert!(back.iter().zip(&b).all(|(x, y)| (x - y).abs() < 1e-12));
    }
}
