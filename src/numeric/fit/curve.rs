//! One type for all fitted curves.

use super::condensed::Rows;
use super::dense;
use super::dependent::Dependent;
use super::outstanding::Terms;
use super::pieces::DEGREE;
use super::{Fourier, MOST_IN_DOUBLE, Polynomial, Quality, Samples, Size, Spline, State};
use crate::numeric::parallel;

/// Kinds of curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// One polynomial.
    Polynomial,
    /// A smoothing spline.
    Spline,
    /// Steady rotation with harmonics.
    Fourier,
}

impl Kind {
    /// All of them.
    pub const ALL: [Kind; 3] = [Kind::Polynomial, Kind::Spline, Kind::Fourier];

    /// Its name in options and outputs.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Polynomial => "polynomial",
            Kind::Spline => "spline",
            Kind::Fourier => "fourier",
        }
    }

    /// What stands for samples in fits of this kind and size: the samples, or narrow blocks of very many. They may have been
    /// computed, with a standard deviation of `computed`.
    pub fn rows<'a>(self, samples: &Samples<'a>, size: Size, computed: f64) -> Rows<'a> {
        match self {
            // What double-double arithmetic gives would be lost with the rounding of blocks.
            Kind::Polynomial if samples.t.len() <= MOST_IN_DOUBLE => Rows::from(samples),
            Kind::Spline => Rows::new(samples, Spline::unit(size), computed),
            _ => Rows::new(samples, 1, computed),
        }
    }

    /// Number of parameters of a curve of this size; of a spline without its penalty.
    fn parameters(self, size: usize) -> usize {
        match self {
            Kind::Polynomial => size + 1,
            Kind::Spline => size + DEGREE,
            Kind::Fourier => 2 * size + 2,
        }
    }
}

/// A fitted curve.
#[derive(Clone, Debug)]
pub enum Curve {
    /// One polynomial.
    Polynomial(Polynomial),
    /// A smoothing spline.
    Spline(Spline),
    /// Steady rotation with harmonics.
    Fourier(Box<Fourier>),
}

impl Curve {
    /// Fits a curve.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn fit(samples: &Samples<'_>, kind: Kind, size: Size) -> Result<Curve, String> {
        let computed = match kind {
            // What a polynomial cannot follow in a block it cannot follow anyway.
            Kind::Polynomial => f64::INFINITY,
            _ => samples.computed(),
        };
        let rows = kind.rows(samples, size, computed);
        let curve = Curve::to(&rows, kind, size)?;
        if curve.is_seen_by(&rows) {
            return Ok(curve);
        }
        Curve::to(&Rows::from(samples), kind, size)
    }

    /// Fits a curve to rows.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn to(rows: &Rows<'_>, kind: Kind, size: Size) -> Result<Curve, String> {
        if let Size::Fixed(size) = size {
            let counting = rows.counting();
            let parameters = kind.parameters(size);
            if kind == Kind::Spline && size == 0 {
                return Err("a spline has at least one piece".to_owned());
            }
            if counting <= parameters {
                return Err(format!(
                    "{counting} samples are too few for {parameters} parameters"
                ));
            }
        }
        match kind {
            Kind::Polynomial => Ok(Curve::Polynomial(Polynomial::to(rows, size))),
            Kind::Spline => Spline::to(rows, size).map(Curve::Spline),
            Kind::Fourier => Fourier::to(rows, size).map(|fit| Curve::Fourier(Box::new(fit))),
        }
    }

    /// The curve alone.
    pub fn value(&self, t: f64) -> f64 {
        match self {
            Curve::Polynomial(polynomial) => polynomial.value(t),
            Curve::Spline(spline) => spline.value(t),
            Curve::Fourier(fourier) => fourier.value(t),
        }
    }

    /// The curve alone at many arguments.
    pub fn values(&self, t: &[f64]) -> Vec<f64> {
        match self {
            Curve::Polynomial(polynomial) => polynomial.values(t),
            Curve::Spline(spline) => parallel::list(t.len(), |i| spline.value(t[i])),
            Curve::Fourier(fourier) => fourier.values(t),
        }
    }

    /// Fits a curve of the same terms, under the same penalty, to rows of almost the same motion: it is near.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn again(&self, rows: &Rows<'_>) -> Result<Curve, String> {
        match self {
            Curve::Polynomial(polynomial) => Ok(Curve::Polynomial(polynomial.again(rows))),
            Curve::Spline(spline) => spline.again(rows).map(Curve::Spline),
            Curve::Fourier(fourier) => fourier.again(rows).map(|fit| Curve::Fourier(Box::new(fit))),
        }
    }

    /// The same, and whether its errors are its own: those of a spline take most of the time, and stay as they are.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn moved(self, rows: &Rows<'_>) -> Result<(Curve, bool), String> {
        match self {
            Curve::Spline(spline) => Ok((Curve::Spline(spline.moved(rows)?), false)),
            other => Ok((other.again(rows)?, true)),
        }
    }

    /// Whether blocks of samples are narrow enough for what the curve does in one, and for what the samples ask for.
    pub fn is_seen_by(&self, rows: &Rows<'_>) -> bool {
        let waves = match self {
            Curve::Polynomial(polynomial) => polynomial.degree().pow(2) as f64,
            Curve::Spline(spline) if spline.wants_more() => f64::INFINITY,
            Curve::Spline(spline) => spline.pieces() as f64,
            Curve::Fourier(fourier) => return fourier.is_seen_by(rows),
        };
        rows.blocks().is_none_or(|blocks| waves <= blocks as f64)
    }

    /// Whether the samples support more terms than were allowed.
    pub fn is_cut_short(&self) -> bool {
        match self {
            Curve::Polynomial(polynomial) => polynomial.is_cut_short(),
            Curve::Spline(_) | Curve::Fourier(_) => false,
        }
    }

    /// Counts errors of the targets, which depend on each other, as what may be wrong with the curve.
    ///
    /// # Errors
    /// A text that says why the samples do not serve.
    pub fn admit(&mut self, samples: &Samples<'_>, errors: Dependent<'_>) -> Result<(), String> {
        match self {
            Curve::Polynomial(polynomial) => {
                let terms = Terms::outstanding(polynomial, samples, errors);
                let errors = errors.beside_motions(&terms, samples);
                polynomial.admit(samples, &errors);
            }
            Curve::Spline(spline) => spline.admit(samples, errors)?,
            Curve::Fourier(fourier) => {
                let errors = errors.beside_motions(&**fourier, samples);
                fourier.admit(samples, &errors);
            }
        }
        Ok(())
    }

    /// Estimates the error of a curve that goes through its samples, if it does, from curves through fewer of them, and
    /// their noise from their differences; whether it has done so.
    pub fn compare(&mut self, samples: &Samples<'_>) -> bool {
        match self {
            Curve::Polynomial(_) | Curve::Fourier(_) => false,
            Curve::Spline(spline) => spline.compare(samples),
        }
    }

    /// The curve and its derivatives.
    pub fn state(&self, t: f64) -> State {
        match self {
            Curve::Polynomial(polynomial) => polynomial.state(t),
            Curve::Spline(spline) => spline.state(t),
            Curve::Fourier(fourier) => fourier.state(t),
        }
    }

    /// Its values alone.
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        match self {
            Curve::Spline(spline) => spline.derivatives(t),
            other => other.state(t).value,
        }
    }

    /// How often a sample counts in the curve at the next one, for samples this far apart, in all: a slow curve is about
    /// the same there.
    pub fn shared(&self, step: f64) -> f64 {
        match self {
            Curve::Fourier(fourier) => fourier.shared(step),
            other => other.quality().parameters,
        }
    }

    /// The states at rising arguments, to rounding.
    pub fn states(&self, t: &[f64]) -> Vec<State> {
        let mut states = Vec::with_capacity(t.len());
        let smooth = |t: &[f64]| match self {
            Curve::Polynomial(_) | Curve::Fourier(_) => t.len(),
            Curve::Spline(spline) => spline.grid().in_one_piece(t),
        };
        dense::states(t, smooth, |t| self.state(t), |state| states.push(state));
        states
    }

    /// What it leaves of the samples.
    pub fn quality(&self) -> Quality {
        match self {
            Curve::Polynomial(polynomial) => polynomial.quality(),
            Curve::Spline(spline) => spline.quality(),
            Curve::Fourier(fourier) => fourier.quality(),
        }
    }

    /// Its kind.
    pub fn kind(&self) -> Kind {
        match self {
            Curve::Polynomial(_) => Kind::Polynomial,
            Curve::Spline(_) => Kind::Spline,
            Curve::Fourier(_) => Kind::Fourier,
        }
    }

    /// Degree of the polynomial or of the spline's pieces, number of harmonics.
    pub fn degree(&self) -> usize {
        match self {
            Curve::Spline(_) => DEGREE,
            other => other.size(),
        }
    }

    /// Coefficients, their standard errors for samples of unit variance, and the condition number that belongs to
    /// them.
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
            Curve::Spline(spline) => spline.coefficients(),
            Curve::Fourier(fourier) => fourier.coefficients(),
        }
    }

    /// Degree of the polynomial, number of pieces of the spline, number of harmonics.
    pub fn size(&self) -> usize {
        match self {
            Curve::Polynomial(polynomial) => polynomial.degree(),
            Curve::Spline(spline) => spline.pieces(),
            Curve::Fourier(fourier) => fourier.harmonics(),
        }
    }
}
