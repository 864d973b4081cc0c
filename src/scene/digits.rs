//! Precision of printed values: decimals and significant digits.

/// Largest numbers of decimals and of significant digits of printed values. All values have as many decimals, or larger
/// ones have fewer decimals and as many digits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Digits {
    decimals: i32,
    significant: i32,
}

/// Bound of the number of decimals, positive or negative, up to which powers of ten are normal doubles.
const MOST_DECIMALS: i32 = 300;

impl Digits {
    /// Decimals and digits of an empty list.
    pub const EMPTY: Digits = Digits {
        decimals: -MOST_DECIMALS,
        significant: 1,
    };

    /// Returns decimals and digits of a number with a decimal point.
    pub fn of(text: &str) -> Digits {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let after = mantissa.split_once('.').map_or(0, |(_, after)| after.len());
        let decimals = (after as i32).saturating_sub(exponent.parse().unwrap_or(0));
        let digits = mantissa.bytes().filter(u8::is_ascii_digit);
        Digits {
            decimals: decimals.clamp(-MOST_DECIMALS, MOST_DECIMALS),
            significant: digits.skip_while(|digit| *digit == b'0').count() as i32,
        }
    }

    pub fn last_unit(self) -> f64 {
        10f64.powi(-self.decimals)
    }

    /// Returns the larger decimals and digits of two.
    pub fn or(self, other: Digits) -> Digits {
        Digits {
            decimals: self.decimals.max(other.decimals),
            significant: self.significant.max(other.significant),
        }
    }

    /// Returns the root mean square of the rounding steps of the values: the coarser of last decimal and last digit.
    pub fn step(self, values: &[f64]) -> f64 {
        let finest = self.last_unit();
        let square = |value: &f64| {
            let size = value.abs().log10().floor() as i32;
            let excess = (size + 1 - self.significant)
                .saturating_add(self.decimals)
                .max(0);
            100f64.powi(excess)
        };
        // A zero has no order of magnitude.
        let sized = values.iter().filter(|value| **value != 0.0);
        let (count, sum) = sized.fold((0u32, 0.0), |(count, sum), value| {
            (count + 1, sum + square(value))
        });
        finest * (sum / f64::from(count.max(1))).max(1.0).sqrt()
    }
}
