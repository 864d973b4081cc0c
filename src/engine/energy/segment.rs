//! Segment: panels in one direction, from the start until the motion turns back, repeats or ends.

use super::extreme::extreme;
use super::panel::Panel;
use crate::numeric::angle::Angle;
use crate::numeric::exact::two_sum;

/// Most panels kept of a segment: 150 MB.
pub(in crate::engine) const MOST_PANELS: usize = 200_000;

/// Continuation after the last panel of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum After {
    /// Repetition of the turn.
    Repeats,
    /// Another turn, under the same forces.
    GoesOn,
    /// Turning point.
    TurnsBack,
    /// No continuation needed: the run ends on the segment.
    Ends,
}

/// Sequence of panels.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Segment {
    pub panels: Vec<Panel>,
    /// Total duration, s: rounded value and remainder.
    pub duration: (f64, f64),
    pub after: After,
    /// Error bound of the duration, s.
    pub error: f64,
    /// Largest truncation error of the time inside a panel, s.
    pub truncation_error: f64,
    /// Largest tail of the series of the panels, relative to the largest coefficient.
    pub tail: f64,
}

impl Segment {
    /// Makes a segment without panels, open at its end.
    pub fn open() -> Segment {
        Segment {
            panels: Vec::with_capacity(8),
            duration: (0.0, 0.0),
            after: After::Ends,
            error: 0.0,
            truncation_error: 0.0,
            tail: 0.0,
        }
    }

    /// Adds the time over an angle (rad) that the rounded end of a turn leaves out.
    pub fn complete(&mut self, turn_remainder: f64) {
        let Some(panel) = self.panels.last() else {
            return;
        };
        let late = turn_remainder / panel.speed(1.0).abs();
        if late.is_finite() {
            self.duration = two_sum(self.duration.0, self.duration.1 + late);
        }
    }

    /// Returns the number of turns begun.
    pub fn turns(&self) -> f64 {
        let whole = self.panels.last().map(|panel| panel.turns.abs() + 1.0);
        whole.unwrap_or_default()
    }

    /// Combines segments with the same pieces linearly, with weights of sum one.
    pub fn blend(segments: &[Segment], shares: &[f64]) -> Segment {
        let mut segment = Segment::open();
        for index in 0..segments.first().map_or(0, |first| first.panels.len()) {
            let parts = segments.iter().zip(shares);
            let panel =
                Panel::blend(parts.map(|(segment, share)| (&segment.panels[index], *share)));
            if let Some(panel) = panel {
                segment.push(panel);
            }
        }
        segment
    }

    pub fn push(&mut self, mut panel: Panel) {
        panel.begin = self.duration.0;
        let (sum, lost) = two_sum(self.duration.0, panel.duration.0);
        self.duration = two_sum(sum, lost + self.duration.1 + panel.duration.1);
        self.error += panel.error;
        self.truncation_error = self.truncation_error.max(panel.truncation_error());
        self.tail = self.tail.max(panel.tail);
        self.panels.push(panel);
    }

    /// Returns angle (turns of the panel, remainder) and speed (rad/s) a time after the start of the segment, s.
    pub fn state(&self, after: f64) -> (Angle, f64) {
        let panel = &self.panels[self.index_at(after)];
        let (rest, speed) = panel.state(after - panel.begin);
        (Angle::new(panel.turns, rest), speed)
    }

    /// Returns the time (s) at which an angle is reached and the speed there (rad/s); none off the segment. Angles off
    /// its ends by rounding count as the ends.
    pub fn at(&self, angle: Angle) -> Option<(f64, f64)> {
        let (index, local) = self.located(angle)?;
        let panel = &self.panels[index];
        let (after, speed) = panel.at(local);
        Some((panel.begin + after, speed))
    }

    /// Returns the index of the panel that passes an angle, and the angle as one of the panel, rad; none off the segment.
    pub fn located(&self, angle: Angle) -> Option<(usize, f64)> {
        // Panels follow each other in one direction.
        let is_begun = |panel: &Panel| {
            let piece = &panel.piece;
            (panel.local(angle) - piece.from) * (piece.to - piece.from) >= 0.0
        };
        let index = self.panels.partition_point(is_begun).saturating_sub(1);
        let panel = self.panels.get(index)?;
        Some((index, panel.piece.nearest(panel.local(angle))?))
    }

    /// Returns the smallest and largest |speed| between two times (s), rad/s.
    pub fn speed_range(&self, from: f64, until: f64) -> (f64, f64) {
        let mut whole = Vec::with_capacity(self.panels.len());
        let mut parts = Vec::new();
        for panel in &self.panels {
            let (begin, end) = (panel.begin, panel.begin + panel.duration.0);
            if from <= begin && end <= until {
                whole.push(panel);
            } else if from < end && begin <= until {
                parts.push((panel, (from - begin).max(0.0), until.min(end) - begin));
            }
        }
        let largest = |sign: f64| {
            let of_parts = parts
                .iter()
                .map(|(panel, from, until)| panel.extreme_between(*from, *until, sign));
            of_parts.fold(extreme(&whole, sign), f64::max)
        };
        (-largest(-1.0), largest(1.0))
    }

    /// Returns the panel at a time, and the time since its start, s.
    pub fn panel_at(&self, after: f64) -> Option<(&Panel, f64)> {
        let panel = self.panels.get(self.index_at(after))?;
        Some((panel, after - panel.begin))
    }

    /// Returns the index of the panel at a time, s.
    pub fn index_at(&self, after: f64) -> usize {
        let begun = self.panels.partition_point(|panel| panel.begin <= after);
        begun.max(1) - 1
    }

    /// Returns the largest kinetic energy at the ends of panels, J.
    pub fn largest_kinetic(&self) -> f64 {
        let ends = self.panels.iter().map(|panel| panel.kinetic_at_end);
        ends.fold(0.0, f64::max)
    }
}
