//! Driving torque of a crank at prescribed speed, by inverse dynamics, and the energy balance of its run.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::energy_balance::EnergyBalance;
use super::load_resolution;
use super::result::TorqueRange;
use super::row::{Row, RowMaker};
use super::row_writer::RowSource;
use super::warning::NoRange;
use crate::engine::time::MotionState;
use crate::mechanism::Equation;
use crate::numeric::angle::{self, Angle};
use crate::numeric::enclosure::{Interval, MotionPiece, has_pole};
use crate::numeric::{gauss, maximum};
use crate::scene::Variable;

/// Run at constant speed.
pub(super) struct ConstantSpeedMotion<'a> {
    pub maker: &'a RowMaker,
    pub start: Angle,
    /// Crank speed, rad/s.
    pub speed: f64,
    /// Last time, s.
    pub end: f64,
}

/// Times of a search at constant speed.
pub(super) struct Samples {
    /// Times that resolve geometry and loads, s.
    pub times: Vec<f64>,
    /// Times between which the loads are smooth and slow, s.
    cuts: Vec<f64>,
    /// Whether the times are those of one turn, which repeats.
    pub is_one_turn: bool,
}

impl ConstantSpeedMotion<'_> {
    fn equation(&self) -> &Equation {
        &self.maker.equation
    }

    /// Returns the crank angle at a time, s.
    pub fn angle(&self, t: f64) -> Angle {
        self.start.plus(self.speed * t)
    }

    /// Makes the row at a time, s.
    pub fn row_at(&self, t: f64) -> Row {
        self.maker.row(t, self.angle(t), self.speed, Some(0.0))
    }

    /// Returns the driving torque at a time (s), friction at the guide included, N m.
    fn torque(&self, t: f64) -> f64 {
        let angle = self.angle(t);
        let torque = self.equation().driving_torque(t, angle, self.speed, 0.0);
        let friction = self.maker.friction(t, angle, self.speed, 0.0);
        if friction == 0.0 {
            return torque;
        }
        torque - friction * self.equation().linkage().pose(angle.rest).dx
    }

    /// Returns the reason that the torque has no finite value at a time, s.
    fn not_finite(&self, t: f64) -> NoRange {
        let (angle, speed) = (self.angle(t), self.speed);
        let at = MotionState { t, angle, speed };
        NoRange::NotFinite {
            at_limit: !self.equation().linkage().pose(angle.rest).is_regular(),
            load: self.maker.without_value(at).map(Box::new),
            at,
        }
    }

    /// Finds least, largest and mean torque: over one turn if all are equal and the run is longer, else over the run.
    ///
    /// # Errors
    /// [`NoRange`] with the reason that the range is not known.
    pub fn torque_range(&self) -> Result<TorqueRange, NoRange> {
        if self.speed == 0.0 {
            let torque = self.torque(0.0);
            let range = TorqueRange {
                min_nm: torque,
                max_nm: torque,
                mean_nm: torque,
            };
            let known = torque.is_finite().then_some(range);
            return known.ok_or_else(|| self.not_finite(0.0));
        }
        let samples = self.samples()?;
        let times = &samples.times;
        let torques: Vec<f64> = times.iter().map(|t| self.torque(*t)).collect();
        if let Some(i) = torques.iter().position(|torque| !torque.is_finite()) {
            return Err(self.not_finite(times[i]));
        }
        let largest = |sign: f64| {
            let signed = |(t, torque): (&f64, &f64)| (*t, sign * torque);
            let rows: Vec<(f64, f64)> = times.iter().zip(&torques).map(signed).collect();
            let refine = |known| maximum::beside(|t| sign * self.torque(t), known);
            maximum::among_rows(&rows, refine).map_or(f64::NAN, |(_, torque)| torque)
        };
        Ok(TorqueRange {
            min_nm: -largest(-1.0),
            max_nm: largest(1.0),
            mean_nm: self.mean(&samples).ok_or(NoRange::Mean)?,
        })
    }

    /// Whether a load has a pole at a time, s, that is known to some roundings.
    fn is_pole(&self, t: f64) -> bool {
        let angle = self.angle(t);
        let width = 1e-13
            * t.abs()
                .max(angle.radians().abs().max(1.0) / self.speed.abs());
        let near = MotionPiece {
            t: Interval::point(t).widened(width),
            angle: Interval::point(angle.radians()).widened(width * self.speed.abs()),
            speed: Interval::point(self.speed),
        };
        let (loads, linkage) = (self.equation().loads(), self.equation().linkage());
        let state = linkage.enclosed_state(&near, loads.slider_use());
        loads.unbounded(&state).is_some() && has_pole(|aside| self.torque(t + aside), width)
    }

    fn turn(&self) -> f64 {
        TAU / self.speed.abs()
    }

    /// Returns times that resolve geometry and loads: of a turn if all are equal and the run is longer, else of all.
    ///
    /// # Errors
    /// [`NoRange`] where there are too many.
    pub fn samples(&self) -> Result<Samples, NoRange> {
        let turn = self.turn();
        let loads = self.equation().loads();
        let reads = loads.reads;
        let repeats = !reads.has(Variable::T) && !reads.has(Variable::Theta);
        let is_one_turn = repeats && self.end >= turn;
        // Bounds the work: turns that differ are all searched.
        let most_turns = 100.0;
        if !is_one_turn && self.end > most_turns * turn {
            return Err(NoRange::TooManyTurns(most_turns));
        }
        // A quarter more than a turn: each place of the turn has two neighbours.
        let turned = if is_one_turn {
            1.25 * TAU
        } else {
            self.speed.abs() * self.end
        };
        let to = self.start.radians() + self.speed * self.end;
        let (low, high) = (self.start.radians().min(to), self.start.radians().max(to));
        let rows = loads.corners_between(low, high).into_iter();
        let rows = rows.map(|theta| (theta - self.start.radians()) / self.speed);
        let mut cuts: Vec<f64> = rows.collect();
        let mut times = self.times(turned);
        times.extend(&cuts);
        let times = angle::distinct(times);
        let pieces = load_resolution::unresolved(loads, &times, &|t| Some(self.row_at(t)))
            .ok_or(NoRange::TooQuick)?;
        let ends = || pieces.iter().flat_map(|piece| [piece.from, piece.to]);
        if let Some(t) = ends().find(|t| self.is_pole(*t)) {
            return Err(self.not_finite(t));
        }
        cuts.extend(ends());
        Ok(Samples {
            times: load_resolution::with_pieces(times, &pieces),
            cuts,
            is_one_turn,
        })
    }

    /// Returns times, s, in any order, of angles that resolve the geometry to a rotation `until` (rad), with both ends.
    fn times(&self, until: f64) -> Vec<f64> {
        let smooth = self.equation().loads().are_linear() && self.maker.guide.is_none();
        let grid = self.equation().linkage().turn_grid(smooth);
        let ahead = |theta: f64| (self.speed.signum() * (theta - self.start.rest)).rem_euclid(TAU);
        let grid: Vec<f64> = grid.into_iter().map(ahead).collect();
        let all = angle::in_turns(&grid, 0..=(until / TAU).ceil() as i64);
        let inside = all.filter(|turned| *turned <= until);
        let times = inside.chain([0.0, until]);
        times.map(|turned| turned / self.speed.abs()).collect()
    }

    /// Computes the mean torque over time, N m; none if not finite. Over whole turns inertia and gravity do no work.
    fn mean(&self, samples: &Samples) -> Option<f64> {
        let is_one_turn = samples.is_one_turn;
        if is_one_turn && self.equation().loads().are_none() && self.maker.guide.is_none() {
            return Some(0.0);
        }
        let span = if is_one_turn { self.turn() } else { self.end };
        if span == 0.0 {
            return Some(self.torque(0.0));
        }
        let kinetic = self.equation().kinetic_energy(self.start.rest, self.speed);
        let way = self.speed * span;
        let cuts = samples
            .cuts
            .iter()
            .map(|t| self.start.rest + self.speed * t);
        let integral = integral_by_pieces(
            self.start.rest,
            self.start.rest + way,
            cuts,
            &|theta| self.torque((theta - self.start.rest) / self.speed),
            1e-12 * kinetic,
        );
        integral.map(|integral| integral / way)
    }

    /// Compares the work by quadrature of ½ M' and V' with the change of the energies from M and V, J, but for whole
    /// turns.
    pub fn energy_balance(&self) -> EnergyBalance {
        let (equation, speed) = (self.equation(), self.speed);
        let kinetic = |theta: f64| equation.kinetic_energy(theta, speed);
        let energy = |theta: f64| kinetic(theta) + equation.gravity_energy(theta);
        let (from, to) = (self.start.rest, self.start.rest + (speed * self.end) % TAU);
        let largest = energy(from).abs().max(kinetic(from)).max(kinetic(to));
        let force = |theta: f64| equation.generalized_force(&equation.terms(theta), speed, 0.0);
        let work = integral_by_pieces(from, to, [], &force, 1e-14 * largest);
        let residual = work.map_or(f64::NAN, |work| work - (energy(to) - energy(from)));
        EnergyBalance { residual, largest }
    }
}

impl RowSource for ConstantSpeedMotion<'_> {
    fn times(&self) -> [f64; 2] {
        [0.0, self.end]
    }

    fn turned(&mut self, t: f64) -> f64 {
        self.speed * t
    }

    fn time_of(&mut self, turned: f64, _: [f64; 2]) -> Option<f64> {
        Some(turned / self.speed)
    }

    fn row(&mut self, t: f64) -> Row {
        self.row_at(t)
    }
}

/// Integrates f over crank angles, cut at some of them and at ±90°, where a rod that is hardly long enough makes peaks.
fn integral_by_pieces(
    from: f64,
    to: f64,
    cuts: impl IntoIterator<Item = f64>,
    f: &dyn Fn(f64) -> f64,
    tolerance: f64,
) -> Option<f64> {
    if from == to {
        return Some(0.0);
    }
    let (low, high) = (from.min(to), from.max(to));
    let first = ((low - FRAC_PI_2) / PI).floor() * PI + FRAC_PI_2;
    let normals = std::iter::successors(Some(first), |cut| Some(cut + PI));
    let cuts = normals.take_while(|cut| *cut < high).chain(cuts);
    let mut cuts: Vec<f64> = cuts.filter(|cut| *cut > low && *cut < high).collect();
    cuts.extend([low, high]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let sum = gauss::adaptive(f, &cuts, tolerance);
    sum.is_finite()
        .then_some(if to < from { -sum } else { sum })
}
