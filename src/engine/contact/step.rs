//! One step of the explicit method on a state of fixed size.

use super::dop853::*;

/// Stages of one step from `start`, along any independent variable.
#[derive(Clone, Debug)]
pub(super) struct Stages<const N: usize> {
    k: [[f64; N]; 13],
    start: [f64; N],
    length: f64,
    end: [f64; N],
}

fn sum<const N: usize, const M: usize>(k: &[[f64; N]], terms: &[Term; M]) -> [f64; N] {
    let mut total = [0.0; N];
    for (stage, weight) in terms {
        for i in 0..N {
            total[i] += weight * k[*stage][i];
        }
    }
    total
}

fn moved<const N: usize, const M: usize>(
    start: &[f64; N],
    length: f64,
    k: &[[f64; N]],
    terms: &[Term; M],
) -> [f64; N] {
    let slope = sum(k, terms);
    std::array::from_fn(|i| start[i] + length * slope[i])
}

/// Sum of the coefficients: the node of a stage.
const fn node<const M: usize>(terms: &[Term; M]) -> f64 {
    let (mut total, mut i) = (0.0, 0);
    while i < M {
        total += terms[i].1;
        i += 1;
    }
    total
}

impl<const N: usize> Stages<N> {
    /// The step of this length. `rates(c, y)` is the rate at `start` variable plus c times the length; `first`
    /// is the one at the start.
    #[inline]
    pub fn new(
        rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N],
        start: &[f64; N],
        first: &[f64; N],
        length: f64,
    ) -> Stages<N> {
        let mut k = [[0.0; N]; 13];
        k[0] = *first;
        macro_rules! stage {
            ($index:literal, $terms:ident) => {
                k[$index] = rates(const { node(&$terms) }, &moved(start, length, &k, &$terms));
            };
        }
        stage!(1, A1);
        stage!(2, A2);
        stage!(3, A3);
        stage!(4, A4);
        stage!(5, A5);
        stage!(6, A6);
        stage!(7, A7);
        stage!(8, A8);
        stage!(9, A9);
        stage!(10, A10);
        stage!(11, A11);
        let end = moved(start, length, &k, &B);
        Stages {
            k,
            start: *start,
            length,
            end,
        }
    }

    /// The state at the end.
    pub fn end(&self) -> &[f64; N] {
        &self.end
    }

    /// Sets the rate at the end, which the dense output needs.
    pub fn set_last_rate(&mut self, rate: [f64; N]) {
        self.k[12] = rate;
    }

    /// Local error in units of `scale`, the root of the mean of squares over `counted` components: the
    /// estimate of order 5, lowered where that of order 3 is larger still (Hairer, Nørsett and Wanner, II.10).
    pub fn error(&self, scale: &[f64; N], counted: usize) -> f64 {
        let (fifth, third) = (sum(&self.k, &E5), sum(&self.k, &E3));
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

    /// The motion inside the step, of order 7; three more evaluations.
    pub fn dense(&self, rates: &mut impl FnMut(f64, &[f64; N]) -> [f64; N]) -> Dense<N> {
        let mut k = [[0.0; N]; 16];
        k[..13].copy_from_slice(&self.k);
        let (start, h) = (&self.start, self.length);
        k[13] = rates(const { node(&A13) }, &moved(start, h, &k, &A13));
        k[14] = rates(const { node(&A14) }, &moved(start, h, &k, &A14));
        k[15] = rates(const { node(&A15) }, &moved(start, h, &k, &A15));
        let higher = [sum(&k, &D0), sum(&k, &D1), sum(&k, &D2), sum(&k, &D3)];
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

/// The motion inside a step, as a function of u in [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Dense<const N: usize> {
    start: [f64; N],
    terms: [[f64; N]; 7],
}

impl<const N: usize> Dense<N> {
    /// The state at u.
    pub fn at(&self, u: f64) -> [f64; N] {
        let rest = 1.0 - u;
        std::array::from_fn(|i| {
            let t = &self.terms;
            let inner = t[3][i] + u * (t[4][i] + rest * (t[5][i] + u * t[6][i]));
            self.start[i] + u * (t[0][i] + rest * (t[1][i] + u * (t[2][i] + rest * inner)))
        })
    }
}
