//! Time stamps so far from zero that doubles do not hold all their digits: the time since the first row, in decimal.

use super::Measurement;
use super::source::Records;

/// Part of the usual step to which times have to be known.
const COARSE: f64 = 1e-6;

/// Powers of ten that doubles hold exactly.
const EXACT: usize = 22;

impl Measurement {
    /// How far doubles as large as the times know them, s, if that is too little for steps as short as these.
    pub(super) fn lost(&self) -> Option<f64> {
        let times = &self.times;
        let (first, last) = (*times.first()?, *times.last()?);
        let step = (last - first) / times.len() as f64;
        let known = f64::EPSILON * first.abs().max(last.abs());
        (known > COARSE * step).then_some(known)
    }

    /// Counts times from the first row where doubles lose digits of the time stamps in the file.
    pub(super) fn count_from_first_row(&mut self) {
        if self.lost().is_some() {
            self.elapsed = self.since_first_row();
            self.origin = self.elapsed.as_ref().map_or(0.0, |_| self.times[0]);
        }
    }

    /// Times since the first row, s, from the texts of both; none for what is not of digits alone.
    fn since_first_row(&self) -> Option<Vec<f64>> {
        let source = self.source.as_ref()?;
        let mut records = Records::new(&source.text, source.delimiter);
        if source.has_header {
            records.next();
        }
        let mut first = None;
        let mut elapsed = Vec::with_capacity(self.times.len());
        while records.next() {
            let time = Decimal::of(records.record.get(source.columns[0])?)?;
            let first = *first.get_or_insert(time);
            elapsed.push(time.since(first)? * source.time.factor);
        }
        Some(elapsed)
    }
}

/// A number as written: `digits` times ten to the power of minus `decimals`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Decimal {
    digits: i128,
    decimals: usize,
}

impl Decimal {
    fn of(cell: &[u8]) -> Option<Decimal> {
        let text = std::str::from_utf8(cell).ok()?;
        let (whole, part) = text.split_once(['.', ',']).unwrap_or((text, ""));
        let is_plain = part.bytes().all(|byte| byte.is_ascii_digit());
        let digits = is_plain.then(|| format!("{whole}{part}"))?;
        Some(Decimal {
            digits: digits.parse().ok()?,
            decimals: part.len(),
        })
    }

    /// What this number is above another one, rounded once.
    fn since(self, other: Decimal) -> Option<f64> {
        let decimals = self.decimals.max(other.decimals);
        let aligned = |number: Decimal| {
            let more = u32::try_from(decimals - number.decimals).ok()?;
            number.digits.checked_mul(10i128.checked_pow(more)?)
        };
        let digits = aligned(self)?.checked_sub(aligned(other)?)?;
        if digits.unsigned_abs() < 1 << f64::MANTISSA_DIGITS && decimals <= EXACT {
            // Both are exact, so the quotient is rounded once.
            return Some(digits as f64 / 10f64.powi(decimals as i32));
        }
        format!("{digits}e-{decimals}").parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_stamps_are_subtracted_in_decimal() {
        for (first, now, since) in [
            ("1700000000.123", "1700000000.124", 0.001),
            ("1700000000.1", "1700000000.1000001", 1e-7),
            ("1700000000", "1700003600.25", 3600.25),
            ("-1700000000.5", "-1699999999.75", 0.75),
            ("1700000000123456789", "1700000000123456790", 1.0),
            (
                "0.0000000000000000000000000",
                "0.0000000000000000000000001",
                1e-25,
            ),
            ("1700000000,25", "1700000000,5", 0.25),
        ] {
            let [first, now] = [first, now].map(|text| Decimal::of(text.as_bytes()));
            let found = now.and_then(|now| now.since(first?));
            assert_eq!(found, Some(since), "{first:?} {now:?}");
        }
        for text in ["1.7e9", "", ".", "1.-5", "12:30:05", "1.5s"] {
            assert_eq!(Decimal::of(text.as_bytes()), None, "{text}");
        }
    }
}
