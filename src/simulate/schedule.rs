//! Schedule of output rows at regular times or crank angles. Times come from an index, never from a sum of steps.

use std::f64::consts::TAU;

use crate::error::Error;
use crate::scene::{Every, Extent, MOST_OUTPUT_ROWS};

/// Number of rows of a run without `output_every`: a smooth curve in a plot.
const DEFAULT_ROWS: u32 = 500;

/// Distance of two rows, as part of the row spacing, within which they are one but for rounding.
pub(super) const SAME_ROW: f64 = 1e-9;

/// Lists the whole numbers passed on the way from `a` to `b`, in the order of passing, without `a` and with `b`. A
/// number within [`SAME_ROW`] of a whole number counts as the whole number.
pub(super) fn integers_passed(a: f64, b: f64) -> impl Iterator<Item = f64> {
    let snapped = |x: f64| {
        if (x - x.round()).abs() < SAME_ROW {
            x.round()
        } else {
            x
        }
    };
    let (a, b) = (snapped(a), snapped(b));
    let (start, way) = if b > a {
        (a.floor(), b.floor() - a.floor())
    } else {
        (a.ceil(), b.ceil() - a.ceil())
    };
    (1..=way.abs() as u64).map(move |i| start + (i as f64).copysign(way))
}

/// Refuses more rows until a time (s) than a run may have.
pub(super) fn check_row_count(rows: f64, until: f64) -> Result<(), Error> {
    if rows <= MOST_OUTPUT_ROWS {
        return Ok(());
    }
    Err(Error::refused(
        format!(
            "run.output_every: more than {MOST_OUTPUT_ROWS} output rows would be written, for the run has {rows:.0} of them until t = {until} s"
        ),
        format!("give a larger step, leave it out for {DEFAULT_ROWS} rows, or shorten the run"),
    ))
}

/// Rows at regular times or crank angles, in addition to the rows of the first and the last state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Schedule {
    /// Rows at times index·step, s, before `end`, s.
    Times { step: f64, end: f64 },
    /// Rows at rotations from the start that are multiples of `step`, rad.
    Angles { step: f64 },
}

impl Schedule {
    pub fn new(every: Option<Every>, extent: Extent) -> Schedule {
        let intervals = f64::from(DEFAULT_ROWS - 1);
        let (end, default) = match extent {
            Extent::Duration(end) => (end, Every::Time(end / intervals)),
            Extent::Revolutions(turns) => (f64::INFINITY, Every::Angle(turns * TAU / intervals)),
        };
        match every.unwrap_or(default) {
            Every::Time(step) => Schedule::Times { step, end },
            Every::Angle(step) => Schedule::Angles { step },
        }
    }

    /// Makes a schedule at constant speed (rad/s) until `end` (s), with times in place of angles. A crank at rest
    /// passes no angle and has two rows, of the first and the last state.
    pub fn at_speed(every: Option<Every>, speed: f64, end: f64) -> Schedule {
        match Schedule::new(every, Extent::Duration(end)) {
            Schedule::Angles { .. } if speed == 0.0 => Schedule::Times { step: end, end },
            Schedule::Angles { step } => Schedule::Times {
                step: step / speed.abs(),
                end,
            },
            schedule => schedule,
        }
    }

    /// Returns the time of the row with an index, if rows are due at times and this one before that of the last state.
    pub fn time(&self, index: u64) -> Option<f64> {
        match *self {
            Schedule::Times { step, end } => {
                let t = index as f64 * step;
                (t < end - SAME_ROW * step).then_some(t)
            }
            Schedule::Angles { .. } => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::integers_passed;

    #[test]
    fn whole_numbers_are_passed_once() {
        let list = |a, b| integers_passed(a, b).collect::<Vec<_>>();
        assert_eq!(list(0.0, 3.0), [1.0, 2.0, 3.0]);
        assert_eq!(list(0.0, -2.5), [-1.0, -2.0]);
        assert_eq!(list(2.0 + 1e-15, 2.9), [0.0; 0]);
        assert_eq!(list(2.9, 2.0 + 1e-15), [2.0]);
        assert_eq!(list(-0.5, 0.5), [0.0]);
        assert_eq!(list(1.5, 1.5), [0.0; 0]);
    }

    #[test]
    fn more_whole_numbers_than_memory_holds_are_passed_one_by_one() {
        assert_eq!(integers_passed(0.0, 1e300).nth(1), Some(2.0));
        assert_eq!(integers_passed(0.0, -1e300).nth(1), Some(-2.0));
    }
}
