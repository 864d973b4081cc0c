//! The largest of values on rows.

use super::super::row::Row;
use super::{FORCES, of_row};

/// A place where a value may be largest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// s
    pub t: f64,
    /// Crank angle, rad.
    pub theta: f64,
    /// Value of the row there.
    pub value: f64,
    /// Top of the parabola through it and its neighbours.
    top: f64,
}

const NOWHERE: Place = Place {
    t: 0.0,
    theta: 0.0,
    value: f64::NEG_INFINITY,
    top: f64::NEG_INFINITY,
};

/// The forces of a row.
#[derive(Clone, Copy, Debug)]
struct Values {
    t: f64,
    theta: f64,
    sizes: [f64; FORCES],
}

/// The largest of each force on rows.
#[derive(Clone, Debug)]
pub(super) struct Track {
    /// The two rows before.
    before: [Option<Values>; 2],
    /// By the rows' values.
    pub largest: [Place; FORCES],
    /// By the tops of the parabolas.
    pub highest: [Place; FORCES],
    /// Whether all values are finite.
    pub finite: bool,
}

impl Default for Track {
    fn default() -> Track {
        Track {
            before: [None; 2],
            largest: [NOWHERE; FORCES],
            highest: [NOWHERE; FORCES],
            finite: true,
        }
    }
}

impl Track {
    fn take(&mut self, row: Values) {
        let Values { t, theta, sizes } = row;
        self.finite &= sizes.iter().all(|value| value.is_finite());
        for (k, &value) in sizes.iter().enumerate() {
            let here = Place {
                t,
                theta,
                value,
                top: value,
            };
            higher(&mut self.largest[k], here, |place| place.value);
            higher(&mut self.highest[k], here, |place| place.top);
            if let [Some(a), Some(b)] = self.before {
                let top = top([a.t, b.t, t], [a.sizes[k], b.sizes[k], value]);
                let there = Place {
                    t: b.t,
                    theta: b.theta,
                    value: b.sizes[k],
                    top,
                };
                higher(&mut self.highest[k], there, |place| place.top);
            }
        }
        self.before = [self.before[1], Some(row)];
    }
}

fn higher(best: &mut Place, other: Place, by: fn(&Place) -> f64) {
    if by(&other) > by(best) {
        *best = other;
    }
}

/// Top of the parabola through three points if the middle one is the largest, else the middle one.
fn top([t0, t1, t2]: [f64; 3], [a, b, c]: [f64; 3]) -> f64 {
    if b < a || b < c {
        return b;
    }
    let (left, right) = ((b - a) / (t1 - t0), (c - b) / (t2 - t1));
    let bend = (right - left) / (t2 - t0);
    let slope = left + bend * (t1 - t0);
    if bend < 0.0 {
        b - 0.25 * slope * slope / bend
    } else {
        b
    }
}

/// Rows, all of them and every second one.
#[derive(Clone, Debug, Default)]
pub(super) struct Scan {
    pub all: Track,
    half: Track,
    rows: u64,
}

impl Scan {
    pub fn take(&mut self, row: &Row) {
        let values = Values {
            t: row.t,
            theta: row.theta,
            sizes: of_row(row),
        };
        self.all.take(values);
        if self.rows.is_multiple_of(2) {
            self.half.take(values);
        }
        self.rows += 1;
    }

    /// Whether half of the rows say the same of the largest values, to a small part of them.
    pub fn is_resolved(&self) -> bool {
        const PART: f64 = 0.02;
        let both = self.all.highest.iter().zip(&self.half.highest);
        both.into_iter()
            .all(|(all, half)| (all.top - half.top).abs() <= PART * all.top)
    }
}
