//! Stretches of a record with an intensity of the process noise of their own.

pub(super) mod intensities;
pub(super) mod parted;
pub(super) mod stretch_search;

/// Stretch of the record with its factor of the process noise intensity, over the usual intensity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    /// Start time, s.
    pub from: f64,
    /// End time, s.
    pub to: f64,
    pub factor: f64,
}

/// Returns the intensity factor at a time, s: the product over the stretches that contain it.
pub(super) fn factor_at(spans: &[Span], t: f64) -> f64 {
    let around = spans.iter().filter(|span| span.from < t && t < span.to);
    around.map(|span| span.factor).product()
}
