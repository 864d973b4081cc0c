//! Refinement of panels that were not solved: higher degree or cut.

use super::Dynamics;
use super::panel::{FIRST_DEGREE, Fineness, PanelTable, SHORTEST_PANEL};
use super::stepper::PanelStepper;
use super::sweep::Unsolved;
use crate::engine::energy::NotApplicable;
use crate::engine::energy::piece::Piece;
use crate::numeric::chebyshev::{Rule, Series, Values};

impl<D: Dynamics> PanelStepper<'_, D> {
    /// Raises the degree of the next panel, or cuts it: for this turn, or for all turns if the failure recurs or will.
    pub(super) fn refine(&mut self, why: Unsolved) -> Result<(), NotApplicable> {
        self.progress.refined = true;
        let (kinetic, fastest) = (self.progress.kinetic, self.progress.fastest);
        let has_parts = self.panels.has_parts();
        let panel = self.panels.next_mut();
        let attempt = self.solution.attempt(panel.rule);
        let attempt = attempt.as_ref();
        if why == Unsolved::TooLong
            && let Some(degree) = self.solution.degree_needed(panel, self.fine.tail)
        {
            return panel.raise(self.dynamics, degree, attempt);
        }
        // A crank that seems to stop within this half length, rad, is not followed further: the panels would shrink
        // geometrically, and a step in time passes. Where the angle is asked for, only below this fraction of the
        // largest kinetic energy.
        let (short_half, slow_share) = (0.25, 0.1);
        let stops = why == Unsolved::Stops && panel.half().abs() < short_half;
        let leaves = self.resolution.may_decline || kinetic < slow_share * fastest;
        if self.gives_up && stops && leaves {
            return Err(NotApplicable::TooSlow);
        }
        // Rounded times leave too few places on a panel that the crank passes this quickly.
        let least_roundings = 1e6;
        let rounding = f64::EPSILON * (self.start.t + self.progress.t.0);
        let speed = (2.0 * kinetic / panel.table.inertia[0]).sqrt();
        let passed = least_roundings * rounding * speed;
        if self.dynamics.reads_time() && 2.0 * panel.half().abs() < passed {
            return Err(NotApplicable::NotSmooth);
        }
        let Some(parts) = panel.parts(self.dynamics, self.fine.cut, self.fine, attempt)? else {
            // The crank is near rest below this fraction of the largest kinetic energy, and where the forces may have
            // produced its energy within so many radians.
            let small = 1e-2;
            let force = panel.table.force[0] + panel.table.push[0];
            return Err(
                if kinetic < small * fastest || kinetic < small * force.abs() {
                    NotApplicable::TooSlow
                } else {
                    NotApplicable::NotSmooth
                },
            );
        };
        // Where the position-dependent forces do less work than this fraction of the kinetic energy, they are not the
        // reason for the panel being too long: it will be too long in the next turn, too.
        let small_work = 0.1;
        let recurs = panel.failed || panel.is_new() && panel.largest_work() < small_work * kinetic;
        if recurs && !has_parts {
            self.panels.cut(parts);
        } else {
            panel.failed = true;
            self.panels.cut_in_turn(parts);
        }
        Ok(())
    }
}

impl<P: Copy> PanelTable<P> {
    /// Raises the degree; `attempt` is the kinetic energy found with the former one.
    pub fn raise(
        &mut self,
        dynamics: &impl Dynamics<Place = P>,
        degree: usize,
        attempt: Option<&Series>,
    ) -> Result<(), NotApplicable> {
        self.rule = Rule::of(degree);
        let attempt = attempt.and_then(|kinetic| on_part(kinetic, self.rule, [-1.0, 1.0]));
        self.past.restart(attempt);
        self.tabulate(dynamics)
    }

    /// Cuts the panel at the fraction `share`; none if it is too short. `attempt`: kinetic energy found on it.
    pub fn parts(
        &self,
        dynamics: &impl Dynamics<Place = P>,
        share: f64,
        fine: Fineness,
        attempt: Option<&Series>,
    ) -> Result<Option<[Self; 2]>, NotApplicable> {
        let Piece { from, to, .. } = self.piece;
        if (to - from).abs() < SHORTEST_PANEL * from.abs().max(1.0) {
            return Ok(None);
        }
        let middle = from + share * (to - from);
        let part = |ends, of: [f64; 2]| {
            let mut part = Self::new(dynamics, self.turns, ends, self.side, fine, FIRST_DEGREE)?;
            let attempt = attempt.and_then(|kinetic| on_part(kinetic, part.rule, of));
            part.past.restart(attempt);
            Ok(part)
        };
        let cut = 2.0 * share - 1.0;
        Ok(Some([
            part([from, middle], [-1.0, cut])?,
            part([middle, to], [cut, 1.0])?,
        ]))
    }
}

/// Returns a series of the kinetic energy at the points of a rule on a part of its panel, J; none unless positive.
fn on_part(kinetic: &Series, rule: &Rule, [from, to]: [f64; 2]) -> Option<Values> {
    let count = rule.degree() + 1;
    let mut values = rule.values(|x| from + 0.5 * (to - from) * (1.0 + x));
    kinetic.values(&mut values[..count]);
    values[..count].iter().all(|k| *k > 0.0).then_some(values)
}
