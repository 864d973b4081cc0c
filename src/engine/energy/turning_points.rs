//! When a motion turns back.

use super::Orbit;
use super::segment::After;

impl Orbit {
    /// Times (s) of the turning points in a period, or in all of a motion that does not repeat; a start at rest is one at the
    /// end of the period.
    fn turnings(&self) -> Vec<f64> {
        let mut found = Vec::new();
        let there = self.forward.duration.0;
        if self.forward.after == After::TurnsBack {
            found.push(there);
            found.extend(self.from_rest.then_some(2.0 * there));
        }
        let back = self.backward.as_ref();
        let back = back.filter(|back| back.after == After::TurnsBack);
        found.extend(back.map(|back| 2.0 * there + back.duration.0));
        found
    }

    /// When it turns back, until a time.
    pub fn turning_times(&self, until: f64) -> Vec<f64> {
        let once = self.turnings();
        let Some((period, _)) = self.period().filter(|_| !once.is_empty()) else {
            return once.into_iter().filter(|t| *t <= until).collect();
        };
        let rounds = (until / period).ceil() as u64;
        (0..=rounds)
            .flat_map(|round| once.iter().map(move |t| t + round as f64 * period))
            .filter(|t| *t <= until)
            .collect()
    }
}
