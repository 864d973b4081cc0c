//! Detail of the loads between the nodes of a panel or a step, from enclosures of the loads.

use super::nonlinear_loads::NonlinearLoads;
use super::{Arms, CurveEquation, CurveTerms, EnclosedState, Linkage, Loads};
use crate::numeric::enclosure::{Detail, Enclosed, Interval, Reach};
use crate::scene::{Load, Variable, Variables};

/// Enclosed state over a piece of a motion, and size of the Bernstein ellipse around the piece.
struct Around<'a> {
    seen: &'a EnclosedState,
    ellipse: f64,
}

impl Around<'_> {
    /// Returns the range of a variable over the piece.
    fn real(&self, variable: Variable) -> Interval {
        match variable {
            Variable::T => self.seen.t,
            Variable::Theta => self.seen.theta,
            Variable::Omega => self.seen.omega,
            Variable::X => self.seen.x,
            Variable::V => self.seen.v,
        }
    }

    fn variable(&self, variable: Variable) -> Enclosed {
        Enclosed::variable(self.real(variable), self.ellipse)
    }

    /// Returns no detail for a closure on a piece no wider than its finest scale, else [`Detail::HIDDEN`].
    fn closure(&self, scales: &[(Variable, f64)]) -> Detail {
        let mut scales = scales.iter();
        let hides = scales.any(|&(variable, scale)| 2.0 * self.real(variable).half() > scale);
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
                pressure.enclose(self.seen.theta) * Enclosed::point(*area)
            }
            Load::Expression(expression) => expression.enclose(|variable| self.variable(variable)),
            // A dry load keeps its sign on a piece.
            Load::Dry(magnitude) => self.magnitude(magnitude),
            _ => Enclosed::point(0.0),
        }
    }

    /// Encloses a magnitude, a function of the size of a speed.
    fn magnitude(&self, load: &Load) -> Enclosed {
        match load {
            Load::Table(table) if matches!(table.of(), Variable::Omega | Variable::V) => {
                table.enclose(self.variable(table.of()).abs().real)
            }
            other => self.load(other),
        }
    }

    fn loads(&self, loads: &NonlinearLoads, arms: Arms) -> Detail {
        let one = |(load, on_slider): &(Load, bool)| {
            let arm = if *on_slider { arms.force } else { arms.torque };
            self.detail(load).times(arm.abs())
        };
        loads
            .list()
            .iter()
            .map(one)
            .fold(Detail::NONE, Detail::plus)
    }
}

/// Whether a load is a table over x; the rows of tables over the crank angle are known corners.
fn is_over_x(load: &Load) -> bool {
    matches!(load, Load::Table(table) if table.of() == Variable::X)
}

fn states_scale(load: &Load) -> bool {
    matches!(load, Load::Function { scales, .. } if !scales.is_empty())
}

impl Loads {
    /// Whether a load may vary between nodes: formulas, tables, gas pressures, dry loads, and closures that state a
    /// scale.
    pub fn have_detail(&self) -> bool {
        self.called().any(|load| {
            matches!(
                load,
                Load::Expression(_) | Load::Table(_) | Load::Gas { .. } | Load::Dry(_)
            ) || states_scale(load)
        })
    }

    /// Whether a load of the position alone may vary between nodes: a formula, a table over x, a closure with a scale.
    pub fn have_detail_of_place(&self) -> bool {
        let mut placed = self.placed.loads();
        placed.any(|load| {
            matches!(load, Load::Expression(_)) || is_over_x(load) || states_scale(load)
        })
    }

    /// Whether the loads act on the slider or depend on its position or velocity.
    pub fn meet_slider(&self) -> bool {
        self.on_slider() || !self.reads().disjoint(Variables::X.or(Variables::V))
    }

    /// Returns the detail of the loads, times their arms, on a piece of a motion and in an `ellipse` around it.
    pub fn detail(&self, seen: &EnclosedState, arms: Arms, ellipse: f64) -> Detail {
        let classes = [&self.placed, &self.timed, &self.mixed, &self.dry];
        Self::detail_of(&classes, seen, arms, ellipse)
    }

    /// Returns the detail of the generalized force, N m, of the loads that depend on the position alone.
    pub fn detail_of_place(&self, linkage: &Linkage, angle: Interval, ellipse: f64) -> Detail {
        let none = Interval::point(0.0);
        let reach = Reach {
            t: none,
            angle,
            speed: none,
        };
        let seen = linkage.seen(&reach, self.meet_slider());
        Self::detail_of(&[&self.placed], &seen, seen.arms(), ellipse)
    }

    /// Returns the detail of the loads that depend on speed or time, without dry loads.
    pub fn detail_of_state(&self, seen: &EnclosedState, arms: Arms, ellipse: f64) -> Detail {
        Self::detail_of(&[&self.timed, &self.mixed], seen, arms, ellipse)
    }

    fn detail_of(
        classes: &[&NonlinearLoads],
        seen: &EnclosedState,
        arms: Arms,
        ellipse: f64,
    ) -> Detail {
        let around = Around { seen, ellipse };
        let details = classes.iter().map(|loads| around.loads(loads, arms));
        details.fold(Detail::NONE, Detail::plus)
    }
}

impl CurveEquation {
    /// Returns the change of q̈ (rad/s²) per unit load, for a motion that slides with c = −μ sgn(v) sgn(N), in the
    /// middle of a range of coordinates (rad): the nodes of a step resolve the linkage.
    pub fn arms(&self, q: Interval, c: f64) -> Arms {
        let terms = self.across(q.middle());
        let CurveTerms { place, m, a, .. } = terms;
        let gain = place.dx / m;
        let rubbed = gain * c / (1.0 - c * (a * gain - terms.x_n));
        let arm = |along: f64, aside: f64| along / m + rubbed * (a * along / m - aside);
        Arms {
            torque: arm(place.dtheta, terms.theta_n),
            force: arm(place.dx, terms.x_n),
        }
    }
}
