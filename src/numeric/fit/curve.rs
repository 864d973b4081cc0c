//! One type for all fitted curves.

use super::{Polynomial, Quality, Samples, Size, State};

/// Kinds of curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One polynomial.
    Polynomial,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 1] = [Kind::Polynomial];

    /// Its name in options and outputs.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Polynomial => "polynomial",
        }
    }
}

/// A fitted curve.
#[derive(Clone, Debug)]
pub enum Curve {
    /// One polynomial.
    Polynomial(Polynomial),
}

impl Curve {
    /// Fits a curve.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, kind: Kind, size: Size) -> Result<Curve, String> {
        match kind {
            Kind::Polynomial => {
                enough(samples, size, |degree| degree + 1)?;
                Ok(Curve::Polynomial(Polynomial::fit(samples, size)))
            }
        }
    }

    /// The curve and its derivatives.
    pub fn state(&self, t: f64) -> State {
        match self {
            Curve::Polynomial(polynomial) => polynomial.state(t),
        }
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        match self {
            Curve::Polynomial(polynomial) => polynomial.quality(),
        }
    }

    /// Its kind.
    pub fn kind(&self) -> Kind {
        match self {
            Curve::Polynomial(_) => Kind::Polynomial,
        }
    }

    /// Degree of the polynomial or of the spline's pieces, number of harmonics.
    pub fn degree(&self) -> usize {
        match self {
            Curve::Polynomial(polynomial) => polynomial.degree(),
        }
    }

    /// Coefficients, their standard errors for samples of unit variance, and the condition number of the design
    /// matrix that belongs to them.
    pub fn coefficients(&self) -> (Vec<f64>, Vec<f64>, f64) {
        match self {
            Curve::Polynomial(polynomial) => {
                let powers = polynomial.powers();
                (
                    powers.coefficients.clone(),
                    powers.errors.clone(),
                    powers.condition,
                )
            }
        }
    }

    /// Degree of the polynomial, number of harmonics.
    pub fn size(&self) -> usize {
        match self {
            Curve::Polynomial(polynomial) => polynomial.degree(),
        }
    }
}

/// Whether there are more samples that count than parameters.
fn enough(
    samples: &Samples<'_>,
    size: Size,
    parameters: impl Fn(usize) -> usize,
) -> Result<(), String> {
    let counting = match samples.weight {
        Some(weight) => weight.iter().filter(|w| **w != 0.0).count(),
        None => samples.t.len(),
    };
    match size {
        Size::Fixed(size) if counting <= parameters(size) => Err(format!(
            "{counting} samples are too few for {} parameters",
            parameters(size)
        )),
        _ => Ok(()),
    }
}
