//! Resolution test: finds loads that the nodes of a panel or a step miss, by enclosures in Bernstein ellipses.

mod steps;

use std::f64::consts::PI;

use crate::numeric::enclosure::{CORNER_SHARE, Variation, ellipses, has_pole, resolved};

pub use steps::{OnStep, finest, unresolved_at};

/// Force along a panel or a step, over the normalized position from 0 to 1, with its interpolant through the nodes.
pub trait ForceAlong {
    /// Returns the variation of the force between two positions, and in the Bernstein ellipse of ρ = `ellipse`.
    fn variation(&self, from: f64, to: f64, ellipse: f64) -> Variation;

    /// Returns the first known corner of the force between two positions.
    fn corner(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// Returns a position between two others at which the motion turns back: a force of the speed may be analytic on
    /// either side only.
    fn turn(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// Returns the force at a position.
    fn force(&self, _at: f64) -> f64 {
        0.0
    }

    /// Replaces some positions by the force there minus its interpolant through the nodes.
    fn missed(&self, at: &mut [f64]) {
        at.fill(0.0);
    }
}

/// Criterion for the nodes of a panel or a step to resolve a force.
#[derive(Clone, Copy, Debug)]
pub struct NodeCriterion {
    /// Number of nodes.
    pub nodes: usize,
    /// Parameters ρ of the Bernstein ellipses in which the force is enclosed, the smaller first.
    pub ellipses: [f64; 2],
    /// Largest error of the force that the nodes may leave anywhere, in the unit of the force.
    pub allowed: f64,
    /// Distance from either end that rounding cannot resolve, as a fraction of the length.
    pub least: f64,
    /// Length that rounding cannot divide, as a fraction of the length.
    pub finest: f64,
    /// True if the nodes define an interpolant to compare with; else they resolve features of a quarter the length.
    pub has_interpolant: bool,
}

/// Halvings of the interval that locate a corner or jump: positions on a panel are rounded by more.
const HALVINGS: i32 = 46;

impl NodeCriterion {
    /// Returns the criterion for a step from one time to another (s), with `least` as 16 roundings of the time.
    pub fn at_step([from, to]: [f64; 2], nodes: usize, part: f64, allowed: f64) -> NodeCriterion {
        let rounding = f64::EPSILON * from.abs().max(to.abs()) / (to - from);
        NodeCriterion {
            nodes,
            ellipses: ellipses(nodes, part),
            allowed,
            least: 16.0 * rounding,
            finest: 4.0 * rounding,
            has_interpolant: false,
        }
    }
}

/// Position at which a panel or a step has to end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unresolved {
    /// Position, as a fraction of the length.
    pub at: f64,
    /// What the force has there.
    pub feature: Feature,
}

/// Feature of a force that the nodes do not resolve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// Detail too fine for the nodes.
    Detail,
    /// Corner or jump.
    Corner,
    /// Pole: the force has no finite value, and its integral has none.
    Pole,
}

/// Returns the position at which a panel or a step has to end for its nodes to resolve the force; none if they do.
pub fn unresolved(force: &impl ForceAlong, criterion: NodeCriterion) -> Option<Unresolved> {
    if criterion.nodes_on(force, 0.0, 1.0).1.is_some() {
        return None;
    }
    let search = Search {
        criterion,
        whole: [0.0, 1.0],
        missed: [0.0; 2],
        is_missed: false,
        first: None,
        corner: None,
        has_turned: false,
    };
    search.run(force)
}

impl NodeCriterion {
    /// Returns the variation of the force on a piece, and the number of nodes that resolve it, if at most
    /// [`Self::nodes`].
    fn nodes_on(&self, force: &impl ForceAlong, from: f64, to: f64) -> (Variation, Option<usize>) {
        self.nodes_for(|ellipse| force.variation(from, to, ellipse))
    }

    fn nodes_for(&self, variation: impl Fn(f64) -> Variation) -> (Variation, Option<usize>) {
        resolved(variation, self.ellipses, self.allowed, self.nodes)
    }

    /// True if the nodes resolve a force whose variation is given as a function of the ellipse parameter.
    pub fn resolves(&self, variation: impl Fn(f64) -> Variation) -> bool {
        self.nodes_for(variation).1.is_some()
    }

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
struct Search {
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
    /// Bisects until each piece is resolved by the number of nodes of the whole, and compares there.
    fn run(mut self, force: &impl ForceAlong) -> Option<Unresolved> {
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
        let mut missed = Vec::from_iter((0..nodes).map(at));
        force.missed(&mut missed);
        let missed = missed.into_iter().map(size).sum::<f64>();
        let integral = missed / nodes as f64 * (to - from);
        if integral > self.criterion.allowed * (to - from) && self.first.is_none() {
            self.first = Some([from, to]);
        }
        self.missed[usize::from(self.corner.is_some_and(|at| from >= at))] += integral;
        self.is_missed = self.missed.iter().sum::<f64>() > self.criterion.allowed;
    }
}
