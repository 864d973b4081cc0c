//! One number or formula of a paper beside ours, and the verdict.

use serde::{Serialize, Serializer};

/// What comparison says of a printed number or formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The mechanics gives what is printed.
    Reproduces,
    /// The printed value reproduces under the condition named.
    OnlyIf,
    /// The printed value does not reproduce, and no condition is known under which it would.
    Cannot,
}

impl Verdict {
    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Reproduces => "reproduces",
            Verdict::OnlyIf => "reproduces only if",
            Verdict::Cannot => "cannot be reproduced",
        }
    }
}

impl Serialize for Verdict {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

/// A printed number or formula beside ours.
#[derive(Clone, Debug, Serialize)]
pub struct Entry {
    /// Name of the paper.
    pub paper: &'static str,
    /// Equation, table or passage.
    pub place: String,
    /// What is compared.
    pub what: String,
    /// Unit of all values.
    pub unit: String,
    /// The number as printed; of a formula, the value that it has as printed.
    pub printed: String,
    /// Ours, by mechanics; none where the paper does not give what it would follow from.
    pub ours: Option<f64>,
    /// The value under `condition`: of other data, or of the formula mended.
    pub conditional: Option<f64>,
    /// What has to be assumed or mended, or why nothing helps.
    pub condition: String,
    /// What the comparison says.
    pub verdict: Verdict,
    /// What it is known to say.
    pub expected: Verdict,
}

/// What is printed, as it is compared.
#[derive(Clone, Debug)]
pub(super) enum Printed {
    /// A number as text, and how far a value may be from it.
    Number(String, f64, f64),
    /// The value of a formula.
    Formula(f64),
}

/// Largest relative difference of formulas that are the same: rounding makes 1e-15 of it, a derivative by differences 1e-12;
/// of those that are not the same the nearest differ by 7e-5.
const SAME: f64 = 1e-9;

impl Printed {
    /// A number, right within half of its last digit.
    pub fn number(text: &str, value: f64) -> Printed {
        let decimals = text.split_once('.').map_or(0, |(_, digits)| digits.len());
        let half = 0.5 * 10f64.powi(-(decimals as i32));
        Printed::Number(text.to_owned(), value, half * (1.0 + SAME))
    }

    /// Words that stand for all values between two.
    pub fn between(words: &str, [least, most]: [f64; 2]) -> Printed {
        Printed::Number(words.to_owned(), 0.5 * (least + most), 0.5 * (most - least))
    }

    /// The verdict beside our value and the one under the condition; `cut`: there digits were cut off rather than rounded.
    fn verdict(&self, ours: Option<f64>, conditional: Option<f64>, cut: bool) -> Verdict {
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
                // Where nothing is left over, what is printed tells the size.
                let size = if ours == 0.0 { value.abs() } else { ours.abs() };
                let same = |a: f64| (a - ours).abs() <= SAME * size;
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

impl Entry {
    /// An entry without words: what is printed beside our value, and beside the one under a condition.
    pub(super) fn judged(
        printed: Printed,
        ours: Option<f64>,
        conditional: Option<f64>,
        cut: bool,
    ) -> Entry {
        let verdict = printed.verdict(ours, conditional, cut);
        Entry {
            paper: "",
            place: String::new(),
            what: String::new(),
            unit: String::new(),
            printed: match printed {
                Printed::Number(text, ..) => text,
                Printed::Formula(value) => format!("{value}"),
            },
            ours,
            // A condition that is not needed is not named.
            conditional: conditional.filter(|_| verdict != Verdict::Reproduces),
            condition: String::new(),
            verdict,
            expected: Verdict::Reproduces,
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
