//! Quantities as people type them: a number and a unit, exact factors, checked dimension.

use std::f64::consts::PI;
use std::fmt;

/// Exponents of metre, kilogram, second and radian.
type Dimension = [i8; 4];

/// What a value of a scene file measures; fixes the units it may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// m
    Length,
    /// kg
    Mass,
    /// kg m²
    Inertia,
    /// rad
    Angle,
    /// rad/s
    AngularSpeed,
    /// m/s²
    Acceleration,
    /// s
    Time,
    /// N
    Force,
    /// N m
    Torque,
    /// N m s/rad
    RotaryDamping,
    /// N s/m
    LinearDamping,
    /// N/m
    Stiffness,
    /// Pa
    Pressure,
    /// kg/m³
    Density,
    /// m/s
    Velocity,
    /// no dimension
    Number,
}

impl Quantity {
    /// Every quantity, in the order of the enum.
    pub const ALL: [Quantity; 16] = [
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
        Quantity::Number,
    ];

    fn facts(self) -> (&'static str, Dimension, &'static str) {
        match self {
            Self::Length => ("a length", [1, 0, 0, 0], "\"47 mm\", \"0.047 m\", \"2 in\""),
            Self::Mass => ("a mass", [0, 1, 0, 0], "\"0.86 kg\", \"860 g\", \"1.9 lb\""),
            Self::Inertia => (
                "a moment of inertia",
                [2, 1, 0, 0],
                "\"5807.55 kg mm^2\", \"0.0058 kg m^2\"",
            ),
            Self::Angle => (
                "an angle",
                [0, 0, 0, 1],
                "\"40 deg\", \"0.7 rad\", \"2 rev\"",
            ),
            Self::AngularSpeed => (
                "an angular speed",
                [0, 0, -1, 1],
                "\"200 rpm\", \"100 rad/s\", \"30 deg/s\"",
            ),
            Self::Acceleration => ("an acceleration", [1, 0, -2, 0], "\"9.80665 m/s^2\""),
            Self::Time => ("a time", [0, 0, 1, 0], "\"1 s\", \"5 ms\", \"2 min\""),
            Self::Force => ("a force", [1, 1, -2, 0], "\"-200 N\", \"5 kN\", \"10 lbf\""),
            Self::Torque => (
                "a torque",
                [2, 1, -2, 0],
                "\"2 N m\", \"250 N mm\", \"1 lbf ft\"",
            ),
            Self::RotaryDamping => (
                "a torque per angular speed",
                [2, 1, -1, -1],
                "\"0.02 N m s/rad\"",
            ),
            Self::LinearDamping => ("a force per velocity", [0, 1, -1, 0], "\"15 N s/m\""),
            Self::Stiffness => ("a stiffness", [0, 1, -2, 0], "\"2 kN/m\", \"3 N/mm\""),
            Self::Pressure => ("a pressure", [-1, 1, -2, 0], "\"10 bar\", \"101325 Pa\""),
            Self::Density => (
                "a density",
                [-3, 1, 0, 0],
                "\"7800 kg/m^3\", \"7.8 g/cm^3\"",
            ),
            Self::Velocity => ("a velocity", [1, 0, -1, 0], "\"2 m/s\""),
            Self::Number => ("a number", [0; 4], "0.1, 1e-10"),
        }
    }

    /// The quantity in words, with its article.
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// Accepted spellings, for error messages and the schema.
    pub fn examples(self) -> &'static str {
        self.facts().2
    }

    /// Radians are a dimension only where leaving them out could be a mistake:
    /// `N m s` is as good as `N m s/rad`.
    fn accepts(self, found: Dimension) -> bool {
        let want = self.facts().1;
        found == want || (self == Self::RotaryDamping && found[..3] == want[..3] && found[3] == 0)
    }
}

/// Why a text is not the quantity that was asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// What is wrong.
    pub what: String,
    /// What would be right.
    pub help: String,
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}; {}", self.what, self.help)
    }
}

/// Reads `text` as `quantity` and returns it in SI units and radians.
///
/// Powers of ten are applied to the decimal digits before they are rounded, so `"155.83 mm"` is the
/// double nearest to 0.15583.
///
/// ```
/// use slider_crank::scene::unit::{parse, Quantity};
/// assert_eq!(parse("155.83 mm", Quantity::Length), Ok(0.15583));
/// assert_eq!(parse("5807.55 kg·mm²", Quantity::Inertia), Ok(5807.55e-6));
/// assert!(parse("47 kg", Quantity::Length).is_err());
/// ```
pub fn parse(text: &str, quantity: Quantity) -> Result<f64, UnitError> {
    let wrong = |what: String| UnitError {
        what,
        help: format!("write {} like {}", quantity.name(), quantity.examples()),
    };
    let (digits, unit) = split(text).map_err(&wrong)?;
    let factor = unit_factor(unit).map_err(&wrong)?;
    let value = factor
        .apply(&digits)
        .filter(|v| v.is_finite())
        .ok_or_else(|| wrong(format!("`{text}` is not a finite number")))?;
    if unit.trim().is_empty() && value == 0.0 {
        return Ok(value);
    }
    if !quantity.accepts(factor.dimension) {
        return Err(wrong(if unit.trim().is_empty() {
            format!("`{text}` has no unit")
        } else {
            format!("`{}` is not the unit of {}", unit.trim(), quantity.name())
        }));
    }
    Ok(value)
}

/// Factor of a unit that stands alone, as in a column header `pressure [bar]`: SI value of one unit.
pub fn factor(unit: &str, quantity: Quantity) -> Result<f64, UnitError> {
    parse(&format!("1 {unit}"), quantity)
}

/// Splits `"-2.5e3 N m"` into its digits and its unit.
fn split(text: &str) -> Result<(String, &str), String> {
    let trimmed = text.trim();
    let mut end = 0;
    let bytes = trimmed.as_bytes();
    let normal = trimmed.replace('\u{2212}', "-");
    if normal.len() != trimmed.len() {
        // A typographic minus sign is a minus sign.
        let rest = trimmed.trim_start_matches('\u{2212}');
        return split(rest).map(|(digits, unit)| (format!("-{digits}"), unit));
    }
    while end < bytes.len() {
        let sign = matches!(bytes[end], b'+' | b'-')
            && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        let exponent = matches!(bytes[end], b'e' | b'E')
            && bytes
                .get(end + 1)
                .is_some_and(|c| c.is_ascii_digit() || matches!(c, b'+' | b'-'));
        if !(bytes[end].is_ascii_digit() || bytes[end] == b'.' || sign || exponent) {
            break;
        }
        end += 1;
    }
    let digits = &trimmed[..end];
    if trimmed[end..].starts_with(',') {
        return Err(format!(
            "`{text}` has a decimal comma where a point is expected"
        ));
    }
    if digits.parse::<f64>().is_err() {
        return Err(format!("`{text}` does not begin with a number"));
    }
    Ok((digits.to_owned(), &trimmed[end..]))
}

/// numerator/denominator · 10^ten · pi^pi, times metre, kilogram, second, radian to `dimension`.
#[derive(Clone, Copy)]
struct Factor {
    numerator: f64,
    denominator: f64,
    ten: i32,
    pi: i32,
    dimension: Dimension,
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

    fn apply(self, digits: &str) -> Option<f64> {
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

fn symbol(name: &str) -> Option<Factor> {
    let find = |name: &str| UNITS.iter().find(|unit| unit.0 == name);
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

/// `unit := factor { (space | · | * | /) factor }`, `factor := symbol [^]integer | ( unit )`.
fn unit_factor(text: &str) -> Result<Factor, String> {
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
            let explicit = rest.strip_prefix(['*', '·', '⋅', '×']);
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
        format!("`{shown}` is not a known unit")
    })?;
    *rest = &rest[end..];
    let power = exponent(rest)?;
    Ok(Factor::ONE.times(base, power))
}

fn exponent(rest: &mut &str) -> Result<i32, String> {
    let caret = rest.strip_prefix('^');
    let text = caret.unwrap_or(rest);
    let mut digits = String::new();
    let mut length = 0;
    for c in text.chars() {
        let plain = match c {
            '0'..='9' | '-' => c,
            '⁻' => '-',
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_as_people_type_them() {
        for (text, quantity, expected) in [
            ("47 mm", Quantity::Length, 0.047),
            ("40mm", Quantity::Length, 0.040),
            ("27698.81 kg mm^2", Quantity::Inertia, 0.02769881),
            ("5807.55 kg·mm²", Quantity::Inertia, 0.00580755),
            ("0.2 kg m2", Quantity::Inertia, 0.2),
            ("200 rpm", Quantity::AngularSpeed, 200.0 * PI / 30.0),
            ("90 deg", Quantity::Angle, PI / 2.0),
            ("30°", Quantity::Angle, PI / 6.0),
            ("2 N*m", Quantity::Torque, 2.0),
            ("250 N mm", Quantity::Torque, 0.25),
            ("2 Nm", Quantity::Torque, 2.0),
            ("10 bar", Quantity::Pressure, 1e6),
            ("1 lbf ft", Quantity::Torque, 1.3558179483314004),
            ("10 lbf", Quantity::Force, 44.48221615260500),
            ("1 lb", Quantity::Mass, 0.45359237),
            ("1 psi", Quantity::Pressure, 6894.757293168361),
            ("0.02 N m s/rad", Quantity::RotaryDamping, 0.02),
            ("0.02 N m s", Quantity::RotaryDamping, 0.02),
            ("7.8 g/cm^3", Quantity::Density, 7800.0),
            ("1 kg/(m s^2)", Quantity::Pressure, 1.0),
            ("−3 N", Quantity::Force, -3.0),
            ("9.80665 m s⁻²", Quantity::Acceleration, 9.80665),
            ("0", Quantity::Length, 0.0),
            ("0.1", Quantity::Number, 0.1),
        ] {
            let value = parse(text, quantity).unwrap_or_else(|e| panic!("{text}: {e}"));
            let error = (value - expected).abs();
            assert!(
                error <= 2e-16 * expected.abs(),
                "{text}: {value} for {expected}"
            );
        }
    }

    #[test]
    fn what_is_not_a_quantity_is_refused() {
        for (text, quantity) in [
            ("47", Quantity::Length),
            ("47 kg", Quantity::Length),
            ("1,5 mm", Quantity::Length),
            ("mm", Quantity::Length),
            ("1e999 m", Quantity::Length),
            ("1 furlong", Quantity::Length),
            ("1 m^", Quantity::Length),
            ("1 m^99", Quantity::Length),
            ("3 1/s", Quantity::AngularSpeed),
            ("1 N m", Quantity::Force),
            ("1 kg/m s", Quantity::Pressure),
            ("nan m", Quantity::Length),
            ("1 (m", Quantity::Length),
            ("", Quantity::Length),
        ] {
            assert!(parse(text, quantity).is_err(), "{text}");
        }
    }
}
