//! The motion that fits samples of something the crank angle is read from: Gauss and Newton's method.
//!
//! Very many samples are condensed once: what the instrument shows is as smooth a function of time as the motion.

use std::f64::consts::{PI, TAU};

use super::course::Course;
use super::fitted::ROUNDED;
use super::near::Near;
use super::sensor::Sensor;
use crate::numeric::chebyshev::largest;
use crate::numeric::fit::{Curve, Kind, Rows, Samples, Size};
use crate::numeric::parallel;

/// Corrections after which a fit counts as not settling.
const MOST: usize = 30;

/// Samples that show how far values reach.
const PART: usize = 20_000;

/// Samples of a turn from which on what the instrument shows of even motion is a polynomial in each block of them.
const OF_TURN: f64 = 16_384.0;

/// Samples of a turn from which on blocks of them show a first motion.
const OF_FIRST: f64 = 512.0;

/// Times what is left of lines that may be left of samples.
const AS_A_LINE: f64 = 2.0;

/// Times that samples get their signs and turns anew.
const UNFOLDED: usize = 8;

/// A fit is settled where further corrections would change it by less than this part of a standard error.
const SETTLED: f64 = 1e-3;

/// Change, in standard errors, below which a motion is right.
const RIGHT: f64 = 1.0;

/// Change, in standard errors, by lines about a better motion, up to which the terms of very many samples stay.
const SLIGHT: f64 = 3.0;

/// Change, in standard errors, from which on slow corrections are made longer.
const SLOW: f64 = 10.0;

/// Units of rounding below which corrections do not shrink any more.
const NOTHING: f64 = 4.0;

/// A correction below this part of the one before it tells that the next one will be as much smaller again.
const FAST: f64 = 0.01;

/// Samples of something that the crank angle is read from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seen<'a> {
    pub sensor: &'a Sensor<'a>,
    pub times: &'a [f64],
    pub values: &'a [f64],
    /// Standard deviation of a value that is due to its digits alone.
    pub floor: f64,
}

impl Seen<'_> {
    /// The motion, from crank angles (rad) that are near, and whether it came to rest.
    pub fn fit(&self, theta: Vec<f64>, kind: Kind, size: Size) -> Result<(Curve, bool), String> {
        let computed = self.computed(&theta);
        let turns = largest(&theta) / TAU;
        // What a polynomial cannot follow in a block it cannot follow anyway.
        let dense = kind == Kind::Polynomial
            && theta.len() as f64 > OF_TURN * turns
            && self.sensor.linkage.limit_angles().is_empty();
        let mut unfolded = self.unfolded(&theta);
        // Crank angles of samples do not tell the signs of values near zero: they are taken from a first motion.
        let mut first = self.sensor.folds() && theta.len() as f64 > OF_FIRST * turns;
        let mut near = Near::Samples(theta);
        let (mut in_blocks, mut rounds) = (true, 0);
        loop {
            let samples = Samples {
                t: self.times,
                target: &unfolded,
                weight: None,
                floor: self.floor,
            };
            let rows = match in_blocks {
                true => kind.rows(
                    &samples,
                    size,
                    if first || dense {
                        f64::INFINITY
                    } else {
                        computed
                    },
                ),
                false => Rows::from(&samples),
            };
            first &= rows.is_condensed();
            rounds += 1;
            let found = self.settle(&rows, &near, kind, size)?;
            near = if found.curve.is_seen_by(&rows) {
                let folds = self.sensor.folds();
                let again = folds.then(|| self.unfolded_again(&found.curve, &unfolded));
                let changed = again.filter(|again| *again != unfolded);
                if !first && (changed.is_none() || rounds == UNFOLDED) {
                    return self.complete(&rows, found);
                }
                unfolded = changed.unwrap_or(unfolded);
                match first {
                    true => Near::Motion(found.curve),
                    false => Near::Curve(found.curve, found.factor),
                }
            } else {
                in_blocks = false;
                Near::Motion(found.curve)
            };
            first = false;
        }
    }

    /// Standard deviation of a sample that was computed.
    fn computed(&self, theta: &[f64]) -> f64 {
        let reached = theta.iter().step_by(1 + theta.len() / PART);
        let reached = reached.map(|theta| (self.sensor.shown(*theta).1 * theta).abs());
        ROUNDED * f64::EPSILON * reached.fold(largest(self.values), f64::max)
    }

    /// The values with their signs and turns about a motion.
    fn unfolded(&self, theta: &[f64]) -> Vec<f64> {
        parallel::list(self.times.len(), |i| {
            self.sensor
                .unfolded(self.values[i], || self.sensor.shown(theta[i]).0)
        })
    }

    /// The same about a curve that was fitted to values with other ones: those that are farther from the folds than all
    /// that it leaves keep theirs.
    fn unfolded_again(&self, curve: &Curve, before: &[f64]) -> Vec<f64> {
        let left = AS_A_LINE * curve.quality().squares.sqrt();
        parallel::list(self.times.len(), |i| {
            let value = self.values[i];
            if value.min(PI - value) > left {
                return before[i];
            }
            let theta = curve.value(self.times[i]);
            self.sensor.unfolded(value, || self.sensor.shown(theta).0)
        })
    }

    /// A motion that fits, with its errors, and whether it came to rest.
    fn complete(&self, rows: &Rows<'_>, found: Found) -> Result<(Curve, bool), String> {
        if found.complete {
            return Ok((found.curve, found.settled));
        }
        let about = found.curve.values(rows.arguments());
        let curve = found.curve.again(&self.linear(rows, &about))?;
        Ok((curve, found.settled))
    }

    /// Corrects a motion until it fits.
    fn settle(
        &self,
        rows: &Rows<'_>,
        near: &Near,
        kind: Kind,
        size: Size,
    ) -> Result<Found, String> {
        let mut last_choice = near.last_choice(rows, self.sensor.folds());
        let mut course = Course::new(rows, near.values(self.times, rows));
        let mut lines = self.linear(rows, &course.about);
        // Each correction evaluates the samples' lines anew, with other roundings.
        let reached = rows.reached(&lines);
        let computed = ROUNDED * f64::EPSILON * largest(self.values).max(reached);
        let (mut chosen, factor_before) = match near {
            Near::Curve(curve, factor) => (Some(curve.clone()), *factor),
            _ => (None, f64::INFINITY),
        };
        // The choice of a spline's terms is dear where samples are very many.
        let keeps = kind == Kind::Spline && rows.is_very_many();
        let (mut round, mut change_before) = (0, 0.0);
        // What is to be the last correction gives the motion its errors at once.
        let mut last = matches!(near, Near::Curve(..)) && to_come(RIGHT, factor_before) < SETTLED;
        loop {
            // Once the motion is about right the choice of terms stays, so that it cannot go on alternating.
            let anew = chosen.is_none() || Some(round) == last_choice;
            let (curve, complete) = match chosen {
                Some(curve) if !anew && last => (curve.again(&lines)?, true),
                Some(curve) if !anew => curve.moved(&lines)?,
                _ => (Curve::to(&lines, kind, size)?, true),
            };
            // Two motions are not held at a time.
            drop(lines);
            if anew || round == 0 {
                course.look(&curve);
            }
            let found = curve.values(rows.arguments());
            let [change, in_rounding] = course.change(&found, [curve.quality().sigma, computed]);
            if !self.sensor.linkage.limit_angles().is_empty()
                && found
                    .iter()
                    .any(|theta| !self.sensor.shown(*theta).1.is_finite())
            {
                return Err("the fit leaves the angles that the crank can take".to_owned());
            }
            if course.is_astray(&found) {
                return Err("the fit goes astray, far off the crank angles of the samples: they hardly tell them, or it is not the fit for this motion".to_owned());
            }
            // Corrections shrink by about the same factor, or ever faster.
            let factor = match round {
                0 => factor_before,
                _ => change / change_before,
            };
            // Terms that were chosen about a motion that is right stay; others are chosen anew as soon as it is.
            last_choice = match round {
                0 if change < RIGHT => last_choice.min(Some(0)),
                1 if change < SLIGHT && keeps => last_choice.min(Some(0)),
                _ if change * factor.min(1.0) < RIGHT => last_choice.min(Some(round + 1)),
                _ => last_choice,
            };
            round += 1;
            let settled = to_come(change, factor) < SETTLED || in_rounding < NOTHING;
            let chosen_last = last_choice.is_none_or(|last| round > last);
            if settled && chosen_last || round == MOST {
                return Ok(Found {
                    curve,
                    complete,
                    settled: settled || change < 1.0,
                    factor,
                });
            }
            course.go_on(
                found,
                chosen_last && change < SLOW && factor > FAST && round > 1,
            );
            lines = self.linear(rows, &course.about);
            last = chosen_last && to_come(change * factor, factor) < SETTLED;
            change_before = change;
            chosen = Some(curve);
        }
    }

    /// Rows about a motion, each a line in the crank angle.
    fn linear<'r>(&self, rows: &'r Rows<'_>, theta: &[f64]) -> Rows<'r> {
        rows.linear(|i, value| {
            let (shown, slope) = self.sensor.shown(theta[i]);
            [slope, value - shown + slope * theta[i]]
        })
    }

    /// The samples about a motion, each a line in the crank angle: slope and value at zero, with what they leave of the
    /// samples.
    pub fn lines(&self, theta: &[f64]) -> [Vec<f64>; 3] {
        parallel::columns(self.times.len(), |i| {
            let theta = theta[i];
            let (residual, slope) = self.sensor.residual(self.values[i], theta);
            [slope, residual + slope * theta, residual]
        })
    }
}

/// The change that is to come after one, in standard errors, as corrections shrink by a factor.
fn to_come(change: f64, factor: f64) -> f64 {
    change * if factor < FAST { factor } else { 1.0 }
}

/// A motion that fits.
#[derive(Debug)]
struct Found {
    curve: Curve,
    /// Whether its errors are its own.
    complete: bool,
    /// Whether it came to rest.
    settled: bool,
    /// The factor by which corrections shrank.
    factor: f64,
}
