//! What is tabulated at the points of a panel.

use crate::numeric::chebyshev::{MAX_DEGREE, Values};

/// What depends on the angle alone, at some angles.
#[derive(Clone)]
pub struct Table<P> {
    /// Inertia M, kg m².
    pub inertia: Values,
    /// Force that has a potential, N m.
    pub force: Values,
    /// Force of the position alone that has none, N m.
    pub push: Values,
    /// Damping, N m s/rad: the force is less by this times the speed.
    pub damping: Values,
    /// What [`super::Driven::drive`] needs; empty if there is nothing to be driven.
    pub places: Vec<P>,
    /// What there is if the forces have two forms.
    pub switch: Option<Box<Switch>>,
}

/// The forces may have two forms, one on each side of a zero of the switch, a function of the state. They are
/// continuous there.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Force of this side by the square of the speed, N m s²/rad².
    pub force: Values,
    /// The switch without speed.
    pub place: Values,
    /// By the speed, s/rad.
    pub rate: Values,
    /// By its square, s²/rad².
    pub square: Values,
}

impl Default for Switch {
    fn default() -> Switch {
        Switch {
            force: [0.0; MAX_DEGREE + 1],
            place: [0.0; MAX_DEGREE + 1],
            rate: [0.0; MAX_DEGREE + 1],
            square: [0.0; MAX_DEGREE + 1],
        }
    }
}

impl<P> Default for Table<P> {
    fn default() -> Table<P> {
        Table {
            inertia: [0.0; MAX_DEGREE + 1],
            force: [0.0; MAX_DEGREE + 1],
            push: [0.0; MAX_DEGREE + 1],
            damping: [0.0; MAX_DEGREE + 1],
            places: Vec::new(),
            switch: None,
        }
    }
}
