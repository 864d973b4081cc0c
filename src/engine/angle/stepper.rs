//! Stepper over the angle: solves panel after panel and accumulates time, energy, work and errors.

use super::super::energy::NotApplicable;
use super::super::energy::error_bound::energy_error_of_angle;
use super::super::energy::piece::Piece;
use super::guide::Guide;
use super::panel::{Fineness, PanelStart, PanelTable};
use super::progress::{Done, Progress};
use super::seen::hides;
use super::solution::PanelSolution;
use super::sweep::{SETTLED, Tails, sweep};
use super::switch::{Side, begins_beyond, side};
use super::{Driven, Panels, Resolution, turn};
use crate::engine::WorkLimit;
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::Interval;

/// State of a run over the angle, with the panels of a cycle.
#[derive(Clone)]
pub(super) struct PanelStepper<'a, D: Driven> {
    pub(super) driven: &'a D,
    pub(super) fine: Fineness,
    direction: f64,
    pub(super) panels: Vec<PanelTable<D::Place>>,
    /// Parts of a panel that was too long in this turn, the next one last.
    pub(super) parts: Vec<PanelTable<D::Place>>,
    pub(super) next: usize,
    /// Motion on the last panel.
    pub(super) solution: PanelSolution,
    /// Known run that supplies the first guess.
    pub(super) guide: Option<Guide<'a>>,
    /// Start time of the run, s.
    pub begin: f64,
    /// Sums up to the next panel.
    pub progress: Progress,
    /// Evaluations of the loads.
    pub evaluations: u64,
    /// Positions tabulated before the run.
    positions: u64,
    start: Angle,
    /// True if the run is a comparison: it shares no panels with other runs.
    other: bool,
    pub limit: WorkLimit<'a>,
    /// True if a crank that seems to stop is given up before its panels become tiny.
    pub gives_up: bool,
}

impl<'a, D: Driven> PanelStepper<'a, D> {
    pub fn new(
        driven: &'a D,
        start: Angle,
        speed: f64,
        resolution: Resolution<'a>,
    ) -> Result<PanelStepper<'a, D>, NotApplicable> {
        let fine = Fineness {
            tail: resolution.tail,
            speed,
        };
        let positions = driven.positions();
        let cuts: &[f64] = if resolution.other {
            &[0.37, 1.0]
        } else {
            &[1.0]
        };
        let shared = driven.shared().filter(|_| !resolution.other);
        let mut panels = shared.map_or_else(Vec::new, |shared| shared.take().0);
        if panels.is_empty() {
            panels = turn::panels(driven, start, fine, cuts)?;
        }
        let kinetic = 0.5 * panels[0].table.inertia[0] * speed * speed;
        if !kinetic.is_finite() {
            return Err(NotApplicable::NotFinite);
        }
        if kinetic == 0.0 {
            return Err(NotApplicable::TooSlow);
        }
        let first = &panels[0];
        let beside = first.piece.angle(first.rule.points()[1]) - first.piece.from;
        let [here, next, ..] = first.table.inertia;
        let off = energy_error_of_angle(start.rest, kinetic, [here, next], beside);
        Ok(PanelStepper {
            driven,
            fine,
            direction: speed.signum(),
            panels,
            parts: Vec::new(),
            next: 0,
            solution: PanelSolution::new(),
            guide: resolution.guide,
            begin: 0.0,
            progress: Progress::at(kinetic, off),
            evaluations: 0,
            positions,
            start,
            other: resolution.other,
            limit: resolution.limit,
            gives_up: false,
        })
    }

    /// Leaves the panels to the next run, if they are shared.
    pub fn leave_panels(&mut self) {
        if let Some(shared) = self.driven.shared().filter(|_| !self.other) {
            shared.replace(Panels(std::mem::take(&mut self.panels)));
        }
    }

    /// Returns the number of load evaluations and tabulated positions.
    pub fn spent(&self) -> u64 {
        self.evaluations + self.driven.positions() - self.positions
    }

    /// Returns the range of the speed at the points of the last panel, rad/s.
    pub fn speeds(&self) -> Interval {
        let count = self.solution.slope.degree() + 1;
        self.solution.forces.speed_range(count)
    }

    /// True if the next panel begins a cycle.
    pub fn at_cycle(&self) -> bool {
        self.next == 0 && self.parts.is_empty()
    }

    /// Solves the next panel, after cuts and changes of side where needed.
    pub fn panel(&mut self) -> Result<Done, NotApplicable> {
        let mut turned_over = 0;
        loop {
            if self.limit.is_reached(self.spent()) {
                return Err(NotApplicable::WorkLimit);
            }
            let start = PanelStart {
                t: self.begin + self.progress.t.0,
                kinetic: self.progress.kinetic,
                turns: self.start.turns + self.progress.turns,
                direction: self.direction,
            };
            let panel = self.parts.last_mut().unwrap_or(&mut self.panels[self.next]);
            if turned_over == 0 && panel.is_new() && begins_beyond(self.driven, panel, start) {
                panel.turn_over(self.driven)?;
            }
            let tails = self.guess(start);
            let panel = self.parts.last_mut().unwrap_or(&mut self.panels[self.next]);
            let solution = &mut self.solution;
            if let Err(why) = sweep(self.driven, panel, start, tails, solution) {
                self.evaluations += self.solution.evaluations;
                self.refine(why)?;
                continue;
            }
            let hidden = hides(self.driven, panel, start, self.fine, solution);
            let parts = hidden.map(|at| panel.parts(self.driven, at, self.fine));
            if let Some([first, second]) = parts.transpose()?.flatten() {
                self.evaluations += self.solution.evaluations;
                self.progress.hid = true;
                self.parts.pop();
                self.parts.extend([second, first]);
                continue;
            }
            match side(self.driven, panel, start, solution) {
                Side::Stays => {
                    panel.remember(&solution.kinetic);
                    let piece = panel.piece;
                    self.remember_rest();
                    return Ok(self.pass(piece, None));
                }
                // Still on the other side after two changes: the switch has no sign.
                Side::Other if turned_over == 2 => {
                    let piece = panel.piece;
                    return Ok(self.pass(piece, None));
                }
                Side::Other => {
                    turned_over += 1;
                    panel.turn_over(self.driven)?;
                }
                Side::Leaves(share) => {
                    panel.remember(&solution.kinetic);
                    let [first, rest] = panel.piece.cut(share);
                    solution.end_at(panel.rule, start, share);
                    let rest = self.rest(rest.from)?;
                    self.remember_rest();
                    return Ok(self.pass(first, Some(rest)));
                }
            }
            self.evaluations += self.solution.evaluations;
        }
    }

    /// Sets the kinetic energy at the points of the next panel to a guess: that of the guide, whose error the sweeps
    /// are to show, or one from the last turns. The guide is not used for panels with a switch: after a switching they
    /// are solved as if there was none, which the guide does not know.
    fn guess(&mut self, start: PanelStart) -> Tails {
        let panel = self.parts.last().unwrap_or(&self.panels[self.next]);
        let series = self.fine.tail;
        let needs_none = panel.is_in_closed_form(self.driven).then_some(series);
        let smooth = panel.table.switch.is_none();
        let guide = self.guide.as_mut().filter(|_| smooth);
        let of_guide = |guide: &mut Guide<'_>| {
            self.solution.kinetic = guide.kinetic(panel, self.progress.turns, start.kinetic)?;
            Some(SETTLED * guide.tail)
        };
        let known = needs_none.or_else(|| guide.and_then(of_guide));
        if known.is_none() {
            let reads_time = self.driven.is_driven() && self.driven.reads_time();
            panel.guess(start.kinetic, reads_time, &mut self.solution.kinetic);
        }
        Tails {
            series,
            sweeps: known.unwrap_or(series),
        }
    }

    /// Moves on over a piece of the next panel; `rest` is the remainder of the panel in this turn.
    fn pass(&mut self, piece: Piece, rest: Option<PanelTable<D::Place>>) -> Done {
        let panel = self.parts.last().unwrap_or(&self.panels[self.next]);
        let done = self.progress.pass(panel, piece, &self.solution);
        self.evaluations += self.solution.evaluations;
        self.parts.pop();
        self.parts.extend(rest);
        if self.parts.is_empty() {
            let turns = self.panels[self.next].turns;
            self.next += 1;
            let next = self.panels.get(self.next);
            if next.is_none_or(|next| next.turns != turns) {
                self.progress.turns += self.direction;
            }
            if next.is_none() {
                self.next = 0;
            }
        }
        done
    }
}
