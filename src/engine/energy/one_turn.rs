//! One turn at any kinetic energy: what depends on the position alone is tabulated once.

use super::build::Begin;
use super::panel::{DEGREE, Panel};
use super::piece::{Piece, missing};
use super::profile::Profile;
use super::segment::{After, Segment};
use crate::numeric::chebyshev::{ROUNDING, Rule, Values};
use crate::numeric::exact::two_sum;

/// A panel with inertia (kg m²) and work since the start of the turn (J) at its points.
#[derive(Clone, Debug)]
struct Station {
    piece: Piece,
    inertia: Values,
    work: Values,
}

/// The panels of a turn, fine enough for the least energy that it was made for and for all above.
#[derive(Clone, Debug)]
pub(in crate::engine) struct OneTurn {
    stations: Vec<Station>,
    /// What the floats for its ends lack of a whole turn, rad.
    missing: f64,
    /// Bound of the relative error of its duration.
    pub error: f64,
}

impl OneTurn {
    /// None if the crank does not complete the turn with the kinetic energy `kinetic` (J) at its start, or only
    /// just.
    pub fn new(profile: &dyn Profile, start: f64, direction: f64, kinetic: f64) -> Option<OneTurn> {
        let until = f64::INFINITY;
        let begin = Begin {
            start,
            direction,
            kinetic,
            off: 0.0,
        };
        // What series leave out adds up over the turns.
        let segment = Segment::build(profile, begin, until, ROUNDING, 1.0).ok()?;
        if segment.after != After::GoesOn {
            return None;
        }
        let rule = Rule::of(DEGREE);
        let mut done = 0.0;
        let stations = segment.pieces().map(|piece| {
            let (mut inertia, mut force) = ([0.0; DEGREE + 1], [0.0; DEGREE + 1]);
            let angles = rule.values(|x| piece.angle(x));
            profile.tabulate(&angles, DEGREE + 1, &mut inertia, &mut force);
            let half = 0.5 * piece.span();
            let work = rule.integrals(&force).map(|work| done + half * work);
            done = work[DEGREE];
            Station {
                piece,
                inertia,
                work,
            }
        });
        Some(OneTurn {
            stations: stations.collect(),
            missing: missing(start, direction),
            error: segment.error / segment.duration.0,
        })
    }

    /// Least kinetic energy on the turn, J.
    pub fn least(&self, kinetic: f64) -> f64 {
        let works = self.stations.iter().flat_map(|station| &station.work);
        kinetic + works.fold(f64::INFINITY, |least, work| least.min(*work))
    }

    /// The largest work done in it, as a magnitude, J.
    pub fn largest_work(&self) -> f64 {
        let works = self.stations.iter().flat_map(|station| &station.work);
        works.fold(0.0, |largest, work| largest.max(work.abs()))
    }

    /// How long it takes, s.
    pub fn duration(&self, kinetic: f64) -> f64 {
        let rule = Rule::of(DEGREE);
        let first = &self.stations[0];
        let mut rest = self.missing * (0.5 * first.inertia[0] / kinetic).sqrt();
        let mut sum = 0.0;
        for station in &self.stations {
            let (duration, lost) = rule.integral(&station.slopes(kinetic));
            let (next, lost_here) = two_sum(sum, duration);
            sum = next;
            rest += lost + lost_here;
        }
        sum + rest
    }

    /// Motion of the turn at a kinetic energy, J.
    pub fn segment(&self, kinetic: f64) -> Segment {
        let mut segment = Segment::open();
        for station in &self.stations {
            segment.push(station.panel(kinetic));
        }
        segment
    }
}

impl Station {
    /// dt/dx at the points.
    fn slopes(&self, kinetic: f64) -> Values {
        let half = 0.5 * self.piece.span().abs();
        std::array::from_fn(|j| half * (0.5 * self.inertia[j] / (kinetic + self.work[j])).sqrt())
    }

    fn panel(&self, kinetic: f64) -> Panel {
        let rule = Rule::of(DEGREE);
        let slopes = self.slopes(kinetic);
        let end = kinetic + self.work[DEGREE];
        Panel::from_slopes(self.piece, rule, &slopes, rule.series(&slopes), 0.0, end)
    }
}
