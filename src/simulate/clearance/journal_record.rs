//! Record of bounded size for a loose joint: journal positions at regular times, and contact statistics between.

use super::result::ContactStatistics;

/// Contact statistics of an interval of time, as sums and maxima.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tally {
    pub impacts: u64,
    /// Time in contact, s.
    pub touching: f64,
    /// Time in which a massless link was in tension, s.
    pub drawn: f64,
    /// ∫ F dt, N s
    pub impulse: f64,
    /// ∫ F² dt, N² s
    pub squared: f64,
    /// Largest force, N.
    pub peak: f64,
    /// Largest penetration, m.
    pub deepest: f64,
}

impl Tally {
    pub fn add(&mut self, other: &Tally) {
        self.impacts += other.impacts;
        self.touching += other.touching;
        self.drawn += other.drawn;
        self.impulse += other.impulse;
        self.squared += other.squared;
        self.peak = self.peak.max(other.peak);
        self.deepest = self.deepest.max(other.deepest);
    }

    /// Converts the sums to means over the time from `from` to `to`, s.
    pub fn statistics(&self, from: f64, to: f64) -> ContactStatistics {
        let mean = |sum: f64| if to > from { sum / (to - from) } else { 0.0 };
        ContactStatistics {
            from_s: from,
            to_s: to,
            impacts: self.impacts,
            // The parts of the time add up to the whole but for rounding.
            contact_share: mean(self.touching).min(1.0),
            force_peak_n: self.peak,
            force_mean_n: mean(self.impulse),
            force_rms_n: mean(self.squared).sqrt(),
        }
    }
}

/// Largest number of samples, of 0.1 MB in all; beyond it every second one is dropped.
const SAMPLES_KEPT: usize = 1024;

/// Journal positions and contact statistics of one run, at a spacing that grows with the run.
#[derive(Clone, Debug)]
pub(super) struct JournalRecord {
    /// Spacing of the samples, s.
    width: f64,
    samples: Vec<[f64; 2]>,
    tallies: Vec<Tally>,
}

impl JournalRecord {
    /// Makes a record with samples at this spacing, s; the spacing doubles whenever a long run fills the record.
    pub fn new(width: f64) -> JournalRecord {
        JournalRecord {
            width,
            samples: Vec::with_capacity(SAMPLES_KEPT + 1),
            tallies: Vec::with_capacity(SAMPLES_KEPT + 1),
        }
    }

    /// Returns the time of the next sample, s.
    pub fn due(&self) -> f64 {
        self.samples.len() as f64 * self.width
    }

    /// Adds the journal position at the time that is due, m.
    pub fn sample(&mut self, journal: [f64; 2]) {
        self.samples.push(journal);
        if self.samples.len() > SAMPLES_KEPT {
            let mut index = 0;
            self.samples.retain(|_| {
                index += 1;
                index % 2 == 1
            });
            let pairs = self.tallies.chunks(2).map(|pair| {
                let mut both = pair[0];
                pair[1..].iter().for_each(|other| both.add(other));
                both
            });
            self.tallies = pairs.collect();
            self.width *= 2.0;
        }
    }

    /// Adds contact statistics at time t, s.
    pub fn tally(&mut self, t: f64, tally: &Tally) {
        let index = (t / self.width) as usize;
        if index >= self.tallies.len() {
            self.tallies
                .resize(index.min(2 * SAMPLES_KEPT) + 1, Tally::default());
        }
        let last = self.tallies.len() - 1;
        self.tallies[index.min(last)].add(tally);
    }

    /// Adds statistics from one time (s) to another, in proportion to the intervals; impacts and maxima to the middle.
    pub fn spread(&mut self, from: f64, to: f64, tally: &Tally) {
        self.tally(
            0.5 * (from + to),
            &Tally {
                impacts: tally.impacts,
                peak: tally.peak,
                deepest: tally.deepest,
                ..Tally::default()
            },
        );
        let mut start = from;
        while start < to {
            let next = ((start / self.width).floor() + 1.0) * self.width;
            let end = if next > start { next.min(to) } else { to };
            let part = (end - start) / (to - from);
            let piece = Tally {
                touching: part * tally.touching,
                drawn: part * tally.drawn,
                impulse: part * tally.impulse,
                squared: part * tally.squared,
                ..Tally::default()
            };
            self.tally(0.5 * (start + end), &piece);
            start = end;
        }
    }

    /// Sums the statistics from time t (s) on, and returns the time at which the sum begins.
    pub fn since(&self, t: f64) -> (Tally, f64) {
        let first = (t / self.width).round() as usize;
        let mut sum = Tally::default();
        let from = self.tallies.get(first..).unwrap_or_default();
        from.iter().for_each(|tally| sum.add(tally));
        (sum, first as f64 * self.width)
    }

    /// Returns the last sample time, s, up to which two records agree within a distance, m; none if throughout.
    pub fn agrees_until(&self, other: &JournalRecord, distance: f64) -> Option<f64> {
        let apart = |(a, b): (&[f64; 2], &[f64; 2])| {
            let off = (a[0] - b[0]).hypot(a[1] - b[1]);
            off > distance || off.is_nan()
        };
        let first = self.samples.iter().zip(&other.samples).position(apart)?;
        Some(first.saturating_sub(1) as f64 * self.width)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Takes steps that end between the times of the record, all in contact under a constant force.
    #[test]
    fn a_contact_without_end_takes_all_of_the_time() {
        let (end, step) = (10.0, 0.7);
        let mut record = JournalRecord::new(1.0);
        let steps = (0..15).map(|i| step * f64::from(i));
        for from in steps {
            let to = f64::min(from + step, end);
            let tally = Tally {
                touching: to - from,
                impulse: 3.0 * (to - from),
                ..Tally::default()
            };
            record.spread(from, to, &tally);
        }
        for since in 0..10 {
            let (tally, from) = record.since(f64::from(since));
            let seen = tally.statistics(from, end);
            assert!((seen.contact_share - 1.0).abs() < 1e-14, "{seen:?}");
            assert!(
                (tally.touching / (end - from) - 1.0).abs() < 1e-14,
                "{seen:?}"
            );
            assert!((seen.force_mean_n - 3.0).abs() < 1e-13, "{seen:?}");
        }
    }
}
