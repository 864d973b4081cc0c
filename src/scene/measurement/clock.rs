//! Times as decimal numbers of a file, or as dates and hours of the day: the time since the first row to all its digits.

/// A number as written: `digits` times ten to the power of minus `decimals`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Decimal {
    digits: i128,
    decimals: usize,
}

/// Powers of ten that doubles hold exactly.
const EXACT: usize = 22;

impl Decimal {
    /// A number without exponent, or the seconds of a date and an hour of the day.
    pub fn of(cell: &str) -> Option<Decimal> {
        match seconds(cell) {
            Some((whole, part)) => Decimal::plain(&whole.to_string(), part),
            None => {
                let (whole, part) = cell.split_once(['.', ',']).unwrap_or((cell, ""));
                Decimal::plain(whole, part)
            }
        }
    }

    fn plain(whole: &str, part: &str) -> Option<Decimal> {
        let is_plain = part.bytes().all(|byte| byte.is_ascii_digit());
        let digits = is_plain.then(|| format!("{whole}{part}"))?;
        Some(Decimal {
            digits: digits.parse().ok()?,
            decimals: part.len(),
        })
    }

    /// What this number is above another one, rounded once.
    pub fn since(self, other: Decimal) -> Option<f64> {
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

/// Whether a cell is an hour of the day, with or without a date.
pub(super) fn is_clock(cell: &str) -> bool {
    seconds(cell).is_some()
}

/// Whole seconds, since 1970 where there is a date, and the decimals of `2024-05-01T12:30:05.25Z`, `2024-05-01 12:30:05.25`
/// or `12:30:05.25`.
fn seconds(cell: &str) -> Option<(i64, &str)> {
    let (date, clock) = cell
        .split_once(['T', ' '])
        .map_or((None, cell), |(date, clock)| (Some(date), clock));
    let (clock, zone) = match clock.rfind(['Z', '+', '-']) {
        Some(at) => clock.split_at(at),
        None => (clock, "Z"),
    };
    let (clock, part) = clock.split_once(['.', ',']).unwrap_or((clock, ""));
    let [hour, minute, second] = numbers(clock, ':')?;
    let days = date.map_or(Some(0), |date| numbers(date, '-').map(days));
    let is_time =
        hour < 24 && minute < 60 && second < 61 && part.bytes().all(|byte| byte.is_ascii_digit());
    let whole = 86_400 * days? + 3600 * hour + 60 * minute + second;
    is_time.then_some((whole - offset(zone)?, part))
}

/// Three whole numbers between separators.
fn numbers(text: &str, separator: char) -> Option<[i64; 3]> {
    let mut parts = text.split(separator).map(|part| {
        let is_plain =
            !part.is_empty() && part.len() <= 4 && part.bytes().all(|byte| byte.is_ascii_digit());
        is_plain.then(|| part.parse().ok()).flatten()
    });
    let three = [parts.next()??, parts.next()??, parts.next()??];
    parts.next().is_none().then_some(three)
}

/// Seconds of a time zone `Z`, `+02:00` or `+0200` east of Greenwich.
fn offset(zone: &str) -> Option<i64> {
    let digits: String = zone.get(1..)?.chars().filter(|c| *c != ':').collect();
    let sign = match zone.chars().next()? {
        'Z' => return digits.is_empty().then_some(0),
        '-' => -1,
        _ => 1,
    };
    let number: i64 = digits.parse().ok().filter(|_| digits.len() == 4)?;
    Some(sign * (3600 * (number / 100) + 60 * (number % 100)))
}

/// Days from 1970-01-01 of a Gregorian date (Hinnant, `days_from_civil`): the year begins in March.
fn days([year, month, day]: [i64; 3]) -> i64 {
    let year = if month > 2 { year } else { year - 1 };
    let of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400) + of_year
        - 719_468
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
            ("2024-02-28T23:59:59.75", "2024-03-01 00:00:00", 86_400.25),
            ("2023-12-31T23:59:59,5Z", "2024-01-01T02:00:00.0+02:00", 0.5),
            ("12:30:05.001", "12:30:05.0025", 0.0015),
            ("1970-01-01T00:00:00Z", "2023-11-14T22:13:20Z", 1.7e9),
        ] {
            let [first, now] = [first, now].map(Decimal::of);
            let found = now.and_then(|now| now.since(first?));
            assert_eq!(found, Some(since), "{first:?} {now:?}");
        }
        for text in [
            "1.7e9",
            "",
            ".",
            "1.-5",
            "12:30",
            "25:00:00",
            "1.5s",
            "2024-05-01",
        ] {
            assert_eq!(Decimal::of(text), None, "{text}");
        }
    }
}
