//! First-order approximation of the slider motion in r/l and e/l, as the literature uses it.

use super::Linkage;

/// Slider motion to first order in r/l and e/l: l cos φ taken as l − (e + r sin θ)²/(2 l).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstOrder {
    /// x'', m/rad²; for e = 0 Obaseki & Alfred (52), −r (cos θ + (r/l) cos 2θ).
    pub d2x: f64,
    /// x' x'' without terms of second order, m²; for e = 0 Obaseki & Alfred (53) is −m ω² times this product.
    pub dx_d2x: f64,
}

impl Linkage {
    /// Computes the first-order motion at a crank angle, rad.
    pub fn first_order(&self, theta: f64) -> FirstOrder {
        let Linkage { r, l, e, s, .. } = *self;
        let (sin, cos) = theta.sin_cos();
        let (u, cos_2) = (e + r * sin, (cos - sin) * (cos + sin));
        let tilt = r * cos_2 - e * sin;
        FirstOrder {
            d2x: -r * cos - s * r * tilt / l,
            dx_d2x: r * r * (sin * cos + s * (sin * tilt + u * cos * cos) / l),
        }
    }
}
