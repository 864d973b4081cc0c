//! Pareto front: keeps, of designs taken one by one, those that no other dominates.

use super::Figure;

/// Figure to minimise or maximise.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Goal figure.
    pub figure: Figure,
    /// True to maximise, false to minimise.
    pub maximise: bool,
}

impl Goal {
    /// Returns the goal to minimise a figure.
    pub fn least(figure: Figure) -> Goal {
        let maximise = false;
        Goal { figure, maximise }
    }

    /// Returns the goal to maximise a figure.
    pub fn most(figure: Figure) -> Goal {
        let maximise = true;
        Goal { figure, maximise }
    }
}

/// Non-dominated design.
#[derive(Clone, Debug, PartialEq)]
pub struct Member {
    /// Number of the design, from 1.
    pub design: usize,
    /// Figures of the design, in the order of the goals.
    pub figures: Vec<f64>,
}

/// Non-dominated designs, in order of arrival.
#[derive(Clone, Debug)]
pub struct ParetoFront {
    /// Sense of each goal: true to maximise.
    maximise: Vec<bool>,
    /// Designs of the front.
    pub members: Vec<Member>,
}

impl ParetoFront {
    /// Starts an empty front; `maximise` has one element per goal.
    pub fn new(maximise: Vec<bool>) -> ParetoFront {
        ParetoFront {
            maximise,
            members: Vec::new(),
        }
    }

    /// Inserts a design unless dominated and removes those it dominates; of equal designs the first stays.
    pub fn take(&mut self, design: usize, figures: &[f64]) {
        let no_worse = |one: &[f64], other: &[f64]| {
            let mut pairs = one.iter().zip(other).zip(&self.maximise);
            pairs.all(|((a, b), maximise)| if *maximise { a >= b } else { a <= b })
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
}
