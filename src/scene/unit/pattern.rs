//! Regular expressions of quantities, for programs that check a scene by its schema.

use super::symbol::spellings;
use super::{PLUS_MINUS, Quantity};

/// Returns the anchored ECMA-262 pattern of a number with a unit of one of these quantities, or zero, and an optional
/// error. Compound dimensions admit any product of units, whose dimension only the reader checks.
pub(in crate::scene) fn pattern(quantities: &[Quantity]) -> String {
    let sign = "[+\\-\u{2212}]?";
    let number = format!("{sign}(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE]{sign}[0-9]+)?");
    let units: Vec<String> = quantities.iter().map(|quantity| unit(*quantity)).collect();
    let units = units.join("|");
    let zero = format!("{sign}(?:0+[.]?0*|[.]0+)");
    let signs = PLUS_MINUS.map(|sign| sign.replace('+', "[+]")).join("|");
    let error = format!("(?:{number} *(?:{units})?|{zero}) *(?:{signs}) *{number} *(?:{units})?");
    format!("^ *(?:{number} *(?:{units})|{zero}|{error}) *$")
}

fn unit(quantity: Quantity) -> String {
    let dimension = quantity.dimension();
    match dimension.iter().map(|power| power.abs()).sum::<i8>() {
        0 => String::new(),
        1 => spellings(|unit| unit == dimension),
        _ => {
            let exponent = "(?:(?:\\^|[*][*])?[-\u{2212}]?[0-9]|[²³⁴]|⁻[¹²³⁴])?";
            let factor = format!("(?:{}|k?g[cm]?m|Ns){exponent}", spellings(|_| true));
            let product = format!("{factor}(?:(?: +| *[-/*.·⋅×] *){factor})*");
            format!("(?:1? */ *)?{product}(?: */ *\\( *{product} *\\))?")
        }
    }
}
