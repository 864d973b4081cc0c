//! Cell of the Poincaré map: turns computed at the points of a range of energies.

use std::f64::consts::TAU;

use super::super::Dynamics;
use super::super::load_resolution::resolves_speeds;
use super::super::stepper::PanelStepper;
use super::{MAP_DEGREE, MapRun};
use crate::engine::energy::NotApplicable;
use crate::engine::energy::interpolated_turns::{Cell, Cycle};
use crate::engine::energy::segment::Segment;
use crate::engine::resolution::NodeCriterion;
use crate::numeric::chebyshev::Rule;
use crate::numeric::enclosure::{Interval, ellipses};

impl<D: Dynamics> MapRun<'_, D> {
    /// Computes the cell over the energies middle ± half, J.
    pub(super) fn cell(&mut self, middle: f64, half: f64) -> Result<Cell, NotApplicable> {
        let rule = Rule::of(MAP_DEGREE);
        let mut turns = Vec::with_capacity(MAP_DEGREE + 1);
        let mut speeds: Option<Interval> = None;
        while turns.len() <= MAP_DEGREE {
            let kinetic = middle + half * rule.points()[turns.len()];
            let (turn, its) = self.whole_turn(kinetic)?;
            speeds = Some(speeds.map_or(its, |all| all.hull(its)));
            // All turns of a cell have the same panels.
            if self.stepper.progress.refined {
                self.stepper
                    .panels
                    .cut_failed(self.stepper.dynamics, self.stepper.fine)?;
                turns.clear();
            } else {
                turns.push(turn);
            }
        }
        match speeds {
            Some(speeds) if self.shows(speeds, middle) => Ok(Cell::new(middle, half, rule, turns)),
            _ => Err(NotApplicable::NotSmooth),
        }
    }

    /// True if the energies of a cell around `middle`, J, resolve the loads at all speeds in the range (rad/s).
    fn shows(&self, speeds: Interval, middle: f64) -> bool {
        let PanelStepper {
            dynamics,
            panels,
            fine,
            ..
        } = &self.stepper;
        let look = NodeCriterion {
            nodes: MAP_DEGREE,
            ellipses: ellipses(MAP_DEGREE, fine.tail),
            allowed: fine.tail * middle / TAU,
            least: 0.0,
            finest: 0.0,
            has_interpolant: false,
        };
        !dynamics.varies_between_nodes()
            || panels
                .panels
                .iter()
                .all(|panel| resolves_speeds(*dynamics, panel, speeds, look))
    }

    /// Computes the turn that begins with this energy, J, and its range of speeds, rad/s.
    fn whole_turn(&mut self, kinetic: f64) -> Result<((Segment, Cycle), Interval), NotApplicable> {
        let mut speeds: Option<Interval> = None;
        self.stepper.restart(kinetic, false);
        let mut segment = Segment::open();
        loop {
            segment.push(self.stepper.panel()?);
            let here = self.stepper.speeds();
            speeds = Some(speeds.map_or(here, |all| all.hull(here)));
            if self.stepper.progress.missed_load {
                // Panels that end at a position specific to this energy make its turn unlike the others.
                return Err(NotApplicable::NotSmooth);
            }
            if self.stepper.panels.at_cycle() {
                break;
            }
        }
        let turn = Cycle {
            count: self.stepper.progress.turns.abs(),
            duration: self.stepper.progress.t.0,
            gain: self.stepper.progress.gain,
            work: self.stepper.progress.work,
        };
        Ok(((segment, turn), speeds.unwrap_or_default()))
    }
}
