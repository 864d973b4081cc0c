//! Stepper over the angle: solves panel after panel and accumulates time, energy, work and errors.

use super::super::energy::NotApplicable;
use super::super::energy::panel::Panel;
use super::super::energy::piece::Piece;
use super::cycle_panels::{self, CyclePanels};
use super::errors::PanelErrors;
use super::load_resolution::unresolved_at;
use super::panel::{Fineness, PanelStart, PanelTable, Problem};
use super::progress::Progress;
use super::solution::PanelSolution;
use super::sweep::sweep;
use super::switch::{Switching, begins_beyond, switching};
use super::{Dynamics, Resolution};
use crate::engine::run_in_time::MotionState;
use crate::numeric::enclosure::Interval;
use crate::numeric::exact::two_sum;

/// State of a run over the angle, with the panels of a cycle.
pub(super) struct PanelStepper<'a, D: Dynamics> {
    pub(super) dynamics: &'a D,
    pub(super) fine: Fineness,
    pub(super) panels: CyclePanels<D::Place>,
    /// Resolution of the run; its guide, which serves from the start on only, is the first guess.
    pub(super) resolution: Resolution<'a>,
    /// Motion on the last panel.
    pub(super) solution: PanelSolution,
    /// Start of the run, with an angle reduced to less than a turn.
    pub start: MotionState,
    /// Sums up to the next panel.
    pub progress: Progress,
    /// Evaluations of the loads.
    pub evaluations: u64,
    /// Positions tabulated before the run.
    positions: u64,
    /// True if a crank that seems to stop is given up before its panels become tiny.
    pub(super) gives_up: bool,
}

impl<'a, D: Dynamics> PanelStepper<'a, D> {
    pub fn new(
        dynamics: &'a D,
        from: MotionState,
        resolution: Resolution<'a>,
    ) -> Result<PanelStepper<'a, D>, NotApplicable> {
        let angle = from.angle.reduced();
        let fine = Fineness {
            tail: resolution.tail,
            speed: from.speed,
            cut: if resolution.is_second { 0.37 } else { 0.5 },
        };
        let positions = dynamics.positions();
        let shared = dynamics.shared().filter(|_| !resolution.is_second);
        let mut panels = shared.map_or_else(Vec::new, |shared| shared.take().0);
        if panels.is_empty() {
            let guide = resolution.guide;
            panels = match guide.and_then(|guide| guide.shapes_from(angle)) {
                Some(shapes) => cycle_panels::finer_panels(dynamics, shapes, fine)?,
                None => cycle_panels::panels(dynamics, angle, fine)?,
            };
        }
        let kinetic = 0.5 * panels[0].table.inertia[0] * from.speed * from.speed;
        if !kinetic.is_finite() {
            return Err(NotApplicable::NotFinite);
        }
        if kinetic == 0.0 {
            return Err(NotApplicable::TooSlow);
        }
        // An angle as given, not reduced, is not rounded.
        let is_rounded = from.t != 0.0 || angle.turns != 0.0;
        let off = kinetic * dynamics.inertia_rounding(angle.rest, is_rounded);
        Ok(PanelStepper {
            dynamics,
            fine,
            panels: CyclePanels::new(panels),
            resolution,
            solution: PanelSolution::new(),
            start: MotionState { angle, ..from },
            progress: Progress::at(kinetic, off),
            evaluations: 0,
            positions,
            gives_up: true,
        })
    }

    /// Restarts at the start of a cycle with another kinetic energy, J.
    pub fn restart(&mut self, kinetic: f64, gives_up: bool) {
        self.panels.restart();
        self.resolution.guide = None;
        self.progress = Progress::at(kinetic, 0.0);
        self.gives_up = gives_up;
    }

    /// Returns the number of load evaluations and tabulated positions.
    pub fn cost(&self) -> u64 {
        self.evaluations + self.dynamics.positions() - self.positions
    }

    /// Returns the range of the speed at the points of the last panel, rad/s.
    pub fn speeds(&self) -> Interval {
        let count = self.solution.slope.degree() + 1;
        self.solution.forces.speed_range(count)
    }

    /// Solves the next panel, after cuts and changes of side where needed.
    pub fn panel(&mut self) -> Result<Panel, NotApplicable> {
        let mut turned_over = 0;
        loop {
            if self.resolution.limit.is_reached(self.cost()) {
                return Err(NotApplicable::WorkLimit);
            }
            let (t, t_low) = two_sum(self.start.t, self.progress.t.0);
            let start = PanelStart {
                t,
                t_low: t_low + self.progress.t.1,
                kinetic: self.progress.kinetic,
                turns: self.start.angle.turns + self.progress.turns,
                direction: self.start.speed.signum(),
            };
            let problem = Problem::new(self.dynamics, self.panels.next(), start);
            if turned_over == 0 && problem.panel.is_new() && begins_beyond(&problem) {
                self.panels.next_mut().turn_over(self.dynamics)?;
            }
            if !self.solve(start)? {
                continue;
            }
            let problem = Problem::new(self.dynamics, self.panels.next(), start);
            // Still on the other side after two changes: the switch has no sign at the start.
            let switching = switching(&problem, &self.solution, turned_over < 2);
            let (panel, solution) = (self.panels.next_mut(), &mut self.solution);
            let piece = panel.piece;
            match switching {
                Switching::AtStart if turned_over < 3 => {
                    turned_over += 1;
                    panel.turn_over(self.dynamics)?;
                    self.evaluations += self.solution.evaluations;
                }
                Switching::AtStart | Switching::Never => {
                    panel.past.remember(&solution.kinetic);
                    self.panels.remember_rest();
                    return Ok(self.pass(start, piece, None));
                }
                Switching::At(share) => {
                    panel.past.remember(&solution.kinetic);
                    solution.end_at(panel, start, share);
                    let [first, rest] = piece.cut(share);
                    let rest = self.panels.rest(self.dynamics, rest.from, self.fine)?;
                    self.panels.remember_rest();
                    return Ok(self.pass(start, first, Some(rest)));
                }
            }
        }
    }

    /// Solves the next panel as it stands; false, with the panel refined, if it is not solved or misses a load.
    fn solve(&mut self, start: PanelStart) -> Result<bool, NotApplicable> {
        self.guess(start);
        let (panel, solution) = (self.panels.next(), &mut self.solution);
        let problem = Problem::new(self.dynamics, panel, start);
        if let Err(why) = sweep(&problem, self.fine.tail, solution) {
            self.evaluations += self.solution.evaluations;
            self.refine(why)?;
            return Ok(false);
        }
        let Some(share) = unresolved_at(&problem, self.fine.tail, solution)? else {
            return Ok(true);
        };
        let found = panel.rule.series(&solution.kinetic);
        let Some(parts) = panel.parts(self.dynamics, share, self.fine, Some(&found))? else {
            return Ok(true);
        };
        self.evaluations += self.solution.evaluations;
        self.progress.missed_load = true;
        self.panels.cut_in_turn(parts);
        Ok(false)
    }

    /// Sets the kinetic energy at the points of the next panel to a guess: that of the guide, whose error the sweeps
    /// are to show, or one from the last turns. The guide is not used for panels with a switch: after a switching they
    /// are solved as if there was none, which the guide does not know.
    fn guess(&mut self, start: PanelStart) {
        let (panel, dynamics) = (self.panels.next(), self.dynamics);
        if panel.is_in_closed_form(dynamics) {
            return;
        }
        let guide = self.resolution.guide;
        let known = guide
            .filter(|_| panel.table.switch.is_none())
            .and_then(|guide| guide.kinetic(panel, self.progress.turns, start.kinetic));
        match known {
            Some(kinetic) => self.solution.kinetic = kinetic,
            None => {
                let reads_time = dynamics.reads_time();
                panel.guess(start.kinetic, reads_time, &mut self.solution.kinetic);
            }
        }
    }

    /// Moves on over a piece of the next panel; `rest` is the remainder of the panel in this turn.
    fn pass(
        &mut self,
        start: PanelStart,
        piece: Piece,
        rest: Option<PanelTable<D::Place>>,
    ) -> Panel {
        let (panel, solution) = (self.panels.next(), &mut self.solution);
        let problem = Problem::new(self.dynamics, panel, start);
        let solved = self.progress.pass(panel, piece, solution);
        if self.resolution.is_second {
            let errors = PanelErrors::of(&problem, &solved, solution);
            self.progress.errors.pass(&errors);
        }
        self.evaluations += self.solution.evaluations;
        if self.panels.advance(rest) {
            self.progress.turns += self.start.speed.signum();
        }
        solved
    }
}
