//! Cell of the Poincaré map: turns computed at the points of a range of energies.

use std::f64::consts::TAU;

use super::super::Driven;
use super::super::progress::Progress;
use super::super::seen::at_speeds;
use super::super::stepper::PanelStepper;
use super::{DEGREE, LastTurns};
use crate::engine::energy::NotApplicable;
use crate::engine::energy::interpolated_turns::{Cell, Cycle};
use crate::engine::energy::segment::Segment;
use crate::engine::resolution::NodeCriterion;
use crate::numeric::chebyshev::Rule;
use crate::numeric::enclosure::{Interval, ellipses};

impl<D: Driven> LastTurns<'_, D> {
    /// Computes the cell over the energies middle ± half, J.
    pub(super) fn cell(&mut self, middle: f64, half: f64) -> Result<Cell, NotApplicable> {
        let rule = Rule::of(DEGREE);
        let mut turns = Vec::with_capacity(DEGREE + 1);
        let mut speeds: Option<Interval> = None;
        while turns.len() <= DEGREE {
            let kinetic = middle + half * rule.points()[turns.len()];
            let (turn, its) = self.whole_turn(kinetic)?;
            speeds = Some(speeds.map_or(its, |all| all.hull(its)));
            // All turns of a cell have the same panels.
            if self.stepper.progress.refined {
                self.stepper.settle()?;
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
        let PanelStepper { driven, panels, .. } = &self.stepper;
        let look = NodeCriterion {
            nodes: DEGREE,
            ellipses: ellipses(DEGREE, self.tail),
            allowed: self.tail * middle / TAU,
            least: 0.0,
            has_interpolant: false,
        };
        !driven.varies_between_nodes()
            || panels
                .iter()
                .all(|panel| at_speeds(*driven, panel, speeds, look))
    }

    /// Computes the turn that begins with this energy, J, and its range of speeds, rad/s.
    fn whole_turn(&mut self, kinetic: f64) -> Result<((Segment, Cycle), Interval), NotApplicable> {
        self.stepper.gives_up = false;
        let mut speeds: Option<Interval> = None;
        self.stepper.restart(kinetic);
        let mut segment = Segment::open();
        loop {
            segment.push(self.stepper.panel()?.panel);
            let here = self.stepper.speeds();
            speeds = Some(speeds.map_or(here, |all| all.hull(here)));
            if self.stepper.progress.hid {
                // Panels that end at a position specific to this energy make its turn unlike the others.
                return Err(NotApplicable::NotSmooth);
            }
            if self.stepper.at_cycle() {
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

impl<D: Driven> PanelStepper<'_, D> {
    /// Restarts at the start of a cycle with another kinetic energy, J.
    pub fn restart(&mut self, kinetic: f64) {
        self.parts.clear();
        self.guide = None;
        self.next = 0;
        self.progress = Progress::at(kinetic, 0.0);
    }
}
