//! What is looked for in the steps of a crank in time: dead centres, turning points, and where the run ends.

use super::bounded_motion::Swing;
use super::recorder::{Coordinate, Recorder};
use super::result::Event;
use super::row::{Row, RowMaker, RowSink};
use super::run_setup::RunSetup;
use crate::engine::events::{self, Crossing};
use crate::engine::step::Step;
use crate::engine::time::{self, Settings};
use crate::engine::{Counted, Motion};
use crate::numeric::angle::Angle;

/// Follows the steps of a crank.
pub(super) struct CrankWatch<'a> {
    pub recorder: Recorder<'a>,
    /// Turning points, if they may show that the crank never completes its turns.
    pub swing: Option<Swing>,
    /// When (s) the run ends inside the last step, and why.
    pub ends_at: Option<(f64, EndsBy)>,
    /// Angle and speed (rad/s) of a start at a dead centre that was noted before.
    pub passed: Option<(Angle, f64)>,
    motion: &'a Counted<'a>,
    start: Angle,
    /// In [0, 2π), rad. A crank that has limits is followed along the configuration curve.
    dead_centres: Vec<f64>,
    /// The run ends when the crank has turned by this, rad.
    turn_limit: Option<f64>,
    crossings: Vec<(f64, Crossing)>,
}

/// What ends a run inside a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EndsBy {
    /// Its turns are complete.
    Turns,
    /// The crank swings to and fro and came no further for long.
    Swing,
}

impl<'a> CrankWatch<'a> {
    pub fn new(
        task: &'a RunSetup<'a>,
        motion: &'a Counted<'a>,
        rows: &'a mut dyn RowSink,
    ) -> CrankWatch<'a> {
        let dead_centres = task.limits.dead_centres.iter();
        CrankWatch {
            recorder: Recorder::new(task, rows, task.schedule()),
            swing: Swing::new(task, task.start()),
            ends_at: None,
            passed: None,
            motion,
            start: task.start(),
            dead_centres: dead_centres.map(|dc| dc.theta).collect(),
            turn_limit: task.extent.angle(),
            crossings: Vec::new(),
        }
    }

    /// Takes a step; true ends the run.
    pub fn step(&mut self, step: &Step) -> bool {
        let mut step = *step;
        self.reach_turn_limit(&mut step);
        self.look_for_events(&mut step);
        if self.ends_at.is_none() {
            self.follow_speed(&mut step);
        }
        let until = self.ends_at.map_or(step.end.t, |(t, _)| t);
        let along = Crank {
            maker: &self.recorder.task().maker,
            motion: self.motion,
            start: self.start,
            crossings: &self.crossings,
        };
        self.recorder.step(&mut step, until, &along, None) || self.ends_at.is_some()
    }

    /// Least and largest speed.
    fn follow_speed(&mut self, step: &mut Step) {
        let speed = self.recorder.speed();
        *speed = events::follow_speed(step, self.motion, *speed);
    }

    /// How far the crank has turned at an angle of a step, rad.
    fn turned(&self, step: &Step, theta: f64) -> f64 {
        step.angle(theta).minus(self.start)
    }

    /// The last step up to where the run ends inside it, integrated anew; at a turn limit once more, to meet it exactly.
    pub fn shortened(&mut self, motion: &Counted<'_>, step: &Step, settings: &Settings) -> Step {
        let until = |t_end: f64, sink: &mut dyn FnMut(&Step) -> bool| {
            time::shortened(motion, step, t_end, settings, sink)
        };
        let Some((mut t, by)) = self.ends_at else {
            return *step;
        };
        if let Some(limit) = self.turn_limit.filter(|_| by == EndsBy::Turns) {
            for _ in 0..3 {
                let end = until(t, &mut |_| false);
                let turned = self.turned(&end, end.end.theta);
                let missing = limit.copysign(turned) - turned;
                if missing == 0.0 || end.end.omega == 0.0 {
                    break;
                }
                t = (t + missing / end.end.omega).clamp(step.start.t, step.end.t);
            }
        }
        until(t, &mut |step| {
            self.follow_speed(&mut step.clone());
            false
        })
    }

    fn reach_turn_limit(&mut self, step: &mut Step) {
        let Some(limit) = self.turn_limit else {
            return;
        };
        if self.turned(step, step.end.theta).abs() < limit {
            return;
        }
        step.refine(self.motion);
        let beyond = self.turned(step, step.end.theta);
        let target = step.end.theta - (beyond - limit.copysign(beyond));
        let t = step.time_of_angle(target, step.start.t, step.end.t);
        self.ends_at = Some((t.unwrap_or(step.end.t), EndsBy::Turns));
    }

    fn look_for_events(&mut self, step: &mut Step) {
        let mut crossings = std::mem::take(&mut self.crossings);
        events::crossings(step, &self.dead_centres, &mut crossings);
        let wanted = self.recorder.keeps_events() || self.swing.is_some();
        if !step.is_refined() && !crossings.is_empty() && wanted {
            step.refine(self.motion);
            events::crossings(step, &self.dead_centres, &mut crossings);
        }
        for &(t, what) in &crossings {
            // An event at the end of the run may be off it by rounding.
            let end = self.ends_at.map_or(t, |(t, _)| t);
            if t > end * (1.0 + 8.0 * f64::EPSILON) {
                break;
            }
            self.happens(step, t.min(end), what);
            if matches!(self.ends_at, Some((_, EndsBy::Swing))) {
                break;
            }
        }
        self.crossings = crossings;
    }

    /// Records a crossing at a time (s) of a step, and whether it ends the run.
    fn happens(&mut self, step: &Step, t: f64, what: Crossing) {
        let (theta, omega) = step.at(t);
        let at = step.angle(theta);
        let (kind, speed) = match what {
            Crossing::Angle(_) => ("dead-centre", omega),
            Crossing::Turning => ("turning-point", 0.0),
        };
        if let Some((angle, speed)) = self.passed.take()
            && at.minus(angle).abs() < 1e-9
            && omega * speed > 0.0
        {
            return;
        }
        self.recorder.event(|| Event {
            kind,
            t_s: t,
            theta_rad: at.radians(),
            omega_rad_per_s: speed,
        });
        if what == Crossing::Turning
            && let Some(swing) = &mut self.swing
        {
            swing.turns_at(at);
            if swing.is_caught() {
                self.ends_at = Some((t, EndsBy::Swing));
            }
        }
    }
}

/// The crank angle as the coordinate of a step.
struct Crank<'a> {
    maker: &'a RowMaker<'a>,
    motion: &'a Counted<'a>,
    start: Angle,
    crossings: &'a [(f64, Crossing)],
}

impl Coordinate for Crank<'_> {
    fn motion(&self) -> &dyn Motion {
        self.motion
    }

    fn turned(&self, step: &Step, t: f64) -> f64 {
        step.angle(step.at(t).0).minus(self.start)
    }

    fn time_of(&self, step: &Step, turned: f64, [from, to]: [f64; 2]) -> Option<f64> {
        let at_start = step.angle(step.start.theta).minus(self.start);
        let theta = step.start.theta + (turned - at_start);
        step.time_of_angle(theta, from, to)
    }

    fn turning_times(&self, _: &Step) -> Vec<f64> {
        let crossings = self.crossings.iter();
        let turning = crossings.filter(|(_, what)| *what == Crossing::Turning);
        turning.map(|(t, _)| *t).collect()
    }

    fn row(&self, t: f64, angle: Angle, speed: f64) -> Row {
        self.maker.row(t, angle, speed, None)
    }
}
