//! The smoothest continuous motion through the anchors, by dynamic programming.

use super::anchors::{Anchors, in_turn};

/// A motion through the anchors.
#[derive(Debug)]
pub(super) struct Path {
    /// Crank angle at each anchor, rad.
    pub theta: Vec<f64>,
    /// Which of the anchor's candidates it is.
    pub choice: Vec<usize>,
    /// Usual difference between an angle and the parabola through the three before it, as of single angles, rad.
    pub scale: f64,
    /// How often the motion changes from one stroke to the other, or could have.
    pub passages: usize,
}

/// Motions that are followed at the same time.
const BEAM: usize = 8;

#[derive(Clone, Copy, Debug)]
struct Node {
    parent: u8,
    choice: u8,
    theta: f64,
}

#[derive(Clone, Debug)]
struct Way {
    node: u8,
    cost: f64,
    /// The last three angles, newest first.
    last: [f64; 3],
    /// The last three choices, two bits each.
    key: u8,
}

/// The smoothest path from each angle of the first anchor, with its sum of squares.
pub(super) fn paths(anchors: &Anchors) -> Vec<(f64, Path)> {
    let starts = anchors.candidates[0].angles().len();
    (0..starts).map(|start| from(anchors, start)).collect()
}

/// What the parabola (or line, or point) through the angles before, newest first, predicts, and the standard
/// deviation of the difference for angles of unit variance.
pub(super) fn predict(t: &[f64], at: usize, last: &[f64; 3]) -> (f64, f64) {
    let known = at.min(3);
    let (mut sum, mut spread) = (0.0, 1.0);
    for i in 0..known {
        let mut weight = 1.0;
        for j in 0..known {
            if j != i {
                weight *= (t[at] - t[at - 1 - j]) / (t[at - 1 - i] - t[at - 1 - j]);
            }
        }
        sum += weight * last[i];
        spread += weight * weight;
    }
    (sum, spread.sqrt())
}

fn from(anchors: &Anchors, start: usize) -> (f64, Path) {
    let first = anchors.candidates[0].angles()[start];
    let mut layers = vec![vec![Node {
        parent: 0,
        choice: start as u8,
        theta: first,
    }]];
    let mut motions = vec![Way {
        node: 0,
        cost: 0.0,
        last: [first, 0.0, 0.0],
        key: start as u8,
    }];
    for at in 1..anchors.t.len() {
        let mut next: Vec<(Way, Node)> = Vec::with_capacity(4 * BEAM);
        for motion in &motions {
            let (expected, spread) = predict(&anchors.t, at, &motion.last);
            for (choice, angle) in anchors.candidates[at].angles().iter().enumerate() {
                let theta = in_turn(*angle, expected);
                // Less than a parabola foretells nothing: the motion may begin fast.
                let error = if at < 3 {
                    0.0
                } else {
                    (theta - expected) / spread
                };
                let key = (motion.key << 2 | choice as u8) & 0x3f;
                let cost = motion.cost + error * error;
                let last = [theta, motion.last[0], motion.last[1]];
                let node = Node {
                    parent: motion.node,
                    choice: choice as u8,
                    theta,
                };
                let new = Way {
                    node: 0,
                    cost,
                    last,
                    key,
                };
                match next.iter_mut().find(|(other, _)| other.key == key) {
                    Some(other) if other.0.cost <= cost => (),
                    Some(other) => *other = (new, node),
                    None => next.push((new, node)),
                }
            }
        }
        if next.is_empty() {
            // A sample without any angle was refused before.
            break;
        }
        next.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
        next.truncate(BEAM);
        let number = |(i, (motion, _)): (usize, &(Way, Node))| Way {
            node: i as u8,
            ..motion.clone()
        };
        motions = next.iter().enumerate().map(number).collect();
        layers.push(next.into_iter().map(|(_, node)| node).collect());
    }
    let cost = motions[0].cost;
    let mut node = 0;
    let mut nodes: Vec<Node> = layers
        .iter()
        .rev()
        .map(|layer| {
            let found = layer[node];
            node = usize::from(found.parent);
            found
        })
        .collect();
    nodes.reverse();
    (cost, Path::new(anchors, &nodes))
}

impl Path {
    fn new(anchors: &Anchors, nodes: &[Node]) -> Path {
        let theta: Vec<f64> = nodes.iter().map(|node| node.theta).collect();
        let choice: Vec<usize> = nodes.iter().map(|node| usize::from(node.choice)).collect();
        let mut errors: Vec<f64> = (3..theta.len())
            .map(|at| error(anchors, &theta, at))
            .collect();
        let middle = errors.len() / 2;
        let scale = match errors.is_empty() {
            true => 0.0,
            false => *errors.select_nth_unstable_by(middle, f64::total_cmp).1,
        };
        Path {
            scale: 1.4826 * scale,
            passages: choice.windows(2).filter(|w| w[0] != w[1]).count(),
            theta,
            choice,
        }
    }
}

/// Size of the difference between an angle and its prediction, as of single angles.
pub(super) fn error(anchors: &Anchors, theta: &[f64], at: usize) -> f64 {
    let last = [theta[at - 1], theta[at - 2], theta[at - 3]];
    let (expected, spread) = predict(&anchors.t, at, &last);
    (theta[at] - expected).abs() / spread
}
