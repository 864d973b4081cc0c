//! One pass over a run: over the crank angle while the crank turns, in time where it comes near to rest.

use std::f64::consts::TAU;

use super::super::angle_model::AngleModel;
use super::super::angle_motion::reason;
use super::super::error_estimate::Forward;
use super::super::guide_friction::Sliding;
use super::arrived::{Arrived, End, Observer};
use super::clear::Clear;
use crate::engine::Counted;
use crate::engine::angle::{self, Driving, Goal, Resolution};
use crate::engine::energy::NotApplicable;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::error::Error;
use crate::mechanism::Equation;
use crate::plan::Engine;
use crate::scene::Extent;

/// What is run, and how finely.
pub(super) struct Course<'a> {
    pub equation: &'a Equation,
    pub position: &'a AngleModel<'a>,
    pub start: Start,
    pub extent: Extent,
    pub resolution: Resolution,
    pub settings: Settings,
    /// Friction at the guide.
    pub sliding: Option<&'a Sliding>,
    /// How far (rad) the crank turns in one direction before the angle takes over again.
    pub wait: f64,
    pub max_evaluations: u64,
}

/// A pass under way.
pub(super) struct Pass<'a, 'o> {
    pub course: &'a Course<'a>,
    motion: &'a Counted<'a>,
    pub observer: &'o mut dyn Observer,
    pub arrived: Arrived,
    /// Positions tabulated before it.
    places: u64,
    /// Evaluations of loads over the angle.
    over_angle: u64,
    /// Evaluations with friction in time.
    pub rubbing: u64,
    wait: f64,
}

impl Course<'_> {
    /// Runs to the end; `first` is the first piece over the angle, if it is known.
    pub fn run(
        &self,
        first: Option<Driving>,
        observer: &mut dyn Observer,
    ) -> Result<Arrived, Error> {
        let forward = Forward(self.equation);
        let motion = Counted::new(&forward);
        let mut pass = Pass {
            course: self,
            motion: &motion,
            observer,
            arrived: Arrived::at(self.start),
            places: self.position.evaluations(),
            over_angle: 0,
            rubbing: 0,
            wait: self.wait,
        };
        pass.pieces(first)?;
        let spent = pass.spent();
        let mut arrived = pass.arrived;
        arrived.evaluations = spent;
        arrived.impossible = motion.impossible();
        Ok(arrived)
    }
}

impl Pass<'_, '_> {
    pub fn spent(&self) -> u64 {
        let places = self.course.position.evaluations() - self.places;
        places + self.over_angle + self.rubbing + self.motion.evaluations()
    }

    fn pieces(&mut self, mut first: Option<Driving>) -> Result<(), Error> {
        let mut turns = true;
        let mut slow = "";
        loop {
            if turns {
                let driven = first.take().map_or_else(|| self.drive(), Ok);
                let why = match driven {
                    Ok(driving) => self.drove(driving)?,
                    Err(why) => {
                        self.wait *= 2.0;
                        Some(why)
                    }
                };
                slow = why.map_or("", reason);
                match why {
                    None => return Ok(()),
                    Some(NotApplicable::TooLong) => continue,
                    Some(NotApplicable::WorkLimit) => {
                        self.arrived.end = End::Integrator(Finish::WorkLimit);
                        return Ok(());
                    }
                    Some(NotApplicable::TooManyTurns) => {
                        self.arrived.end = End::Integrator(Finish::TooManyTurns);
                        return Ok(());
                    }
                    Some(NotApplicable::TooSlow) => {}
                    // What kept the angle from going on is not left behind with the speed.
                    Some(_) => turns = false,
                }
            }
            let wait = if turns { self.wait } else { f64::INFINITY };
            let before = &self.arrived;
            if before.over_angle > 0 && before.last.is_none() {
                self.arrived.to_time += 1;
            }
            let from = self.arrived.now.t;
            self.observer.begins(Engine::Time, from, slow);
            let back = match self.course.sliding {
                Some(sliding) => self.with_friction(sliding, wait),
                None => self.in_time(wait),
            };
            if back {
                self.arrived.to_angle += 1;
            } else {
                return Ok(());
            }
        }
    }

    /// A piece over the angle from here.
    fn drive(&self) -> Result<Driving, NotApplicable> {
        let course = self.course;
        let now = self.arrived.now;
        let goal = match course.extent {
            Extent::Duration(duration) => Goal::Time(duration - now.t),
            Extent::Revolutions(turns) => {
                let turned = now.angle.minus(course.start.angle);
                Goal::Turned(turns * TAU - now.speed.signum() * turned)
            }
        };
        let resolution = Resolution {
            most_evaluations: course.max_evaluations.saturating_sub(self.spent()),
            ..course.resolution
        };
        angle::run(course.position, now, goal, resolution)
    }

    /// Takes a piece over the angle; why it ended before the goal.
    fn drove(&mut self, driving: Driving) -> Result<Option<NotApplicable>, Error> {
        let begin = self.arrived.now;
        let short = driving.short;
        let end = match (self.course.extent, short) {
            (Extent::Duration(duration), None) => duration,
            _ => begin.t + driving.end,
        };
        let (angle, speed) = match short {
            None => driving.orbit.state(driving.end),
            Some(short) => {
                let inertia = self.course.equation.terms(short.angle.rest).inertia.m;
                let speed = (2.0 * short.kinetic / inertia).sqrt();
                (short.angle.reduced(), begin.speed.signum() * speed)
            }
        };
        self.over_angle += driving.evaluations;
        let arrived = &mut self.arrived;
        arrived.work += driving.work;
        arrived.steps += driving.orbit.panels() as u64;
        arrived.over_angle += 1;
        let largest = driving.orbit.largest_kinetic(driving.end);
        arrived.largest_kinetic = arrived.largest_kinetic.max(largest);
        arrived.last = None;
        arrived.rubbed = None;
        arrived.now = Start {
            t: end,
            angle,
            speed,
        };
        if short.is_some() {
            let way = angle.minus(begin.angle).abs();
            let soon = way < 2.0 * self.wait;
            self.wait = if soon {
                2.0 * self.wait
            } else {
                self.course.wait
            };
        }
        let observer = &mut self.observer;
        observer.begins(Engine::Angle, begin.t, "the crank turns");
        observer.over_angle(begin, end, driving)?;
        Ok(short.map(|short| short.why))
    }

    /// A piece in time, until the crank has turned by `wait` (rad) in one direction; whether it has.
    fn in_time(&mut self, wait: f64) -> bool {
        let course = self.course;
        let from = self.arrived.now;
        let evaluations = course.max_evaluations.saturating_sub(self.spent());
        let settings = Settings {
            max_evaluations: self.motion.evaluations() + evaluations,
            ..course.settings
        };
        let mut clear = Clear::new(course, from, wait);
        self.observer.begin_in_time(from);
        let observer = &mut *self.observer;
        let mut back = false;
        let (mut finish, last, steps) = time::run(self.motion, from, &settings, &mut |step| {
            let ends = observer.step(step);
            back = !ends && clear.is_reached(step);
            ends || back
        });
        let last = match self.observer.end_in_time(self.motion, &last, &settings) {
            Some(shortened) => {
                finish = Finish::AtEnd;
                shortened
            }
            None => last,
        };
        let arrived = &mut self.arrived;
        arrived.steps += steps;
        arrived.in_time += 1;
        arrived.work += last.end.work;
        arrived.largest_kinetic = arrived.largest_kinetic.max(clear.largest_kinetic);
        arrived.now = Start {
            t: last.end.t,
            angle: last.angle(last.end.theta).reduced(),
            speed: last.end.omega,
        };
        arrived.last = Some(last);
        back &= finish == Finish::Stopped;
        if !back {
            arrived.end = match finish {
                Finish::AtEnd if course.is_at_goal(&arrived.now) => End::AtGoal,
                finish => End::Integrator(finish),
            };
        }
        back
    }
}

impl Course<'_> {
    /// Whether a run has come to its time, or its turns did not take for ever.
    pub fn is_at_goal(&self, now: &Start) -> bool {
        match self.extent {
            Extent::Duration(duration) => now.t >= duration,
            Extent::Revolutions(_) => now.t < self.settings.t_end,
        }
    }
}
