//! How strong the penalty of a spline may be that is hardly more than a polynomial.
//!
//! Samples that a few terms follow do not tell the roughness of what comes after them: a penalty as strong as any is as
//! likely as another one, and its spline has errors that its own roughness does not show. How fast the terms of a polynomial
//! fall off still tells how many of them leave out little.

use std::f64::consts::PI;

use super::penalized::Normal;
use super::roughness::ORDER;
use super::{Polynomial, Size};

/// Parameters up to which a spline is hardly more than a polynomial.
const FEW: f64 = 3.0 * ORDER as f64;

/// Times as many parameters for which an estimate of them is enough.
const CLEARLY: f64 = 4.0;

/// Halvings in the search for a strength.
const HALVINGS: usize = 20;

/// A penalty, at most as strong as this one, that leaves to a spline of few parameters as many as a polynomial needs that
/// leaves out little.
pub(super) fn supported(normal: &Normal<'_>, strength: f64) -> f64 {
    // A penalty as strong as the data cuts off at half of the pieces, one that is stronger where its power makes up for it.
    let cut_off = (normal.mean_pivot() / strength).min(1.0);
    let least = 0.5 / PI * normal.grid.size() as f64 * cut_off.powf(0.5 / ORDER as f64);
    if least > CLEARLY * FEW {
        return strength;
    }
    let parameters = |strength: f64| normal.parameters(strength).unwrap_or(f64::INFINITY);
    if parameters(strength) > FEW {
        return strength;
    }
    let terms = Polynomial::to(normal.rows(), Size::Auto).degree() as f64 + 1.0;
    if terms > FEW || terms <= parameters(strength) {
        return strength;
    }
    let (mut weak, mut strong) = (normal.weakest().min(strength).ln(), strength.ln());
    for _ in 0..HALVINGS {
        let middle = 0.5 * (weak + strong);
        if parameters(middle.exp()) < terms {
            strong = middle;
        } else {
            weak = middle;
        }
    }
    weak.exp()
}
