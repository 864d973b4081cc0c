//! What drives a crank at prescribed speed: its torque, and the balance of its work.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::outcome::Balance;
use super::result::TorqueRange;
use super::row::RowMaker;
use super::warning::NoRange;
use crate::engine::time::Start;
use crate::mechanism::Equation;
use crate::numeric::angle::Angle;
use crate::numeric::{gauss, golden};
use crate::scene::{Instant, Variable};

/// A run at constant speed.
pub(super) struct Drive<'a> {
    pub equation: &'a Equation,
    pub maker: &'a RowMaker,
    pub start: Angle,
    /// rad/s
    pub speed: f64,
    /// Last time, s.
    pub end: f64,
}

/// Turns of a run whose loads do not repeat that are looked at.
const MOST_TURNS: f64 = 100.0;

impl Drive<'_> {
    fn torque(&self, t: f64) -> f64 {
        let angle = self.start.plus(self.speed * t);
        let torque = self.equation.driving_torque(t, angle, self.speed, 0.0);
        let friction = self.maker.friction(t, angle, self.speed, 0.0);
        if friction == 0.0 {
            return torque;
        }
        torque - friction * self.equation.linkage().pose(angle.rest).dx
    }

    /// The torque has no finite value at a time (s).
    fn not_finite(&self, t: f64) -> NoRange {
        let angle = self.start.plus(self.speed * t);
        let pose = self.equation.linkage().pose(angle.rest);
        let now = Instant {
            t,
            theta: angle.radians(),
            omega: self.speed,
            x: pose.x,
            v: pose.dx * self.speed,
        };
        let load = self.equation.loads().without_value(&now).cloned();
        NoRange::NotFinite {
            at_limit: !pose.exists(),
            load: load.map(Box::new),
            at: Start {
                t,
                angle,
                speed: self.speed,
            },
        }
    }

    /// Smallest, largest and mean driving torque: over one turn if every turn is the same and the run is
    /// longer, else over the run.
    ///
    /// # Errors
    /// Why it is not known.
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
        let turn = TAU / self.speed.abs();
        let reads = self.equation.loads().reads();
        let repeats = !reads.has(Variable::T) && !reads.has(Variable::Theta);
        let span = if repeats {
            turn.min(self.end)
        } else {
            self.end
        };
        if span > MOST_TURNS * turn {
            return Err(NoRange::TooManyTurns(MOST_TURNS));
        }
        let times = self.times(span);
        let torques: Vec<f64> = times.iter().map(|t| self.torque(*t)).collect();
        if let Some(i) = torques.iter().position(|torque| !torque.is_finite()) {
            return Err(self.not_finite(times[i]));
        }
        Ok(TorqueRange {
            min_nm: -self.largest(&times, &torques, -1.0),
            max_nm: self.largest(&times, &torques, 1.0),
            mean_nm: self.mean(span).ok_or(NoRange::Mean)?,
        })
    }

    /// Times of the angles of a fine grid of each turn, with the ends.
    fn times(&self, span: f64) -> Vec<f64> {
        let grid = self.equation.linkage().turn_grid();
        let turns = (span * self.speed.abs() / TAU).ceil() as i64;
        let whole = |turn: i64| turn as f64 * TAU * self.speed.signum();
        let angles =
            (-1..=turns).flat_map(|turn| grid.iter().map(move |angle| angle + whole(turn)));
        let mut times: Vec<f64> = angles
            .map(|angle| (angle - self.start.rest) / self.speed)
            .filter(|t| (0.0..=span).contains(t))
            .chain([0.0, span])
            .collect();
        times.sort_by(f64::total_cmp);
        times
    }

    /// Largest sign·torque: at the times, then between the neighbours of the largest, by golden section.
    fn largest(&self, times: &[f64], torques: &[f64], sign: f64) -> f64 {
        let value = |index: &usize| sign * torques[*index];
        let best = (0..times.len()).max_by(|a, b| value(a).total_cmp(&value(b)));
        let best = best.unwrap_or(0);
        let (from, to) = (
            times[best.saturating_sub(1)],
            times[(best + 1).min(times.len() - 1)],
        );
        let (_, between) = golden::largest(|t| sign * self.torque(t), from, to);
        between.max(sign * torques[best])
    }

    /// Mean over time.
    fn mean(&self, span: f64) -> Option<f64> {
        if span == 0.0 {
            return Some(self.torque(0.0));
        }
        let scale = self.equation.kinetic_energy(self.start.rest, self.speed) / self.speed.abs();
        let way = self.speed * span;
        let integral = quarters(
            self.start.rest,
            self.start.rest + way,
            &|theta| self.torque((theta - self.start.rest) / self.speed),
            1e-12 * scale * self.speed.abs(),
        );
        integral.map(|integral| integral / way)
    }

    /// Work that the equation asks for on the way, by quadrature, against the energies at its ends, J: ½ M' and
    /// V' against M and V. Whole turns bring nothing.
    pub fn energy_balance(&self) -> Balance {
        let (equation, speed) = (self.equation, self.speed);
        let kinetic = |theta: f64| equation.kinetic_energy(theta, speed);
        let energy = |theta: f64| kinetic(theta) + equation.gravity_energy(theta);
        let (from, to) = (self.start.rest, self.start.rest + (speed * self.end) % TAU);
        let largest = energy(from).abs().max(kinetic(from)).max(kinetic(to));
        let force = |theta: f64| equation.generalized_force(&equation.terms(theta), speed, 0.0);
        let work = quarters(from, to, &force, 1e-14 * largest);
        let residual = work.map_or(f64::NAN, |work| work - (energy(to) - energy(from)));
        Balance { residual, largest }
    }
}

/// ∫ f over a range of crank angles, cut at ±90°, where a rod that is hardly long enough makes narrow peaks.
fn quarters(from: f64, to: f64, f: &dyn Fn(f64) -> f64, tolerance: f64) -> Option<f64> {
    let (low, high) = (from.min(to), from.max(to));
    let mut cuts = vec![low];
    let mut cut = ((low - FRAC_PI_2) / PI).floor() * PI + FRAC_PI_2;
    while cut < high {
        if cut > low {
            cuts.push(cut);
        }
        cut += PI;
    }
    cuts.push(high);
    let sum: f64 = cuts
        .windows(2)
        .map(|w| gauss::adaptive(f, w[0], w[1], tolerance))
        .sum();
    sum.is_finite()
        .then_some(if to < from { -sum } else { sum })
}
