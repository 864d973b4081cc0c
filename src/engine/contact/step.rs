//! One step of DOP853 on a state of fixed size.

use super::dop853::{DENSE, DENSE_STAGES, ERRORS, STAGES, Term};

/// Stages of one step from `start`, along any independent variable.
#[derive(Clone, Debug)]
pub(super) struct Stages<const N: usize> {
    k: [[f64; N]; 13],
    start: [f64; N],
    length: f64,
    end: [f64; N],
}

#[inline(always)]
fn sum<const N: usize>(k: &[[f64; N]], terms: &[Term]) -> [f64; N] {
    let mut total = [0.0; N];
    for (stage, weight) in terms {
        for i in 0..N {
            total[i] += weight * k[*stage][i];
        }
    }
    total
}

#[inline(always)]
fn moved<const N: usize>(
    start: &[f64; N],
    length: f64,
    k: &[[f64; N]],
    terms: &[Term],
) -> [f64; N] {
    let slope = sum(k, terms);
    std::array::from_fn(|i| start[i] + length * slope[i])
}

/// Node of a stage: the sum of its coefficients.
const fn node(terms: &[Term]) -> f64 {
    let (mut total, mut i) = (0.0, 0);
    while i < terms.len() {
        total += terms[i].1;
        i += 1;
    }
    total
}

impl<const N: usize> Stages<N> {
    /// Computes the step of this length. `rates(c, y)` is the rate at the fraction c of the step, `first` the rate at
    /// its start.
    #[inline]
    pub fn new(
        rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N],
        start: &[f64; N],
        first: &[f64; N],
        length: f64,
    ) -> Stages<N> {
        let mut k = [[0.0; N]; 13];
        k[0] = *first;
        macro_rules! stages {
            ($($index:literal)*) => {$(
                let terms = const { STAGES[$index - 1] };
                k[$index] = rates(const { node(STAGES[$index - 1]) }, &moved(start, length, &k, terms));
            )*};
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11);
        let end = moved(start, length, &k, STAGES[11]);
        Stages {
            k,
            start: *start,
            length,
            end,
        }
    }

    /// Returns the state at the end.
    pub fn end(&self) -> &[f64; N] {
        &self.end
    }

    /// Sets the rate at the end, which the dense output needs.
    pub fn set_last_rate(&mut self, rate: [f64; N]) {
        self.k[12] = rate;
    }

    /// Estimates the local error in units of `scale`, root mean square over the first `counted` components: the
    /// estimate of order 5, reduced where that of order 3 is larger still (Hairer, Nørsett and Wanner, II.10).
    pub fn error(&self, scale: &[f64; N], counted: usize) -> f64 {
        let (fifth, third) = (sum(&self.k, ERRORS[0]), sum(&self.k, ERRORS[1]));
        let (mut five, mut three) = (0.0, 0.0);
        for i in 0..counted {
            let (a, b) = (fifth[i] / scale[i], third[i] / scale[i]);
            five += a * a;
            three += b * b;
        }
        if five == 0.0 && three == 0.0 {
            return 0.0;
        }
        self.length.abs() * five / ((five + 0.01 * three) * counted as f64).sqrt()
    }

    /// Computes the dense output of order 7; three more evaluations.
    pub fn dense(&self, rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N]) -> Dense<N> {
        let mut k = [[0.0; N]; 16];
        k[..13].copy_from_slice(&self.k);
        let (start, h) = (&self.start, self.length);
        for (stage, terms) in DENSE_STAGES.into_iter().enumerate() {
            k[13 + stage] = rates(node(terms), &moved(start, h, &k, terms));
        }
        let higher = DENSE.map(|terms| sum(&k, terms));
        let mut terms = [[0.0; N]; 7];
        for i in 0..N {
            let rise = self.end[i] - start[i];
            terms[0][i] = rise;
            terms[1][i] = h * k[0][i] - rise;
            terms[2][i] = 2.0 * rise - h * (k[12][i] + k[0][i]);
            for (term, higher) in terms[3..].iter_mut().zip(&higher) {
                term[i] = h * higher[i];
            }
        }
        Dense {
            start: *start,
            terms,
        }
    }
}

/// Dense output of a step, as a function of u in [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Dense<const N: usize> {
    start: [f64; N],
    terms: [[f64; N]; 7],
}

impl<const N: usize> Dense<N> {
    /// Returns the state at u.
    pub fn at(&self, u: f64) -> [f64; N] {
        let rest = 1.0 - u;
        std::array::from_fn(|i| {
            let t = &self.terms;
            let inner = t[3][i] + u * (t[4][i] + rest * (t[5][i] + u * t[6][i]));
            self.start[i] + u * (t[0][i] + rest * (t[1][i] + u * (t[2][i] + rest * inner)))
        })
    }
}
