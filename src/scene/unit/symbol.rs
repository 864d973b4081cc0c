//! Unit symbols and their exact factors.

use std::f64::consts::PI;

/// Exponents of metre, kilogram, second and radian.
pub(super) type Dimension = [i8; 4];

/// Factor numerator/denominator · 10^ten · pi^pi to SI, times metre, kilogram, second, radian to `dimension`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Factor {
    numerator: f64,
    denominator: f64,
    ten: i32,
    pi: i32,
    pub(super) dimension: Dimension,
}

impl Factor {
    pub(super) const ONE: Factor = Factor {
        numerator: 1.0,
        denominator: 1.0,
        ten: 0,
        pi: 0,
        dimension: [0; 4],
    };

    pub(super) fn times(mut self, other: Factor, power: i32) -> Factor {
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

    /// Returns a count per minute as revolutions per minute, (rad/s)/(1/min); none for other units. One per second may
    /// be meant in radians as well.
    pub(super) fn revolutions(self) -> Option<Factor> {
        let per_minute = self.numerator == 1.0 && self.denominator == 60.0;
        let plain = (self.ten, self.pi, self.dimension) == (0, 0, [0, 0, -1, 0]);
        let turn = symbol("rev")?;
        (per_minute && plain).then(|| self.times(turn, 1))
    }

    /// Returns the value of these digits, in SI units and radians.
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

struct Unit {
    symbol: &'static str,
    factor: Factor,
    /// Whether the symbol takes an SI prefix.
    prefixed: bool,
}

impl Unit {
    /// Whether the symbol takes the prefix of a power of ten: an angle takes those of its parts alone, for `Grad` is a degree in
    /// German.
    fn takes(&self, power: i32) -> bool {
        self.prefixed && (power < 0 || self.factor.dimension != [0, 0, 0, 1])
    }
}

macro_rules! units {
    ($($symbol:literal: $numerator:literal / $denominator:literal, 10^$ten:literal, pi^$pi:literal, $dimension:expr, $prefixed:literal;)*) => {
        &[$(Unit {
            symbol: $symbol,
            factor: Factor {
                numerator: $numerator,
                denominator: $denominator,
                ten: $ten,
                pi: $pi,
                dimension: $dimension,
            },
            prefixed: $prefixed,
        }),*]
    };
}

/// Units with exact factors, and whether the symbol takes a prefix.
const UNITS: &[Unit] = units! {
    "m": 1.0 / 1.0, 10^0, pi^0, [1, 0, 0, 0], true;
    "g": 1.0 / 1.0, 10^-3, pi^0, [0, 1, 0, 0], true;
    "s": 1.0 / 1.0, 10^0, pi^0, [0, 0, 1, 0], true;
    "rad": 1.0 / 1.0, 10^0, pi^0, [0, 0, 0, 1], true;
    "N": 1.0 / 1.0, 10^0, pi^0, [1, 1, -2, 0], true;
    "Nm": 1.0 / 1.0, 10^0, pi^0, [2, 1, -2, 0], true;
    "Nmm": 1.0 / 1.0, 10^-3, pi^0, [2, 1, -2, 0], true;
    "J": 1.0 / 1.0, 10^0, pi^0, [2, 1, -2, 0], true;
    "W": 1.0 / 1.0, 10^0, pi^0, [2, 1, -3, 0], true;
    "Pa": 1.0 / 1.0, 10^0, pi^0, [-1, 1, -2, 0], true;
    "bar": 1.0 / 1.0, 10^5, pi^0, [-1, 1, -2, 0], true;
    "atm": 101_325.0 / 1.0, 10^0, pi^0, [-1, 1, -2, 0], false;
    "min": 60.0 / 1.0, 10^0, pi^0, [0, 0, 1, 0], false;
    "h": 3600.0 / 1.0, 10^0, pi^0, [0, 0, 1, 0], false;
    "deg": 1.0 / 180.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "°": 1.0 / 180.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "rev": 2.0 / 1.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "turn": 2.0 / 1.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "gon": 1.0 / 200.0, 10^0, pi^1, [0, 0, 0, 1], true;
    "arcmin": 1.0 / 10_800.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "arcsec": 1.0 / 648_000.0, 10^0, pi^1, [0, 0, 0, 1], false;
    "rpm": 1.0 / 30.0, 10^0, pi^1, [0, 0, -1, 1], false;
    "Hz": 2.0 / 1.0, 10^0, pi^1, [0, 0, -1, 1], true;
    "t": 1.0 / 1.0, 10^3, pi^0, [0, 1, 0, 0], false;
    "in": 254.0 / 1.0, 10^-4, pi^0, [1, 0, 0, 0], false;
    "ft": 3048.0 / 1.0, 10^-4, pi^0, [1, 0, 0, 0], false;
    "lb": 45_359_237.0 / 1.0, 10^-8, pi^0, [0, 1, 0, 0], false;
    "lbm": 45_359_237.0 / 1.0, 10^-8, pi^0, [0, 1, 0, 0], false;
    "oz": 28_349_523_125.0 / 1.0, 10^-12, pi^0, [0, 1, 0, 0], false;
    "slug": 44_482_216_152_605.0 / 3048.0, 10^-9, pi^0, [0, 1, 0, 0], false;
    "lbf": 44_482_216_152_605.0 / 1.0, 10^-13, pi^0, [1, 1, -2, 0], false;
    "kgf": 980_665.0 / 1.0, 10^-5, pi^0, [1, 1, -2, 0], false;
    "psi": 44_482_216_152_605.0 / 64_516.0, 10^-5, pi^0, [-1, 1, -2, 0], false;
};

/// Names that people and instruments write in place of symbols.
const NAMES: &[(&str, &[&str])] = &[
    ("s", &["sec", "secs", "second", "seconds"]),
    ("min", &["minutes"]),
    ("deg", &["degree", "degrees"]),
    ("rad", &["radian", "radians"]),
    ("rev", &["revs", "r", "U"]),
    ("turn", &["turns"]),
    ("rpm", &["RPM"]),
    ("in", &["inch", "inches"]),
    ("ft", &["foot", "feet"]),
    ("lb", &["lbs"]),
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

/// Returns the symbols of a dimension, without prefixes.
pub(super) fn symbols(dimension: Dimension) -> impl Iterator<Item = &'static str> {
    let of_it = UNITS
        .iter()
        .filter(move |unit| unit.factor.dimension == dimension);
    of_it.map(|unit| unit.symbol)
}

/// Returns a regular expression of every spelling of the units whose dimension satisfies `is_one`.
#[cfg(feature = "cli")]
pub(super) fn spellings(is_one: impl Fn(Dimension) -> bool) -> String {
    let prefixes = |unit: &Unit| {
        let taken = PREFIXES.iter().filter(|(_, power)| unit.takes(*power));
        let taken: Vec<&str> = taken.map(|prefix| prefix.0).collect();
        match taken.is_empty() {
            true => String::new(),
            false => format!("(?:{})?", taken.join("|")),
        }
    };
    let mut all = Vec::new();
    for unit in UNITS.iter().filter(|unit| is_one(unit.factor.dimension)) {
        let names = NAMES.iter().filter(|(symbol, _)| *symbol == unit.symbol);
        let names = names.flat_map(|(_, names)| *names);
        for name in std::iter::once(&unit.symbol).chain(names) {
            all.push(format!("{}{name}", prefixes(unit)));
        }
    }
    format!("(?:{})", all.join("|"))
}

/// Returns the factor of a symbol or name, with a prefix or without.
pub(super) fn symbol(name: &str) -> Option<Factor> {
    let find = |name: &str| {
        let named = NAMES.iter().find(|(_, names)| names.contains(&name));
        let symbol = named.map_or(name, |(symbol, _)| symbol);
        UNITS.iter().find(|unit| unit.symbol == symbol)
    };
    if let Some(unit) = find(name) {
        return Some(unit.factor);
    }
    PREFIXES.iter().find_map(|(prefix, power)| {
        let unit = find(name.strip_prefix(prefix)?)?;
        let ten = unit.factor.ten + power;
        unit.takes(*power).then_some(Factor { ten, ..unit.factor })
    })
}
