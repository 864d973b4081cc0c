//! One turn at any kinetic energy, from tabulated inertia and work.

use super::panel::Panel;
use super::piece::{KineticState, Piece, turn_remainder};
use super::profile::Profile;
use super::segment::{After, Segment};
use crate::numeric::chebyshev::{MAX_DEGREE, Rule, SERIES_ROUNDING, Values};
use crate::numeric::exact::two_sum;

/// Panel with inertia (kg m²) and work since the start of the turn (J) at its points.
#[derive(Clone, Debug)]
struct TabulatedPanel {
    piece: Piece,
    inertia: Values,
    work: Values,
}

/// Panels of a turn, fine enough for all kinetic energies from the one for which it was made.
#[derive(Clone, Debug)]
pub(in crate::engine) struct OneTurn {
    panels: Vec<TabulatedPanel>,
    /// Part of a whole turn that the rounded angles of its ends leave out, rad.
    turn_remainder: f64,
    /// Bound of the relative error of the duration.
    pub error: f64,
}

impl OneTurn {
    /// Makes the turn from a state; none if the crank does not complete it, or only just.
    pub fn new(profile: &dyn Profile, begin: KineticState) -> Option<OneTurn> {
        // Truncation errors add up over the turns.
        let segment = Segment::build(profile, begin, f64::INFINITY, SERIES_ROUNDING, 1.0).ok()?;
        if segment.after != After::GoesOn {
            return None;
        }
        let rule = Rule::of(MAX_DEGREE);
        let mut done = 0.0;
        let panels = segment.panels.iter().map(|&Panel { piece, .. }| {
            let [inertia, force] = profile.on_piece(&piece);
            let half = 0.5 * piece.span;
            let work = rule.integrals(&force).map(|work| done + half * work);
            done = work[MAX_DEGREE];
            TabulatedPanel {
                piece,
                inertia,
                work,
            }
        });
        Some(OneTurn {
            panels: panels.collect(),
            turn_remainder: turn_remainder(begin.angle, begin.direction),
            error: segment.error / segment.duration.0,
        })
    }

    /// Returns the least kinetic energy in the turn, J.
    pub fn least(&self, kinetic: f64) -> f64 {
        let works = self.panels.iter().flat_map(|panel| &panel.work);
        kinetic + works.fold(f64::INFINITY, |least, work| least.min(*work))
    }

    /// Returns the largest magnitude of the work done in the turn, J.
    pub fn largest_work(&self) -> f64 {
        let works = self.panels.iter().flat_map(|panel| &panel.work);
        works.fold(0.0, |largest, work| largest.max(work.abs()))
    }

    /// Returns the duration of the turn, s.
    pub fn duration(&self, kinetic: f64) -> f64 {
        let rule = Rule::of(MAX_DEGREE);
        let first = &self.panels[0];
        let mut rest = self.turn_remainder * (0.5 * first.inertia[0] / kinetic).sqrt();
        let mut sum = 0.0;
        for panel in &self.panels {
            let (duration, lost) = rule.integral(&panel.slopes(kinetic));
            let (next, lost_here) = two_sum(sum, duration);
            sum = next;
            rest += lost + lost_here;
        }
        sum + rest
    }

    /// Computes the motion in the turn at a kinetic energy, J.
    pub fn segment(&self, kinetic: f64) -> Segment {
        let mut segment = Segment::open();
        for panel in &self.panels {
            segment.push(panel.at(kinetic));
        }
        segment
    }
}

impl TabulatedPanel {
    /// Computes dt/dx at the points, s.
    fn slopes(&self, kinetic: f64) -> Values {
        let half = 0.5 * self.piece.span.abs();
        std::array::from_fn(|j| half * (0.5 * self.inertia[j] / (kinetic + self.work[j])).sqrt())
    }

    /// Computes the motion on the panel for a kinetic energy at the start of the turn, J.
    fn at(&self, kinetic: f64) -> Panel {
        let rule = Rule::of(MAX_DEGREE);
        let slopes = self.slopes(kinetic);
        let end = kinetic + self.work[MAX_DEGREE];
        Panel::from_slopes(self.piece, rule, &slopes, rule.series(&slopes), 0.0, end)
    }
}
