//! Quantities as regular expressions, for programs that check a scene by its schema.

use super::Quantity;
use super::symbol::{Dimension, spellings};

/// A sign as editors write it.
const MINUS: &str = "[\\-\u{2212}]";

/// A number and a unit of one of these quantities, or zero; ECMA-262, anchored.
pub(in crate::scene) fn pattern(quantities: &[Quantity]) -> String {
    let sign = "[+\\-\u{2212}]?";
    let number = format!("{sign}(?:[0-9]+[.]?[0-9]*|[.][0-9]+)(?:[eE]{sign}[0-9]+)?");
    let units: Vec<String> = quantities.iter().map(|quantity| unit(*quantity)).collect();
    let units = units.join("|");
    format!("^ *(?:{number} *(?:{units})|{sign}(?:0+[.]?0*|[.]0+)) *$")
}

/// The units of a quantity: their symbols, and those made of several in the ways that engineers write them.
fn unit(quantity: Quantity) -> String {
    let mut all: Vec<String> = shapes(quantity)
        .iter()
        .map(|shape| product(shape))
        .collect();
    match quantity {
        Quantity::AngularSpeed => all.push(format!("1? */ *min|min{}", exponent(-1))),
        Quantity::Inertia => all.push(format!("k?g[cm]?m{}", exponent(2))),
        Quantity::LinearDamping => all.push(format!("Ns */ *{}", symbols('L'))),
        _ => {}
    }
    all.join("|")
}

/// Factors as letters, each with its power: M mass, L length, T time, A angle, W angular speed, V velocity, F force,
/// E torque, P pressure.
fn shapes(quantity: Quantity) -> &'static [&'static [(char, i32)]] {
    match quantity {
        Quantity::Length => &[&[('L', 1)]],
        Quantity::Mass => &[&[('M', 1)]],
        Quantity::Inertia => &[
            &[('M', 1), ('L', 2)],
            &[('E', 1), ('T', 2)],
            &[('F', 1), ('L', 1), ('T', 2)],
        ],
        Quantity::Angle => &[&[('A', 1)]],
        Quantity::AngularSpeed => &[&[('W', 1)], &[('A', 1), ('T', -1)]],
        Quantity::Acceleration => &[
            &[('L', 1), ('T', -2)],
            &[('L', 1), ('T', -1), ('T', -1)],
            &[('V', 1), ('T', -1)],
        ],
        Quantity::Time => &[&[('T', 1)]],
        Quantity::Force => &[&[('F', 1)], &[('M', 1), ('L', 1), ('T', -2)]],
        Quantity::Torque => &[
            &[('E', 1)],
            &[('F', 1), ('L', 1)],
            &[('M', 1), ('L', 2), ('T', -2)],
        ],
        Quantity::RotaryDamping => &[
            &[('E', 1), ('T', 1)],
            &[('E', 1), ('T', 1), ('A', -1)],
            &[('E', 1), ('W', -1)],
            &[('F', 1), ('L', 1), ('T', 1)],
            &[('F', 1), ('L', 1), ('T', 1), ('A', -1)],
            &[('F', 1), ('L', 1), ('W', -1)],
        ],
        Quantity::LinearDamping => &[
            &[('F', 1), ('T', 1), ('L', -1)],
            &[('F', 1), ('V', -1)],
            &[('M', 1), ('T', -1)],
        ],
        Quantity::Stiffness => &[&[('F', 1), ('L', -1)], &[('M', 1), ('T', -2)]],
        Quantity::Pressure => &[
            &[('P', 1)],
            &[('F', 1), ('L', -2)],
            &[('M', 1), ('L', -1), ('T', -2)],
        ],
        Quantity::Density => &[&[('M', 1), ('L', -3)]],
        Quantity::Velocity => &[&[('V', 1)], &[('L', 1), ('T', -1)]],
        Quantity::Number => &[&[]],
    }
}

/// Spellings of one factor.
fn symbols(letter: char) -> String {
    let of = |dimension: Dimension| spellings(dimension);
    let ratio =
        |above: char, below: char| format!("\\( *{} */ *{} *\\)", symbols(above), symbols(below));
    match letter {
        'M' => of([0, 1, 0, 0]),
        'L' => of([1, 0, 0, 0]),
        'T' => of([0, 0, 1, 0]),
        'A' => of([0, 0, 0, 1]),
        'W' => format!("(?:{}|{})", of([0, 0, -1, 1]), ratio('A', 'T')),
        'V' => ratio('L', 'T'),
        'F' => of([1, 1, -2, 0]),
        'E' => of([2, 1, -2, 0]),
        _ => of([-1, 1, -2, 0]),
    }
}

fn exponent(power: i32) -> String {
    let sign = if power < 0 { MINUS } else { "" };
    let raised = match power.abs() {
        1 => "\u{b9}",
        2 => "\u{b2}",
        _ => "\u{b3}",
    };
    let above = if power < 0 { "\u{207b}" } else { "" };
    match power {
        1 => String::new(),
        _ => format!("(?:(?:\\^|\\*\\*)?{sign}{}|{above}{raised})", power.abs()),
    }
}

/// Factors above the line in any order; those below it after a stroke, in a bracket, or with negative powers.
fn product(factors: &[(char, i32)]) -> String {
    const TIMES: &str = "(?: *[*\u{b7}\u{22c5}\u{d7}.\\-] *| +)";
    let part = |&(letter, power): &(char, i32)| format!("{}{}", symbols(letter), exponent(power));
    let (above, below): (Vec<_>, Vec<_>) = factors.iter().partition(|factor| factor.1 > 0);
    let orders: Vec<String> = orders(above)
        .iter()
        .map(|order| order.iter().map(part).collect::<Vec<_>>().join(TIMES))
        .collect();
    let above = format!("(?:{})", orders.join("|"));
    if below.is_empty() {
        return above;
    }
    let inverse: Vec<String> = below
        .iter()
        .map(|&(letter, power)| part(&(letter, -power)))
        .collect();
    let divided: String = inverse.iter().map(|part| format!(" */ *{part}")).collect();
    let bracket = format!(" */ *\\( *{} *\\)", inverse.join(TIMES));
    if below.iter().any(|factor| matches!(factor.0, 'V' | 'W')) {
        return format!("{above}(?:{divided}|{bracket})");
    }
    let negative: String = below
        .iter()
        .map(|factor| format!("{TIMES}{}", part(factor)))
        .collect();
    format!("{above}(?:{divided}|{bracket}|{negative})")
}

/// All orders of a few factors.
fn orders(factors: Vec<(char, i32)>) -> Vec<Vec<(char, i32)>> {
    if factors.len() < 2 {
        return vec![factors];
    }
    let first = |i: usize| {
        let mut rest = factors.clone();
        let first = rest.remove(i);
        orders(rest)
            .into_iter()
            .map(move |order| [vec![first], order].concat())
    };
    (0..factors.len()).flat_map(first).collect()
}

#[cfg(test)]
mod tests {
    use proptest::strategy::{Strategy, ValueTree};
    use proptest::test_runner::TestRunner;

    use super::*;
    use crate::scene::unit::parse;

    const ALL: [Quantity; 15] = [
        Quantity::Length,
        Quantity::Mass,
        Quantity::Inertia,
        Quantity::Angle,
        Quantity::AngularSpeed,
        Quantity::Acceleration,
        Quantity::Time,
        Quantity::Force,
        Quantity::Torque,
        Quantity::RotaryDamping,
        Quantity::LinearDamping,
        Quantity::Stiffness,
        Quantity::Pressure,
        Quantity::Density,
        Quantity::Velocity,
    ];

    #[test]
    fn every_unit_that_the_schema_takes_is_one_of_its_quantity() {
        let mut runner = TestRunner::deterministic();
        for quantity in ALL {
            let units = proptest::string::string_regex(&unit(quantity)).expect("a pattern");
            for _ in 0..500 {
                let unit = units.new_tree(&mut runner).expect("a text").current();
                let value = parse(&format!("2 {unit}"), quantity);
                assert!(value.is_ok(), "{unit}: {value:?}");
            }
        }
    }
}
