//! Grammar of compound units: takes a text, returns the factor to SI and the dimension.

use super::symbol::{Factor, symbol};
use crate::scene::number::MINUS;

/// Product of the factors in a bracket, or of the whole unit.
struct Product<'a> {
    text: &'a str,
    total: Factor,
    /// Whether a division sign has occurred.
    divided: bool,
    /// Exponent of this product in the one around it.
    power: i32,
}

/// Parses `unit := [1 /] factor { (space | · | * | . | - | /) factor }`, `factor := symbol [^]integer | ( unit )`.
/// A hyphen before a digit is the sign of an exponent. A stack of the open brackets allows any depth.
pub(super) fn unit_factor(text: &str) -> Result<Factor, String> {
    let begin = |text, power| Product {
        text,
        total: Factor::ONE,
        divided: false,
        power,
    };
    // The 1 of `1/min` is left out.
    let one = text.trim().strip_prefix('1').map(str::trim_start);
    let one = one.filter(|after| after.starts_with('/'));
    let mut rest = one.unwrap_or(text.trim());
    let mut product = begin(rest, 1);
    let mut around = Vec::new();
    loop {
        rest = rest.trim_start();
        if rest.is_empty() || rest.starts_with(')') {
            let Some(outer) = around.pop() else { break };
            let inner = std::mem::replace(&mut product, outer);
            let after = rest.strip_prefix(')');
            rest = after.ok_or_else(|| "a bracket of the unit is not closed".to_owned())?;
            product.total = product.total.times(inner.total, inner.power);
            continue;
        }
        let first = rest.len() == product.text.trim_start().len();
        let mut power = 1;
        if let Some(after) = rest.strip_prefix('/') {
            (rest, power, product.divided) = (after.trim_start(), -1, true);
        } else if !first && product.divided {
            let text = product.text;
            return Err(format!(
                "`{text}` can be read in two ways: put what is divided by in brackets, as in `kg/(m s)`"
            ));
        } else if !first && let Some(after) = rest.strip_prefix(['*', '·', '⋅', '×', '.', '-'])
        {
            rest = after.trim_start();
        }
        if let Some(inner) = rest.strip_prefix('(') {
            rest = inner;
            around.push(std::mem::replace(&mut product, begin(inner, power)));
        } else {
            product.total = product.total.times(factor_of(&mut rest)?, power);
        }
    }
    if rest.is_empty() {
        return Ok(product.total);
    }
    let text = text.trim();
    Err(format!("`{rest}` in the unit `{text}` is not understood"))
}

fn factor_of(rest: &mut &str) -> Result<Factor, String> {
    let end = rest.find(|c: char| !(c.is_alphabetic() || c == '°'));
    let (name, after) = rest.split_at(end.unwrap_or(rest.len()));
    let [before, last] = symbols_of(name).ok_or_else(|| {
        let shown = if name.is_empty() { *rest } else { name };
        let small = name.to_lowercase();
        match symbol(&small) {
            Some(_) => format!("`{shown}` is not a known unit: `{small}` is"),
            None => format!("`{shown}` is not a known unit"),
        }
    })?;
    *rest = after;
    let power = exponent(rest)?;
    Ok(before.times(last, power))
}

/// Splits a name into one symbol, or two written without a space, as in `kgm^2` and `Ns`: a mass or a force, and a
/// length or a time, where only one reading fits. An exponent belongs to the last.
fn symbols_of(name: &str) -> Option<[Factor; 2]> {
    if let Some(only) = symbol(name) {
        return Some([Factor::ONE, only]);
    }
    let ends = name.char_indices().map(|(at, _)| name.split_at(at));
    let fits = |[first, last]: &[Factor; 2]| {
        first.dimension[1] == 1 && matches!(last.dimension, [1, 0, 0, 0] | [0, 0, 1, 0])
    };
    let pairs = ends.filter_map(|(a, b)| Some([symbol(a)?, symbol(b)?]));
    let mut pairs = pairs.filter(fits);
    let pair = pairs.next()?;
    pairs.next().is_none().then_some(pair)
}

fn exponent(rest: &mut &str) -> Result<i32, String> {
    let caret = rest.strip_prefix('^').or_else(|| rest.strip_prefix("**"));
    let text = caret.unwrap_or(rest);
    let after_hyphen = text.strip_prefix('-');
    let is_hyphen =
        after_hyphen.is_some_and(|after| !after.starts_with(|c: char| c.is_ascii_digit()));
    let plain = |(at, c)| match c {
        '0'..='9' => Some(c),
        '-' | '⁻' | MINUS if at == 0 => Some('-'),
        '¹' => Some('1'),
        '²' => Some('2'),
        '³' => Some('3'),
        '⁴' => Some('4'),
        _ => None,
    };
    let digits: String = text.char_indices().map_while(plain).collect();
    if caret.is_none() && (digits.is_empty() || is_hyphen) {
        return Ok(1);
    }
    let end = text.char_indices().nth(digits.len());
    *rest = &text[end.map_or(text.len(), |(at, _)| at)..];
    let power = digits.parse().ok();
    let power = power.filter(|power| (-6..=6).contains(power));
    power.ok_or_else(|| format!("`^{digits}` is not a usable exponent of a unit"))
}
