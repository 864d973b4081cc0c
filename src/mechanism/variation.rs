//! Variation of the loads between the nodes of a panel or a step, from enclosures of the loads.

use super::nonlinear_loads::NonlinearLoads;
use super::{CurveEquation, CurveTerms, EnclosedState, Linkage, Loads, SliderUse, UnitLoadEffects};
use crate::numeric::enclosure::{Enclosed, Interval, MotionPiece, Variation};
use crate::scene::{Load, Variable, Variables};

/// Enclosed state over a piece of a motion, and size of the Bernstein ellipse around the piece.
struct Around<'a> {
    state: &'a EnclosedState,
    ellipse: f64,
}

impl Around<'_> {
    /// Returns the range of a variable over the piece.
    fn real(&self, variable: Variable) -> Interval {
        match variable {
            Variable::T => self.state.t,
            Variable::Theta => self.state.theta,
            Variable::Omega => self.state.omega,
            Variable::X => self.state.x,
            Variable::V => self.state.v,
        }
    }

    fn variable(&self, variable: Variable) -> Enclosed {
        Enclosed::variable(self.real(variable), self.ellipse)
    }

    /// Returns no variation for a closure on a piece no wider than its finest scale, else [`Variation::HIDDEN`].
    fn closure(&self, scales: &[(Variable, f64)]) -> Variation {
        let mut scales = scales.iter();
        let hides = scales.any(|&(variable, scale)| 2.0 * self.real(variable).half() > scale);
        match hides {
            true => Variation::HIDDEN,
            false => Variation::NONE,
        }
    }

    fn variation(&self, load: &Load) -> Variation {
        match load {
            Load::Function { scales, .. } => self.closure(scales),
            other => Variation::of(self.load(other)),
        }
    }

    fn load(&self, load: &Load) -> Enclosed {
        match load {
            Load::Table(table) => table.enclose(self.variable(table.of()).real),
            Load::Gas { pressure, area, .. } => {
                pressure.enclose(self.state.theta) * Enclosed::point(*area)
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

    fn loads<'l>(
        &self,
        loads: impl IntoIterator<Item = &'l (Load, bool)>,
        effects: UnitLoadEffects,
    ) -> Variation {
        let one = |(load, on_slider): &(Load, bool)| {
            let arm = if *on_slider {
                effects.force
            } else {
                effects.torque
            };
            match arm == 0.0 {
                true => Variation::NONE,
                false => self.variation(load).times(arm.abs()),
            }
        };
        let each = loads.into_iter().map(one);
        each.fold(Variation::NONE, Variation::plus)
    }
}

impl Loads {
    /// Whether a load may vary between nodes: formula, table, gas pressure, dry load, or closure that states a scale.
    pub fn vary_between_nodes(&self) -> bool {
        self.called().any(|load| match load {
            Load::Expression(_) | Load::Table(_) | Load::Gas { .. } | Load::Dry(_) => true,
            Load::Function { scales, .. } => !scales.is_empty(),
            _ => false,
        })
    }

    /// Whether a load of the position alone may vary between nodes: a formula, a table over x, a closure with a scale.
    pub fn vary_with_position_between_nodes(&self) -> bool {
        self.placed.loads().any(varies_with_position)
    }

    /// Returns what the loads make of the slider.
    pub fn slider_use(&self) -> SliderUse {
        match self.reads.disjoint(Variables::X.or(Variables::V)) {
            false => SliderUse::Read,
            true if self.on_slider => SliderUse::Moved,
            true => SliderUse::Untouched,
        }
    }

    /// Returns the variation of the loads, times their effects, on a piece of a motion and in an `ellipse` around it.
    pub fn variation(
        &self,
        state: &EnclosedState,
        effects: UnitLoadEffects,
        ellipse: f64,
    ) -> Variation {
        Self::variation_of(&self.classes(), state, effects, ellipse)
    }

    /// Returns the first load that is unbounded on a piece of a motion.
    pub fn unbounded(&self, state: &EnclosedState) -> Option<&Load> {
        let around = Around {
            state,
            ellipse: 1.0,
        };
        let unbounded = |load: &&Load| around.variation(load).change.is_infinite();
        self.called().find(unbounded)
    }

    /// Returns the variation of the generalized force, N m, of loads of the position alone that vary between nodes.
    pub fn variation_with_position(
        &self,
        linkage: &Linkage,
        angle: Interval,
        ellipse: f64,
    ) -> Variation {
        let none = Interval::point(0.0);
        let piece = MotionPiece {
            t: none,
            angle,
            speed: none,
        };
        let state = &linkage.enclosed_state(&piece, self.slider_use());
        let varying = self.placed.0.iter();
        let varying = varying.filter(|(load, _)| varies_with_position(load));
        Around { state, ellipse }.loads(varying, state.unit_load_effects())
    }

    /// Returns the variation of the loads that depend on speed or time, without dry loads.
    pub fn variation_with_state(
        &self,
        state: &EnclosedState,
        effects: UnitLoadEffects,
        ellipse: f64,
    ) -> Variation {
        Self::variation_of(&[&self.timed, &self.mixed], state, effects, ellipse)
    }

    fn variation_of(
        classes: &[&NonlinearLoads],
        state: &EnclosedState,
        effects: UnitLoadEffects,
        ellipse: f64,
    ) -> Variation {
        let around = Around { state, ellipse };
        let variations = classes.iter().map(|loads| around.loads(&loads.0, effects));
        variations.fold(Variation::NONE, Variation::plus)
    }
}

/// Whether a load of the position alone may vary between nodes: rows of tables over the crank angle are known corners.
fn varies_with_position(load: &Load) -> bool {
    match load {
        Load::Expression(_) => true,
        Load::Table(table) => table.of() == Variable::X,
        Load::Function { scales, .. } => !scales.is_empty(),
        _ => false,
    }
}

impl CurveEquation {
    /// Returns the change of q̈ (rad/s²) per unit load, for a motion that slides with c = −μ sgn(v) sgn(N), in the
    /// middle of a range of coordinates (rad): the nodes of a step resolve the linkage.
    pub fn unit_load_effects(&self, q: Interval, c: f64) -> UnitLoadEffects {
        let terms = self.terms(q.middle());
        let CurveTerms { pose, m, a, .. } = terms;
        let gain = pose.dx / m;
        let rubbed = gain * c / (1.0 - c * (a * gain - terms.x_n));
        let arm = |along: f64, off_guide: f64| along / m + rubbed * (a * along / m - off_guide);
        UnitLoadEffects {
            torque: arm(pose.dtheta, terms.theta_n),
            force: arm(pose.dx, terms.x_n),
        }
    }
}
