//! One panel: dt/dθ and t as series over a piece of the angle.

use super::kinetic::Energy;
use super::piece::{Piece, Turning};
use super::{Profile, Unserved};
use crate::numeric::chebyshev::{self, DEGREE, POINTS, Values};
use crate::numeric::exact;

/// A piece with its series.
#[derive(Clone, Debug)]
pub(in crate::engine) struct Panel {
    pub piece: Piece,
    /// Whole turns to be added to its angles.
    pub turns: f64,
    /// dt/dx
    slope: Values,
    /// Time since the start of the panel.
    time: Values,
    /// Its duration, s: rounded value and rest.
    pub duration: (f64, f64),
    /// Kinetic energy at its end, J.
    pub kinetic_at_end: f64,
    /// Bound of the error of its duration, s.
    pub error: f64,
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
            time: chebyshev::integral(&slope),
            slope,
            duration,
            kinetic_at_end: match piece.turning {
                Turning::Nowhere => kinetic[DEGREE],
                Turning::AtStart => 2.0 * piece.span().abs() * energy.mean_force(1.0),
                Turning::AtEnd => 0.0,
            },
            error: (tail + 0.5 * rounding / least) * duration.0,
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
            time: chebyshev::integral(&slope),
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
        let (mut low, mut high) = (-1.0, 1.0);
        let mut x = 2.0 * after / total - 1.0;
        for _ in 0..60 {
            let excess = chebyshev::value(&self.time, x) - after;
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
        chebyshev::value(&self.time, self.piece.variable(theta))
    }

    /// Smallest and largest |speed| until a time after the start: at points, then by golden section around
    /// them.
    pub fn speed_range(&self, until: f64) -> (f64, f64) {
        let share = 0.5 * (1.0 + self.position(until));
        let points = chebyshev::points().map(|x| share * (1.0 + x) - 1.0);
        let extreme = |sign: f64| {
            let value = |x: f64| sign * self.speed(x).abs();
            let best = (0..POINTS)
                .max_by(|a, b| value(points[*a]).total_cmp(&value(points[*b])))
                .unwrap_or(0);
            let (mut a, mut b) = (
                points[best.saturating_sub(1)],
                points[(best + 1).min(DEGREE)],
            );
            let mut found = value(points[best]);
            for _ in 0..40 {
                let (c, d) = (
                    b - 0.618_033_988_75 * (b - a),
                    a + 0.618_033_988_75 * (b - a),
                );
                let (at_c, at_d) = (value(c), value(d));
                found = found.max(at_c).max(at_d);
                if at_c > at_d { b = d } else { a = c }
            }
            sign * found
        };
        (extreme(-1.0), extreme(1.0))
    }
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
