//! Newton's method on one panel.

use nalgebra::{DMatrix, DVectorViewMut};

use super::panel::PanelTable;
use super::solution::PanelSolution;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values, largest};
use crate::numeric::exponential;

impl PanelSolution {
    /// Converts the change by a sweep, ρ, to the Newton correction for the tabulated forces (in function space,
    /// Kantorovich): δ = ρ + E ∫ r ρ/E with r = ∂F/∂K and the integrating factor E = exp ∫ r. False, without
    /// correction, where E is too steep for its series: that of exp(c x) decays only beyond degree c.
    pub(super) fn linearise<P: Copy>(
        &mut self,
        panel: &PanelTable<P>,
        change: &mut Values,
    ) -> bool {
        let (count, half) = (panel.rule.degree() + 1, panel.half());
        let mut rates = self.forces.rates_of_table(panel);
        let mut factor = panel.rule.integrals(&rates);
        if 0.5 * half.abs() * largest(&factor[..count]) > panel.rule.degree() as f64 {
            return false;
        }
        for factor in &mut factor[..count] {
            *factor *= half;
        }
        factor = exponential::of(&factor);
        for j in 0..count {
            rates[j] *= change[j] / factor[j];
        }
        let more = panel.rule.integrals(&rates);
        let rates = self.forces.rates_of_table(panel);
        let mut of_table = [0.0; MAX_DEGREE + 1];
        for j in 0..count {
            change[j] += half * factor[j] * more[j];
            of_table[j] = rates[j] * change[j];
        }
        self.forces.add(&of_table, count);
        true
    }
}

/// Returns a bound of C in the error C δ² that a Newton sweep leaves of a relative change δ, for forces that are linear
/// in the speed: ½ ∂²F/∂K² = −r/4K with r = ∂F/∂K, whose integral the contraction bounds, as it bounds the logarithm of
/// the integrating factor.
pub(super) fn quadratic(contraction: f64) -> f64 {
    0.25 * contraction * contraction.exp()
}

/// Converts the change by a sweep to the Newton correction: solves (1 − half·S·diag(rates)) δ = change, where S
/// integrates from the start of the panel. None if there is no solution.
pub(super) fn correction(
    rule: &Rule,
    half: f64,
    rates: &Values,
    change: &mut Values,
) -> Option<()> {
    let count = rule.degree() + 1;
    let integrals = rule.integration();
    let matrix = DMatrix::from_fn(count, count, |i, j| {
        f64::from(u8::from(i == j)) - half * integrals[i][j] * rates[j]
    });
    let mut change = DVectorViewMut::from_slice(change, count);
    matrix.lu().solve_mut(&mut change).then_some(())
}

/// Shortens a correction that would leave less than a tenth of the kinetic energy at any point.
pub(super) fn keep_positive(kinetic: &Values, change: &mut Values) {
    let share = |k: f64, c: f64| if c < -0.9 * k { -0.9 * k / c } else { 1.0 };
    let pairs = kinetic.iter().zip(change.iter());
    let least = pairs.fold(1.0f64, |least, (k, c)| least.min(share(*k, *c)));
    if least < 1.0 {
        for c in change {
            *c *= least;
        }
    }
}
