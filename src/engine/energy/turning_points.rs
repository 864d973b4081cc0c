//! Turning points of a motion and the range of its speed.

use super::Orbit;
use super::segment::After;

impl Orbit {
    /// Returns the smallest and the largest speed up to a time (s), with sign, rad/s.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        if until == 0.0 {
            return (self.speed, self.speed);
        }
        let mut range = (f64::INFINITY, f64::NEG_INFINITY);
        let mut widen = |(low, high): (f64, f64), direction: f64| {
            let (low, high) = match direction > 0.0 {
                true => (low, high),
                false => (-high, -low),
            };
            range = (range.0.min(low), range.1.max(high));
        };
        let there = self.forward.duration.0;
        if let Some(later) = self.later.as_ref().filter(|_| until > there) {
            widen(later.speed_range(until), self.direction);
        }
        let forward = (Some(&self.forward), until, self.direction);
        let backward = (self.backward.as_ref(), until - 2.0 * there, -self.direction);
        for (segment, since, direction) in [forward, backward] {
            let Some(segment) = segment.filter(|_| since > 0.0) else {
                continue;
            };
            widen(segment.speed_range(0.0, since), direction);
            let end = segment.duration.0;
            if segment.after == After::TurnsBack && since > end {
                // The motion returns over the same states, beginning at the last.
                let back = (2.0 * end - since).max(0.0);
                widen(segment.speed_range(back, end), -direction);
            }
        }
        range
    }

    /// Returns the times (s) of the turning points in a period, or in a whole motion that does not repeat; a start at
    /// rest counts at the end of the period.
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

    /// Returns the times of the turning points up to a time, s.
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
