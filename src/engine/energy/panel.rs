//! One panel: dt/dθ and t as series over a piece of the angle.

use super::{Profile, Unserved};
use crate::numeric::chebyshev::{self, DEGREE, POINTS, Values};
use crate::numeric::{exact, root};

/// Which end of a panel is a turning point, where dt/dθ is infinite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::engine) enum Turning {
    Nowhere,
    AtStart,
    AtEnd,
}

/// A piece of the motion between two angles, in a variable x in [−1, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::engine) struct Piece {
    /// rad
    pub from: f64,
    /// rad, in either direction
    pub to: f64,
    pub turning: Turning,
}

impl Piece {
    fn span(&self) -> f64 {
        self.to - self.from
    }

    pub fn angle(&self, x: f64) -> f64 {
        match self.turning {
            Turning::Nowhere => self.from + 0.5 * (1.0 + x) * self.span(),
            Turning::AtStart => self.from + 0.25 * (1.0 + x) * (1.0 + x) * self.span(),
            Turning::AtEnd => self.to - 0.25 * (1.0 - x) * (1.0 - x) * self.span(),
        }
    }

    /// dθ/dx
    fn stretch(&self, x: f64) -> f64 {
        let share = match self.turning {
            Turning::Nowhere => 0.5,
            Turning::AtStart => 0.5 * (1.0 + x),
            Turning::AtEnd => 0.5 * (1.0 - x),
        };
        share * self.span()
    }

    /// The variable x of an angle of the piece.
    fn variable(&self, theta: f64) -> f64 {
        let share = ((theta - self.from) / self.span()).clamp(0.0, 1.0);
        match self.turning {
            Turning::Nowhere => 2.0 * share - 1.0,
            Turning::AtStart => 2.0 * share.sqrt() - 1.0,
            Turning::AtEnd => 1.0 - 2.0 * (1.0 - share).sqrt(),
        }
    }
}

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

/// The kinetic energy on a piece, from the series of the force. It is integrated from the piece's own start
/// or end, never a difference of large potentials.
struct Energy<'a> {
    piece: Piece,
    /// At the start, J.
    kinetic: f64,
    force: &'a Values,
}

impl Energy<'_> {
    /// Whether the force's error hardly counts, relative to the force or to the energy.
    fn is_resolved(&self, accepted: f64) -> bool {
        let largest = self.force.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let share = match self.piece.turning {
            Turning::Nowhere => (largest * self.piece.span().abs() / self.kinetic).min(1.0),
            _ => 1.0,
        };
        chebyshev::tail(self.force) * share <= 4.0 * accepted
    }

    /// K at the points of a piece that does not turn: K at its start plus the integral of the force.
    fn kinetic_at_points(&self, force: &Values) -> Values {
        if force.iter().all(|f| *f == 0.0) {
            return [self.kinetic; POINTS];
        }
        let work = chebyshev::integral(self.force);
        let half = 0.5 * self.piece.span();
        chebyshev::points().map(|x| self.kinetic + half * chebyshev::value(&work, x))
    }

    /// ∫ F u du over [0, 1] between the turning end (u = 0) and x (u = 1), times the direction: there
    /// K = ½ span (1 ± x)² times this, without cancellation. Gauss-Legendre with 14 points is exact for the
    /// series.
    fn mean_force(&self, x: f64) -> f64 {
        let sum: f64 = gauss_14()
            .iter()
            .map(|(u, weight)| {
                let at = match self.piece.turning {
                    Turning::AtEnd => 1.0 - u * (1.0 - x),
                    _ => u * (1.0 + x) - 1.0,
                };
                weight * u * chebyshev::value(self.force, at)
            })
            .sum();
        sum * self.piece.span().signum()
    }

    /// The turning point just before the point `j`, at which the energy is not positive.
    fn turns_before(&self, j: usize) -> Tried {
        let points = chebyshev::points();
        if j == 0 {
            return Tried::Unresolved;
        }
        let work = chebyshev::integral(self.force);
        let half = 0.5 * self.piece.span();
        let x = root::bracketed(
            |x| match self.piece.turning {
                Turning::Nowhere => self.kinetic + half * chebyshev::value(&work, x),
                _ => self.mean_force(x),
            },
            points[j - 1],
            points[j],
        );
        match x {
            Some(x) if x > -1.0 => Tried::TurnsAt(self.piece.angle(x)),
            _ => Tried::Unresolved,
        }
    }
}

/// Nodes and weights of the Gauss-Legendre rule with 14 points on [0, 1].
fn gauss_14() -> &'static [(f64, f64); 14] {
    static RULE: std::sync::OnceLock<[(f64, f64); 14]> = std::sync::OnceLock::new();
    RULE.get_or_init(|| std::array::from_fn(|i| crate::numeric::gauss::legendre(14, i)))
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
