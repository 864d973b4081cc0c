//! A panel of a turn and what is known on it.

use super::super::energy::NotApplicable;
use super::super::energy::piece::{Piece, Turning};
use super::predictor::Predictor;
use super::{Driven, State, Table};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values, largest};

/// The state at the start of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelStart {
    /// s
    pub t: f64,
    /// J
    pub kinetic: f64,
    /// Whole turns beside the angles of the panel.
    pub turns: f64,
    /// Sign of the speed.
    pub direction: f64,
}

/// A panel with what depends on the position alone: the same in each cycle.
#[derive(Clone)]
pub(super) struct PanelTable<P> {
    /// Whole turns beside the angles of the piece, in the first cycle.
    pub turns: f64,
    pub piece: Piece,
    pub rule: &'static Rule,
    pub table: Table<P>,
    /// Side of the switch for which the table is, ±1.
    pub side: f64,
    /// 2/M at the points, 1/(kg m²).
    pub mobility: Values,
    /// Work of the forces of the position alone from the start to the points, J; less by `growth` where there is a switch.
    pub work: Values,
    /// Factor by which the force of the switch, which goes with the kinetic energy, makes it grow from the start to the points.
    pub(super) growth: Option<Box<Values>>,
    /// Whether there is damping.
    pub damped: bool,
    /// The largest force that has a potential, N m: at balance the others are as large.
    pub largest_force: f64,
    /// Kinetic energy in the last turns.
    pub(super) past: Predictor,
    /// What a sweep left of the error of the one before.
    pub factor: f64,
    /// Whether it was too long for a turn before.
    pub failed: bool,
    /// What was left of it after each change of the switch in the last turn.
    pub rests: Vec<Rest>,
    /// Which of the rests of another panel it is.
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

/// The shortest panel, rad; a corner or a change of the switch as near to an end of a panel is at the end. The forces are
/// continuous at a change: it is felt by the square of this.
pub(super) const SHORTEST_PANEL: f64 = 1e-9;
/// What the forces leave out adds up over the turns: it is to be less by this.
const ADDED_UP: f64 = 0.1;
/// Sweeps that gain less than this factor give way to Newton's method; taken for the factor before it is known.
pub(super) const SLOW_FACTOR: f64 = 0.3;
/// Degree of the series that are tried first.
pub(super) const FIRST_DEGREE: usize = 24;

impl<P: Copy> PanelTable<P> {
    /// The panel from one angle to another; its degree is the least that resolves inertia and forces, after one
    /// that is tried first.
    pub fn new<D: Driven<Place = P>>(
        driven: &D,
        turns: f64,
        ends: [f64; 2],
        side: f64,
        fine: Fineness,
        first: usize,
    ) -> Result<Self, NotApplicable> {
        let mut panel = Self::empty(turns, ends, Rule::of(first), side);
        panel.tabulate(driven)?;
        panel.resolve(driven, fine, MAX_DEGREE)?;
        Ok(panel)
    }

    /// Takes the least degree that resolves inertia and forces, or `most`; whether it does resolve them.
    pub fn resolve<D: Driven<Place = P>>(
        &mut self,
        driven: &D,
        fine: Fineness,
        most: usize,
    ) -> Result<bool, NotApplicable> {
        loop {
            let enough = self.degree_for(fine);
            let tried = self.rule.degree();
            if enough.is_none() && tried >= most {
                return Ok(false);
            }
            let next = if tried < FIRST_DEGREE {
                FIRST_DEGREE
            } else {
                most
            };
            let degree = enough.unwrap_or(next);
            if degree != tried {
                self.rule = Rule::of(degree);
                self.tabulate(driven)?;
            }
            if enough.is_some() {
                return Ok(true);
            }
        }
    }

    pub fn empty(turns: f64, [from, to]: [f64; 2], rule: &'static Rule, side: f64) -> Self {
        Self {
            turns,
            piece: Piece::between(from, to, Turning::Nowhere),
            rule,
            table: Table::default(),
            side,
            mobility: [0.0; MAX_DEGREE + 1],
            work: [0.0; MAX_DEGREE + 1],
            growth: None,
            damped: false,
            largest_force: 0.0,
            past: Predictor::new(),
            factor: SLOW_FACTOR,
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
    ) -> Result<Self, NotApplicable> {
        let ends = [from, self.piece.to];
        let mut panel = match known {
            None => Self::new(driven, self.turns, ends, -self.side, fine, FIRST_DEGREE)?,
            Some(known) => {
                let mut panel = Self::empty(self.turns, ends, known.rule, -self.side);
                panel.past.remember(&known.kinetic);
                panel.tabulate(driven)?;
                panel
            }
        };
        panel.is_rest = Some(index);
        Ok(panel)
    }

    /// The place as the rest of another panel.
    pub fn as_rest(&self) -> Option<(usize, Rest)> {
        let (rule, kinetic) = (self.rule, *self.past.last()?);
        Some((self.is_rest?, Rest { rule, kinetic }))
    }

    /// Goes over to the other side of the switch.
    pub fn turn_over<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), NotApplicable> {
        self.side = -self.side;
        self.past.forget();
        self.tabulate(driven)
    }

    pub fn tabulate<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<(), NotApplicable> {
        let piece = self.piece;
        let angles = self.rule.values(|x| piece.angle(x));
        let count = self.rule.degree() + 1;
        driven.tabulate(self.turns, (&angles, count), self.side, &mut self.table);
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
        self.damped = self.table.damping[..count]
            .iter()
            .any(|damping| *damping != 0.0);
        self.fill_work();
        if known(&self.table.inertia) && known(&self.table.force) && known(&self.table.push) {
            Ok(())
        } else {
            Err(NotApplicable::NotFinite)
        }
    }

    /// The least degree at which the series of the speed by a kinetic energy that is the same everywhere, and of what
    /// the forces do to it, have decayed; none if this one is not enough.
    fn degree_for(&self, fine: Fineness) -> Option<usize> {
        let kinetic = 0.5 * self.table.inertia[0] * fine.speed * fine.speed;
        let slowness = self.rule.series(&self.table.inertia.map(f64::sqrt));
        let force = self.rule.series(&self.force_of_position());
        let share = (force.largest() * self.half().abs() / kinetic / ADDED_UP).min(1.0);
        let degrees = Rule::DEGREES.into_iter();
        let mut smaller = degrees.take_while(|degree| *degree <= self.rule.degree());
        smaller.find(|degree| {
            slowness.tail_at(*degree) <= fine.tail && force.tail_at(*degree) * share <= fine.tail
        })
    }

    /// Force of the position alone at the points, N m.
    pub(super) fn force_of_position(&self) -> Values {
        let mut force = self.table.force;
        for (force, push) in force.iter_mut().zip(&self.table.push) {
            *force += push;
        }
        force
    }

    /// Takes the next degree; false if there is none.
    pub fn raise<D: Driven<Place = P>>(&mut self, driven: &D) -> Result<bool, NotApplicable> {
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
    ) -> Result<Option<[Self; 2]>, NotApplicable> {
        let Piece { from, to, .. } = self.piece;
        if (to - from).abs() < SHORTEST_PANEL * from.abs().max(1.0) {
            return Ok(None);
        }
        let middle = from + share * (to - from);
        let part = |ends| Self::new(driven, self.turns, ends, self.side, fine, FIRST_DEGREE);
        Ok(Some([part([from, middle])?, part([middle, to])?]))
    }

    /// The state at one of its points, at a time (s) and speed (rad/s).
    #[inline]
    pub fn state(&self, turns: f64, j: usize, t: f64, speed: f64) -> State<'_, P> {
        State {
            place: &self.table.places[j],
            t,
            angle: Angle::new(turns, self.piece.angle(self.rule.points()[j])),
            speed,
        }
    }

    /// Half its length with sign, rad.
    pub fn half(&self) -> f64 {
        0.5 * (self.piece.to - self.piece.from)
    }

    /// Whether a force of the table depends on the speed.
    pub fn varies_with_speed(&self) -> bool {
        self.damped || self.growth.is_some()
    }

    /// Whether it was not solved yet.
    pub fn is_new(&self) -> bool {
        self.past.last().is_none()
    }

    /// Largest work of the forces of the position alone from the start to a point, as a magnitude, J.
    pub fn largest_work(&self) -> f64 {
        largest(&self.work[..=self.rule.degree()])
    }

    /// Keeps the kinetic energy of this turn for the next.
    pub fn remember(&mut self, kinetic: &Values) {
        self.past.remember(kinetic);
    }
}
