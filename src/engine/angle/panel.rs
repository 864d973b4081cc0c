//! Panel of a cycle with its tables and what earlier turns found on it.

use std::cell::Cell;

use super::super::energy::NotApplicable;
use super::super::energy::piece::{Piece, Turning};
use super::predictor::Predictor;
use super::{Dynamics, State, Table};
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, Values, largest};

/// State at the start of a panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct PanelStart {
    /// Rounded time, s.
    pub t: f64,
    /// Remainder of the rounded time, s.
    pub t_low: f64,
    /// Kinetic energy, J.
    pub kinetic: f64,
    /// Whole turns to be added to the angles of the panel.
    pub turns: f64,
    /// Sign of the speed.
    pub direction: f64,
}

/// Initial value problem on a panel.
pub(super) struct Problem<'a, D: Dynamics> {
    pub dynamics: &'a D,
    pub panel: &'a PanelTable<D::Place>,
    pub start: PanelStart,
}

impl<'a, D: Dynamics> Problem<'a, D> {
    pub fn new(dynamics: &'a D, panel: &'a PanelTable<D::Place>, start: PanelStart) -> Self {
        Problem {
            dynamics,
            panel,
            start,
        }
    }

    /// Returns the state at point `j`, at a time (s) and speed (rad/s).
    #[inline]
    pub fn state(&self, j: usize, t: f64, speed: f64) -> State<'_, D::Place> {
        let panel = self.panel;
        let theta = panel.piece.angle(panel.rule.points()[j]);
        State {
            place: &panel.table.places[j],
            t,
            angle: Angle::new(self.start.turns, theta),
            speed,
        }
    }
}

/// Panel with the tables of all that depends on the position alone, equal in each cycle.
pub(super) struct PanelTable<P> {
    /// Whole turns to be added to the angles of the piece, in the first cycle.
    pub turns: f64,
    pub piece: Piece,
    pub rule: &'static Rule,
    pub table: Table<P>,
    /// Side of the switch to which the table applies, ±1.
    pub side: f64,
    /// Twice the inverse inertia, 2/M, at the points, 1/(kg m²).
    pub mobility: Values,
    /// Work of position-dependent forces from the start to the points, J; integrand over `growth` if there is a switch.
    pub work: Values,
    /// Growth of the kinetic energy from the start to the points due to the switch force, which is proportional to it.
    pub(super) growth: Option<Box<Values>>,
    /// True if there is damping.
    pub damped: bool,
    /// Largest conservative force, N m: near an equilibrium the others are as large.
    pub largest_force: f64,
    /// Kinetic energy in the last turns.
    pub(super) past: Predictor,
    /// Convergence factor of the sweeps as last measured.
    pub factor: Cell<f64>,
    /// True if the panel was too long in an earlier turn.
    pub failed: bool,
    /// Rests of the panel after each switching in the last turn.
    pub rests: Vec<Rest>,
    /// Index of this panel among the rests of another one.
    pub rest_index: Option<usize>,
}

/// Rest of a panel after a switching: guess for the next turn.
pub(super) struct Rest {
    rule: &'static Rule,
    /// Kinetic energy at the points, J.
    kinetic: Values,
}

/// Requirements on the resolution of panels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fineness {
    /// Largest tail of a resolved series.
    pub tail: f64,
    /// Typical crank speed, rad/s.
    pub speed: f64,
    /// Share at which panels are cut that are too long: another in a second run, for the same panels have the same error.
    pub cut: f64,
}

/// Length of the shortest panel, rad; a corner or switching as near to an end of a panel counts as at the end, and a
/// switch as small there, beside its parts, as zero. Forces are continuous at a switching: the effect is of second
/// order in this length.
pub(super) const SHORTEST_PANEL: f64 = 1e-9;
/// Convergence factor above which sweeps give way to Newton's method; also the first estimate of the factor.
pub(super) const SLOW_FACTOR: f64 = 0.3;
/// Degree of the series tried first: a higher one costs no less than more panels.
pub(super) const FIRST_DEGREE: usize = 24;

impl<P: Copy> PanelTable<P> {
    /// Makes the panel between two angles (rad), of the least degree that resolves inertia and forces; `first`: first
    /// try.
    pub fn new(
        dynamics: &impl Dynamics<Place = P>,
        turns: f64,
        ends: [f64; 2],
        side: f64,
        fine: Fineness,
        first: usize,
    ) -> Result<Self, NotApplicable> {
        let mut panel = Self::empty(turns, ends, Rule::of(first), side);
        panel.tabulate(dynamics)?;
        panel.resolve(dynamics, fine)?;
        Ok(panel)
    }

    /// Sets the least degree that resolves inertia and forces, or the largest.
    pub fn resolve(
        &mut self,
        dynamics: &impl Dynamics<Place = P>,
        fine: Fineness,
    ) -> Result<(), NotApplicable> {
        loop {
            let (enough, tried) = (self.degree_for(fine), self.rule.degree());
            let next = if tried < FIRST_DEGREE {
                FIRST_DEGREE
            } else {
                MAX_DEGREE
            };
            let degree = enough.unwrap_or(next);
            if degree == tried {
                return Ok(());
            }
            self.rule = Rule::of(degree);
            self.tabulate(dynamics)?;
            if enough.is_some() {
                return Ok(());
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
            factor: Cell::new(SLOW_FACTOR),
            failed: false,
            rests: Vec::new(),
            rest_index: None,
        }
    }

    /// Makes the rest of the panel from an angle (rad) on, after switching number `index`, for the other side; `known`
    /// is the same rest in the last turn.
    pub fn rest(
        &self,
        dynamics: &impl Dynamics<Place = P>,
        from: f64,
        index: usize,
        known: Option<&Rest>,
        fine: Fineness,
    ) -> Result<Self, NotApplicable> {
        let ends = [from, self.piece.to];
        let mut panel = match known {
            None => Self::new(dynamics, self.turns, ends, -self.side, fine, FIRST_DEGREE)?,
            Some(known) => {
                let mut panel = Self::empty(self.turns, ends, known.rule, -self.side);
                panel.past.remember(&known.kinetic);
                panel.tabulate(dynamics)?;
                panel
            }
        };
        panel.rest_index = Some(index);
        Ok(panel)
    }

    /// Converts this panel to the rest that it is of another, with its index; none if it is none or is not solved.
    pub fn as_rest(&self) -> Option<(usize, Rest)> {
        let (rule, kinetic) = (self.rule, *self.past.last()?);
        Some((self.rest_index?, Rest { rule, kinetic }))
    }

    /// Changes to the other side of the switch.
    pub fn turn_over(&mut self, dynamics: &impl Dynamics<Place = P>) -> Result<(), NotApplicable> {
        self.side = -self.side;
        self.past.restart(None);
        self.tabulate(dynamics)
    }

    pub fn tabulate(&mut self, dynamics: &impl Dynamics<Place = P>) -> Result<(), NotApplicable> {
        let piece = self.piece;
        let angles = self.rule.values(|x| piece.angle(x));
        let count = self.rule.degree() + 1;
        dynamics.fill_table(self.turns, (&angles, count), self.side, &mut self.table);
        self.largest_force = largest(&self.table.force[..count]);
        let inertias = self.table.inertia[..count].iter();
        for (mobility, inertia) in self.mobility.iter_mut().zip(inertias) {
            *mobility = 2.0 / inertia;
        }
        let damping = &self.table.damping[..count];
        self.damped = damping.iter().any(|damping| *damping != 0.0);
        self.fill_work();
        let table = &self.table;
        let finite = [&table.inertia, &table.force, &table.push]
            .iter()
            .all(|values| values[..count].iter().all(|value| value.is_finite()));
        finite.then_some(()).ok_or(NotApplicable::NotFinite)
    }

    /// Returns the least degree that resolves the speed at constant kinetic energy and the forces relative to that
    /// energy; none if the present degree is insufficient.
    fn degree_for(&self, fine: Fineness) -> Option<usize> {
        let kinetic = 0.5 * self.table.inertia[0] * fine.speed * fine.speed;
        let slowness = self.rule.series(&self.table.inertia.map(f64::sqrt));
        let force = self.rule.series(&self.force_of_position());
        // Fraction of the tail for the truncation error of forces, which adds up over the turns.
        let error_share = 0.1;
        let share = (force.largest() * self.half().abs() / kinetic / error_share).min(1.0);
        let degrees = Rule::DEGREES.into_iter();
        let mut smaller = degrees.take_while(|degree| *degree <= self.rule.degree());
        smaller.find(|degree| {
            slowness.tail_at(*degree) <= fine.tail && force.tail_at(*degree) * share <= fine.tail
        })
    }

    /// Returns the force of the position alone at the points, N m.
    pub(super) fn force_of_position(&self) -> Values {
        let mut force = self.table.force;
        for (force, push) in force.iter_mut().zip(&self.table.push) {
            *force += push;
        }
        force
    }

    /// Returns half the signed length, rad.
    pub fn half(&self) -> f64 {
        0.5 * (self.piece.to - self.piece.from)
    }

    /// True if a tabulated force depends on the speed.
    pub fn varies_with_speed(&self) -> bool {
        self.damped || self.growth.is_some()
    }

    /// True if the panel has not been solved yet.
    pub fn is_new(&self) -> bool {
        self.past.last().is_none()
    }

    /// Returns the largest magnitude of the work of the position-dependent forces from the start to a point, J.
    pub fn largest_work(&self) -> f64 {
        largest(&self.work[..=self.rule.degree()])
    }
}
