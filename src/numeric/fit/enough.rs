//! The number of pieces of a spline that samples ask for: that of the largest restricted likelihood among those that each
//! have twice as many as the one before.

use std::ops::Range;

use super::condensed::Rows;
use super::likely::{Choice, Left};
use super::penalized::Normal;
use super::pieces::DEGREE;
use super::roughness::ORDER;

/// Fewest pieces that are tried.
pub(super) const FEWEST: usize = 4;

/// Pieces for each one that the samples ask for, so that the penalty and not the pieces decide how smooth it is.
const FINER: usize = 4;

/// The same where pieces are dear, and where nothing but digits is left.
const LITTLE_FINER: usize = 2;

/// Penalties up to this many times the weakest one let a spline go through the samples.
const THROUGH: f64 = 64.0;

/// Parts of a long record of which one shows what the whole one asks for, and its fewest rows.
const PARTS: usize = 16;
const OF_PART: usize = 1 << 14;

/// Times as far as in the middle part that the curve goes in one that is taken instead of it, and rows at either end of a
/// part that tell where it is.
const FARTHER: f64 = 2.0;
const AT_END: usize = 64;

/// Rows of the fewest pieces that are tried of such a part: blocks as narrow do not show its motion.
const WIDE: usize = 256;

/// Gain in minus twice the logarithm of the likelihood, in all and for each piece more, below which such a part asks for no
/// more pieces: a penalty on differences is not quite one on derivatives, and more pieces always gain a little.
const SLIGHT: [f64; 2] = [16.0, 0.0625];

/// What samples ask for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Enough {
    pub pieces: usize,
    /// Logarithm of the likely penalty relative to the mean pivot, if it is about known.
    pub likely: Option<f64>,
    /// Whether it is the most that the blocks of the rows allow, and they ask for more.
    pub more: bool,
    /// Whether pieces are to be doubled until they leave noise.
    pub until_noise: bool,
}

/// Whether a spline goes through the samples of a normal matrix.
pub(super) fn goes_through(normal: &Normal<'_>, strength: f64) -> bool {
    strength <= THROUGH * normal.weakest()
}

impl Enough {
    /// So many pieces.
    pub fn just(pieces: usize) -> Enough {
        Enough {
            pieces,
            likely: None,
            more: false,
            until_noise: false,
        }
    }

    /// What rows ask for; none if they determine no spline.
    pub fn of(rows: &Rows<'_>) -> Option<Enough> {
        let most = rows.count.saturating_sub(DEGREE + 1).max(1);
        // Knots inside a block would be lost; what narrow blocks leave is noise.
        let most = rows.blocks().map_or(most, |blocks| blocks.min(most));
        if rows.is_very_many() && !rows.is_condensed() {
            return Enough::of_part(rows, most);
        }
        let found = Search::new(rows, FEWEST..most, [0.0; 2])?;
        let finer = if found.digits { LITTLE_FINER } else { FINER };
        let pieces = found.best.grid.pieces;
        Some(Enough {
            more: rows.is_condensed() && !found.digits && 2 * pieces > most,
            ..Enough::just((finer * pieces).min(most).max(pieces))
        })
    }

    /// The same, as a part of the rows has it.
    fn of_part(rows: &Rows<'_>, most: usize) -> Option<Enough> {
        let part = telling(rows);
        let from = (part.number() / WIDE).max(1);
        let found = Search::new(&part, from..part.number() - DEGREE - 1, SLIGHT)?;
        let whole = found.best.grid.pieces as f64 * (rows.span[1] - rows.span[0])
            / (part.span[1] - part.span[0]);
        let enough = Enough {
            pieces: whole.round() as usize,
            likely: Some(found.best.relative),
            more: false,
            until_noise: found.is_noise || found.digits,
        };
        let finer = if found.digits { 1 } else { LITTLE_FINER };
        Some(enough.finer(finer, most))
    }

    /// The sums for them with the likely penalty.
    pub fn choose<'a>(mut self, rows: &'a Rows<'a>) -> Option<(Normal<'a>, Choice)> {
        let most = rows.count.saturating_sub(DEGREE + 1);
        let mut before: Option<(Normal<'a>, Choice, Left)> = None;
        loop {
            let normal = Normal::new(rows, self.pieces);
            let near = self.likely.map(|likely| normal.choose_near(likely));
            let Some(choice) = near.unwrap_or_else(|| normal.choose()) else {
                // More than the samples determine.
                return before.map(|(normal, choice, _)| (normal, choice));
            };
            if !self.until_noise || 2 * self.pieces > most {
                return Some((normal, choice));
            }
            let left = choice.left(rows);
            if left.is_noise(rows) || left.is_computed(rows) {
                return Some((normal, choice));
            }
            match before {
                // It is not for want of pieces.
                Some((normal, choice, before)) if !left.is_much_less_than(&before) => {
                    return Some((normal, choice));
                }
                _ => before = Some((normal, choice, left)),
            }
            self = self.finer(2, most);
        }
    }

    /// With so many times as many pieces, but not more than `most`.
    fn finer(self, by: usize, most: usize) -> Enough {
        let pieces = (by * self.pieces).min(most).max(1);
        // Of the same roughness: it is that of differences over widths, to the power of the order.
        let per_doubling = 2.0 * ORDER as f64;
        let doublings = (pieces as f64 / self.pieces as f64).ln();
        Enough {
            pieces,
            likely: self.likely.map(|l| l + per_doubling * doublings),
            ..self
        }
    }
}

/// The part in the middle of a record, or the one in which the curve goes farthest, if that is much farther: a machine may
/// rest for a while.
fn telling<'a>(rows: &'a Rows<'_>) -> Rows<'a> {
    let number = (rows.number() / PARTS).max(OF_PART).min(rows.number());
    let last = rows.number() - number;
    let place = |from: usize| {
        let some = rows.some(from..from + AT_END);
        let sums = some.fold([0.0; 2], |[value, square], (_, weight, target)| {
            [value + weight * target, square + weight * weight]
        });
        sums[0] / sums[1]
    };
    let way = |from: usize| {
        let way = (place(from + number - AT_END) - place(from)).abs();
        if way.is_finite() { way } else { 0.0 }
    };
    let starts = (0..PARTS).map(|part| part * last / (PARTS - 1));
    let farthest = starts.max_by(|a, b| way(*a).total_cmp(&way(*b)));
    let middle = last / 2;
    let from = farthest.filter(|farthest| way(*farthest) > FARTHER * way(middle));
    let from = from.unwrap_or(middle);
    rows.part(from..from + number)
}

/// The best of numbers of pieces.
struct Search {
    best: Choice,
    /// Whether what it leaves looks like noise.
    is_noise: bool,
    /// Whether it goes through the samples, and leaves nothing but digits.
    digits: bool,
}

impl Search {
    /// The gain that so many pieces are to bring over the best ones.
    fn slight(&self, pieces: usize, [in_all, of_piece]: [f64; 2]) -> f64 {
        in_all + of_piece * (pieces - self.best.grid.pieces) as f64
    }

    /// Of numbers of pieces in a range, as long as they gain more than a slight amount.
    fn new(rows: &Rows<'_>, range: Range<usize>, slight: [f64; 2]) -> Option<Search> {
        let most = range.end;
        let levels = rows.levels(range.start);
        let mut pieces = range.start.min(most);
        let mut best: Option<Search> = None;
        let mut worse = 0;
        while pieces <= most && (worse < 2 || best.as_ref().is_some_and(|best| !best.is_noise)) {
            let serves = |level: &&Rows<'_>| level.blocks().is_none_or(|blocks| blocks >= pieces);
            let level = levels.iter().rev().find(serves).unwrap_or(rows);
            let normal = Normal::new(level, pieces);
            let Some(choice) = normal.choose() else {
                // More than the samples determine.
                break;
            };
            if best
                .as_ref()
                .is_none_or(|best| choice.cost < best.best.cost - best.slight(pieces, slight))
            {
                let left = choice.left(rows);
                let through = goes_through(&normal, choice.strength);
                let found = Search {
                    is_noise: left.is_noise(rows),
                    digits: through && left.is_computed(rows),
                    best: choice,
                };
                if found.digits {
                    return Some(found);
                }
                best = Some(found);
                worse = 0;
            } else {
                worse += 1;
            }
            pieces *= 2;
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::fit::Samples;

    /// A record that rests in the middle is told by a part in which it does not, a steady one by its middle.
    #[test]
    fn a_part_that_moves_is_telling() {
        let t: Vec<f64> = (0..90_000).map(f64::from).collect();
        let rests: Vec<f64> = t.iter().map(|t| t.min(3e4) + (t - 6e4).max(0.0)).collect();
        for (target, moves) in [(&rests, true), (&t, false)] {
            let rows = Rows::from(&Samples {
                t: &t,
                target,
                weight: None,
                floor: 0.0,
            });
            let [first, last] = telling(&rows).span;
            assert_eq!(last <= 3e4 || first >= 6e4, moves, "{first} to {last}");
        }
    }
}
