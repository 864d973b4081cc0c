//! The panels of one turn and what is known on them.

use std::f64::consts::{PI, TAU};

use super::past::Past;
use super::{Driven, Table};
use crate::engine::energy::Unserved;
use crate::engine::energy::piece::{Piece, Turning};
use crate::numeric::chebyshev::{MOST, Rule, Values};

/// A panel with what depends on the position alone: the same in each turn.
#[derive(Clone)]
pub(super) struct Station<P> {
    pub piece: Piece,
    pub rule: &'static Rule,
    pub table: Table<P>,
    /// Side of the switch for which the table is, ±1.
    pub side: f64,
    /// 2/M at the points, 1/(kg m²).
    pub mobility: Values,
    /// Whether its degree resolves inertia and forces.
    pub resolved: bool,
    /// The largest force that has a potential, N m: at balance the others are as large.
    pub largest_force: f64,
    /// Kinetic energy in the last turns.
    past: Past,
    /// What a sweep left of the error of the one before.
    pub factor: f64,
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

/// What panels are to resolve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fineness {
    /// Series end where their coefficients have decayed to this.
    pub tail: f64,
    /// A usual speed of the crank, rad/s.
    pub speed: f64,
}

/// Panels are not cut below this, rad.
const SHORTEST: f64 = 1e-9;
/// Panels are not longer at first, rad.
const LONGEST: f64 = PI + 1e-9;
/// What a sweep is taken to leave before it is known.
const UNKNOWN: f64 = 0.3;
/// What the forces leave out adds up over the turns: it is to be less by this.
const ADDED_UP: f64 = 0.1;
/// Degree of the series that are tried first.
const FIRST_DEGREE: usize = 24;

impl<P: Copy> Station<P> {
    /// The panel from one angle to another; its degree is the least that resolves inertia and forces, after one
    /// that is tried first.
    pub fn new<D: Driven<Place = P>>(
        driven: &D,
        [from, to]: [f64; 2],
        side: f64,
        fine: Fineness,
        first: usize,
    ) -> Result<Station<P>, Unserved> {
        let piece = Piece {
            from,
            to,
            turning: Turning::Nowhere,
        };
        let mut station = Station::empty(piece, Rule::of(first), side);
        station.tabulate(driven)?;
        loop {
            let enough = station.degree_for(fine);
            let tried = station.rule.degree();
            let degree = enough.unwrap_or(if tried < FIRST_DEGREE {
                FIRST_DEGREE
            } else {
                MOST
            });
            if degree != tried {
                station.rule = Rule::of(degree);
                station.tabulate(driven)?;
            }
            if enough.is_some() || degree == MOST {
                station.resolved = enough.is_some();
                return Ok(station);
            }
        }
    }

    fn empty(piece: Piece, rule: &'static Rule, side: f64) -> Station<P> {
        Station {
            piece,
            rule,
            table: Table::default(),
            side,
            mobility: [0.0; MOST + 1],
            resolved: true,
            largest_force: 0.0,
            past: Past::new(),
            factor: UNKNOWN,
            failed: false,
            rests: Vec::new(),
            is_rest: None,
        }
    }

    /// What is left of the panel from an angle on, beyond the change number `index` of the switch, for the other
    /// side; `known`: the same in the last turn.
    pub fn rest<D: Driven<Place = P>>(
        &self,
        driven: &D,
        from: f64,
        index: usize,
        known: Option<&Rest>,
        fine: Fineness,
    ) -> Result<Station<P>, Unserved> {
        let piece = Piece { from, ..self.piece };
        let mut station = match known {
            None => Station::new(driven, [from, piece.to], -self.side, fine, FIRST_DEGREE)?,
            Some(known) => {
                let mut station = Station::empty(piece, known.rule, -self.side);
                station.past.remember(&known.kinetic);
                station.tabulate(driven)?;
                station
            }
        };
        station.is_rest = Some(index);
        Ok(station)
    }

    /// It as the rest of another station.
    pub fn as_rest(&self) -> Option<(usize, Rest)> {
        let (rule, kinetic) = (self.rule, *self.past.last()?);
        Some((self.is_rest?, Rest { rule, kinetic }))
    }

    /// Goes over to the other side of the switch.
    pub fn turn_over<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), Unserved> {
        self.side = -self.side;
        self.past.forget();
        self.tabulate(driven)
    }

    fn tabulate<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), Unserved> {
        let piece = self.piece;
        let angles = self.rule.values(|x| piece.angle(x));
        let count = self.rule.degree() + 1;
        driven.tabulate(&angles, count, self.side, &mut self.table);
        let known = |values: &Values| values[..count].iter().all(|value| value.is_finite());
        let forces = self.table.force[..count].iter();
        self.largest_force = forces.fold(0.0, |largest, force| largest.max(force.abs()));
        for (mobility, inertia) in self
            .mobility
            .iter_mut()
            .zip(&self.table.inertia)
            .take(count)
        {
            *mobility = 2.0 / inertia;
        }
        if known(&self.table.inertia) && known(&self.table.force) && known(&self.table.push) {
            Ok(())
        } else {
            Err(Unserved::NotFinite)
        }
    }

    /// The least degree at which the series of the speed by a kinetic energy that is the same everywhere, and of what
    /// the forces do to it, have decayed; none if this one is not enough.
    fn degree_for(&self, fine: Fineness) -> Option<usize> {
        let kinetic = 0.5 * self.table.inertia[0] * fine.speed * fine.speed;
        let slowness = self.rule.series(&self.table.inertia.map(f64::sqrt));
        let mut force = self.table.force;
        for (force, push) in force.iter_mut().zip(&self.table.push) {
            *force += push;
        }
        let force = self.rule.series(&force);
        let share = (force.largest() * self.half().abs() / kinetic / ADDED_UP).min(1.0);
        let degrees = Rule::DEGREES.into_iter();
        let mut smaller = degrees.take_while(|degree| *degree <= self.rule.degree());
        smaller.find(|degree| {
            slowness.tail_at(*degree) <= fine.tail && force.tail_at(*degree) * share <= fine.tail
        })
    }

    /// Takes the next degree; false if there is none.
    pub fn raise<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<bool, Unserved> {
        let Some(next) = Rule::DEGREES.iter().find(|d| **d > self.rule.degree()) else {
            return Ok(false);
        };
        self.rule = Rule::of(*next);
        self.past.forget();
        self.tabulate(driven)?;
        Ok(true)
    }

    /// The two parts of the panel; none if it is too short to be cut.
    pub fn parts<D: Driven<Place = P>>(
        &self,
        driven: &D,
        share: f64,
        fine: Fineness,
    ) -> Result<Option<[Station<P>; 2]>, Unserved> {
        let Piece { from, to, .. } = self.piece;
        if (to - from).abs() < SHORTEST * from.abs().max(1.0) {
            return Ok(None);
        }
        let middle = from + share * (to - from);
        let part = |ends: [f64; 2]| Station::new(driven, ends, self.side, fine, FIRST_DEGREE);
        Ok(Some([part([from, middle])?, part([middle, to])?]))
    }

    /// Half its length with sign, rad.
    pub fn half(&self) -> f64 {
        0.5 * (self.piece.to - self.piece.from)
    }

    /// Kinetic energy at the points, from that at the start (J): the profiles of the last turns carried on.
    /// Where time matters, turns of the same energy are not the same.
    pub fn guess(&self, start: f64, reads_time: bool, kinetic: &mut Values) {
        let most = if reads_time { 2 } else { usize::MAX };
        if self.past.carry_on(start, most, kinetic).is_none() {
            // The same speed everywhere.
            let inertia = &self.table.inertia;
            *kinetic = inertia.map(|here| start * (here / inertia[0]));
        }
    }

    /// Keeps the kinetic energy of this turn for the next.
    pub fn remember(&mut self, kinetic: &Values) {
        self.past.remember(kinetic);
    }
}

/// Panels of one turn between the corners.
pub(super) fn stations<D: Driven>(
    driven: &D,
    start: f64,
    fine: Fineness,
) -> Result<Vec<Station<D::Place>>, Unserved> {
    let (few, all) = (driven.corners(), driven.corners_if_light());
    if few.len() < all.len()
        && let Some(list) = between(driven, few, start, fine, true)?
    {
        return Ok(list);
    }
    Ok(between(driven, all, start, fine, false)?.unwrap_or_default())
}

/// Panels between some corners; none if one of them is to be resolved and is not.
fn between<D: Driven>(
    driven: &D,
    corners: &[f64],
    start: f64,
    fine: Fineness,
    resolved: bool,
) -> Result<Option<Vec<Station<D::Place>>>, Unserved> {
    let direction = fine.speed.signum();
    let mut ends: Vec<f64> = corners
        .iter()
        .map(|corner| (direction * (corner - start)).rem_euclid(TAU))
        .filter(|ahead| *ahead > 1e-9 && *ahead < TAU - 1e-9)
        .collect();
    ends.sort_by(f64::total_cmp);
    ends.push(TAU);
    let mut from = 0.0;
    let mut list: Vec<Station<D::Place>> = Vec::with_capacity(8);
    for to in ends {
        let parts = ((to - from) / LONGEST).ceil();
        let begin = from;
        for part in 1..=parts as u32 {
            let share = f64::from(part) / parts;
            let until = if share < 1.0 {
                begin + share * (to - begin)
            } else {
                to
            };
            let ends = [from, until].map(|ahead| start + direction * ahead);
            // Neighbours are alike.
            let degree = list.last().map_or(FIRST_DEGREE, |last| last.rule.degree());
            let station = Station::new(driven, ends, 1.0, fine, degree)?;
            if resolved && !station.resolved {
                return Ok(None);
            }
            list.push(station);
            from = until;
        }
    }
    Ok(Some(list))
}
