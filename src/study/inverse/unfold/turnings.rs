//! Where the measured value turns back: there alone a motion can change strokes.

/// A sample with a largest or smallest value.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turning {
    pub at: usize,
    /// Whether the value is a largest one.
    pub above: bool,
}

/// The largest and smallest values between which the value changes by more than a threshold.
pub(super) fn turnings(values: &[f64], threshold: f64) -> Vec<Turning> {
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
            found.extend(up.map(|_| Turning {
                at: most,
                above: true,
            }));
            (up, least) = (Some(false), at);
        } else if up != Some(true) && values[at] - values[least] > threshold {
            found.extend(up.map(|_| Turning {
                at: least,
                above: false,
            }));
            (up, most) = (Some(true), at);
        }
    }
    found
}
