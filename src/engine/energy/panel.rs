//! One panel: dt/dθ and t as series over a piece of the angle.

use super::extreme::{Extreme, extremes};
use super::kinetic::{Energy, Noise};

use super::piece::{Piece, Turning};
use super::profile::{NotApplicable, Profile};
use super::time_sensitivity::TimeSensitivity;
use crate::numeric::chebyshev::{self, Rule, Series, Values};

/// Degree of the series: half a turn of a usual engine is right to rounding.
pub(super) const DEGREE: usize = chebyshev::MAX_DEGREE;

/// Panels next to a balance are shorter than this, rad. Half or twice as much changes the stated errors of 200 random runs by
/// 12 % at most.
const NEAR_BALANCE: f64 = 0.1;

/// A piece with its series.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Panel {
    pub piece: Piece,
    /// Whole turns to be added to its angles.
    pub turns: f64,
    pub rule: &'static Rule,
    /// dt/dx
    pub(super) slope: Series,
    /// Duration, s: rounded value and rest.
    pub duration: (f64, f64),
    /// Kinetic energy at its end, J.
    pub kinetic_at_end: f64,
    /// Bound of the error of its duration, s.
    pub error: f64,
    /// Slowest and fastest of its points.
    pub(super) extremes: [Extreme; 2],
    /// What its series of dt/dx leaves out, relative to the largest.
    pub tail: f64,
    /// How far the turning point at its end may be off, rad.
    pub misplaced: f64,
    /// Kinetic energy at its start that it does not use up until the turning point at its end, J.
    pub missed: f64,
    /// How far the kinetic energy on it may be off, J; beside a turning point, as part of the energy there.
    pub off: f64,
}

/// What is found when a panel is tried.
pub(in crate::engine) enum Tried {
    /// The series have converged; how far the kinetic energy at the end is off because angles are rounded, J.
    Done(Box<Panel>, f64),
    /// The coefficients have not decayed: a shorter panel is needed.
    Unresolved,
    /// The kinetic energy vanishes this far from the start, before the end, rad with sign.
    TurnsAfter(f64),
}

/// Where the kinetic energy of a piece is known, and how far it may be off there, J.
#[derive(Clone, Copy, Debug)]
pub(in crate::engine) enum Uncertain {
    /// At its start: elsewhere the rounding on the piece is added.
    AtStart(f64),
    /// At the turning point at its end, which is known by itself.
    AtTurn(f64),
}

impl Panel {
    /// Tries a panel with the kinetic energy `kinetic` (J) at its start; `tolerance` is the tail that counts
    /// as converged, `uncertain` what the kinetic energy may be off.
    pub fn attempt(
        profile: &dyn Profile,
        piece: Piece,
        kinetic: f64,
        tolerance: f64,
        uncertain: Uncertain,
    ) -> Result<Tried, NotApplicable> {
        let rule = Rule::of(DEGREE);
        let (mut inertia, mut force) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
        let angles = rule.values(|x| piece.angle(x));
        profile.tabulate(&angles, DEGREE + 1, &mut inertia, &mut force);
        let known = |values: &Values| values.iter().all(|value| value.is_finite());
        if !known(&inertia) || !known(&force) {
            return Err(NotApplicable::NotFinite);
        }
        // Only next to a balance, where panels are short, may forces be small differences of large ones.
        let near_balance = piece.span().abs() < NEAR_BALANCE;
        let rounding = if near_balance {
            profile.rounding(piece.from)
        } else {
            0.0
        };
        let series = rule.series(&force);
        let energy = Energy {
            piece,
            kinetic,
            rule,
            force: &series,
        };
        let noise = Noise::of(&energy, &inertia, &force, rounding);
        if !energy.is_resolved(tolerance, noise.force) {
            return Ok(Tried::Unresolved);
        }
        let kinetic: Values = match piece.turning {
            Turning::Nowhere => energy.kinetic_at_points(&force),
            _ => rule.values(|x| energy.mean_force(x)),
        };
        if piece.turning != Turning::AtEnd
            && let Some(j) = kinetic.iter().position(|k| *k <= 0.0)
        {
            return Ok(energy.turns_before(j));
        }
        let span = piece.span().abs();
        let slopes: Values = std::array::from_fn(|j| match piece.turning {
            Turning::Nowhere => 0.5 * span * (0.5 * inertia[j] / kinetic[j]).sqrt(),
            _ => 0.5 * (span * inertia[j] / kinetic[j].abs()).sqrt(),
        });
        if !slopes.iter().all(|slope| slope.is_finite()) {
            return Ok(Tried::Unresolved);
        }
        let slope = rule.series(&slopes);
        let tail = slope.tail();
        if tail > tolerance.max(noise.slope) {
            return Ok(Tried::Unresolved);
        }
        let steep = TimeSensitivity::of(&piece, &force, rounding);
        let missed = match piece.turning {
            Turning::AtEnd => energy.kinetic + 2.0 * span * kinetic[0],
            _ => 0.0,
        };
        let off = match uncertain {
            Uncertain::AtStart(off) => (off + steep.energy).hypot(missed),
            Uncertain::AtTurn(off) => off,
        };
        let shaken = shaken(&energy, &steep, &slopes, &kinetic, off);
        let kinetic_at_end = match piece.turning {
            Turning::Nowhere => kinetic[DEGREE],
            Turning::AtStart => 2.0 * piece.span().abs() * energy.mean_force(1.0),
            Turning::AtEnd => 0.0,
        };
        let panel = Panel {
            misplaced: steep.misplaced(&piece, off),
            missed,
            off: match piece.turning {
                Turning::Nowhere => off,
                Turning::AtStart => off / kinetic_at_end,
                Turning::AtEnd => off / energy.kinetic,
            },
            ..Panel::from_slopes(piece, rule, &slopes, slope, shaken, kinetic_at_end)
        };
        Ok(Tried::Done(Box::new(panel), steep.energy))
    }

    /// A panel from dt/dx at the points of a rule and its series, the relative error of dt/dx by rounding, and
    /// the kinetic energy (J) at its end.
    pub fn from_slopes(
        piece: Piece,
        rule: &'static Rule,
        slopes: &Values,
        slope: Series,
        shaken: f64,
        kinetic_at_end: f64,
    ) -> Panel {
        let duration = rule.integral(slopes);
        let tail = slope.tail();
        // What the series leaves out alternates: over the whole panel its integral is smaller by the square of the
        // degree (that of the polynomial T_k is 2/(k² − 1)), for all terms that follow.
        let uncertain = 8.0 * tail / (rule.degree() as f64).powi(2) + shaken;
        Panel {
            piece,
            turns: 0.0,
            extremes: extremes(&piece, rule, slopes),
            rule,
            slope,
            duration,
            kinetic_at_end,
            error: uncertain * duration.0,
            tail,
            misplaced: 0.0,
            missed: 0.0,
            off: 0.0,
        }
    }

    /// Panels over the same piece, blended by shares whose sum is one; its durations are right to rounding of the
    /// sum, its extremes those of the points.
    pub fn blend<'a>(panels: impl Iterator<Item = (&'a Panel, f64)> + Clone) -> Option<Panel> {
        let (first, _) = panels.clone().next()?;
        let slope = Series::blend(panels.clone().map(|(panel, share)| (&panel.slope, share)));
        let sum = |of: fn(&Panel) -> f64| -> f64 {
            panels.clone().map(|(panel, share)| share * of(panel)).sum()
        };
        let slopes = first.rule.values(|x| slope.value(x));
        Some(Panel {
            slope,
            duration: (sum(|panel| panel.duration.0), sum(|panel| panel.duration.1)),
            kinetic_at_end: sum(|panel| panel.kinetic_at_end),
            extremes: extremes(&first.piece, first.rule, &slopes),
            ..first.clone()
        })
    }

    /// What the series leaves out of the time inside the panel, s.
    pub fn left_out(&self) -> f64 {
        self.tail / self.rule.degree() as f64 * self.duration.0
    }

    /// What the series leaves out of the speed a time `after` its start (s), relative to it: the more the smaller dt/dx
    /// is there.
    pub fn left_out_of_speed(&self, after: f64) -> f64 {
        let here = self.slope.value(self.position(after)).abs();
        self.tail * self.slope.largest() / here
    }

    /// Angle and speed a time `after` its start, rad and rad/s; the sign of the speed is that of the panel.
    pub fn state(&self, after: f64) -> (f64, f64) {
        let x = self.position(after);
        (self.piece.angle(x), self.speed(x))
    }

    /// The variable x, from −1 to 1, at a time (s) after the start: Newton, kept inside its bracket.
    pub fn position(&self, after: f64) -> f64 {
        let total = self.duration.0;
        if after <= 0.0 {
            return -1.0;
        }
        if after >= total {
            return 1.0;
        }
        let time = self.slope.integral();
        let (mut low, mut high) = (-1.0, 1.0);
        let mut x = 2.0 * after / total - 1.0;
        for _ in 0..60 {
            let excess = time.value(x) - after;
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let newton = x - excess / self.slope.value(x);
            let next = if newton >= low && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            let change = (next - x).abs();
            x = next;
            // A step of Newton squares what is left.
            if change <= 1e-10 && next == newton {
                break;
            }
        }
        x
    }

    /// Time after the start, s.
    pub(super) fn time(&self, x: f64) -> f64 {
        self.slope.integral().value(x)
    }

    /// Crank speed, rad/s.
    pub(super) fn speed(&self, x: f64) -> f64 {
        self.piece.stretch(x) / self.slope.value(x)
    }

    /// Time of an angle, and the speed there.
    pub(super) fn at(&self, theta: f64) -> (f64, f64) {
        let x = self.piece.variable(theta);
        (self.time(x), self.speed(x))
    }
}

/// What errors of the kinetic energy make of the duration of a panel, relative to it. `slopes` and `kinetic` are dt/dx
/// and the kinetic energy (J) at the points, `off` (J) what it may be off.
fn shaken(
    energy: &Energy<'_>,
    steep: &TimeSensitivity,
    slopes: &Values,
    kinetic: &Values,
    off: f64,
) -> f64 {
    let (piece, rule) = (&energy.piece, energy.rule);
    let left_out = energy.left_out();
    match piece.turning {
        Turning::Nowhere => {
            // dT/dK is the integral of dt/2K.
            let early: Values = std::array::from_fn(|j| 0.5 * slopes[j] / kinetic[j]);
            let least = kinetic.iter().fold(f64::INFINITY, |m, k| m.min(*k));
            off * rule.rounded_integral(&early) / rule.rounded_integral(slopes) + left_out / least
        }
        Turning::AtStart => steep.at_turn(piece, f64::INFINITY, off),
        Turning::AtEnd => steep.at_turn(piece, energy.kinetic, off) + left_out / energy.kinetic,
    }
}
