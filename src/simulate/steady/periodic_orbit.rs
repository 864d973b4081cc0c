//! One computation of the periodic motion, and where its speed is extreme.

use std::f64::consts::TAU;

use super::super::angle_model::AngleModel;
use super::super::error_estimate::{LEAST_TAIL, MARGIN};
use super::super::guide_friction::Sliding;
use super::Estimated;
use super::refusal::{Over, Refusal, not_turned, over};
use super::round::{Motion, Round, Rounds};
use super::timed::Timed;
use crate::engine::WorkLimit;
use crate::engine::angle::{self, FixedPoint, Resolution};
use crate::error::Error;
use crate::mechanism::{Equation, Limits};
use crate::numeric::angle::Angle;
use crate::numeric::root;
use crate::plan::cycle_over_angle;
use crate::scene::{Scene, Variable};

/// Relative error of speeds and times by rounding.
pub(super) const SPEED_ROUNDING: f64 = 8.0 * f64::EPSILON;
/// A turn that gains no more than this part of its largest energy gains nothing.
const NO_GAIN: f64 = 1e-12;
/// First step of the search in the logarithm of the energy; of a search beside a motion that is known.
const FIRST_LOG_STEP: f64 = 0.05;
const STEP_BESIDE: f64 = 1e-10;

/// An extreme of the speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Extreme {
    /// Turned since the start, rad, positive.
    pub turned: f64,
    /// Signed, rad/s.
    pub omega: f64,
}

/// A periodic motion.
pub(super) struct Found {
    pub start: Angle,
    motion: Motion,
    /// Speed at the start, rad/s.
    pub speed: f64,
    /// Turns after which it is the same again.
    pub turns: f64,
    /// Their time, s.
    pub period: f64,
    /// Least and largest speed.
    pub extremes: [Extreme; 2],
    /// Deviation from it after these turns, by that before.
    pub multiplier: f64,
    pub multiplier_error: f64,
    /// What is left open of its energies, relative to them.
    pub uncertain: f64,
    pub approached: bool,
    /// Whether every speed is periodic.
    pub any_speed: bool,
    /// Largest kinetic energy, J.
    pub largest: f64,
}

impl Found {
    /// Coefficient of fluctuation: the range of the speed, by its mean.
    pub fn fluctuation(&self) -> f64 {
        let [slow, fast] = self.extremes;
        (fast.omega - slow.omega).abs() * self.period / self.way()
    }

    /// The crank's way in a period, rad.
    pub fn way(&self) -> f64 {
        self.turns * TAU
    }

    /// Speed where the crank has turned by this since the start, rad, rad/s.
    pub fn omega(&self, turned: f64) -> f64 {
        self.motion.omega(turned)
    }
}

/// What looks for the periodic motion of a scene.
pub(super) struct Seeker<'a> {
    scene: Scene,
    equation: Equation,
    /// Friction at the guide.
    sliding: Option<Sliding>,
    /// Turns after which the loads are the same again.
    cycle: u32,
    start: Angle,
    /// rad/s
    speed: f64,
    limit: WorkLimit<'a>,
}

impl<'a> Seeker<'a> {
    /// Looks from a speed on, rad/s.
    pub fn new(scene: &Scene, speed: f64, limit: WorkLimit<'a>) -> Seeker<'a> {
        let equation = Equation::new(scene);
        Seeker {
            sliding: Sliding::new(scene, &equation),
            equation,
            scene: scene.clone(),
            // What has none was refused.
            cycle: cycle_over_angle(scene).unwrap_or(1),
            start: Angle::from(scene.motion.angle).reduced(),
            speed,
            limit,
        }
    }

    pub fn find(&self) -> Result<Found, Error> {
        self.search(FIRST_LOG_STEP, false)
    }

    /// A second computation, cut at other angles, because equal panels would err alike.
    pub fn again(&self) -> Result<Found, Error> {
        self.search(STEP_BESIDE, true)
    }

    fn search(&self, step: f64, other: bool) -> Result<Found, Error> {
        let limits = Limits::new(self.equation.linkage(), self.speed);
        let inertia = |theta: f64| self.equation.terms(theta).inertia.m;
        let vanishes = |theta: f64| inertia(theta) <= 1e-12 * inertia(theta + 1.0);
        if limits.dead_centres.iter().any(|dc| vanishes(dc.theta)) {
            return Err(Refusal::Unbounded.into());
        }
        if over(&self.scene) == Over::Time {
            let mut timed = Timed::new(&self.scene, self.speed, self.cycle, other, self.limit);
            let found = self.solve(&mut timed, step);
            return match (found, timed.refused) {
                (Err(_), Some(why)) => Err(why),
                (found, _) => found,
            };
        }
        let position = AngleModel::new(&self.equation, &limits, self.start, self.speed)
            .with_cycle(self.cycle)
            .with_friction(self.sliding.as_ref());
        let resolution = Resolution {
            // What a turn leaves out adds up over all turns that are remembered.
            tail: LEAST_TAIL,
            other,
            guide: None,
            limit: self.limit,
        };
        let turns = angle::Turns::new(&position, self.start, self.speed, resolution);
        self.solve(&mut turns.map_err(not_turned)?, step)
    }

    /// Whether nothing depends on the speed.
    fn any_speed(&self) -> bool {
        let reads = self.equation.loads().reads();
        !reads.has(Variable::Omega) && !reads.has(Variable::V) && self.sliding.is_none()
    }

    fn solve(&self, rounds: &mut dyn Rounds, step: f64) -> Result<Found, Error> {
        if self.any_speed() {
            let round = rounds.round(rounds.first()).map_err(not_turned)?;
            if round.gain.abs() > NO_GAIN.max(rounds.noise()) * round.largest {
                return Err(match round.gain > 0.0 {
                    true => Refusal::AlwaysGains(round.gain).into(),
                    false => Refusal::AlwaysLoses(-round.gain).into(),
                });
            }
            return self.found(round, None);
        }
        let fixed = angle::fixed_point(rounds, step).map_err(Refusal::from)?;
        let round = rounds.round(fixed.kinetic);
        let round = round.map_err(Refusal::NotComputed)?;
        self.found(round, Some((fixed, rounds.noise())))
    }

    /// From a cycle, which is a fixed point found within some noise of the gain, or begins with any speed.
    fn found(&self, round: Round, fixed: Option<(FixedPoint, f64)>) -> Result<Found, Error> {
        let mut found = Found {
            start: self.start,
            motion: round.motion,
            speed: round.speed,
            turns: f64::from(self.cycle),
            period: round.period,
            extremes: [Extreme {
                turned: 0.0,
                omega: round.speed,
            }; 2],
            multiplier: 1.0,
            multiplier_error: 0.0,
            uncertain: round.uncertain,
            approached: true,
            any_speed: fixed.is_none(),
            largest: round.largest,
        };
        if let Some((fixed, noise)) = fixed {
            found.uncertain /= fixed.slope.abs().max(noise);
            // Motions do not cross: what is below zero is rounding.
            found.multiplier = (1.0 + fixed.slope).max(0.0);
            found.multiplier_error = fixed.slope_error;
            found.approached = fixed.approached;
        }
        found.extremes = [-1.0, 1.0].map(|sign| self.extreme(&found, sign));
        let known = found
            .extremes
            .iter()
            .all(|extreme| extreme.omega.is_finite());
        if known {
            Ok(found)
        } else {
            Err(Refusal::Unbounded.into())
        }
    }

    /// θ̈, rad/s².
    fn acceleration(&self, angle: Angle, omega: f64) -> f64 {
        match &self.sliding {
            // Not at the start of a motion, where the guide is what it will be.
            Some(sliding) => sliding.state(f64::MIN_POSITIVE, angle, omega).0,
            None => self.equation.acceleration(0.0, angle, omega),
        }
    }

    /// The largest sign·|speed|: of the angles of a fine grid, then where the acceleration vanishes beside it.
    fn extreme(&self, found: &Found, sign: f64) -> Extreme {
        let (sense, whole) = (found.speed.signum(), found.way());
        let grid = self.equation.linkage().turn_grid(1f64.to_radians());
        let since = |theta: &f64| (sense * (theta - self.start.rest)).rem_euclid(TAU);
        let again = |turn: u32| {
            let before = f64::from(turn) * TAU;
            grid.iter().map(move |theta| since(theta) + before)
        };
        let mut ways: Vec<f64> = (0..self.cycle).flat_map(again).collect();
        ways.push(0.0);
        ways.sort_by(f64::total_cmp);
        ways.dedup();
        let value = |way: f64| sign * sense * found.omega(way.rem_euclid(whole));
        let best = (0..ways.len()).max_by(|a, b| value(ways[*a]).total_cmp(&value(ways[*b])));
        let best = best.unwrap_or(0);
        let count = ways.len();
        let before = if best == 0 {
            ways[count - 1] - whole
        } else {
            ways[best - 1]
        };
        let after = if best + 1 == count {
            whole
        } else {
            ways[best + 1]
        };
        let slope = |way: f64| {
            let way = way.rem_euclid(whole);
            let angle = self.start.plus(sense * way);
            self.acceleration(angle, found.omega(way))
        };
        let way = root::bracketed(slope, before, after)
            .filter(|way| value(*way) > value(ways[best]))
            .unwrap_or(ways[best])
            .rem_euclid(whole);
        Extreme {
            turned: way,
            omega: found.omega(way),
        }
    }
}

/// The crank angle of an extreme, with its error: that of the acceleration by a part `relative` of the speed moves it
/// the more, the less the speed varies.
pub(super) fn place(found: &Found, check: &Found, which: usize, relative: f64) -> Estimated {
    let [here, there] = [found, check].map(|f| f.extremes[which].turned);
    let apart = (here - there).abs();
    let apart = apart.min((found.way() - apart).abs());
    let angle = found.start.plus(found.speed.signum() * here);
    Estimated {
        value: angle.radians().rem_euclid(found.way()),
        error: MARGIN * apart + relative * TAU / found.fluctuation().clamp(1e-12, 1.0),
    }
}
