//! Search for the first feature of a force that the nodes miss, by bisection.

use std::f64::consts::PI;

use super::{Feature, ForceAlong, NodeCriterion, Unresolved};
use crate::numeric::chebyshev::Values;
use crate::numeric::enclosure::{CORNER_SHARE, Variation, has_pole};

/// Halvings of the interval that locate a corner or jump: positions on a panel are rounded by more.
const HALVINGS: i32 = 46;

impl NodeCriterion {
    /// Returns the fraction that may be cut off at an end for a corner there, to cover the rounding error of its
    /// position: the larger of two after 20 and 40 halvings, or none.
    fn end(&self, force: &impl ForceAlong, piece: fn(f64) -> [f64; 2]) -> f64 {
        let little = |end: &f64| {
            let [from, to] = piece(*end);
            let variation = force.variation(from, to, self.ellipses[0]);
            variation.change * end <= CORNER_SHARE * self.allowed
        };
        let parts = [20, 40].map(|halvings| 0.5f64.powi(halvings));
        parts.into_iter().find(little).unwrap_or(0.0)
    }
}

/// Returns the magnitude; infinity for NaN.
fn size(missed: f64) -> f64 {
    if missed.is_nan() {
        f64::INFINITY
    } else {
        missed.abs()
    }
}

/// State of the search for the first unresolved feature.
pub(super) struct Search {
    criterion: NodeCriterion,
    /// Interval searched: without corners at the ends.
    whole: [f64; 2],
    /// Integral of |force − interpolant| before the first corner and after it.
    missed: [f64; 2],
    is_missed: bool,
    /// First piece on which the nodes miss anything.
    first: Option<[f64; 2]>,
    corner: Option<f64>,
    /// True once a piece was divided at a turn.
    has_turned: bool,
}

impl Search {
    pub fn new(criterion: NodeCriterion) -> Search {
        Search {
            criterion,
            whole: [0.0, 1.0],
            missed: [0.0; 2],
            is_missed: false,
            first: None,
            corner: None,
            has_turned: false,
        }
    }

    /// Bisects until each piece is resolved by the number of nodes of the whole, and compares there.
    pub fn run(mut self, force: &impl ForceAlong) -> Option<Unresolved> {
        // Beside the halves: the whole, two parts about a turn, and one behind a known corner.
        let mut left = [[0.0; 2]; HALVINGS as usize + 4];
        let begin = self.criterion.end(force, |end| [0.0, end]);
        let end = self.criterion.end(force, |end| [1.0 - end, 1.0]);
        // A corner made up by rounding there would hide the first one inside.
        self.whole = [
            begin.max(self.criterion.least),
            1.0 - end.max(self.criterion.least),
        ];
        left[0] = self.whole;
        let (mut count, mut pieces) = (1, 0);
        let most_examined = 400;
        while count > 0 {
            let [from, to] = left[count - 1];
            count -= 1;
            pieces += 1;
            if pieces > most_examined {
                let here = Unresolved {
                    at: from,
                    feature: Feature::Detail,
                };
                return self.found(force).or((from > self.whole[0]).then_some(here));
            }
            let (varies, nodes) = self.criterion.nodes_on(force, from, to);
            match nodes {
                Some(nodes) => self.compare(force, [from, to], nodes),
                None if self.is_least(&varies, to - from) => self.note_corner(&varies, from, to),
                None => {
                    let around_turn = self.around_turn(force, from, to);
                    let [before, behind] =
                        around_turn.unwrap_or_else(|| self.divided(force, from, to));
                    left[count] = [behind, to];
                    if around_turn.is_some() {
                        count += 1;
                        left[count] = [before, behind];
                    }
                    left[count + 1] = [from, before];
                    count += 2;
                }
            }
            if self.corner.is_some() && self.is_missed {
                break;
            }
        }
        (self.is_missed || self.cuts_off())
            .then(|| self.found(force))
            .flatten()
    }

    /// Returns the ends of the two parts of a piece: on either side of a known corner, or at the middle.
    fn divided(&mut self, force: &impl ForceAlong, from: f64, to: f64) -> [f64; 2] {
        let least = self.criterion.least;
        let inside = |at: &f64| at - least > from && at + least < to;
        let Some(at) = force.corner(from, to).filter(inside) else {
            return [0.5 * (from + to); 2];
        };
        self.corner_at(at);
        [at - least, at + least]
    }

    /// Returns the ends of a short part about the first turn in a piece, once.
    fn around_turn(&mut self, force: &impl ForceAlong, from: f64, to: f64) -> Option<[f64; 2]> {
        if self.has_turned {
            return None;
        }
        let least = self.criterion.least;
        let inside = |at: &f64| at - least > from && at + least < to;
        let at = force.turn(from, to).filter(inside)?;
        self.has_turned = true;
        Some([at - least, at + least])
    }

    fn corner_at(&mut self, at: f64) {
        if self.corner.is_none() {
            self.corner = Some(at);
            self.is_missed |= !self.criterion.has_interpolant;
        }
    }

    /// True if a corner is so near an end that all nodes lie on one side of it and the other side is missed.
    fn cuts_off(&self) -> bool {
        let [before, behind] = self.missed;
        let share = 10.0 * CORNER_SHARE * self.criterion.allowed;
        let missed = self.corner.map(|at| if at < 0.5 { before } else { behind });
        self.criterion.has_interpolant && missed.is_some_and(|missed| missed > share)
    }

    /// Returns the first corner, or else an end of the first piece with a missed force.
    fn found(&self, force: &impl ForceAlong) -> Option<Unresolved> {
        let [begin, end] = self.whole;
        let inside = |at: &f64| *at > begin && *at < end;
        let mut ends = self.first.into_iter().flatten();
        let at = self.corner.or_else(|| ends.find(inside))?;
        let feature = match self.corner {
            None => Feature::Detail,
            Some(corner) if self.is_pole(force, corner) => Feature::Pole,
            Some(_) => Feature::Corner,
        };
        Some(Unresolved { at, feature })
    }

    /// True if a corner is a pole: there the enclosure is unbounded.
    fn is_pole(&self, force: &impl ForceAlong, corner: f64) -> bool {
        let width = 2.0 * self.criterion.finest.max(0.5f64.powi(HALVINGS));
        let [from, to] = [corner - width, corner + width];
        let enclosed = force.variation(from, to, self.criterion.ellipses[0]);
        enclosed.change.is_infinite() && has_pole(|aside| force.force(corner + aside), width)
    }

    fn is_least(&self, varies: &Variation, length: f64) -> bool {
        let allowed = CORNER_SHARE * self.criterion.allowed;
        let is_unbounded = varies.change.is_infinite();
        varies.change * length <= allowed
            || length < 0.5f64.powi(HALVINGS)
            || is_unbounded && length < self.criterion.finest
    }

    fn note_corner(&mut self, variation: &Variation, from: f64, to: f64) {
        let is_at_end = from == self.whole[0] || to == self.whole[1];
        if variation.deviation > 0.0 && !is_at_end {
            self.corner_at(0.5 * (from + to));
        }
    }

    fn compare(&mut self, force: &impl ForceAlong, [from, to]: [f64; 2], nodes: usize) {
        if self.is_missed {
            return;
        }
        if !self.criterion.has_interpolant {
            // The stages of a step are about a quarter apart.
            let shortest_shown = 0.2;
            if to - from < shortest_shown {
                (self.is_missed, self.first) = (true, Some([from, to]));
            }
            return;
        }
        let half = 0.5 * (to - from);
        let at = |i: usize| from + half * (1.0 - (PI * (i as f64 + 0.5) / nodes as f64).cos());
        let mut missed: Values = std::array::from_fn(at);
        let missed = &mut missed[..nodes];
        force.missed(missed);
        let missed = missed.iter().map(|missed| size(*missed)).sum::<f64>();
        let integral = missed / nodes as f64 * (to - from);
        if integral > self.criterion.allowed * (to - from) && self.first.is_none() {
            self.first = Some([from, to]);
        }
        self.missed[usize::from(self.corner.is_some_and(|at| from >= at))] += integral;
        self.is_missed = self.missed.iter().sum::<f64>() > self.criterion.allowed;
    }
}
