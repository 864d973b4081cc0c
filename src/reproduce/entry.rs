//! One number or formula of a paper beside ours, and the verdict.

use serde::{Serialize, Serializer};

/// What comparison says of a printed number or formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The mechanics gives what is printed.
    Reproduces,
    /// It does under the condition named.
    OnlyIf,
    /// It does not, and no condition is known under which it would.
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
    pub unit: &'static str,
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

/// An entry before it is judged.
#[derive(Clone, Debug)]
pub(super) struct Claim {
    place: String,
    what: String,
    unit: &'static str,
    printed: Printed,
    ours: Option<f64>,
    conditional: Option<f64>,
    /// Digits were cut off rather than rounded under the condition.
    cut: bool,
    condition: String,
    expected: Verdict,
}

#[derive(Clone, Debug)]
enum Printed {
    /// A number as text, and how far a value may be from it.
    Number(String, f64, f64),
    /// The value of a formula.
    Formula(f64),
}

/// Largest relative difference of formulas that are the same: rounding makes 1e-15 of it, a derivative by differences 1e-12;
/// of those that are not the same the nearest differ by 7e-5.
const SAME: f64 = 1e-9;

/// A printed number, right within half of its last digit.
pub(super) fn number(place: &str, what: &str, unit: &'static str, text: &str, ours: f64) -> Claim {
    let value: f64 = text.parse().expect("a printed number");
    let decimals = text
        .split_once('.')
        .map_or(0, |(_, decimals)| decimals.len());
    let half = 0.5 * 10f64.powi(-(decimals as i32));
    claim(
        place,
        what,
        unit,
        Printed::Number(text.to_owned(), value, half * (1.0 + SAME)),
        Some(ours),
    )
}

/// A number that is read from a figure or said to be so "about", with its tolerance.
pub(super) fn about(
    place: &str,
    what: &str,
    unit: &'static str,
    value: f64,
    tolerance: f64,
    ours: f64,
) -> Claim {
    let text = format!("about {value}");
    claim(
        place,
        what,
        unit,
        Printed::Number(text, value, tolerance),
        Some(ours),
    )
}

/// Words that stand for all values between two.
pub(super) fn worded(
    place: &str,
    what: &str,
    unit: &'static str,
    words: &str,
    [least, most]: [f64; 2],
    ours: f64,
) -> Claim {
    let (middle, half) = (0.5 * (least + most), 0.5 * (most - least));
    let printed = Printed::Number(words.to_owned(), middle, half);
    claim(place, what, unit, printed, Some(ours))
}

/// A printed number for which the paper gives nothing to compute it from.
pub(super) fn without_data(place: &str, what: &str, unit: &'static str, text: &str) -> Claim {
    Claim {
        ours: None,
        ..number(place, what, unit, text, f64::NAN)
    }
    .cannot("the paper does not give the data it would follow from")
}

/// A printed formula, evaluated, beside the mechanics.
pub(super) fn formula(place: &str, what: &str, unit: &'static str, value: f64, ours: f64) -> Claim {
    claim(place, what, unit, Printed::Formula(value), Some(ours))
}

fn claim(
    place: &str,
    what: &str,
    unit: &'static str,
    printed: Printed,
    ours: Option<f64>,
) -> Claim {
    Claim {
        place: place.to_owned(),
        what: what.to_owned(),
        unit,
        printed,
        ours,
        conditional: None,
        cut: false,
        condition: String::new(),
        expected: Verdict::Reproduces,
    }
}

impl Claim {
    /// Known to hold only if the condition does, under which the value is another.
    pub fn only_if(self, condition: &str, value: f64) -> Claim {
        Claim {
            conditional: Some(value),
            condition: condition.to_owned(),
            expected: Verdict::OnlyIf,
            ..self
        }
    }

    /// As [`Self::only_if`], with digits cut off instead of rounded.
    pub fn only_if_cut(self, condition: &str, value: f64) -> Claim {
        Claim {
            cut: true,
            ..self.only_if(&format!("{condition}, digits cut off"), value)
        }
    }

    /// Known not to hold, with the reason.
    pub fn cannot(self, reason: &str) -> Claim {
        Claim {
            condition: reason.to_owned(),
            expected: Verdict::Cannot,
            ..self
        }
    }

    /// What the comparison is known to say.
    pub fn expect(self, expected: Verdict) -> Claim {
        Claim { expected, ..self }
    }

    pub fn judged(self, paper: &'static str) -> Entry {
        let verdict = self.verdict();
        // A condition that is not needed is not named.
        let needed = verdict != Verdict::Reproduces;
        Entry {
            paper,
            place: self.place,
            what: self.what,
            unit: self.unit,
            printed: match &self.printed {
                Printed::Number(text, ..) => text.clone(),
                Printed::Formula(value) => format!("{value}"),
            },
            ours: self.ours,
            conditional: self.conditional.filter(|_| needed),
            condition: if needed {
                self.condition
            } else {
                String::new()
            },
            verdict,
            expected: self.expected,
        }
    }

    fn verdict(&self) -> Verdict {
        let (holds, holds_if) = match self.printed {
            Printed::Number(_, value, tolerance) => {
                let near = |candidate: f64| (candidate - value).abs() <= tolerance;
                let cut = |candidate: f64| {
                    let past = candidate.abs() - value.abs();
                    self.cut && (0.0..2.0 * tolerance).contains(&past)
                };
                (
                    self.ours.is_some_and(near),
                    self.conditional.is_some_and(|c| near(c) || cut(c)),
                )
            }
            Printed::Formula(value) => {
                let Some(ours) = self.ours else {
                    return Verdict::Cannot;
                };
                // Where nothing is left over, what is printed tells the size.
                let size = if ours == 0.0 { value.abs() } else { ours.abs() };
                let same = |a: f64| (a - ours).abs() <= SAME * size;
                (same(value), self.conditional.is_some_and(same))
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

    fn verdict(claim: Claim) -> Verdict {
        claim.judged("paper").verdict
    }

    #[test]
    fn a_number_holds_within_half_of_its_last_digit() {
        let ours = |ours: f64| number("", "", "N", "12.50", ours);
        assert_eq!(verdict(ours(12.5049)), Verdict::Reproduces);
        assert_eq!(verdict(ours(12.5051)), Verdict::Cannot);
        assert_eq!(verdict(ours(12.6).only_if("", 12.495)), Verdict::OnlyIf);
        assert_eq!(verdict(ours(12.6).only_if("", 12.509)), Verdict::Cannot);
        assert_eq!(verdict(ours(12.6).only_if_cut("", 12.509)), Verdict::OnlyIf);
        assert_eq!(verdict(ours(12.6).only_if_cut("", 12.511)), Verdict::Cannot);
        assert_eq!(verdict(ours(12.6).only_if_cut("", 12.494)), Verdict::Cannot);
        assert_eq!(verdict(ours(f64::NAN)), Verdict::Cannot);
        assert_eq!(verdict(without_data("", "", "N", "1.0")), Verdict::Cannot);
    }

    #[test]
    fn a_formula_holds_or_its_mended_form_does() {
        let printed = |value: f64| formula("", "", "N", value, 3.0);
        assert_eq!(verdict(printed(3.0 + 1e-9)), Verdict::Reproduces);
        assert_eq!(verdict(printed(3.0 + 1e-8)), Verdict::Cannot);
        assert_eq!(verdict(printed(4.0).only_if("", 3.0)), Verdict::OnlyIf);
        assert_eq!(verdict(printed(4.0).only_if("", 3.1)), Verdict::Cannot);
        let nothing = |mended: f64| formula("", "", "N", 10.0, 0.0).only_if("", mended);
        assert_eq!(verdict(nothing(1e-10)), Verdict::OnlyIf);
        assert_eq!(verdict(nothing(1e-7)), Verdict::Cannot);
    }

    #[test]
    fn a_condition_is_named_only_where_it_is_needed() {
        let entry = number("", "", "N", "1.0", 1.0)
            .only_if("the moon is full", 2.0)
            .judged("paper");
        assert_eq!((entry.condition.as_str(), entry.conditional), ("", None));
        assert_eq!(entry.expected, Verdict::OnlyIf, "a surprise");
    }
}
