//! The Pareto front: designs that no other is better than in one figure without being worse in another.

use super::Figure;

/// A figure that should be as small, or as large, as it can be.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// The figure.
    pub figure: Figure,
    /// Whether more of it is better.
    pub most: bool,
}

/// A design of a front.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// From 1.
    pub design: usize,
    /// Figures of the design, in the order of the goals.
    pub figures: Vec<f64>,
}

/// The designs so far that no other one dominates, in the order in which they came.
#[derive(Clone, Debug)]
pub struct ParetoFront {
    /// Of each goal whether more is better.
    most: Vec<bool>,
    members: Vec<Member>,
}

impl ParetoFront {
    /// Of these senses; true: more is better.
    pub fn new(most: Vec<bool>) -> ParetoFront {
        ParetoFront {
            most,
            members: Vec::new(),
        }
    }

    /// Takes a design that has all figures; of equal ones the first stays.
    pub fn take(&mut self, design: usize, figures: &[f64]) {
        let no_worse = |one: &[f64], other: &[f64]| {
            let pairs = one.iter().zip(other).zip(&self.most);
            pairs
                .into_iter()
                .all(|((one, other), most)| if *most { one >= other } else { one <= other })
        };
        let beaten = |member: &Member| no_worse(&member.figures, figures);
        if self.members.iter().any(beaten) {
            return;
        }
        self.members
            .retain(|member| !no_worse(figures, &member.figures));
        self.members.push(Member {
            design,
            figures: figures.to_vec(),
        });
    }

    /// The front.
    pub fn members(&self) -> &[Member] {
        &self.members
    }
}
