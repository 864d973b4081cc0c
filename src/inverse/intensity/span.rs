//! Stretches of a record with an intensity of the process noise of their own.

/// Stretch of the record with its factor of the process noise intensity.
#[derive(Clone, Copy, Debug)]
pub(in crate::inverse) struct Span {
    /// Start time, s.
    pub from: f64,
    /// End time, s.
    pub to: f64,
    pub factor: f64,
}

/// Intensity factors of the process noise along a record, over the usual intensity.
#[derive(Clone, Debug, Default)]
pub(in crate::inverse) struct Intensities(pub Vec<Span>);

impl Intensities {
    /// Returns the intensity factor at a time, s: the product over the stretches that contain it.
    pub fn at(&self, t: f64) -> f64 {
        let spans = self.0.iter().filter(|span| span.from < t && t < span.to);
        spans.map(|span| span.factor).product()
    }
}
