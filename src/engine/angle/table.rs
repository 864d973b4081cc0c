//! Tables of inertia and forces at the points of a panel.

use crate::numeric::chebyshev::{MAX_DEGREE, Values};

/// Quantities that depend on the angle alone, at some angles.
#[derive(Clone)]
pub struct Table<P> {
    /// Inertia M, kg m².
    pub inertia: Values,
    /// Conservative force, N m.
    pub force: Values,
    /// Non-conservative force of the position alone, N m.
    pub push: Values,
    /// Damping coefficient, N m s/rad: the force −damping·ω.
    pub damping: Values,
    /// Data for [`super::Dynamics::state_loads`]; empty if there are no state loads.
    pub places: Vec<P>,
    /// Switch between two forms of the forces, if there are two.
    pub switch: Option<Box<Switch>>,
}

/// Switch between two forms of the forces, one on each side of its zero: place + rate·ω + square·ω² + the part of the
/// state loads. The forces are continuous at the zero.
#[derive(Clone, Debug)]
pub struct Switch {
    /// Force of this side per square of the speed, N m s²/rad².
    pub force: Values,
    /// Switch at zero speed.
    pub place: Values,
    /// Coefficient of the speed in the switch, in its unit times s/rad.
    pub rate: Values,
    /// Coefficient of the squared speed in the switch, in its unit times s²/rad².
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
