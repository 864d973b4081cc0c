//! Construction of the panels of one cycle.

use super::AngleDynamics;
use super::panel::{FIRST_DEGREE, Fineness, PanelTable, SHORTEST_PANEL};
use crate::engine::energy::NotApplicable;
use crate::engine::energy::piece::HALF_TURN;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule};
use std::f64::consts::TAU;

/// Makes the panels of one cycle, which end at the corners.
pub(super) fn panels<D: AngleDynamics>(
    dynamics: &D,
    start: Angle,
    fine: Fineness,
    cuts: &[f64],
) -> Result<Vec<PanelTable<D::Place>>, NotApplicable> {
    let (few, all) = (dynamics.corners(), dynamics.corners_if_light());
    if few.len() < all.len() {
        // Beyond this degree more panels cost no more.
        let heavy = between(dynamics, few, start, fine, cuts, FIRST_DEGREE)?;
        if let Some(list) = heavy {
            return Ok(list);
        }
    }
    Ok(between(dynamics, all, start, fine, cuts, MAX_DEGREE)?.unwrap_or_default())
}

/// Makes the panels between corners, cut at fractions `cuts` up to 1; none if one is not resolved at degree `most`.
fn between<D: AngleDynamics>(
    dynamics: &D,
    corners: &[f64],
    start: Angle,
    fine: Fineness,
    cuts: &[f64],
    most: usize,
) -> Result<Option<Vec<PanelTable<D::Place>>>, NotApplicable> {
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
        ends.push(TAU);
        let turns = start.turns + direction * before;
        let mut from = 0.0;
        for to in ends {
            let parts = ((to - from) / HALF_TURN).ceil();
            let begin = from;
            let whole = 0..parts as u32;
            let shares = whole.flat_map(|part| cuts.iter().map(move |cut| f64::from(part) + cut));
            for share in shares.map(|end| end / parts) {
                let until = if share < 1.0 {
                    begin + share * (to - begin)
                } else {
                    to
                };
                let ends = [from, until].map(|ahead| start.rest + direction * ahead);
                // The degree of the neighbour is likely to suffice.
                let degree = list.last().map_or(FIRST_DEGREE, |last| last.rule.degree());
                let mut panel = PanelTable::empty(turns, ends, Rule::of(degree), 1.0);
                panel.tabulate(dynamics)?;
                if !panel.resolve(dynamics, fine, most)? && most < MAX_DEGREE {
                    return Ok(None);
                }
                list.push(panel);
                from = until;
            }
        }
    }
    Ok(Some(list))
}
