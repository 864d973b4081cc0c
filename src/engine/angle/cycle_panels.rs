//! Panels of a cycle, with the parts into which one of them is cut in the present turn.

use std::f64::consts::TAU;

use super::Dynamics;
use super::panel::{FIRST_DEGREE, Fineness, PanelTable, SHORTEST_PANEL};
use crate::engine::energy::NotApplicable;
use crate::engine::energy::piece::HALF_TURN;
use crate::numeric::angle::{Angle, in_turns};
use crate::numeric::chebyshev::{MAX_DEGREE, Rule};

/// Panels of a cycle in the order of motion, and the position of a run among them.
pub(super) struct CyclePanels<P> {
    pub panels: Vec<PanelTable<P>>,
    /// Parts of a panel that was too long in this turn, the next one last.
    parts: Vec<PanelTable<P>>,
    /// Index of the next panel, or of the one in parts.
    index: usize,
}

impl<P: Copy> CyclePanels<P> {
    /// Begins with the first of some panels.
    pub fn new(panels: Vec<PanelTable<P>>) -> CyclePanels<P> {
        CyclePanels {
            panels,
            parts: Vec::new(),
            index: 0,
        }
    }

    /// Begins again with the first panel.
    pub fn restart(&mut self) {
        self.parts.clear();
        self.index = 0;
    }

    /// True if the next panel begins a cycle.
    pub fn at_cycle(&self) -> bool {
        self.index == 0 && !self.has_parts()
    }

    /// True if the next panel is part of another one, in this turn alone.
    pub fn has_parts(&self) -> bool {
        !self.parts.is_empty()
    }

    /// Returns the next panel or part of a panel.
    pub fn next(&self) -> &PanelTable<P> {
        self.parts.last().unwrap_or(&self.panels[self.index])
    }

    /// Returns the next panel or part of a panel, to be changed.
    pub fn next_mut(&mut self) -> &mut PanelTable<P> {
        let whole = &mut self.panels[self.index];
        self.parts.last_mut().unwrap_or(whole)
    }

    /// Moves on to the rest of the next panel, or beyond it; true at the end of a turn.
    pub fn advance(&mut self, rest: Option<PanelTable<P>>) -> bool {
        self.parts.pop();
        self.parts.extend(rest);
        if self.has_parts() {
            return false;
        }
        let turns = self.panels[self.index].turns;
        self.index += 1;
        let next = self.panels.get(self.index);
        let ends_turn = next.is_none_or(|next| next.turns != turns);
        self.index %= self.panels.len();
        ends_turn
    }

    /// Replaces the next panel by two parts, in this turn.
    pub fn cut_in_turn(&mut self, [first, second]: [PanelTable<P>; 2]) {
        self.parts.pop();
        self.parts.extend([second, first]);
    }

    /// Replaces the next panel by two parts, in all turns.
    pub fn cut(&mut self, parts: [PanelTable<P>; 2]) {
        self.panels.splice(self.index..=self.index, parts);
    }

    /// Cuts every panel that failed, in all turns.
    pub fn cut_failed(
        &mut self,
        dynamics: &impl Dynamics<Place = P>,
        fine: Fineness,
    ) -> Result<(), NotApplicable> {
        let mut all = Vec::with_capacity(2 * self.panels.len());
        for panel in std::mem::take(&mut self.panels) {
            let parts = panel
                .failed
                .then(|| panel.parts(dynamics, fine.cut, fine, None));
            match parts.transpose()?.flatten() {
                Some(parts) => all.extend(parts),
                None => all.push(panel),
            }
        }
        self.panels = all;
        Ok(())
    }

    /// Makes the rest of the next panel from an angle (rad) on.
    pub fn rest(
        &self,
        dynamics: &impl Dynamics<Place = P>,
        from: f64,
        fine: Fineness,
    ) -> Result<PanelTable<P>, NotApplicable> {
        let panel = self.next();
        let index = panel.rest_index.map_or(0, |index| index + 1);
        let known = self.panels[self.index].rests.get(index);
        panel.rest(dynamics, from, index, known, fine)
    }

    /// Stores the solution on a rest as the guess for the next turn.
    pub fn remember_rest(&mut self) {
        if let Some((index, rest)) = self.parts.last().and_then(PanelTable::as_rest) {
            let rests = &mut self.panels[self.index].rests;
            if index < rests.len() {
                rests[index] = rest;
            } else {
                rests.push(rest);
            }
        }
    }

    /// Returns the shapes of the panels.
    pub fn shapes(&self) -> Vec<PanelShape> {
        let shape = |panel: &PanelTable<P>| PanelShape {
            turns: panel.turns,
            ends: [panel.piece.from, panel.piece.to],
            degree: panel.rule.degree(),
        };
        self.panels.iter().map(shape).collect()
    }
}

/// Ends and degree of a panel of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PanelShape {
    pub turns: f64,
    pub ends: [f64; 2],
    pub degree: usize,
}

/// Makes finer panels than those of another run: of the next higher degree or, beyond the largest, in two parts.
pub(super) fn finer_panels<D: Dynamics>(
    dynamics: &D,
    shapes: &[PanelShape],
    fine: Fineness,
) -> Result<Vec<PanelTable<D::Place>>, NotApplicable> {
    let mut list = Vec::with_capacity(2 * shapes.len());
    let mut add = |turns, ends, degree| {
        let mut panel = PanelTable::empty(turns, ends, Rule::of(degree), 1.0);
        panel.tabulate(dynamics)?;
        list.push(panel);
        Ok(())
    };
    for &PanelShape {
        turns,
        ends,
        degree,
    } in shapes
    {
        let [from, to] = ends;
        let cut = from + fine.cut * (to - from);
        if let Some(next) = Rule::next_degree(degree) {
            add(turns, ends, next)?;
        } else {
            add(turns, [from, cut], FIRST_DEGREE)?;
            add(turns, [cut, to], FIRST_DEGREE)?;
        }
    }
    Ok(list)
}

/// Makes the panels of one cycle. They end at the corners, and beside branch points too near for the series of half a
/// turn to decay (Trefethen, theorem 8.1): shorter panels grade towards a point at an end. Between these ends they are
/// equally long, but for the ends in a second run.
pub(super) fn panels<D: Dynamics>(
    dynamics: &D,
    start: Angle,
    fine: Fineness,
) -> Result<Vec<PanelTable<D::Place>>, NotApplicable> {
    let is_near = |[_, height]: &[f64; 2]| {
        let scaled = 2.0 * height / HALF_TURN;
        let rho = scaled + scaled.hypot(1.0);
        rho.powi(-(MAX_DEGREE as i32)) > fine.tail
    };
    let branch_points = dynamics.branch_points().into_iter().filter(is_near);
    let feet: Vec<f64> = branch_points.map(|[theta, _]| theta).collect();
    let feet = in_turns(&feet, 0..i64::from(dynamics.cycle()));
    let corners: Vec<f64> = feet
        .chain(dynamics.corners_of_cycle().iter().copied())
        .collect();
    let direction = fine.speed.signum();
    let mut list: Vec<PanelTable<D::Place>> = Vec::with_capacity(8);
    let cycle = f64::from(dynamics.cycle());
    // Origin of the corners; for a cycle of one turn the whole turns do not matter.
    let phase = start.turns.rem_euclid(cycle) * TAU + start.rest;
    for turn in 0..dynamics.cycle() {
        let before = f64::from(turn);
        let mut ends: Vec<f64> = corners
            .iter()
            .map(|corner| (direction * (corner - phase)).rem_euclid(cycle * TAU) - before * TAU)
            .filter(|ahead| *ahead > SHORTEST_PANEL && *ahead < TAU - SHORTEST_PANEL)
            .collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|next, end| *next - *end <= SHORTEST_PANEL);
        ends.push(TAU);
        let turns = start.turns + direction * before;
        let mut from = 0.0;
        for to in ends {
            let parts = ((to - from) / HALF_TURN).ceil();
            let begin = from;
            for part in 0..=parts as u32 {
                let share = (f64::from(part) + 2.0 * fine.cut) / parts;
                let until = if share < 1.0 {
                    begin + share * (to - begin)
                } else {
                    to
                };
                if until == from {
                    break;
                }
                let ends = [from, until].map(|ahead| start.rest + direction * ahead);
                // The degree of the neighbour is likely to suffice.
                let degree = list.last().map_or(FIRST_DEGREE, |last| last.rule.degree());
                list.push(PanelTable::new(dynamics, turns, ends, 1.0, fine, degree)?);
                from = until;
            }
        }
    }
    Ok(list)
}
