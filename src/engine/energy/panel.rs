//! One panel: dt/dθ and t as series over a piece of the angle.

use super::kinetic::Energy;
use super::piece::{Piece, Turning};
use super::{Profile, Unserved};
use crate::numeric::chebyshev::{self, DEGREE, POINTS, Values};
use crate::numeric::{exact, root};

/// A piece with its series.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Panel {
    pub piece: Piece,
    /// Whole turns to be added to its angles.
    pub turns: f64,
    /// dt/dx
    slope: Values,
    /// Its duration, s: rounded value and rest.
    pub duration: (f64, f64),
    /// Kinetic energy at its end, J.
    pub kinetic_at_end: f64,
    /// Bound of the error of its duration, s.
    pub error: f64,
    /// Slowest and fastest of its points, with their |speed|.
    extremes: [(usize, f64); 2],
}

/// What is found when a panel is tried.
pub(in crate::engine) enum Tried {
    /// The series have converged.
    Done(Box<Panel>),
    /// They have not: a shorter one is needed.
    Unresolved,
    /// The kinetic energy vanishes at this angle, before the end.
    TurnsAt(f64),
}

impl Panel {
    /// Tries a panel with the kinetic energy `kinetic` (J) at its start; `tolerance` is the tail that counts
    /// as converged, `rounding` (J) what the kinetic energy may be off.
    pub fn attempt(
        profile: &dyn Profile,
        piece: Piece,
        kinetic: f64,
        tolerance: f64,
        rounding: f64,
    ) -> Result<Tried, Unserved> {
        let points = chebyshev::points();
        let (mut inertia, mut force) = ([0.0; POINTS], [0.0; POINTS]);
        for j in 0..POINTS {
            (inertia[j], force[j]) = profile.inertia_and_force(piece.angle(points[j]));
            if !inertia[j].is_finite() || !force[j].is_finite() {
                return Err(Unserved::NotFinite);
            }
        }
        // Angles are rounded, which the series of a short panel sees as noise.
        let noise = 8.0 * f64::EPSILON * (1.0 + piece.from.abs() / piece.span().abs());
        let accepted = tolerance.max(noise);
        let series = chebyshev::coefficients(&force);
        let energy = Energy {
            piece,
            kinetic,
            force: &series,
        };
        if !energy.is_resolved(accepted) {
            return Ok(Tried::Unresolved);
        }
        let kinetic: Values = match piece.turning {
            Turning::Nowhere => energy.kinetic_at_points(&force),
            _ => std::array::from_fn(|j| energy.mean_force(points[j])),
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
        let slope = chebyshev::coefficients(&slopes);
        let tail = chebyshev::tail(&slope);
        if tail > accepted {
            return Ok(Tried::Unresolved);
        }
        let duration = duration(&slopes);
        let least = match piece.turning {
            Turning::Nowhere => kinetic.iter().fold(f64::INFINITY, |m, k| m.min(*k)),
            Turning::AtStart => f64::INFINITY,
            Turning::AtEnd => energy.kinetic,
        };
        Ok(Tried::Done(Box::new(Panel {
            piece,
            turns: 0.0,
            extremes: extremes(&piece, &slopes),
            slope,
            duration,
            kinetic_at_end: match piece.turning {
                Turning::Nowhere => kinetic[DEGREE],
                Turning::AtStart => 2.0 * piece.span().abs() * energy.mean_force(1.0),
                Turning::AtEnd => 0.0,
            },
            error: (tail + shaken(rounding / least)) * duration.0,
        })))
    }

    /// A panel from dt/dx at the points and its coefficients.
    pub fn from_slopes(
        piece: Piece,
        slopes: &Values,
        slope: Values,
        tail: f64,
        kinetic: f64,
    ) -> Panel {
        let duration = duration(slopes);
        Panel {
            piece,
            turns: 0.0,
            extremes: extremes(&piece, slopes),
            slope,
            duration,
            kinetic_at_end: kinetic,
            error: tail * duration.0,
        }
    }

    /// Angle and speed a time `after` its start, rad and rad/s; the sign of the speed is that of the panel.
    pub fn state(&self, after: f64) -> (f64, f64) {
        let x = self.position(after);
        (self.piece.angle(x), self.speed(x))
    }

    /// The variable x at a time after the start: Newton, kept inside its bracket.
    pub fn position(&self, after: f64) -> f64 {
        let total = self.duration.0;
        if after <= 0.0 {
            return -1.0;
        }
        if after >= total {
            return 1.0;
        }
        let time = chebyshev::integral(&self.slope);
        let (mut low, mut high) = (-1.0, 1.0);
        let mut x = 2.0 * after / total - 1.0;
        for _ in 0..60 {
            let excess = chebyshev::value(&time, x) - after;
            if excess > 0.0 {
                high = x;
            } else {
                low = x;
            }
            let newton = x - excess / chebyshev::value(&self.slope, x);
            let next = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            let change = (next - x).abs();
            x = next;
            if change <= 2.0 * f64::EPSILON {
                break;
            }
        }
        x
    }

    fn speed(&self, x: f64) -> f64 {
        self.piece.stretch(x) / chebyshev::value(&self.slope, x)
    }

    /// Time after the start at which an angle of the panel is reached.
    pub fn time_of(&self, theta: f64) -> f64 {
        let time = chebyshev::integral(&self.slope);
        chebyshev::value(&time, self.piece.variable(theta))
    }

    /// Largest speed·sign among the points, where `sign` is +1 or −1, with |speed| for speed.
    pub fn extreme_at_points(&self, sign: f64) -> f64 {
        sign * self.extremes[usize::from(sign > 0.0)].1
    }

    /// The same between the points.
    pub fn extreme(&self, sign: f64) -> f64 {
        let (index, _) = self.extremes[usize::from(sign > 0.0)];
        self.extreme_near(chebyshev::points(), index, sign)
    }

    /// Largest sign·|speed| near one of some points: there, or next to it where the derivative of the speed
    /// vanishes.
    fn extreme_near(&self, points: &Values, index: usize, sign: f64) -> f64 {
        let from = points[index.saturating_sub(1)];
        let to = points[(index + 1).min(DEGREE)];
        let bend = chebyshev::derivative(&self.slope);
        let stretch_rate = self.piece.stretch_rate();
        // Speed is stretch/slope.
        let rate = |x: f64| {
            stretch_rate * chebyshev::value(&self.slope, x)
                - self.piece.stretch(x) * chebyshev::value(&bend, x)
        };
        let at_point = sign * self.speed(points[index]).abs();
        root::bracketed(rate, from, to)
            .map_or(at_point, |x| at_point.max(sign * self.speed(x).abs()))
    }

    /// Largest sign·|speed| until a time after the start.
    pub fn extreme_until(&self, until: f64, sign: f64) -> f64 {
        let share = 0.5 * (1.0 + self.position(until));
        let points = chebyshev::points().map(|x| share * (1.0 + x) - 1.0);
        let value = |index: &usize| sign * self.speed(points[*index]).abs();
        let best = (0..POINTS).max_by(|a, b| value(a).total_cmp(&value(b)));
        self.extreme_near(&points, best.unwrap_or(0), sign)
    }
}

/// Relative error of the time if the kinetic energy is off by this part of itself; near an unstable rest, where
/// that part is large, the place of the turning point is off too.
fn shaken(part: f64) -> f64 {
    if part > 100.0 * f64::EPSILON {
        16.0 * part
    } else {
        0.5 * part
    }
}

/// Slowest and fastest of the points with their |speed|, from dt/dx there.
fn extremes(piece: &Piece, slopes: &Values) -> [(usize, f64); 2] {
    let speed = |j: usize| (piece.stretch(chebyshev::points()[j]) / slopes[j]).abs();
    let mut found = [(0, speed(0)); 2];
    for j in 1..POINTS {
        let here = speed(j);
        if here < found[0].1 {
            found[0] = (j, here);
        }
        if here > found[1].1 {
            found[1] = (j, here);
        }
    }
    found
}

/// ∫ dt/dx by Clenshaw and Curtis, summed without rounding loss.
pub(in crate::engine) fn duration(slopes: &Values) -> (f64, f64) {
    let (mut sum, mut rest) = (0.0, 0.0);
    for (weight, slope) in chebyshev::weights().iter().zip(slopes) {
        let (next, lost) = exact::two_sum(sum, weight * slope);
        sum = next;
        rest += lost;
    }
    exact::two_sum(sum, rest)
}
