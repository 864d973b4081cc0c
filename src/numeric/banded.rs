//! Symmetric positive definite matrices with few diagonals.

/// Diagonals that are stored: the main one and seven beside it.
pub const DIAGONALS: usize = 8;

/// A symmetric matrix: row i holds (i, i), (i, i+1), ..., zeros beyond the last column.
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

    /// Row i from the diagonal on.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[f64; DIAGONALS] {
        &self.0[i]
    }

    /// The element of row i and column j, which must be inside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = (i.min(j), i.max(j));
        self.0[i][j - i]
    }

    /// Adds to the element of row i and column j ≥ i.
    #[inline(always)]
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        self.0[i][j - i] += value;
    }

    /// Adds the products of a vector with itself, times a factor, to the rows and columns from `first` on.
    #[inline(always)]
    pub fn add_products(&mut self, first: usize, factor: f64, x: &[f64; DIAGONALS]) {
        for (i, row) in self.0[first..first + DIAGONALS].iter_mut().enumerate() {
            let factor = factor * x[i];
            for k in 0..DIAGONALS - i {
                row[k] += factor * x[i + k];
            }
        }
    }

    /// Adds a smaller matrix to the rows and columns from `first` on.
    pub fn add_from(&mut self, first: usize, part: &Banded) {
        for (sum, part) in self.0[first..].iter_mut().zip(&part.0) {
            sum.iter_mut().zip(part).for_each(|(sum, p)| *sum += p);
        }
    }

    /// Adds another matrix times a factor.
    pub fn add_times(&mut self, factor: f64, other: &Banded) {
        for (sum, other) in self.0.iter_mut().zip(&other.0) {
            sum.iter_mut()
                .zip(other)
                .for_each(|(sum, o)| *sum += factor * o);
        }
    }

    /// The rows of this matrix plus `factor` times the one of the given rows.
    pub fn plus(
        &self,
        factor: f64,
        row: impl Fn(usize) -> [f64; DIAGONALS],
    ) -> impl ExactSizeIterator<Item = [f64; DIAGONALS]> {
        self.0.iter().enumerate().map(move |(i, a)| {
            let b = row(i);
            std::array::from_fn(|k| a[k] + factor * b[k])
        })
    }

    /// This matrix times a vector.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = Vec::with_capacity(x.len());
        // What the rows before add to the next ones.
        let mut ahead = [0.0; DIAGONALS];
        for (i, row) in self.0.iter().enumerate() {
            let right = row.iter().zip(&x[i..]);
            y.push(ahead[0] + right.map(|(a, x)| a * x).sum::<f64>());
            for k in 1..DIAGONALS {
                ahead[k - 1] = ahead[k] + row[k] * x[i];
            }
        }
        y
    }

    /// The block of this matrix that begins at row and column `from`, as wide as the band, times a vector.
    pub fn times_part(&self, from: usize, x: &[f64; DIAGONALS]) -> [f64; DIAGONALS] {
        let mut y = [0.0; DIAGONALS];
        for (i, row) in self.0[from..from + DIAGONALS].iter().enumerate() {
            y[i] += row[0] * x[i];
            for k in 1..DIAGONALS - i {
                y[i] += row[k] * x[i + k];
                y[i + k] += row[k] * x[i];
            }
        }
        y
    }

    /// Trace of the product of this matrix with another.
    pub fn trace_of_product(&self, other: &Banded) -> f64 {
        let row = |(a, b): (&[f64; DIAGONALS], &[f64; DIAGONALS])| {
            let off: f64 = (1..DIAGONALS).map(|k| a[k] * b[k]).sum();
            a[0] * b[0] + 2.0 * off
        };
        self.0.iter().zip(&other.0).map(row).sum()
    }
}

/// Takes the first of these rows from those after it and puts its factors in its place; whether its pivot is positive.
#[inline(always)]
fn eliminate(rows: &mut [[f64; DIAGONALS]]) -> bool {
    let row = rows[0];
    let per_pivot = 1.0 / row[0];
    rows[0] = row.map(|entry| entry * per_pivot);
    rows[0][0] = per_pivot;
    let factors = rows[0];
    for (k, below) in rows.iter_mut().enumerate().skip(1) {
        for m in 0..DIAGONALS - k {
            below[m] -= factors[k] * row[k + m];
        }
    }
    row[0] > 0.0
}

impl FromIterator<[f64; DIAGONALS]> for Banded {
    fn from_iter<I: IntoIterator<Item = [f64; DIAGONALS]>>(rows: I) -> Banded {
        Banded(rows.into_iter().collect())
    }
}

/// Factors of a symmetric matrix L D Lᵀ: row i holds one over the i-th pivot, and the i-th column of L below its diagonal,
/// which is 1.
#[derive(Clone, Debug)]
pub struct Factors(Vec<[f64; DIAGONALS]>);

impl Factors {
    /// The factors of a matrix of these rows = L D Lᵀ (Cholesky, without square roots); none if it is not positive definite.
    pub fn of(mut matrix: impl ExactSizeIterator<Item = [f64; DIAGONALS]>) -> Option<Factors> {
        let size = matrix.len();
        let mut rows = Vec::with_capacity(size);
        for j in 0..size {
            // No sooner than they are needed: what was just made is at hand.
            rows.extend(matrix.by_ref().take(j + DIAGONALS - rows.len()));
            let rest = &mut rows[j..];
            let positive = match rest.first_chunk_mut::<DIAGONALS>() {
                Some(window) => eliminate(window),
                None => eliminate(rest),
            };
            if !positive {
                return None;
            }
        }
        Some(Factors(rows))
    }

    /// Solves L D Lᵀ x = b.
    pub fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = b.to_vec();
        // What the entries before take from the next ones.
        let mut ahead = [0.0; DIAGONALS];
        for (x, row) in x.iter_mut().zip(&self.0) {
            *x -= ahead[0];
            for k in 1..DIAGONALS {
                ahead[k - 1] = ahead[k] + row[k] * *x;
            }
        }
        let mut after = [0.0; DIAGONALS];
        for (x, row) in x.iter_mut().zip(&self.0).rev() {
            let mut sum = *x * row[0];
            // The one that was found last comes last.
            for k in (1..DIAGONALS).rev() {
                sum -= row[k] * after[k];
                after[k] = after[k - 1];
            }
            (after[1], *x) = (sum, sum);
        }
        x
    }

    /// Logarithm of the determinant.
    pub fn log_determinant(&self) -> f64 {
        -self.0.iter().map(|row| row[0].ln()).sum::<f64>()
    }

    /// Square root of the largest pivot over the smallest.
    pub fn diagonal_ratio(&self) -> f64 {
        let (least, most) = self.0.iter().fold((f64::INFINITY, 0.0f64), |(a, b), row| {
            (a.min(row[0]), b.max(row[0]))
        });
        (most / least).sqrt()
    }

    /// The elements of (L D Lᵀ)⁻¹ inside the band, from the last row upwards (Takahashi, Fagan and Chin 1973; Hutchinson and
    /// de Hoog, Numer. Math. 47 (1985) 99).
    pub fn inverse_band(self) -> Banded {
        let Factors(mut rows) = self;
        for i in (0..rows.len()).rev() {
            let rest = &mut rows[i..];
            match rest.first_chunk_mut::<DIAGONALS>() {
                Some(window) => invert(window),
                None => invert(rest),
            }
        }
        Banded(rows)
    }
}

/// Puts a row of the inverse in the place of its factors, before those after it.
#[inline(always)]
fn invert(rows: &mut [[f64; DIAGONALS]]) {
    let row = rows[0];
    let mut found = [0.0; DIAGONALS];
    for (m, below) in rows.iter().enumerate().skip(1) {
        let mut sum = row[m] * below[0];
        for k in 1..DIAGONALS - m {
            sum += row[m + k] * below[k];
            found[m + k] -= row[m] * below[k];
        }
        found[m] -= sum;
    }
    let off: f64 = (1..DIAGONALS).map(|k| row[k] * found[k]).sum();
    found[0] = row[0] - off;
    rows[0] = found;
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
            for k in 0..DIAGONALS.min(size - i) {
                let value = if k == 0 {
                    9.0
                } else {
                    ((i * 7 + k * 3) % 5) as f64 / 4.0 - 0.5
                };
                banded.add(i, i + k, value);
                full[(i, i + k)] = value;
                full[(i + k, i)] = value;
            }
        }
        let factor = Factors::of(banded.0.iter().copied()).expect("positive definite");
        let inverse = full.clone().try_inverse().expect("regular");
        let found = factor.clone().inverse_band();
        for i in 0..size {
            for k in 0..DIAGONALS.min(size - i) {
                assert!((found.get(i + k, i) - inverse[(i + k, i)]).abs() < 1e-14);
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
