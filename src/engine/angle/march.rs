//! Panel after panel, turn after turn.

use super::station::{Fineness, Station, stations};
use super::sweep::{Start, Swept, sweep};
use super::{Driven, Resolution};
use crate::engine::energy::Unserved;
use crate::engine::energy::panel::Panel;
use crate::numeric::angle::Angle;
use crate::numeric::chebyshev::Values;
use crate::numeric::exact::two_sum;

/// With less than this part of the largest kinetic energy the crank is near to rest.
const SLOW: f64 = 1e-2;
/// Panels of a crank near to rest are not cut below this, rad.
const SHORT: f64 = 1e-3;

/// A run over the angle: the panels of a turn, and where it has come to.
#[derive(Clone)]
pub(super) struct March<'a, D: Driven> {
    driven: &'a D,
    fine: Fineness,
    direction: f64,
    stations: Vec<Station<D::Place>>,
    /// Parts of a panel that was too long this time, the next one last.
    parts: Vec<Station<D::Place>>,
    next: usize,
    /// The motion on the last panel.
    swept: Swept,
    /// s, rounded value and rest
    pub t: (f64, f64),
    /// J
    pub kinetic: f64,
    /// Whole turns since the start, with sign.
    pub turns: f64,
    /// Kinetic energy gained, J.
    pub gain: f64,
    /// Work of the loads without a potential, J.
    pub work: f64,
    pub evaluations: u64,
    fastest: f64,
    start: Angle,
    most_evaluations: u64,
    /// Whether a panel was cut or its degree raised since this was last cleared.
    pub refined: bool,
}

/// A panel with the work that was done on it.
pub(super) struct Done {
    pub panel: Panel,
    /// Force without a potential at the points of the panel, N m.
    pub spent: Values,
    /// Work of these forces on it, J.
    pub work: f64,
}

impl<'a, D: Driven> March<'a, D> {
    pub fn new(
        driven: &'a D,
        start: Angle,
        speed: f64,
        resolution: Resolution,
    ) -> Result<March<'a, D>, Unserved> {
        let fine = Fineness {
            tail: resolution.tail,
            speed,
        };
        let mut stations = stations(driven, start.rest, fine)?;
        if resolution.other {
            let mut cut = Vec::with_capacity(2 * stations.len());
            for station in stations {
                match station.parts(driven, 0.37, fine)? {
                    Some(parts) => cut.extend(parts),
                    None => cut.push(station),
                }
            }
            stations = cut;
        }
        let kinetic = 0.5 * stations[0].table.inertia[0] * speed * speed;
        if !kinetic.is_finite() {
            return Err(Unserved::NotFinite);
        }
        if kinetic == 0.0 {
            return Err(Unserved::TooSlow);
        }
        Ok(March {
            driven,
            fine,
            direction: speed.signum(),
            stations,
            parts: Vec::new(),
            next: 0,
            swept: Swept::new(),
            t: (0.0, 0.0),
            kinetic,
            turns: 0.0,
            gain: 0.0,
            work: 0.0,
            evaluations: 0,
            fastest: kinetic,
            start,
            most_evaluations: resolution.most_evaluations,
            refined: false,
        })
    }

    /// The same panels, at the start of a turn with another kinetic energy, J.
    pub fn restart(&mut self, kinetic: f64) {
        self.parts.clear();
        self.next = 0;
        self.t = (0.0, 0.0);
        self.kinetic = kinetic;
        self.fastest = kinetic;
        self.turns = 0.0;
        self.gain = 0.0;
        self.work = 0.0;
        self.refined = false;
    }

    /// Whether the kinetic energy has risen over the run.
    pub fn rises(&self) -> bool {
        self.gain > 0.0
    }

    /// Largest kinetic energy at the ends of panels so far, J.
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Whether the next panel begins a turn.
    pub fn at_turn(&self) -> bool {
        self.next == 0 && self.parts.is_empty()
    }

    /// The next panel.
    pub fn panel(&mut self) -> Result<Done, Unserved> {
        loop {
            if self.evaluations > self.most_evaluations {
                return Err(Unserved::WorkLimit);
            }
            let start = Start {
                t: self.t.0,
                kinetic: self.kinetic,
                turns: self.start.turns + self.turns,
                direction: self.direction,
            };
            let station = self
                .parts
                .last_mut()
                .unwrap_or(&mut self.stations[self.next]);
            if sweep(self.driven, station, start, self.fine.tail, &mut self.swept).is_some() {
                station.remember(&self.swept.kinetic);
                return Ok(self.pass());
            }
            self.refine()?;
        }
    }

    fn pass(&mut self) -> Done {
        let station = self.parts.last().unwrap_or(&self.stations[self.next]);
        let (piece, rule, swept) = (station.piece, station.rule, &self.swept);
        let work = station.half() * rule.rounded_integral(swept.spent());
        self.kinetic = swept.end;
        self.gain += swept.gain;
        self.fastest = self.fastest.max(self.kinetic);
        self.work += work;
        self.evaluations += swept.evaluations;
        let (slopes, slope) = (&swept.slopes, swept.slope);
        let mut panel = Panel::from_slopes(piece, rule, slopes, slope, 0.0, self.kinetic);
        panel.turns = self.turns;
        let (sum, lost) = two_sum(self.t.0, panel.duration.0);
        self.t = two_sum(sum, lost + self.t.1 + panel.duration.1);
        if self.parts.pop().is_none() || self.parts.is_empty() {
            self.next += 1;
            if self.next == self.stations.len() {
                self.next = 0;
                self.turns += self.direction;
            }
        }
        Done {
            panel,
            spent: *self.swept.spent(),
            work,
        }
    }

    /// Raises the degree of the next panel, or cuts it: for this turn, and for all if it happens again.
    fn refine(&mut self) -> Result<(), Unserved> {
        self.refined = true;
        let for_now = !self.parts.is_empty();
        let station = self
            .parts
            .last_mut()
            .unwrap_or(&mut self.stations[self.next]);
        if station.raise(self.driven)? {
            return Ok(());
        }
        let slow = self.kinetic < SLOW * self.fastest;
        if slow && station.half().abs() < SHORT {
            return Err(Unserved::TooSlow);
        }
        let Some([first, second]) = station.parts(self.driven, 0.5, self.fine)? else {
            return Err(if slow {
                Unserved::TooSlow
            } else {
                Unserved::NotSmooth
            });
        };
        if for_now {
            self.parts.pop();
            self.parts.extend([second, first]);
        } else if station.failed {
            self.stations.splice(self.next..=self.next, [first, second]);
        } else {
            station.failed = true;
            self.parts.extend([second, first]);
        }
        Ok(())
    }

    /// Cuts every panel that failed for good.
    pub fn settle(&mut self) -> Result<(), Unserved> {
        let stations = std::mem::take(&mut self.stations);
        for station in stations {
            let parts = if station.failed {
                station.parts(self.driven, 0.5, self.fine)?
            } else {
                None
            };
            match parts {
                Some(parts) => self.stations.extend(parts),
                None => self.stations.push(station),
            }
        }
        Ok(())
    }
}
