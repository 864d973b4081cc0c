//! Phase unwrapping of measured crank angles: samples of theta in, as they are or reduced to a period, continuous angles out.
//! A step from sample to sample is continued by as many periods as bring it nearest to the usual step about it, so that a
//! value that is far off, or a gap of several turns, does not mislead the ones after it.

use std::f64::consts::{PI, TAU};
use std::ops::Range;

use super::Measurement;
use crate::error::Error;
use crate::numeric::median::{median, range};
use crate::numeric::parallel;

/// Largest range of angles reduced to a period, in periods: noise and the scale of a sensor exceed one.
const ONE_PERIOD: f64 = 1.05;

/// Ratio of the speed at a jump by more than half a turn to the median speed, above which the jump is reported.
const JUMP: f64 = 10.0;

/// What is to be added to the angles from the second sample on, rad, and the warning about it.
type Continued = (Vec<f64>, Option<String>);

/// Crank angles continued over the turns.
pub(crate) struct Unwrapped {
    /// Crank angle at each sample, rad.
    pub theta: Vec<f64>,
    /// Warning about what was continued.
    pub warning: Option<String>,
}

impl Measurement {
    /// Returns a measured crank angle as it is, or continued if it was reduced to one turn, to a cycle of two, or by a counter.
    ///
    /// # Errors
    /// [`Error::Refused`] where the samples do not say how far the crank went.
    pub(crate) fn unwrapped(&self) -> Result<Unwrapped, Error> {
        let mut theta = self.values.clone();
        if (1..theta.len()).all(|i| self.change(i).abs() <= PI) {
            let warning = None;
            return Ok(Unwrapped { theta, warning });
        }
        let (offsets, warning) = match self.period() {
            Some(period) => self.continued(period)?,
            None => self.across_jumps().unwrap_or_default(),
        };
        let pairs = theta.iter_mut().skip(1).zip(offsets);
        pairs.for_each(|(theta, offset)| *theta += offset);
        Ok(Unwrapped { theta, warning })
    }

    /// Returns the period, rad, that the range of the angles shows but for single values that are far off: a turn, a cycle of
    /// two turns, or that of a counter of 16 bits. None where no step is longer than half of it.
    fn period(&self) -> Option<f64> {
        let values = self.values.windows(3);
        let middles = values.filter_map(|w| median(w.iter().copied()));
        let (least, most) = range(&middles.collect::<Vec<_>>());
        let is_long = |period: f64| (1..self.len()).any(|i| self.change(i).abs() > 0.5 * period);
        let counter = f64::from(1 << 16) * self.resolution;
        let counter = self.is_counted().then_some(counter);
        let mut periods = [TAU, 2.0 * TAU].into_iter().chain(counter);
        periods.find(|period| most - least <= ONE_PERIOD * period && is_long(*period))
    }

    /// Returns the change of the angle in step i, which leads to sample i, as it stands, rad.
    fn change(&self, i: usize) -> f64 {
        self.values[i] - self.values[i - 1]
    }

    /// Returns the duration of a step, s.
    fn duration(&self, i: usize) -> f64 {
        let times = self.elapsed();
        times[i] - times[i - 1]
    }

    /// Returns the change in a step at the median speed of some steps, rad.
    fn usual(&self, i: usize, steps: impl Iterator<Item = usize>) -> f64 {
        let speeds = steps.map(|k| self.change(k) / self.duration(k));
        median(speeds).map_or(0.0, |speed| speed * self.duration(i))
    }

    /// Returns the steps before and after one that tell the usual speed there.
    fn steps_about(&self, i: usize) -> [Range<usize>; 2] {
        let some = 3;
        [
            i.saturating_sub(some).max(1)..i,
            i + 1..(i + 1 + some).min(self.len()),
        ]
    }

    /// Returns the change that is expected in a step, by those about it, rad.
    fn expected(&self, i: usize) -> f64 {
        let [before, after] = self.steps_about(i);
        self.usual(i, before.start..after.end)
    }

    /// Number of periods by which a step is longer than a change, rad.
    fn periods(&self, i: usize, change: f64, period: f64) -> f64 {
        ((self.change(i) - change) / period).round()
    }

    /// Continues angles that were reduced to a period, rad.
    fn continued(&self, period: f64) -> Result<Continued, Error> {
        let steps = 1..self.len();
        let usual = median(steps.clone().map(|i| self.duration(i))).unwrap_or(0.0);
        let expected = parallel::list(self.len() - 1, |k| self.expected(k + 1));
        // Part of a period from which on an expected step may be one in the other direction.
        let ambiguous = 0.4;
        let is_doubtful = |i: &usize| {
            let is_gap = self.duration(*i) > 1.5 * usual;
            expected[i - 1].abs() > ambiguous * period && !(is_gap && self.agrees(*i, period))
        };
        if let Some(sample) = steps.clone().find(is_doubtful) {
            return Err(Error::refused(
                format!(
                    "theta is reduced to {}, and may have gone either way at {}: the samples do not say which way the crank went, nor how far",
                    self.shown(period),
                    self.place(sample)
                ),
                "sample more often, or give theta without reducing it",
            ));
        }
        let mut sum = 0.0;
        let offsets = steps.map(|i| {
            sum -= self.periods(i, expected[i - 1], period) * period;
            sum
        });
        let offsets: Vec<f64> = offsets.collect();
        let is_continued = offsets.windows(2).any(|w| w[0] == w[1] && w[0] != 0.0);
        let said = match period == TAU {
            true => "theta stays within one turn and jumps: it is taken as reduced to one turn, and continued over the turns by the usual speed".to_owned(),
            false => format!("theta stays within {} and jumps: it is taken as reduced to it, and continued by the usual speed", self.shown(period)),
        };
        Ok((offsets, is_continued.then_some(said)))
    }

    /// True if the speeds before and after a gap tell the same number of periods in it.
    fn agrees(&self, i: usize, period: f64) -> bool {
        let [a, b] = self
            .steps_about(i)
            .map(|some| self.periods(i, self.usual(i, some), period));
        a == b
    }

    /// True if a step makes up for values that the sensor held: it is nearer to the usual change since the first of them than to
    /// whole turns.
    fn was_held(&self, i: usize) -> bool {
        let held = (1..i).rev().take_while(|k| self.change(*k) == 0.0);
        let duration: f64 = held.map(|k| self.duration(k)).sum();
        let [_, after] = self.steps_about(i);
        let usual = self.usual(i, after) * (1.0 + duration / self.duration(i));
        let off = |change: f64| (self.change(i) - change).abs();
        duration > 0.0 && off(usual) < off((self.change(i) / TAU).round() * TAU)
    }

    /// Continues an angle whose turns jump, for example where their counter was reset, by whole turns; other jumps are left.
    fn across_jumps(&self) -> Option<Continued> {
        let speed = |i: usize| (self.change(i) / self.duration(i)).abs();
        let usual = median((1..self.len()).map(speed))?;
        let is_fast = |i: usize| self.change(i).abs() > PI && speed(i) > JUMP * usual;
        let jumps = |i: &usize| is_fast(*i) && !self.was_held(*i);
        let all: Vec<usize> = (1..self.len()).filter(jumps).collect();
        let first = *all.first()?;
        // What whole turns leave of each jump is a usual step.
        let left = |i: &usize| {
            let off = self.change(*i) - self.expected(*i);
            (off - (off / TAU).round() * TAU).abs() <= JUMP * usual * self.duration(*i)
        };
        let are_turns = all.iter().all(left);
        let mut sum = 0.0;
        let offsets = (1..self.len()).map(|i| {
            if are_turns && jumps(&i) {
                sum -= self.periods(i, self.expected(i), TAU) * TAU;
            }
            sum
        });
        let offsets = offsets.collect();
        let said = format!(
            "theta jumps {}, by {} at {}: more than half a turn, more than {JUMP} times as fast as usual; it is {}",
            match all.len() {
                1 => "once".to_owned(),
                count => format!("{count} times, first"),
            },
            self.shown(self.change(first)),
            self.place(first),
            match are_turns {
                true => "continued over the jump by whole turns",
                false => "taken as it is",
            }
        );
        Some((offsets, Some(said)))
    }
}
