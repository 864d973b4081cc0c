//! Times to full precision: counted from the first row where they are far from zero, and evenly spaced where they are
//! even times rounded to the decimals of a file.

use super::Measurement;
use crate::numeric::median::median;
use crate::scene::number::computed;

/// Decimal number as written: `digits` times ten to the power of minus `decimals`.
#[derive(Clone, Copy, Debug)]
struct Decimal {
    digits: i128,
    decimals: usize,
}

impl Decimal {
    /// Parses a number without exponent.
    fn of(cell: &str) -> Option<Decimal> {
        let (whole, part) = cell.split_once(['.', ',']).unwrap_or((cell, ""));
        let is_plain = part.bytes().all(|byte| byte.is_ascii_digit());
        let digits = is_plain.then(|| format!("{whole}{part}"))?;
        Some(Decimal {
            digits: digits.parse().ok()?,
            decimals: part.len(),
        })
    }

    /// Returns the difference of this number and another, rounded once.
    fn since(self, other: Decimal) -> Option<f64> {
        let decimals = self.decimals.max(other.decimals);
        let aligned = |number: Decimal| {
            let more = u32::try_from(decimals - number.decimals).ok()?;
            number.digits.checked_mul(10i128.checked_pow(more)?)
        };
        let digits = aligned(self)?.checked_sub(aligned(other)?)?;
        format!("{digits}e-{decimals}").parse().ok()
    }
}

impl Measurement {
    /// Returns the spacing of doubles at the times, s, if it is more than 1e-6 of the mean time step.
    pub(super) fn lost(&self) -> Option<f64> {
        let (first, last) = (*self.times.first()?, *self.times.last()?);
        let step = (last - first) / self.times.len() as f64;
        let known = f64::EPSILON * first.abs().max(last.abs());
        (known > 1e-6 * step).then_some(known)
    }

    /// Counts times from the first row where doubles lose digits of the time stamps in the file.
    pub(super) fn count_from_first_row(&mut self) {
        if self.lost().is_some() {
            self.elapsed = self.since_first_row();
            self.origin = self.elapsed.as_ref().map_or(0.0, |_| self.times[0]);
        }
    }

    /// Computes the times since the first row, s, from the texts of both; none if a time is not of digits alone.
    fn since_first_row(&self) -> Option<Vec<f64>> {
        let source = self.source.as_ref()?;
        let mut first = None;
        let mut since = |row: &str| {
            let time = Decimal::of(source.dialect.cells(row).nth(source.at[0])?)?;
            let first = *first.get_or_insert(time);
            Some(time.since(first)? * self.time.factor)
        };
        source.dialect.rows(&source.text).map(&mut since).collect()
    }

    /// Replaces times that are rounded values of even times by the even times, but within the written ones, which the rows
    /// of tables over the time may not exceed; returns a note where a value changes by more than its last digit meanwhile.
    pub(super) fn space_evenly(&mut self) -> Option<String> {
        let times = self.elapsed();
        let even = Even::of(times)?;
        let (count, first, last) = (times.len(), times[0], times[times.len() - 1]);
        let steps = times.windows(2).zip(self.values.windows(2));
        let changes = steps.map(|(t, value)| (value[1] - value[0]).abs() / (t[1] - t[0]));
        let is_seen = changes.fold(0.0, f64::max) * even.step > self.resolution;
        if self.lost().is_some() {
            self.origin = self.times[0];
        }
        let earlier = first - (self.times[0] - self.origin);
        let time = |place: &f64| {
            let time = first + even.first + even.period * place;
            time.clamp(first, last) - earlier
        };
        self.period_uncertainty = even.step / ((count as f64).sqrt() * (last - first));
        self.elapsed = Some(even.places.iter().map(time).collect());
        is_seen.then(|| format!(
            "the times are those of samples {} s apart, rounded to {} s: the fit takes them as even",
            computed(even.period),
            computed(even.step)
        ))
    }
}

/// Even times, s, that were rounded.
struct Even {
    /// Place of each sample among those that would be there without gaps, from 0.
    places: Vec<f64>,
    /// Time of the first sample minus its rounded one.
    first: f64,
    /// Sampling period.
    period: f64,
    /// Rounding step.
    step: f64,
}

impl Even {
    /// Fits a line by least squares through times; none unless they are rounded values of even times, with gaps or without.
    fn of(times: &[f64]) -> Option<Even> {
        let count = times.len() as f64;
        let gaps = || times.windows(2).map(|pair| pair[1] - pair[0]);
        let mean = |most: f64| {
            let some = || gaps().filter(|gap| *gap < most);
            some().sum::<f64>() / some().count() as f64
        };
        // A mean less long gaps is one of gaps of one period, in which rounding may double the shortest.
        let usual = mean(2.01 * median(gaps())?);
        let single = || gaps().filter(|gap| *gap < 1.5 * usual);
        let short = single().fold(f64::INFINITY, f64::min);
        let long = single().fold(0.0, f64::max);
        // Rounding makes gaps that differ by one step, and keeps the order of the samples.
        let step = long - short;
        let rounding_of_doubles = 1e3 * f64::EPSILON * (times.last()? - times[0]);
        if step < rounding_of_doubles || step > short + rounding_of_doubles {
            return None;
        }
        let usual = mean(1.5 * usual);
        let mut places = vec![0.0];
        places.extend(gaps().scan(0.0, |place, gap| {
            *place += (gap / usual).round();
            Some(*place)
        }));
        let since = || {
            places
                .iter()
                .zip(times)
                .map(|(k, time)| (k, time - times[0]))
        };
        let middle = places.iter().sum::<f64>() / count;
        let mean = since().map(|(_, time)| time).sum::<f64>() / count;
        let moment: f64 = since().map(|(k, time)| (k - middle) * time).sum();
        let period = moment / places.iter().map(|k| (k - middle).powi(2)).sum::<f64>();
        let first = mean - period * middle;
        // Errors beyond rounding, in rounding steps.
        let most_off = 0.1;
        let mut off_line = since().map(|(k, time)| (time - first - period * k).abs());
        let mut off_step = single().map(|gap| (gap - short).min(long - gap));
        (off_line.all(|off| off < (0.5 + most_off) * step)
            && off_step.all(|off| off < most_off * step))
        .then_some(Even {
            places,
            first,
            period,
            step,
        })
    }
}
