//! Stepper over the angle: solves panel after panel and accumulates time, energy, work and errors.

use super::super::energy::NotApplicable;
use super::super::energy::error_bound::energy_error_of_angle;
use super::super::energy::panel::Panel;
use super::super::energy::piece::Piece;
use super::errors::{Errors, uncertain};
use super::guide::Guide;
use super::panel::{Fineness, PanelStart, PanelTable};
use super::seen::hides;
use super::sweep::{SETTLED, Tails, sweep};
use super::swept::{Spent, Swept};
use super::switch::{Side, begins_beyond, side};
use super::{Driven, Panels, Resolution, turn};
use crate::engine::WorkLimit;
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::Interval;
use crate::numeric::exact::two_sum;

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
    pub(super) swept: Swept,
    /// Known run that supplies the first guess.
    pub(super) guide: Option<Guide<'a>>,
    /// Start time of the run, s.
    pub begin: f64,
    /// Time since the start of the run, s: rounded value and remainder.
    pub t: (f64, f64),
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Rounding remainder of the kinetic energy, J.
    pub(super) kinetic_low: f64,
    /// Propagated rounding errors.
    pub errors: Errors,
    /// Whole turns since the start, with sign.
    pub turns: f64,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// Work of the non-conservative loads, J.
    pub work: f64,
    /// Evaluations of the loads.
    pub evaluations: u64,
    /// Positions tabulated before the run.
    positions: u64,
    /// Largest kinetic energy at the ends of panels, J.
    pub fastest: f64,
    start: Angle,
    /// True if the run is a comparison: it shares no panels with other runs.
    other: bool,
    pub limit: WorkLimit<'a>,
    /// True if a panel was cut or its degree raised since the last reset.
    pub refined: bool,
    /// True if the points of a panel missed a load since the last reset.
    pub hid: bool,
    /// True if a crank that seems to stop is given up before its panels become tiny.
    pub gives_up: bool,
}

/// Solved panel with the work done on it.
pub(super) struct Done {
    pub panel: Panel,
    /// Non-conservative force on the panel.
    pub spent: Spent,
    /// Work of the non-conservative force on the panel, J.
    pub work: f64,
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
            swept: Swept::new(),
            guide: resolution.guide,
            begin: 0.0,
            t: (0.0, 0.0),
            kinetic,
            kinetic_low: 0.0,
            errors: Errors::at(kinetic, off),
            turns: 0.0,
            gain: 0.0,
            work: 0.0,
            evaluations: 0,
            positions,
            fastest: kinetic,
            start,
            other: resolution.other,
            limit: resolution.limit,
            refined: false,
            hid: false,
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
        let count = self.swept.slope.degree() + 1;
        self.swept.forces.speed_range(count)
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
                t: self.begin + self.t.0,
                kinetic: self.kinetic,
                turns: self.start.turns + self.turns,
                direction: self.direction,
            };
            let panel = self.parts.last_mut().unwrap_or(&mut self.panels[self.next]);
            if turned_over == 0 && panel.is_new() && begins_beyond(self.driven, panel, start) {
                panel.turn_over(self.driven)?;
            }
            let tails = self.guess(start);
            let panel = self.parts.last_mut().unwrap_or(&mut self.panels[self.next]);
            let swept = &mut self.swept;
            if let Err(why) = sweep(self.driven, panel, start, tails, swept) {
                self.evaluations += self.swept.evaluations;
                self.refine(why)?;
                continue;
            }
            let hidden = hides(self.driven, panel, start, self.fine, swept);
            let parts = hidden.map(|at| panel.parts(self.driven, at, self.fine));
            if let Some([first, second]) = parts.transpose()?.flatten() {
                self.evaluations += self.swept.evaluations;
                self.hid = true;
                self.parts.pop();
                self.parts.extend([second, first]);
                continue;
            }
            match side(self.driven, panel, start, swept) {
                Side::Stays => {
                    panel.remember(&swept.kinetic);
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
                    panel.remember(&swept.kinetic);
                    let [first, rest] = panel.piece.cut(share);
                    swept.end_at(panel.rule, start, share);
                    let rest = self.rest(rest.from)?;
                    self.remember_rest();
                    return Ok(self.pass(first, Some(rest)));
                }
            }
            self.evaluations += self.swept.evaluations;
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
            self.swept.kinetic = guide.kinetic(panel, self.turns, start.kinetic)?;
            Some(SETTLED * guide.tail)
        };
        let known = needs_none.or_else(|| guide.and_then(of_guide));
        if known.is_none() {
            let reads_time = self.driven.is_driven() && self.driven.reads_time();
            panel.guess(start.kinetic, reads_time, &mut self.swept.kinetic);
        }
        Tails {
            series,
            sweeps: known.unwrap_or(series),
        }
    }

    /// Moves on over a piece of the next panel; `rest` is the remainder of the panel in this turn.
    fn pass(&mut self, piece: Piece, rest: Option<PanelTable<D::Place>>) -> Done {
        let swept = &self.swept;
        let panel = self.parts.last().unwrap_or(&self.panels[self.next]);
        let rule = panel.rule;
        let spent = swept.spent();
        let work = spent.work(rule, piece.to - piece.from, 1.0);
        // Under steep loads the end energy is not the sum of start and gain.
        let summed = swept.end == self.kinetic + swept.gain;
        (self.kinetic, self.kinetic_low) = if summed {
            two_sum(self.kinetic, swept.gain + self.kinetic_low)
        } else {
            (swept.end, 0.0)
        };
        self.gain += swept.gain;
        self.fastest = self.fastest.max(self.kinetic);
        self.work += work;
        self.evaluations += swept.evaluations;
        let kept = (0.5 * work.min(0.0) / self.kinetic).exp();
        let count = rule.degree() + 1;
        let misplaced = [&panel.table.force, &panel.table.push]
            .map(|forces| uncertain(&piece, &forces[..count]));
        let noise = f64::EPSILON * (swept.gain.abs() + misplaced[0] + misplaced[1]);
        let (early, most) = swept.early(rule);
        let (slopes, slope) = (&swept.slopes, swept.slope);
        let mut panel = Panel::from_slopes(piece, rule, slopes, slope, 0.0, self.kinetic);
        panel.turns = self.turns;
        let duration = panel.duration.0;
        self.errors.pass(kept, noise, early, duration, most);
        let (sum, lost) = two_sum(self.t.0, panel.duration.0);
        self.t = two_sum(sum, lost + self.t.1 + panel.duration.1);
        self.parts.pop();
        self.parts.extend(rest);
        if self.parts.is_empty() {
            let turns = self.panels[self.next].turns;
            self.next += 1;
            let next = self.panels.get(self.next);
            if next.is_none_or(|next| next.turns != turns) {
                self.turns += self.direction;
            }
            if next.is_none() {
                self.next = 0;
            }
        }
        Done { panel, spent, work }
    }
}
