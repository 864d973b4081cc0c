//! Comparison of one printed number or formula with the computed value, and its verdict.

use serde::{Serialize, Serializer};

named! {
    /// Verdict on a printed number or formula.
    pub enum Verdict {
        /// The computed value agrees with the printed one.
        Reproduces = "reproduces",
        /// The printed value reproduces only under the stated condition.
        OnlyIf = "reproduces only if",
        /// The printed value does not reproduce, and no condition is known under which it would.
        Cannot = "cannot be reproduced",
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// Printed number or formula with the computed value.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Name of the paper.
    pub paper: &'static str,
    /// Equation, table or passage.
    pub place: String,
    /// Description of the compared quantity.
    pub what: String,
    /// Unit of all values.
    pub unit: String,
    /// Number as printed, or value of the printed formula.
    pub printed: String,
    /// Computed value; none where the paper lacks the data for it.
    pub ours: Option<f64>,
    /// Value under `condition`: with other data, or by the corrected formula.
    pub conditional: Option<f64>,
    /// Assumption or correction under which the printed value reproduces, or the reason why none is known.
    pub condition: String,
    /// Verdict of the comparison.
    pub verdict: Verdict,
    /// Verdict on record.
    pub expected: Verdict,
}

/// Printed value, in the form in which it is compared.
#[derive(Clone, Debug)]
pub(super) enum Printed {
    /// Number as text, its value, and the tolerance.
    Number(String, f64, f64),
    /// Value of a formula.
    Formula(f64),
}

/// Relative difference up to which two formulas agree: rounding gives 1e-15, a numerical derivative 1e-12; formulas
/// that disagree differ by 7e-5 or more.
const FORMULA_ROUNDING: f64 = 1e-9;

impl Printed {
    /// Returns a printed number, with a tolerance of half a unit of its last digit.
    pub fn number(text: &str, value: f64) -> Printed {
        let decimals = text.split_once('.').map_or(0, |(_, digits)| digits.len());
        let half = 0.5 * 10f64.powi(-(decimals as i32));
        Printed::Number(text.to_owned(), value, half * (1.0 + FORMULA_ROUNDING))
    }

    /// Returns printed words that stand for the range of values between two.
    pub fn between(words: &str, [least, most]: [f64; 2]) -> Printed {
        Printed::Number(words.to_owned(), 0.5 * (least + most), 0.5 * (most - least))
    }

    /// Returns the number as printed, or the value of the formula.
    pub fn text(&self) -> String {
        match self {
            Printed::Number(text, ..) => text.clone(),
            Printed::Formula(value) => format!("{value}"),
        }
    }

    /// Returns the verdict from the computed and the conditional value; `cut`: the conditional number may be truncated.
    pub fn verdict(&self, ours: Option<f64>, conditional: Option<f64>, cut: bool) -> Verdict {
        let (holds, holds_if) = match *self {
            Printed::Number(_, value, tolerance) => {
                let near = |candidate: f64| (candidate - value).abs() <= tolerance;
                let cut = |candidate: f64| {
                    let past = candidate.abs() - value.abs();
                    cut && (0.0..2.0 * tolerance).contains(&past)
                };
                (
                    ours.is_some_and(near),
                    conditional.is_some_and(|c| near(c) || cut(c)),
                )
            }
            Printed::Formula(value) => {
                let Some(ours) = ours else {
                    return Verdict::Cannot;
                };
                // For a computed zero the printed value sets the scale.
                let size = if ours == 0.0 { value.abs() } else { ours.abs() };
                let same = |a: f64| (a - ours).abs() <= FORMULA_ROUNDING * size;
                (same(value), conditional.is_some_and(same))
            }
        };
        match (holds, holds_if) {
            (true, _) => Verdict::Reproduces,
            (_, true) => Verdict::OnlyIf,
            _ => Verdict::Cannot,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_holds_within_half_of_its_last_digit() {
        let of = |ours: f64, conditional: f64, cut: bool| {
            Printed::number("12.50", 12.5).verdict(Some(ours), Some(conditional), cut)
        };
        assert_eq!(of(12.5049, f64::NAN, false), Verdict::Reproduces);
        assert_eq!(of(12.5051, f64::NAN, false), Verdict::Cannot);
        assert_eq!(of(12.6, 12.495, false), Verdict::OnlyIf);
        assert_eq!(of(12.6, 12.509, false), Verdict::Cannot);
        assert_eq!(of(12.6, 12.509, true), Verdict::OnlyIf);
        assert_eq!(of(12.6, 12.511, true), Verdict::Cannot);
        assert_eq!(of(12.6, 12.494, true), Verdict::Cannot);
        assert_eq!(of(f64::NAN, f64::NAN, false), Verdict::Cannot);
    }

    #[test]
    fn a_formula_holds_or_its_mended_form_does() {
        let of = |value: f64, ours: f64, mended: f64| {
            Printed::Formula(value).verdict(Some(ours), Some(mended), false)
        };
        assert_eq!(of(3.0 + 1e-9, 3.0, f64::NAN), Verdict::Reproduces);
        assert_eq!(of(3.0 + 1e-8, 3.0, f64::NAN), Verdict::Cannot);
        assert_eq!(of(4.0, 3.0, 3.0), Verdict::OnlyIf);
        assert_eq!(of(4.0, 3.0, 3.1), Verdict::Cannot);
        assert_eq!(of(10.0, 0.0, 1e-10), Verdict::OnlyIf);
        assert_eq!(of(10.0, 0.0, 1e-7), Verdict::Cannot);
    }
}
