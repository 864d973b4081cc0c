//! Where the measured value turns back: there alone a motion can change strokes.

use super::record::Record;

/// A sample with a largest or smallest value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turning {
    pub at: usize,
    /// Whether the value is a largest one.
    pub above: bool,
}

/// The largest and smallest values between which the value changes by more than a threshold, or by more than a lower
/// one before the first of them and after the last.
pub(super) fn turnings(record: &Record<'_>) -> Vec<Turning> {
    let values = record.values;
    let [threshold, at_ends] = record.thresholds();
    let mut found = Vec::new();
    let (mut least, mut most) = (0, 0);
    // Whether the value is on its way up, once that is known.
    let mut up = None;
    for at in 1..values.len() {
        if values[at] >= values[most] {
            most = at;
        }
        if values[at] <= values[least] {
            least = at;
        }
        if up != Some(false) && values[most] - values[at] > threshold {
            if up.is_some() || values[most] - values[0] > at_ends {
                found.push(Turning {
                    at: most,
                    above: true,
                });
            }
            (up, least) = (Some(false), at);
        } else if up != Some(true) && values[at] - values[least] > threshold {
            if up.is_some() || values[0] - values[least] > at_ends {
                found.push(Turning {
                    at: least,
                    above: false,
                });
            }
            (up, most) = (Some(true), at);
        }
    }
    let last = values.last().copied().unwrap_or(0.0);
    match up {
        Some(true) if values[most] - last > at_ends => found.push(Turning {
            at: most,
            above: true,
        }),
        Some(false) if last - values[least] > at_ends => found.push(Turning {
            at: least,
            above: false,
        }),
        _ => (),
    }
    found
}
