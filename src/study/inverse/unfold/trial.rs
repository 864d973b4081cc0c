//! Whether to look for a motion of very many turns at all: where stretches of it are in doubt all over, the rest is as well, and
//! the search through it would take long.

use super::record::Record;
use super::steady;
use super::track::Track;
use super::turnings::Turning;
use super::visit::Motion;
use super::{MANY, PART};
use crate::numeric::parallel;

/// Stretches that are looked at, and turning points of each.
const STRETCHES: usize = 16;
const LONG: usize = 64;

/// Times as many turning points as in the stretches, from which on they are looked at first.
const VERY_MANY: usize = 8;

/// What some stretches of a motion tell.
#[derive(Debug)]
pub(super) struct Trial {
    /// Choices in doubt.
    pub doubts: usize,
    /// All choices.
    pub visits: usize,
    /// The first sample of a doubt.
    pub first: usize,
}

impl Trial {
    /// Of a motion that is not worth the search.
    pub fn in_vain(motion: &Motion<'_>) -> Option<Trial> {
        let count = motion.turnings.len();
        if count < VERY_MANY * STRETCHES * LONG {
            return None;
        }
        let starts = (0..STRETCHES).map(|stretch| stretch * (count - LONG) / (STRETCHES - 1));
        let parts = parallel::map(starts, |start| stretch(motion, start));
        let doubts = parts.iter().map(|(doubts, _)| doubts.len()).sum();
        let visits = parts.iter().map(|(_, visits)| visits).sum();
        let first = *parts.iter().find_map(|(doubts, _)| doubts.first())?;
        (doubts > MANY && PART * doubts >= visits).then_some(Trial {
            doubts,
            visits,
            first,
        })
    }
}

/// The samples of doubts in a stretch from a turning point on, and the number of choices.
fn stretch(motion: &Motion<'_>, start: usize) -> (Vec<usize>, usize) {
    let all = &motion.turnings[start..start + LONG];
    let (from, to) = (all[0].at, all[LONG - 1].at);
    let inner = all[1..LONG - 1].iter().map(|turning| Turning {
        at: turning.at - from,
        ..*turning
    });
    let turnings: Vec<Turning> = inner.collect();
    let part = Motion {
        record: Record {
            times: &motion.record.times[from..=to],
            values: &motion.record.values[from..=to],
            ..motion.record
        },
        turnings: &turnings,
        ..*motion
    };
    let track = Track::new(&part, &steady::passed(&part), motion.strokes.all()[0]);
    let doubts = track.doubts.iter().map(|at| from + at);
    (doubts.collect(), track.visits)
}
