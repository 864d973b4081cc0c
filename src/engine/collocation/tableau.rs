//! Nodes and coefficients of Gauss collocation for θ̈ = f(t, θ, θ̇), computed from Legendre polynomials (Hairer,
//! Nørsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed., sections II.7 and II.14).

use std::sync::OnceLock;

use super::super::NODES;
use super::super::step::TERMS;
use crate::numeric::gauss;

/// Coefficients on the step [0, 1], s = (1 + x)/2. ℓ_j: Lagrange polynomial of degree n − 1, 1 at node j, 0 at the
/// others.
#[derive(Clone, Debug)]
pub struct Tableau {
    /// Nodes c_i.
    pub nodes: [f64; NODES],
    /// ∫ ℓ_j from 0 to c_i, as row j: all i are summed side by side.
    pub speed: [[f64; NODES]; NODES],
    /// ∫∫ ℓ_j from 0 to c_i, as row j.
    pub angle: [[f64; NODES]; NODES],
    /// Weights ∫ ℓ_j from 0 to 1.
    pub end_speed: [f64; NODES],
    /// Weights ∫∫ ℓ_j from 0 to 1.
    pub end_angle: [f64; NODES],
    /// Legendre coefficient k of ℓ_j, as row j.
    pub legendre: [[f64; NODES]; NODES],
    /// Legendre polynomial k integrated twice from s = 0, in powers of x.
    pub powers: [[f64; TERMS]; NODES],
    /// Lebesgue constant of the ends, Σ |ℓ_j(1)|: how much the polynomial there magnifies errors at the nodes.
    pub lebesgue: f64,
}

impl Tableau {
    /// Returns the tableau, which is computed once.
    pub fn get() -> &'static Tableau {
        static TABLEAU: OnceLock<Tableau> = OnceLock::new();
        TABLEAU.get_or_init(Tableau::new)
    }

    fn new() -> Tableau {
        let rule: [(f64, f64); NODES] =
            std::array::from_fn(|j| gauss::legendre(NODES as u32, NODES - 1 - j));
        let legendre: [[f64; NODES]; NODES] = std::array::from_fn(|k| {
            std::array::from_fn(|j| {
                let (s, weight) = rule[j];
                (2 * k + 1) as f64 * weight * polynomials(s)[k]
            })
        });
        let at_end = |j| (0..NODES).map(|k| legendre[k][j]).sum::<f64>();
        let of_values = |s: f64, integral: fn(&[f64; NODES + 3], f64, usize) -> f64| {
            let p = polynomials(s);
            std::array::from_fn(|j| {
                (0..NODES)
                    .map(|k| integral(&p, s, k) * legendre[k][j])
                    .sum()
            })
        };
        Tableau {
            nodes: rule.map(|(s, _)| s),
            speed: transposed(rule.map(|(s, _)| of_values(s, once))),
            angle: transposed(rule.map(|(s, _)| of_values(s, twice))),
            end_speed: rule.map(|(_, weight)| weight),
            end_angle: rule.map(|(s, weight)| weight * (1.0 - s)),
            lebesgue: (0..NODES).map(|j| at_end(j).abs()).sum(),
            legendre: transposed(legendre),
            powers: powers(),
        }
    }
}

fn transposed(rows: [[f64; NODES]; NODES]) -> [[f64; NODES]; NODES] {
    std::array::from_fn(|j| std::array::from_fn(|i| rows[i][j]))
}

/// Evaluates the Legendre polynomials of x = 2s − 1 by their recurrence (Abramowitz and Stegun, 22.7.10).
fn polynomials(s: f64) -> [f64; NODES + 3] {
    let x = 2.0 * s - 1.0;
    let mut p = [1.0; NODES + 3];
    p[1] = x;
    for k in 1..NODES + 2 {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
    }
    p
}

/// Integrates P_k from 0 to s: (P_{k+1} − P_{k−1})/(2(2k + 1)).
fn once(p: &[f64; NODES + 3], s: f64, k: usize) -> f64 {
    if k == 0 {
        return s;
    }
    (p[k + 1] - p[k - 1]) / (2 * (2 * k + 1)) as f64
}

/// Integrates P_k twice from 0 to s.
fn twice(p: &[f64; NODES + 3], s: f64, k: usize) -> f64 {
    if k == 0 {
        return 0.5 * s * s;
    }
    (once(p, s, k + 1) - once(p, s, k - 1)) / (2 * (2 * k + 1)) as f64
}

/// Integrates P_k twice from s = 0, in powers of x.
fn powers() -> [[f64; TERMS]; NODES] {
    let mut p = [[0.0; TERMS]; NODES + 2];
    p[0][0] = 1.0;
    p[1][1] = 1.0;
    for k in 1..NODES + 1 {
        let n = k as f64;
        for i in 0..TERMS {
            let shifted = if i == 0 { 0.0 } else { p[k][i - 1] };
            p[k + 1][i] = ((2.0 * n + 1.0) * shifted - n * p[k - 1][i]) / (n + 1.0);
        }
    }
    std::array::from_fn(|k| {
        let mut once = [0.0; TERMS];
        let mut twice = [0.0; TERMS];
        integrate(&p[k], &mut once);
        integrate(&once, &mut twice);
        twice
    })
}

/// Integrates from x = −1, times ds/dx = 1/2.
fn integrate(of: &[f64; TERMS], to: &mut [f64; TERMS]) {
    let mut at_start = 0.0;
    for i in 1..TERMS {
        to[i] = 0.5 * of[i - 1] / i as f64;
        at_start += if i % 2 == 0 { to[i] } else { -to[i] };
    }
    to[0] = -at_start;
}
