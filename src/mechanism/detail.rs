//! What loads do between the nodes of a panel or a step.

use super::nonlinear_loads::NonlinearLoads;
use super::{Linkage, Loads};
use crate::numeric::enclosure::{Detail, Enclosed, Interval, Reach};
use crate::scene::{Load, Variable, Variables};

/// Slider position (m) and x' (m/rad) where the crank has these angles.
#[derive(Clone, Copy, Debug)]
struct Places {
    x: Interval,
    dx: Interval,
}

/// A piece of a motion as the loads see it.
struct Around<'a> {
    reach: &'a Reach,
    places: Option<Places>,
    ellipse: f64,
}

impl Linkage {
    fn enclose(&self, angle: Interval) -> Places {
        let at = Interval::point;
        let (sin, cos) = (angle.sin(), angle.cos());
        let sin_phi = (at(self.e) + at(self.r) * sin) * at(1.0 / self.l);
        let squared = at(1.0) - sin_phi.square();
        let cos_phi = Interval::new(squared.low.max(0.0), squared.high.max(0.0)).rising(f64::sqrt);
        let along = at(self.r) * cos;
        Places {
            x: along + at(self.s * self.l) * cos_phi,
            dx: -(at(self.r) * sin) - at(self.s) * along * sin_phi * cos_phi.reciprocal(),
        }
    }
}

impl Around<'_> {
    /// A variable over the piece, and of how many parts each has nodes of its own.
    fn real(&self, variable: Variable) -> (Interval, f64) {
        let unknown = Interval::WHOLE;
        let place = |of: fn(&Places) -> Interval| self.places.as_ref().map_or(unknown, of);
        let real = match variable {
            Variable::T => self.reach.t,
            Variable::Theta => self.reach.angle,
            Variable::Omega => self.reach.speed,
            Variable::X => place(|places| places.x),
            Variable::V => place(|places| places.dx) * self.reach.speed,
        };
        // A part of the way may be a larger one of the stroke.
        let parts = match variable {
            Variable::X | Variable::V => 1.0,
            _ => self.reach.parts,
        };
        (real, parts)
    }

    fn variable(&self, variable: Variable) -> Enclosed {
        let (real, parts) = self.real(variable);
        Enclosed::in_parts(real, self.ellipse, parts)
    }

    /// A closure shows what it does where no part is wider than its finest scale.
    fn closure(&self, scales: &[(Variable, f64)]) -> Detail {
        let hides = scales.iter().any(|&(variable, scale)| {
            let (real, parts) = self.real(variable);
            2.0 * real.half() > scale * parts
        });
        if hides { Detail::HIDDEN } else { Detail::NONE }
    }

    fn detail(&self, load: &Load) -> Detail {
        match load {
            Load::Function { scales, .. } => self.closure(scales),
            other => Detail::of(self.load(other)),
        }
    }

    fn load(&self, load: &Load) -> Enclosed {
        match load {
            Load::Table(table) => table.enclose(self.variable(table.of()).real),
            Load::Gas { pressure, area, .. } => {
                pressure.enclose(self.reach.angle) * Enclosed::point(*area)
            }
            Load::Expression(expression) => expression.enclose(|variable| self.variable(variable)),
            // Its sign stays on a piece.
            Load::Dry(magnitude) => self.magnitude(magnitude),
            _ => Enclosed::point(0.0),
        }
    }

    /// A magnitude, which is over the size of a speed.
    fn magnitude(&self, load: &Load) -> Enclosed {
        match load {
            Load::Table(table) if matches!(table.of(), Variable::Omega | Variable::V) => {
                table.enclose(self.variable(table.of()).abs().real)
            }
            other => self.load(other),
        }
    }

    fn loads(&self, loads: &NonlinearLoads) -> Detail {
        let sum = |list: &[Load]| {
            let details = list.iter().map(|load| self.detail(load));
            details.fold(Detail::NONE, Detail::plus)
        };
        let torque = sum(&loads.torques);
        match self.places {
            Some(places) if !loads.forces.is_empty() => {
                torque.plus(sum(&loads.forces).times(places.dx.largest()))
            }
            _ => torque,
        }
    }
}

/// The rows of other tables of the position are known as crank angles.
fn is_over_x(load: &Load) -> bool {
    matches!(load, Load::Table(table) if table.of() == Variable::X)
}

fn states_scale(load: &Load) -> bool {
    matches!(load, Load::Function { scales, .. } if !scales.is_empty())
}

impl Loads {
    /// Whether there are loads that may do something between nodes: formulas, closures that state a scale, and tables over
    /// another variable than the crank angle or time, whose rows are known.
    pub fn have_detail(&self) -> bool {
        self.called().any(|load| {
            matches!(
                load,
                Load::Expression(_) | Load::Table(_) | Load::Gas { .. } | Load::Dry(_)
            ) || states_scale(load)
        })
    }

    /// Whether one of them depends on the position alone.
    pub fn have_detail_of_place(&self) -> bool {
        let mut placed = self.placed.loads();
        placed.any(|load| {
            matches!(load, Load::Expression(_)) || is_over_x(load) || states_scale(load)
        })
    }

    /// What the generalized force (N m) of the loads does on a piece of a motion, and in an ellipse of this size around it.
    pub fn detail(&self, linkage: &Linkage, reach: &Reach, ellipse: f64) -> Detail {
        let classes = [&self.placed, &self.timed, &self.mixed, &self.dry];
        self.detail_of(&classes, linkage, reach, ellipse)
    }

    /// Detail of the loads that depend on the position alone.
    pub fn detail_of_place(&self, linkage: &Linkage, angle: Interval, ellipse: f64) -> Detail {
        let none = Interval::point(0.0);
        let reach = Reach {
            t: none,
            angle,
            speed: none,
            parts: 1.0,
        };
        self.detail_of(&[&self.placed], linkage, &reach, ellipse)
    }

    /// Detail of the loads that depend on speed or time.
    pub fn detail_of_state(&self, linkage: &Linkage, reach: &Reach, ellipse: f64) -> Detail {
        self.detail_of(&[&self.timed, &self.mixed], linkage, reach, ellipse)
    }

    fn detail_of(
        &self,
        classes: &[&NonlinearLoads],
        linkage: &Linkage,
        reach: &Reach,
        ellipse: f64,
    ) -> Detail {
        let by_place = Variables::X.or(Variables::V);
        let placed = self.on_slider || !self.reads().disjoint(by_place);
        let around = Around {
            reach,
            places: placed.then(|| linkage.enclose(reach.angle)),
            ellipse,
        };
        let classes = classes.iter().filter(|loads| !loads.is_empty());
        let details = classes.map(|loads| around.loads(loads));
        details.fold(Detail::NONE, Detail::plus)
    }
}
