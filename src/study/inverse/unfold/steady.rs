//! Turning points that a crank passes which goes on turning, told from several at a time.
//!
//! If the crank passes all folds of a stretch, its angle is one polynomial there; if it went back from any, it would bend.

use super::evidence::{ENOUGH, Evidence, is_simpler, leaves_noise};
use super::strokes::Stroke;
use super::visit::Motion;
use super::window::Window;
use crate::numeric::parallel;

/// Turning points on either side of one that is looked at: of an even motion it tells as many as that.
const AROUND: usize = 2;

/// Between even turning points the times are alike to this factor: the crank is about as fast at all of them.
const ALIKE: f64 = 2.0;

/// Part of the evidence that decides that is enough between even turning points.
const EVEN: f64 = 0.75;

/// The same if the motion that passes leaves nothing but noise.
const NOISE: f64 = 0.5;

/// Which turning points are passed without doubt, whatever the stroke on which the motion begins: strokes of a crank that
/// turns fully are mirror images.
pub(super) fn passed(motion: &Motion<'_>) -> Vec<bool> {
    let count = motion.turnings.len();
    let first = motion.strokes.all();
    if first.len() > 2 || count <= 2 * AROUND {
        return vec![false; count];
    }
    let mut along = vec![first[0]];
    for k in 0..count {
        let change = motion.fold(k).map_or(0, |fold| fold.change);
        along.push(along[k] ^ change);
    }
    let parts = parallel::map(0..count.div_ceil(AROUND), |part| {
        let from = part * AROUND;
        let even = is_even(motion, from + 1);
        if even && passes(motion, from + 1, &along, even) {
            return [true; AROUND];
        }
        std::array::from_fn(|k| {
            let k = from + k;
            passes(motion, k, &along, even) || passes_alone(motion, k, &along, even)
        })
    });
    parts.into_iter().flatten().take(count).collect()
}

/// Whether the turning points around one follow each other evenly, all at folds.
fn is_even(motion: &Motion<'_>, k: usize) -> bool {
    let Some(from) = k.checked_sub(AROUND) else {
        return false;
    };
    let Some(around) = motion.turnings.get(from..k + AROUND + 1) else {
        return false;
    };
    let t = |k: usize| motion.record.times[around[k].at];
    let times = (1..around.len()).map(|k| t(k) - t(k - 1));
    let ends = (f64::INFINITY, 0.0f64);
    let (least, most) = times.fold(ends, |(a, b), time| (a.min(time), b.max(time)));
    most < ALIKE * least && (from..k + AROUND + 1).all(|k| motion.fold(k).is_some())
}

/// Whether a motion that passes all folds around a turning point plainly passes there too.
fn passes(motion: &Motion<'_>, k: usize, along: &[Stroke], even: bool) -> bool {
    if k >= motion.turnings.len() {
        return false;
    }
    let Some(fold) = motion.fold(k) else {
        return false;
    };
    let at = motion.turnings[k].at;
    let back = |i: usize| {
        let stroke = along[motion.turnings.partition_point(|turning| turning.at < i)];
        if i > at { stroke ^ fold.change } else { stroke }
    };
    let range = motion.between(k, AROUND);
    let window = Window::new(motion, (at, fold), back, range);
    Evidence::at_first_sight(&window).is_some_and(|(evidence, [back, past])| {
        // Of even turning points a motion tells several alike, without being explained.
        let enough = if leaves_noise(&past, &window) {
            NOISE
        } else {
            EVEN
        };
        let tells =
            || is_simpler(&past, &back) || !evidence.explained && evidence.passes > enough * ENOUGH;
        evidence.tells_a_passage() || even && tells()
    })
}

/// The same told from the way to the turning points next to it alone: one polynomial may follow a turn of an uneven motion, if not
/// two.
fn passes_alone(motion: &Motion<'_>, k: usize, along: &[Stroke], even: bool) -> bool {
    let Some(fold) = (k < motion.turnings.len())
        .then(|| motion.fold(k))
        .flatten()
    else {
        return false;
    };
    let (back, range) = (|_| along[k], motion.between(k, 1));
    let window = Window::new(motion, (motion.turnings[k].at, fold), back, range);
    let rough = Evidence::at_first_sight(&window);
    let tells =
        |(rough, _): (Evidence, _)| rough.tells_a_passage() || even && rough.is_clear_passage();
    rough.is_some_and(tells) || motion.evidence(k, fold, back, range).is_clear_passage()
}
