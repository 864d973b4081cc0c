//! Whether the nodes of a panel or a step show the forces on it, or something is hidden between them.

mod steps;

use std::f64::consts::PI;

use crate::numeric::enclosure::{Detail, ellipses, shown};

pub use steps::{OnStep, hides};

/// The motion on a panel or a step, over its part from 0 to 1.
pub trait Interpolant {
    /// What the force does between two parts of it, and in an ellipse of this size around that.
    fn detail(&self, from: f64, to: f64, ellipse: f64) -> Detail;

    /// Where a corner of the force is known to be inside a part of it, the first one.
    fn corner(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// The force there less that which the nodes show.
    fn missed(&self, _at: f64) -> f64 {
        0.0
    }
}

/// How a panel or a step is looked at.
#[derive(Clone, Copy, Debug)]
pub struct NodeCriterion {
    /// Number of nodes.
    pub nodes: usize,
    /// Sizes of the ellipses that they need.
    pub ellipses: [f64; 2],
    /// What the nodes may leave out of the force, everywhere on it.
    pub allowed: f64,
    /// Part of it at either end that rounding does not tell from the end.
    pub least: f64,
    /// Whether its nodes tell the force between them, to be compared; else they show what is as wide as a quarter of it.
    pub compares: bool,
}

/// A corner or a jump is found to so many halvings of the whole: the place in a panel is rounded by more.
const HALVINGS: i32 = 46;
/// Part of what is allowed that each corner may leave.
const AT_CORNER: f64 = 1e-4;
/// A step whose nodes are not to be compared shows what it shows on pieces of about a quarter: its stages are so far apart.
const SHOWN_PIECE: f64 = 0.2;
/// Most pieces of one panel that are looked at.
const MOST_PIECES: usize = 400;
/// Ends that are left out where a corner is at an end, off by what its place is off.
const END_PARTS: [f64; 2] = [9.5367431640625e-7, 9.094947017729282e-13];

impl NodeCriterion {
    /// At a step from one time to another (s), which ends no closer to its start than some roundings of the time.
    pub fn at_step([from, to]: [f64; 2], nodes: usize, part: f64, allowed: f64) -> NodeCriterion {
        NodeCriterion {
            nodes,
            ellipses: ellipses(nodes, part),
            allowed,
            least: 16.0 * f64::EPSILON * from.abs().max(to.abs()) / (to - from),
            compares: false,
        }
    }
}

/// Where a panel or a step has to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hidden {
    /// As part of it.
    pub at: f64,
    /// Whether the force has a corner or a jump there.
    pub is_corner: bool,
}

/// Where a panel or a step has to end so that its nodes show the forces; none if they do.
pub fn hidden(way: &impl Interpolant, look: NodeCriterion) -> Option<Hidden> {
    if look.nodes_on(way, 0.0, 1.0).1.is_some() {
        return None;
    }
    Search::new(look).run(way)
}

impl NodeCriterion {
    /// What the force does on a piece, and how many nodes show it, where its own are enough.
    fn nodes_on(&self, way: &impl Interpolant, from: f64, to: f64) -> (Detail, Option<usize>) {
        self.nodes_for(|ellipse| way.detail(from, to, ellipse))
    }

    fn nodes_for(&self, detail: impl Fn(f64) -> Detail) -> (Detail, Option<usize>) {
        shown(detail, self.ellipses, self.allowed, self.nodes)
    }

    /// Whether its nodes show a force, of which the detail in an ellipse of some size is given.
    pub fn shows(&self, detail: impl Fn(f64) -> Detail) -> bool {
        self.nodes_for(detail).1.is_some()
    }

    /// The part at an end that may be left out for a corner there.
    fn end(&self, way: &impl Interpolant, piece: fn(f64) -> [f64; 2]) -> f64 {
        let little = |end: &f64| {
            let [from, to] = piece(*end);
            let detail = way.detail(from, to, self.ellipses[0]);
            detail.change * end <= AT_CORNER * self.allowed
        };
        END_PARTS.into_iter().find(little).unwrap_or(0.0)
    }
}

/// A magnitude; what has no value is missed beyond all bounds.
fn size(missed: f64) -> f64 {
    if missed.is_nan() {
        f64::INFINITY
    } else {
        missed.abs()
    }
}

/// What was found from the start of a panel on.
struct Search {
    look: NodeCriterion,
    /// What is looked at: all but corners at the ends.
    whole: [f64; 2],
    /// Integral of what the nodes miss, before the first corner and behind it.
    missed: [f64; 2],
    is_missed: bool,
    /// The first piece on which they miss anything.
    first: Option<[f64; 2]>,
    corner: Option<f64>,
}

impl Search {
    fn new(look: NodeCriterion) -> Search {
        Search {
            look,
            whole: [0.0, 1.0],
            missed: [0.0; 2],
            is_missed: false,
            first: None,
            corner: None,
        }
    }

    /// Halves the panel until each piece is shown by as many nodes as the panel has, and compares there.
    fn run(mut self, way: &impl Interpolant) -> Option<Hidden> {
        let mut left = [[0.0; 2]; HALVINGS as usize + 2];
        let begin = self.look.end(way, |end| [0.0, end]);
        let end = self.look.end(way, |end| [1.0 - end, 1.0]);
        // A corner that rounding makes up there would hide the first one inside.
        self.whole = [begin.max(self.look.least), 1.0 - end.max(self.look.least)];
        left[0] = self.whole;
        let (mut count, mut pieces) = (1, 0);
        while count > 0 {
            let [from, to] = left[count - 1];
            count -= 1;
            pieces += 1;
            if pieces > MOST_PIECES {
                let here = Hidden {
                    at: from,
                    is_corner: false,
                };
                return self.place().or((from > self.whole[0]).then_some(here));
            }
            let (detail, nodes) = self.look.nodes_on(way, from, to);
            match nodes {
                Some(nodes) => self.compare(way, [from, to], nodes),
                None if self.is_least(&detail, to - from) => self.note_corner(&detail, from, to),
                None => {
                    let [before, behind] = self.divided(way, from, to);
                    left[count] = [behind, to];
                    left[count + 1] = [from, before];
                    count += 2;
                }
            }
            if self.corner.is_some() && self.is_missed {
                break;
            }
        }
        (self.is_missed || self.cuts_off())
            .then(|| self.place())
            .flatten()
    }

    /// Where a piece is divided: beside a corner that is known, or in the middle.
    fn divided(&mut self, way: &impl Interpolant, from: f64, to: f64) -> [f64; 2] {
        let least = self.look.least;
        let inside = |at: &f64| at - least > from && at + least < to;
        let Some(at) = way.corner(from, to).filter(inside) else {
            return [0.5 * (from + to); 2];
        };
        self.corner_at(at);
        [at - least, at + least]
    }

    fn corner_at(&mut self, at: f64) {
        if self.corner.is_none() {
            self.corner = Some(at);
            self.is_missed |= !self.look.compares;
        }
    }

    /// Whether there is a corner so near to an end that the nodes are all on one side, and something on the other.
    fn cuts_off(&self) -> bool {
        let [before, behind] = self.missed;
        let share = 10.0 * AT_CORNER * self.look.allowed;
        let missed = self.corner.map(|at| if at < 0.5 { before } else { behind });
        self.look.compares && missed.is_some_and(|missed| missed > share)
    }

    /// The first corner, or else an end of the piece on which something was missed first.
    fn place(&self) -> Option<Hidden> {
        let [begin, end] = self.whole;
        let inside = |at: &f64| *at > begin && *at < end;
        let mut ends = self.first.into_iter().flatten();
        let at = self.corner.or_else(|| ends.find(inside))?;
        let is_corner = self.corner.is_some();
        Some(Hidden { at, is_corner })
    }

    fn is_least(&self, detail: &Detail, length: f64) -> bool {
        detail.change * length <= AT_CORNER * self.look.allowed || length < 0.5f64.powi(HALVINGS)
    }

    fn note_corner(&mut self, detail: &Detail, from: f64, to: f64) {
        let is_at_end = from == self.whole[0] || to == self.whole[1];
        if detail.around.is_none() && !is_at_end {
            self.corner_at(0.5 * (from + to));
        }
    }

    fn compare(&mut self, way: &impl Interpolant, [from, to]: [f64; 2], nodes: usize) {
        if self.is_missed {
            return;
        }
        if !self.look.compares {
            if to - from < SHOWN_PIECE {
                (self.is_missed, self.first) = (true, Some([from, to]));
            }
            return;
        }
        let half = 0.5 * (to - from);
        let at = |i: usize| from + half * (1.0 - (PI * (i as f64 + 0.5) / nodes as f64).cos());
        let missed = (0..nodes).map(|i| size(way.missed(at(i)))).sum::<f64>();
        let integral = missed / nodes as f64 * (to - from);
        if integral > self.look.allowed * (to - from) && self.first.is_none() {
            self.first = Some([from, to]);
        }
        self.missed[usize::from(self.corner.is_some_and(|at| from >= at))] += integral;
        self.is_missed = self.missed.iter().sum::<f64>() > self.look.allowed;
    }
}
