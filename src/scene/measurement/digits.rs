//! How finely values are printed: with so many decimals, or with so many digits.

/// Decades of sizes that are told apart, from 10^-FINEST on.
const DECADES: usize = 40;
const FINEST: f64 = 20.0;

/// Fewest different values of a decade that show its decimals: some may end in zeros that are not printed.
const FEWEST: usize = 20;

/// Decimals of values, by the size of the value.
#[derive(Clone, Debug)]
pub(super) struct Digits {
    decades: [Decade; DECADES],
    /// The most decimals of a value.
    most: Option<i32>,
}

/// Values of about one size.
#[derive(Clone, Copy, Debug, Default)]
struct Decade {
    values: usize,
    /// Those that differ from the one before.
    different: usize,
    last: f64,
    most: i32,
}

impl Default for Digits {
    fn default() -> Digits {
        Digits {
            decades: [Decade::default(); DECADES],
            most: None,
        }
    }
}

impl Digits {
    /// Takes a value as printed.
    pub fn take(&mut self, value: f64, text: &[u8]) {
        let decimals = decimals_of(text);
        self.most = self.most.max(Some(decimals));
        // A zero has no size.
        if value == 0.0 {
            return;
        }
        let at = (value.abs().log10() + FINEST).clamp(0.0, DECADES as f64 - 1.0);
        let decade = &mut self.decades[at as usize];
        decade.most = match decade.values {
            0 => decimals,
            _ => decade.most.max(decimals),
        };
        decade.values += 1;
        decade.different += usize::from(value != decade.last);
        decade.last = value;
    }

    /// Takes what others have shown.
    pub fn join(&mut self, other: &Digits) {
        self.most = self.most.max(other.most);
        for (mine, others) in self.decades.iter_mut().zip(other.decades) {
            *mine = match (mine.values, others.values) {
                (_, 0) => *mine,
                (0, _) => others,
                _ => Decade {
                    values: mine.values + others.values,
                    different: mine.different + others.different,
                    last: others.last,
                    most: mine.most.max(others.most),
                },
            };
        }
    }

    /// Root mean square of the steps to which the values are rounded.
    pub fn step(&self) -> f64 {
        let most = self.most.unwrap_or(0);
        let decimals = |decade: &Decade| match decade.different {
            FEWEST.. => decade.most,
            _ => most,
        };
        let shown = self.decades.iter().filter(|decade| decade.values > 0);
        let coarser = |decade: &Decade| 100f64.powi(most - decimals(decade));
        let squares = shown.clone().map(|d| d.values as f64 * coarser(d));
        let values: usize = shown.map(|decade| decade.values).sum();
        let mean = squares.sum::<f64>() / values.max(1) as f64;
        10f64.powi(-most) * mean.max(1.0).sqrt()
    }
}

/// The power of ten of the last digit of a number, changed in sign.
pub(super) fn decimals_of(cell: &[u8]) -> i32 {
    let end = cell.iter().position(|b| matches!(b, b'e' | b'E'));
    let mantissa = &cell[..end.unwrap_or(cell.len())];
    let exponent = end.and_then(|at| std::str::from_utf8(&cell[at + 1..]).ok()?.parse().ok());
    let after = mantissa
        .iter()
        .rposition(|b| *b == b'.')
        .map_or(0, |at| mantissa.len() - at - 1);
    (after as i32)
        .saturating_sub(exponent.unwrap_or(0))
        .clamp(-300, 300)
}
