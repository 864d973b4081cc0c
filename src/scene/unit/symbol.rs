//! Unit symbols, their exact factors, and the grammar of compound units.

use std::f64::consts::PI;

use crate::scene::number::MINUS;

/// Exponents of metre, kilogram, second and radian.
pub(super) type Dimension = [i8; 4];

/// numerator/denominator · 10^ten · pi^pi, times metre, kilogram, second, radian to `dimension`.
#[derive(Clone, Copy)]
pub(super) struct Factor {
    numerator: f64,
    denominator: f64,
    ten: i32,
    pi: i32,
    pub(super) dimension: Dimension,
}

impl Factor {
    const ONE: Factor = Factor {
        numerator: 1.0,
        denominator: 1.0,
        ten: 0,
        pi: 0,
        dimension: [0; 4],
    };

    fn times(mut self, other: Factor, power: i32) -> Factor {
        let (up, down) = if power >= 0 {
            (other.numerator, other.denominator)
        } else {
            (other.denominator, other.numerator)
        };
        self.numerator *= up.powi(power.abs());
        self.denominator *= down.powi(power.abs());
        self.ten += power * other.ten;
        self.pi += power * other.pi;
        for (mine, theirs) in self.dimension.iter_mut().zip(other.dimension) {
            *mine = mine.saturating_add(theirs.saturating_mul(power as i8));
        }
        self
    }

    pub(super) fn apply(self, digits: &str) -> Option<f64> {
        let (mantissa, exponent) = match digits.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (digits, 0),
        };
        let scaled: f64 = format!("{mantissa}e{}", exponent.checked_add(self.ten)?)
            .parse()
            .ok()?;
        Some(scaled * self.numerator / self.denominator * PI.powi(self.pi))
    }
}

/// symbol, numerator, denominator, power of ten, power of pi, dimension, takes a prefix
type Unit = (&'static str, f64, f64, i32, i32, Dimension, bool);

const UNITS: &[Unit] = &[
    ("m", 1.0, 1.0, 0, 0, [1, 0, 0, 0], true),
    ("g", 1.0, 1.0, -3, 0, [0, 1, 0, 0], true),
    ("s", 1.0, 1.0, 0, 0, [0, 0, 1, 0], true),
    ("rad", 1.0, 1.0, 0, 0, [0, 0, 0, 1], true),
    ("N", 1.0, 1.0, 0, 0, [1, 1, -2, 0], true),
    ("Nm", 1.0, 1.0, 0, 0, [2, 1, -2, 0], true),
    ("Nmm", 1.0, 1.0, -3, 0, [2, 1, -2, 0], true),
    ("J", 1.0, 1.0, 0, 0, [2, 1, -2, 0], true),
    ("W", 1.0, 1.0, 0, 0, [2, 1, -3, 0], true),
    ("Pa", 1.0, 1.0, 0, 0, [-1, 1, -2, 0], true),
    ("bar", 1.0, 1.0, 5, 0, [-1, 1, -2, 0], true),
    ("atm", 101_325.0, 1.0, 0, 0, [-1, 1, -2, 0], false),
    ("min", 60.0, 1.0, 0, 0, [0, 0, 1, 0], false),
    ("h", 3600.0, 1.0, 0, 0, [0, 0, 1, 0], false),
    ("deg", 1.0, 180.0, 0, 1, [0, 0, 0, 1], false),
    ("°", 1.0, 180.0, 0, 1, [0, 0, 0, 1], false),
    ("rev", 2.0, 1.0, 0, 1, [0, 0, 0, 1], false),
    ("turn", 2.0, 1.0, 0, 1, [0, 0, 0, 1], false),
    ("gon", 1.0, 200.0, 0, 1, [0, 0, 0, 1], true),
    ("arcmin", 1.0, 10_800.0, 0, 1, [0, 0, 0, 1], false),
    ("arcsec", 1.0, 648_000.0, 0, 1, [0, 0, 0, 1], false),
    ("rpm", 1.0, 30.0, 0, 1, [0, 0, -1, 1], false),
    ("t", 1.0, 1.0, 3, 0, [0, 1, 0, 0], false),
    ("in", 254.0, 1.0, -4, 0, [1, 0, 0, 0], false),
    ("ft", 3048.0, 1.0, -4, 0, [1, 0, 0, 0], false),
    ("lb", 45_359_237.0, 1.0, -8, 0, [0, 1, 0, 0], false),
    ("lbm", 45_359_237.0, 1.0, -8, 0, [0, 1, 0, 0], false),
    ("oz", 28_349_523_125.0, 1.0, -12, 0, [0, 1, 0, 0], false),
    (
        "slug",
        44_482_216_152_605.0,
        3048.0,
        -9,
        0,
        [0, 1, 0, 0],
        false,
    ),
    (
        "lbf",
        44_482_216_152_605.0,
        1.0,
        -13,
        0,
        [1, 1, -2, 0],
        false,
    ),
    ("kgf", 980_665.0, 1.0, -5, 0, [1, 1, -2, 0], false),
    (
        "psi",
        44_482_216_152_605.0,
        64_516.0,
        -5,
        0,
        [-1, 1, -2, 0],
        false,
    ),
];

/// Names that people and instruments write in the place of symbols.
const NAMES: &[(&str, &str)] = &[
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("minutes", "min"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("revs", "rev"),
    ("turns", "turn"),
    ("r", "rev"),
    ("RPM", "rpm"),
    ("inch", "in"),
    ("inches", "in"),
    ("foot", "ft"),
    ("feet", "ft"),
    ("lbs", "lb"),
];

const PREFIXES: &[(&str, i32)] = &[
    ("G", 9),
    ("M", 6),
    ("k", 3),
    ("h", 2),
    ("da", 1),
    ("d", -1),
    ("c", -2),
    ("m", -3),
    ("u", -6),
    ("µ", -6),
    ("μ", -6),
    ("n", -9),
];

/// The symbols of a dimension that have no prefix.
pub(super) fn symbols(dimension: Dimension) -> impl Iterator<Item = &'static str> {
    let of_it = UNITS.iter().filter(move |unit| unit.5 == dimension);
    of_it.map(|unit| unit.0)
}

fn symbol(name: &str) -> Option<Factor> {
    let find = |name: &str| {
        let named = NAMES.iter().find(|entry| entry.0 == name);
        let symbol = named.map_or(name, |entry| entry.1);
        UNITS.iter().find(|unit| unit.0 == symbol)
    };
    let make = |unit: &Unit, ten: i32| Factor {
        numerator: unit.1,
        denominator: unit.2,
        ten: unit.3 + ten,
        pi: unit.4,
        dimension: unit.5,
    };
    if let Some(unit) = find(name) {
        return Some(make(unit, 0));
    }
    PREFIXES.iter().find_map(|(prefix, ten)| {
        let unit = find(name.strip_prefix(prefix)?)?;
        unit.6.then(|| make(unit, *ten))
    })
}

/// `unit := factor { (space | · | * | . | - | /) factor }`, `factor := symbol [^]integer | ( unit )`. A hyphen before a
/// digit is the sign of an exponent.
pub(super) fn unit_factor(text: &str) -> Result<Factor, String> {
    let mut rest = text.trim();
    let (factor, left) = product(&mut rest)?;
    if left.is_empty() {
        Ok(factor)
    } else {
        Err(format!(
            "`{left}` in the unit `{}` is not understood",
            text.trim()
        ))
    }
}

fn product<'a>(rest: &mut &'a str) -> Result<(Factor, &'a str), String> {
    let whole = *rest;
    let mut total = Factor::ONE;
    let mut divided = false;
    let mut first = true;
    loop {
        *rest = rest.trim_start();
        if rest.is_empty() || rest.starts_with(')') {
            return Ok((total, rest));
        }
        let mut divide = false;
        if let Some(after) = rest.strip_prefix('/') {
            divide = true;
            *rest = after.trim_start();
        } else if !first {
            let explicit = rest.strip_prefix(['*', '·', '⋅', '×', '.', '-']);
            if divided {
                return Err(format!(
                    "`{whole}` can be read in two ways: put what is divided by in brackets, as in `kg/(m s)`"
                ));
            }
            if let Some(after) = explicit {
                *rest = after.trim_start();
            }
        }
        divided |= divide;
        first = false;
        let part = factor_of(rest)?;
        total = total.times(part, if divide { -1 } else { 1 });
    }
}

fn factor_of(rest: &mut &str) -> Result<Factor, String> {
    if let Some(inner) = rest.strip_prefix('(') {
        *rest = inner;
        let (factor, left) = product(rest)?;
        *rest = left
            .strip_prefix(')')
            .ok_or_else(|| "a bracket of the unit is not closed".to_owned())?;
        return Ok(factor);
    }
    let end = rest
        .find(|c: char| !(c.is_alphabetic() || c == '°'))
        .unwrap_or(rest.len());
    let name = &rest[..end];
    let base = symbol(name).ok_or_else(|| {
        let shown = if name.is_empty() { *rest } else { name };
        let small = name.to_lowercase();
        match symbol(&small) {
            Some(_) => format!("`{shown}` is not a known unit: `{small}` is"),
            None => format!("`{shown}` is not a known unit"),
        }
    })?;
    *rest = &rest[end..];
    let power = exponent(rest)?;
    Ok(Factor::ONE.times(base, power))
}

fn exponent(rest: &mut &str) -> Result<i32, String> {
    let caret = rest.strip_prefix('^').or_else(|| rest.strip_prefix("**"));
    let text = caret.unwrap_or(rest);
    let hyphen = |rest: &str| {
        let after = rest.strip_prefix('-');
        after.is_some_and(|after| !after.starts_with(|c: char| c.is_ascii_digit()))
    };
    if caret.is_none() && hyphen(text) {
        return Ok(1);
    }
    let mut digits = String::new();
    let mut length = 0;
    for c in text.chars() {
        let plain = match c {
            '0'..='9' | '-' => c,
            '⁻' | MINUS => '-',
            '¹' => '1',
            '²' => '2',
            '³' => '3',
            '⁴' => '4',
            _ => break,
        };
        digits.push(plain);
        length += c.len_utf8();
    }
    if digits.is_empty() && caret.is_none() {
        return Ok(1);
    }
    *rest = &text[length..];
    digits
        .parse::<i32>()
        .ok()
        .filter(|power| (-6..=6).contains(power))
        .ok_or_else(|| format!("`^{digits}` is not a usable exponent of a unit"))
}
