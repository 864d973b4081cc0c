//! Resolution test: finds loads that the nodes of a panel or a step miss, by enclosures in Bernstein ellipses.

mod search;
mod steps;

use search::Search;

use crate::numeric::enclosure::{Variation, ellipses, is_resolved_by_least_ellipse, resolved};

pub use steps::unresolved_on;

/// Force along a panel or a step, over the normalized position from 0 to 1, with its interpolant through the nodes.
pub trait ForceAlong {
    /// Returns the variation of the force between two positions, and in the Bernstein ellipse of ρ = `ellipse`.
    fn variation(&self, from: f64, to: f64, ellipse: f64) -> Variation;

    /// Returns the first known corner of the force between two positions.
    fn corner(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// Returns a position between two others at which the motion turns back: a force of the speed may have a corner.
    fn turn(&self, _from: f64, _to: f64) -> Option<f64> {
        None
    }

    /// Returns the force at a position.
    fn force(&self, _at: f64) -> f64 {
        0.0
    }

    /// Replaces some positions, no more than the nodes, by the force there minus its interpolant through the nodes.
    fn missed(&self, at: &mut [f64]) {
        at.fill(0.0);
    }
}

/// Criterion for the nodes of a panel or a step to resolve a force.
#[derive(Clone, Copy, Debug)]
pub struct NodeCriterion {
    /// Number of nodes, at most [`crate::numeric::chebyshev::MAX_DEGREE`].
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
    let (varies, resolved) = criterion.nodes_on(force, 0.0, 1.0);
    let of_whole = |ellipse| force.variation(0.0, 1.0, ellipse);
    let NodeCriterion { allowed, nodes, .. } = criterion;
    if resolved.is_some() || is_resolved_by_least_ellipse(of_whole, varies.change, allowed, nodes) {
        return None;
    }
    Search::new(criterion).run(force)
}

impl NodeCriterion {
    /// Returns the variation of the force on a piece, and the nodes that resolve it, if at most [`Self::nodes`].
    fn nodes_on(&self, force: &impl ForceAlong, from: f64, to: f64) -> (Variation, Option<usize>) {
        let variation = |ellipse| force.variation(from, to, ellipse);
        resolved(variation, self.ellipses, self.allowed, self.nodes)
    }

    /// True if the nodes resolve a force whose variation is given as a function of the ellipse parameter.
    pub fn resolves(&self, variation: impl Fn(f64) -> Variation) -> bool {
        let (_, nodes) = resolved(variation, self.ellipses, self.allowed, self.nodes);
        nodes.is_some()
    }
}
