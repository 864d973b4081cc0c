//! The panels of one turn and what is known on them.

use std::f64::consts::TAU;

use super::{Driven, Table};
use crate::engine::energy::Unserved;
use crate::engine::energy::piece::{Piece, Turning};
use crate::numeric::chebyshev::{Rule, Values};

/// A panel with what depends on the position alone: the same in each turn.
#[derive(Clone)]
pub(super) struct Station<P> {
    pub piece: Piece,
    pub rule: &'static Rule,
    pub table: Table<P>,
    /// Side of the switch for which the table is, ±1.
    pub side: f64,
    /// Kinetic energy at the points in the last turn and in the one before.
    past: [Option<Values>; 2],
    /// Whether it was too long for a turn before.
    pub failed: bool,
    /// What was left of it after each change of the switch in the last turn.
    pub rests: Vec<Rest>,
    /// Which of the rests of another station it is.
    pub is_rest: Option<usize>,
}

/// What is left of a panel after a change of the switch.
#[derive(Clone)]
pub(super) struct Rest {
    rule: &'static Rule,
    /// Kinetic energy at its points, J.
    kinetic: Values,
}

/// Panels are not cut below this, rad.
const SHORTEST: f64 = 1e-9;
/// Degree of the series that are tried first.
const FIRST_DEGREE: usize = 24;

impl<P: Copy> Station<P> {
    /// The panel from one angle to another; its degree is the least that resolves inertia and force to `tail`.
    pub fn new<D: Driven<Place = P>>(
        driven: &D,
        [from, to]: [f64; 2],
        side: f64,
        tail: f64,
    ) -> Result<Station<P>, Unserved> {
        let mut station = Station {
            piece: Piece {
                from,
                to,
                turning: Turning::Nowhere,
            },
            rule: Rule::of(FIRST_DEGREE),
            table: Table::default(),
            side,
            past: [None; 2],
            failed: false,
            rests: Vec::new(),
            is_rest: None,
        };
        station.tabulate(driven)?;
        let enough = station.degree_for(tail);
        if enough != FIRST_DEGREE {
            station.rule = Rule::of(enough);
            station.tabulate(driven)?;
        }
        Ok(station)
    }

    /// What is left of the panel from an angle on, beyond the change number `index` of the switch, for the other
    /// side; `known`: the same in the last turn.
    pub fn rest<D: Driven<Place = P>>(
        &self,
        driven: &D,
        from: f64,
        index: usize,
        known: Option<&Rest>,
        tail: f64,
    ) -> Result<Station<P>, Unserved> {
        let piece = Piece { from, ..self.piece };
        let Some(known) = known else {
            let ends = [from, piece.to];
            let mut station = Station::new(driven, ends, -self.side, tail)?;
            station.is_rest = Some(index);
            return Ok(station);
        };
        let mut station = Station {
            piece,
            rule: known.rule,
            table: Table::default(),
            side: -self.side,
            past: [Some(known.kinetic), None],
            failed: false,
            rests: Vec::new(),
            is_rest: Some(index),
        };
        station.tabulate(driven)?;
        Ok(station)
    }

    /// It as the rest of another station.
    pub fn as_rest(&self) -> Option<(usize, Rest)> {
        let kinetic = self.past[0]?;
        let rule = self.rule;
        Some((self.is_rest?, Rest { rule, kinetic }))
    }

    fn tabulate<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), Unserved> {
        let piece = self.piece;
        let angles = self.rule.values(|x| piece.angle(x));
        let count = self.rule.degree() + 1;
        driven.tabulate(&angles, count, self.side, &mut self.table);
        let known = |values: &Values| values[..count].iter().all(|value| value.is_finite());
        if known(&self.table.inertia) && known(&self.table.force) && known(&self.table.push) {
            Ok(())
        } else {
            Err(Unserved::NotFinite)
        }
    }

    /// The least degree at which the series of inertia and force end below a part `tail` of themselves.
    fn degree_for(&self, tail: f64) -> usize {
        let all = [&self.table.inertia, &self.table.force, &self.table.push];
        let series = all.map(|values| self.rule.series(values));
        let resolved = |degree: &&usize| {
            let ends = |series: &crate::numeric::chebyshev::Series| series.tail_at(**degree);
            series.iter().all(|series| ends(series) <= tail)
        };
        let mut smaller = Rule::DEGREES.iter().filter(|d| **d <= self.rule.degree());
        *smaller.find(resolved).unwrap_or(&32)
    }

    /// Takes the next degree; false if there is none.
    pub fn raise<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<bool, Unserved> {
        let Some(next) = Rule::DEGREES.iter().find(|d| **d > self.rule.degree()) else {
            return Ok(false);
        };
        self.rule = Rule::of(*next);
        self.past = [None; 2];
        self.tabulate(driven)?;
        Ok(true)
    }

    /// The two parts of the panel; none if it is too short to be cut.
    pub fn parts<D: Driven<Place = P>>(
        &self,
        driven: &D,
        share: f64,
        tail: f64,
    ) -> Result<Option<[Station<P>; 2]>, Unserved> {
        let Piece { from, to, .. } = self.piece;
        if (to - from).abs() < SHORTEST * from.abs().max(1.0) {
            return Ok(None);
        }
        let middle = from + share * (to - from);
        let first = Station::new(driven, [from, middle], self.side, tail)?;
        let second = Station::new(driven, [middle, to], self.side, tail)?;
        Ok(Some([first, second]))
    }

    /// Goes over to the other side of the switch.
    pub fn turn_over<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), Unserved> {
        self.side = -self.side;
        self.past = [None; 2];
        self.tabulate(driven)
    }

    /// Half its length with sign, rad.
    pub fn half(&self) -> f64 {
        0.5 * (self.piece.to - self.piece.from)
    }

    /// Kinetic energy at the points, from that at the start (J): the profile of the last turns carried on.
    pub fn guess(&self, start: f64) -> Values {
        match &self.past {
            [Some(last), Some(before)] => {
                let apart = last[0] - before[0];
                let share = (start - last[0]) / apart;
                if share.abs() <= 2.0 {
                    std::array::from_fn(|j| last[j] + share * (last[j] - before[j]))
                } else {
                    last.map(|k| k + (start - last[0]))
                }
            }
            [Some(last), None] => last.map(|k| k + (start - last[0])),
            // The same speed everywhere.
            _ => {
                let inertia = &self.table.inertia;
                inertia.map(|here| start * (here / inertia[0]))
            }
        }
    }

    /// Keeps the kinetic energy of this turn for the next.
    pub fn remember(&mut self, kinetic: &Values) {
        self.past = [Some(*kinetic), self.past[0]];
    }
}

/// Panels of one turn between the corners.
pub(super) fn stations<D: Driven>(
    driven: &D,
    start: f64,
    direction: f64,
    tail: f64,
) -> Result<Vec<Station<D::Place>>, Unserved> {
    let mut ends: Vec<f64> = driven
        .corners()
        .iter()
        .map(|corner| (direction * (corner - start)).rem_euclid(TAU))
        .filter(|ahead| *ahead > 1e-9 && *ahead < TAU - 1e-9)
        .collect();
    ends.sort_by(f64::total_cmp);
    ends.push(TAU);
    let mut from = 0.0;
    let mut list = Vec::with_capacity(8);
    for to in ends {
        let (begin, end) = (start + direction * from, start + direction * to);
        list.push(Station::new(driven, [begin, end], 1.0, tail)?);
        from = to;
    }
    Ok(list)
}
