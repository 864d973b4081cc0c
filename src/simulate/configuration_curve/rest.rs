//! Transitions between motion and rest, release by loads in time, and jamming, where rigid bodies leave the motion
//! undetermined.

use super::super::coordinate::Coordinate;
use super::super::guide_friction::NEARBY_ANGLE;
use super::super::stick_slip::EventIndex::{self, CrankRate, DeadCentre, NormalForce, Speed};
use super::super::stick_slip::{Signs, StickSlipPhase, opposed, signs};
use super::super::stop::Why;
use super::EndReason;
use super::follow::CurveRun;
use crate::engine::event_functions::EventFunction;
use crate::engine::step::{Node, Step};
use crate::engine::time::{Finish, MotionState};
use crate::engine::{Motion, WorkLimit};
use crate::mechanism::{AtRest, Free, FromRest};
use crate::numeric::root;
use crate::scene::Variable;

impl CurveRun<'_, '_> {
    /// Leaves rest; none if the motion goes on, otherwise the end of the run. `before`: previous direction of motion.
    pub fn leave_rest(&mut self, before: Option<f64>) -> Option<EndReason> {
        let friction = self.equation.friction;
        let [mu, mu_static] = friction.map_or([0.0; 2], |f| [f.coefficient, f.static_coefficient]);
        let at = self.state;
        let held = self.equation.at_rest(at.angle).held(at.t);
        let direction = match held.free.from_rest(mu, mu_static) {
            FromRest::Move(direction) => {
                if before.is_some_and(|before| before != direction) {
                    self.observer.event("turning-point", at);
                }
                direction
            }
            FromRest::Hold(_) => match self.rest(mu_static) {
                Ok(direction) => direction,
                Err(end) => return Some(end),
            },
            FromRest::Jam => return Some(self.jam()),
        };
        self.signs = self.signs_for(direction);
        self.check_jam()
    }

    /// Stays at rest until static friction gives way; returns the direction of the slip, or the end of the run.
    fn rest(&mut self, mu_static: f64) -> Result<f64, EndReason> {
        let at = self.state;
        let MotionState { t, angle, .. } = at;
        let equation = self.equation;
        let is_open = self.events.turn_limit.is_some();
        // A run of turns has no last time: it seeks a release for this many times its time up to now, or this many s.
        let search_span = 1e3;
        let end = match is_open {
            true => t + search_span * t.max(1.0),
            false => self.settings.t_end,
        };
        let changes = equation.loads().reads.has(Variable::T);
        let (release, looked) = if changes {
            let allowed = self.settings.limit.after(self.spent());
            release(&equation.at_rest(angle), mu_static, t, end, allowed)
        } else {
            (Release::Never, 0)
        };
        self.piece.evaluations += looked;
        let kind = match release {
            Release::Never => "rest",
            _ => "stick",
        };
        self.observer.event(kind, at);
        let (until, ends) = match release {
            Release::Never if is_open => return Err(EndReason::AtRest),
            Release::Never => (end, Some(EndReason::Done)),
            Release::At(t) => (t, None),
            Release::Unknown(t) => (t, Some(EndReason::Integrator(Finish::WorkLimit))),
        };
        let node = |t: f64| Node {
            t,
            theta: angle.rest,
            ..Node::default()
        };
        let still = Step::new(angle.turns, node(t), node(until));
        let along = Coordinate::Curve(self.curve_motion(StickSlipPhase::Sticking));
        self.observer.step(&still, &along);
        self.arrive(still);
        if let Some(end) = ends {
            return Err(end);
        }
        self.observer.event("slip", MotionState { t: until, ..at });
        let free = equation.free(until, angle, 0.0);
        Ok(if free.pull > 0.0 { 1.0 } else { -1.0 })
    }

    /// Returns the end of the run if rigid bodies jam at the current state.
    pub fn check_jam(&mut self) -> Option<EndReason> {
        let friction = self.equation.friction?;
        (self.free().clear_of_jam(friction.coefficient) <= 0.0).then(|| self.jam())
    }

    /// Returns the free motion from the current state, without friction.
    fn free(&self) -> Free {
        let MotionState { t, angle, speed } = self.state;
        self.equation.free(t, angle, speed)
    }

    /// Returns the end where rigid bodies jam, in the current state.
    pub fn jam(&self) -> EndReason {
        let free = self.free();
        let mu = self.equation.friction.map_or(0.0, |f| f.coefficient);
        EndReason::Named(Box::new(Why::Jam {
            solutions: free.jam(
                mu,
                self.signs[Speed as usize] * self.signs[DeadCentre as usize],
            ),
            mu,
            kappa: free.kappa.abs(),
        }))
    }

    /// Returns the end of a run whose steps became too small: jamming, if the state is close to it.
    pub fn singular(&self) -> EndReason {
        // Of 1 − μ |κ|: the acceleration grows a thousandfold towards jamming, which the steps do not follow.
        let near_jam = 1e-3;
        let clear = |mu: f64| self.free().clear_of_jam(mu);
        match self.equation.friction {
            Some(friction) if clear(friction.coefficient) < near_jam => self.jam(),
            _ => EndReason::Integrator(Finish::StepTooSmall),
        }
    }

    /// Returns the signs at the start of a motion in `direction` (±1 of the coordinate).
    pub fn signs_for(&self, direction: f64) -> Signs {
        let equation = self.equation;
        if equation.loads().are_dry() {
            // The signs of the speeds determine the sign of N.
            let signs_ahead = self.signs_ahead(direction);
            self.events.opposed.set(opposed(equation, &signs_ahead));
        }
        self.signs_ahead(direction)
    }

    fn signs_ahead(&self, direction: f64) -> Signs {
        let MotionState { t, angle, speed } = self.state;
        let values = self.events.values(t, angle, speed);
        let ahead = self
            .events
            .values(t, angle.plus(direction * NEARBY_ANGLE), speed);
        let mut signs = signs(values, ahead, direction);
        // A start at rest has no direction: the acceleration gives it.
        if speed == 0.0 && !self.may_stick() {
            let motion = self.curve_motion(StickSlipPhase::FREE);
            if motion.acceleration(t, angle, speed) < 0.0 {
                signs[Speed as usize] = -1.0;
            }
        }
        signs
    }

    /// Updates the signs where dry loads reverse and the normal force jumps.
    pub fn update_dry_signs(&mut self, index: EventIndex) {
        let equation = self.equation;
        if equation.loads().are_dry() && matches!(index, DeadCentre | CrankRate) {
            self.events.opposed.set(opposed(equation, &self.signs));
            let direction = self.signs[Speed as usize];
            self.signs[NormalForce as usize] = self.signs_ahead(direction)[NormalForce as usize];
        }
    }
}

/// Sample places in an interval, as parts of its length: uneven, as a periodic load could hide between even ones.
const SAMPLE_PLACES: [f64; 5] = [0.0, 0.29, 0.53, 0.83, 1.0];

/// Result of a search for release.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Release {
    /// The static friction gives way after this time, s.
    At(f64),
    /// The slider sticks for all of the time.
    Never,
    /// The work limit ended the search at this time, s.
    Unknown(f64),
}

/// Finds the first time between `from` and `to` (s) after which static friction gives way; counts evaluations.
fn release(
    rest: &AtRest<'_>,
    mu_static: f64,
    from: f64,
    to: f64,
    allowed: WorkLimit<'_>,
) -> (Release, u64) {
    let mut count = 0;
    let band = |t: f64| rest.margin(t, mu_static);
    // Intervals, s: a prime number of them is out of step with the period of most loads; shorter dips are not resolved.
    let [longest, shortest] = [1.0 / 317.0, 1e-9].map(|part| part * (to - from));
    let (mut t, mut length) = (from, longest);
    while t < to && !allowed.is_reached(count) {
        let corner = rest.equation.loads().next_corner(t);
        let end = corner.min(to).min(t + length);
        let times = SAMPLE_PLACES.map(|part| match part {
            1.0 => end,
            _ => t + part * (end - t),
        });
        let values = times.map(band);
        count += SAMPLE_PLACES.len() as u64;
        // The distance of the samples from a straight line indicates the dip of the margin between them.
        let line = |part: f64| values[0] + part * (values[4] - values[0]);
        let bend = (1..4)
            .map(|i| (values[i] - line(SAMPLE_PLACES[i])).abs())
            .fold(0.0, f64::max);
        let least = values.iter().fold(f64::INFINITY, |a, b| a.min(*b));
        // A margin that is zero throughout, as at a dead centre without weight, holds.
        let even = least > 2.0 * bend || least >= 0.0 && bend == 0.0;
        let change = rest.margin_change(mu_static, [t, end]);
        let is_resolved = even && least >= change || end - t <= shortest;
        let falls = |i: usize| change == 0.0 && values[..i].windows(2).all(|w| w[1] <= w[0]);
        // A margin that falls all the way to its crossing needs no closer look.
        if let Some(i) = (1..5).find(|i| values[*i] < 0.0)
            && (is_resolved || falls(i))
        {
            let crossing = root::bracketed(band, times[i - 1], times[i]).unwrap_or(times[i]);
            // Where the margin jumps, the loads that move the slider act behind the crossing.
            let behind = (crossing * (1.0 + 4.0 * f64::EPSILON)).min(times[i]);
            let holds = band(crossing) >= 0.0;
            return (Release::At(if holds { behind } else { crossing }), count);
        }
        if is_resolved {
            t = end;
            length = (2.0 * length).min(longest);
        } else {
            length = 0.5 * (end - t);
        }
    }
    let end = match t < to {
        true => Release::Unknown(t),
        false => Release::Never,
    };
    (end, count)
}
