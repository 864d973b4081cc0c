//! The samples around a turning point, read on both strokes that meet there.

use std::f64::consts::TAU;

use super::strokes::{Fold, Stroke};
use super::visit::Motion;

/// Most blocks of samples.
const BLOCKS: usize = 48;

/// Standard errors within which an angle is at the fold, and beyond which it is certainly not.
const AT_FOLD: f64 = 2.0;
const CLEAR: f64 = 20.0;

/// Standard deviations of noise within which a size next to its fold loses the sign of it: averaged it is still off by one.
const FOLDED: f64 = 2.0;

/// Blocks of samples around a turning point.
#[derive(Debug, Default)]
pub(super) struct Window {
    /// Time, from −1 to 1.
    pub t: Vec<f64>,
    /// Measured values and their standard deviations.
    pub shown: Vec<(f64, f64)>,
    /// Crank angle of the fold, rad.
    pub at_fold: f64,
    /// Crank angles beyond that of a motion that goes back, rad.
    pub back: Vec<f64>,
    /// The same of motions that pass: the fold may be just before the turning point or just after it.
    pub past: Vec<Vec<f64>>,
    /// Standard error of an angle, rad.
    pub error: Vec<f64>,
    /// Blocks that are not at the fold, before it and after it.
    pub clear: [usize; 2],
    /// The first block after the turning point.
    pub after: usize,
}

impl Window {
    /// The window from one sample to another around the turning point at a fold; `along` has the stroke of each sample
    /// for a motion that goes back.
    pub fn new(
        motion: &Motion<'_>,
        (turning, fold): (usize, Fold),
        along: impl Fn(usize) -> Stroke,
        [from, to]: [usize; 2],
    ) -> Window {
        let Motion {
            record, strokes, ..
        } = motion;
        let at_fold = strokes.angles(fold.value)[along(turning)];
        let count = (to - from + 1).min(BLOCKS);
        let place = |k: usize| from + (to - from) * k / (count - 1).max(1);
        let around = if count < BLOCKS {
            0
        } else {
            (to - from) / (2 * count)
        };
        let middle = 0.5 * (record.times[from] + record.times[to]);
        let half = 0.5 * (record.times[to] - record.times[from]);
        let mut window = Window {
            at_fold,
            ..Window::default()
        };
        let (mut past, mut either) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for at in (0..count).map(place) {
            // Not over the fold, where a size has a bend.
            let (value, noise) = record.value(at, around.min(at.abs_diff(turning)));
            let noise = match strokes.sensor.folds()
                && (value - fold.value).abs() < FOLDED * record.noise
            {
                true => noise.max(record.noise),
                false => noise,
            };
            let (angles, stroke) = (strokes.angles(value), along(at));
            let error = [value - noise, value + noise]
                .map(|value| turned_back(strokes.angles(value)[stroke] - angles[stroke]).abs());
            window.shown.push((value, noise));
            window.t.push((record.times[at] - middle) / half);
            window.back.push(angles[stroke]);
            past.push(angles[stroke ^ fold.change]);
            either.push(at != turning && motion.turns_at(at));
            window
                .error
                .push(error[0].max(error[1]) + 4.0 * f64::EPSILON);
        }
        let after = (0..count).find(|k| place(*k) > turning);
        window.after = after.unwrap_or(count);
        window.part(past, &either);
        window
    }

    /// The times between which a motion is nearest to the fold, which noise may have moved: half of the way to the ends.
    pub fn around_fold(&self) -> [f64; 2] {
        let [before, after] = self.clear;
        [self.t[before / 2], self.t[self.t.len() - 1 - after / 2]]
    }

    /// Lets the motions part at the fold, which is before the first block after the turning point. Samples at other turning points may be on `either` stroke.
    fn part(&mut self, mut past: Vec<f64>, either: &[bool]) {
        let (count, after) = (past.len(), self.after);
        outward(&mut self.back, self.at_fold, after);
        outward(&mut past, self.at_fold, after);
        let lean = |k: usize| 0.5 * (self.back[k] - past[k]).abs();
        let is_at_fold = |k: &usize| lean(*k) < AT_FOLD * self.error[*k];
        let first = (0..after).rev().take_while(is_at_fold).last();
        let last = (after..count).take_while(is_at_fold).last();
        let [until, on] = [first.unwrap_or(after), last.map_or(after, |last| last + 1)];
        // At the folds of other turning points the stroke is not certain.
        let is_clear = |k: &usize| lean(*k) > CLEAR * self.error[*k];
        let before = (0..after).rev().skip_while(|k| !is_clear(k));
        let beyond = (after..count).skip_while(|k| !is_clear(k));
        let others = before.chain(beyond).filter(|k| !is_clear(k) || either[*k]);
        let middle: Vec<usize> = others.chain(until..on).collect();
        for k in middle {
            self.error[k] = self.error[k].max(0.5 * (self.back[k] - past[k]).abs());
            let angle = 0.5 * (self.back[k] + past[k]);
            (self.back[k], past[k]) = (angle, angle);
        }
        let other = past[until.saturating_sub(1)];
        past[..until].copy_from_slice(&self.back[..until]);
        if until == on && 0 < until {
            let mut later = past.clone();
            later[until - 1] = other;
            self.past.push(later);
        }
        self.past.push(past);
        self.clear = [until, count - on];
    }
}

/// Makes angles continuous from a fold at one of them on, and counts them from there.
fn outward(angles: &mut [f64], at_fold: f64, from: usize) {
    let (before, after) = angles.split_at_mut(from);
    follow(before.iter_mut().rev(), at_fold);
    follow(after.iter_mut(), at_fold);
}

fn follow<'a>(angles: impl Iterator<Item = &'a mut f64>, at_fold: f64) {
    let mut last: Option<[f64; 2]> = None;
    for angle in angles {
        let expected = last.map_or(0.0, |[now, before]| 2.0 * now - before);
        *angle = expected + turned_back(*angle - at_fold - expected);
        last = Some([*angle, last.map_or(0.0, |[now, _]| now)]);
    }
}

/// The angle less whole turns, from −π to π.
pub(super) fn turned_back(angle: f64) -> f64 {
    angle - (angle / TAU).round() * TAU
}
