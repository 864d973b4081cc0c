//! Run panel by panel, continued by the Poincaré map of a cycle where there are many turns.

use std::f64::consts::TAU;

use super::poincare_map::{self, SINGLE_TURNS};
use super::stepper::PanelStepper;
use super::{AngleRun, Dynamics, EarlyEnd, Goal, Panels, Resolution};
use crate::engine::energy::interpolated_turns::TurnStart;
use crate::engine::energy::piece::SAME_ANGLE;
use crate::engine::energy::segment::{MOST_PANELS, Segment};
use crate::engine::energy::turns::Turns;
use crate::engine::energy::{NotApplicable, Orbit};
use crate::engine::run_in_time::{Ends, MotionState, UNLIMITED_TIME};
use crate::engine::work_forecast::WorkForecast;
use crate::numeric::angle::Angle;

/// Integrates from a start to the goal, or as far as the angle can be the independent variable.
///
/// # Errors
/// [`NotApplicable`] where the angle cannot be the independent variable at the start.
pub fn run<D: Dynamics>(
    dynamics: &D,
    from: MotionState,
    goal: Goal,
    resolution: Resolution<'_>,
) -> Result<AngleRun, NotApplicable> {
    let mut stepper = PanelStepper::new(dynamics, from, resolution)?;
    let reads_time = dynamics.reads_time();
    let repeats = !reads_time && stepper.panels.panels[0].table.switch.is_none();
    let (t, way) = match goal {
        Goal::Time(until) => (until, f64::INFINITY),
        Goal::Turned(way) => (UNLIMITED_TIME, way),
    };
    let limit = resolution.limit;
    let mut forecast = WorkForecast::new(0.0, stepper.cost(), Ends { t, way, limit }, reads_time);
    let cycle = f64::from(dynamics.cycle()) * TAU;
    let (mut segment, first) = (Segment::open(), TurnStart::default());
    let why = loop {
        let at_cycle = stepper.panels.at_cycle();
        let (cost, t) = (stepper.cost(), stepper.progress.t.0);
        if at_cycle
            && !segment.panels.is_empty()
            && forecast.reason_to_stop(cost, t, cycle).is_some()
        {
            break Some(NotApplicable::TooManyTurns);
        }
        if repeats && at_cycle && stepper.progress.turns.abs() >= SINGLE_TURNS {
            return poincare_map::run(stepper, segment, goal);
        }
        if segment.panels.len() >= MOST_PANELS {
            break Some(NotApplicable::TooLong);
        }
        match stepper.advance(&mut segment, &first, goal) {
            Ok(false) => {}
            Ok(true) => break None,
            Err(why) => break Some(why),
        }
    };
    stepper.finished((segment, None), &first, goal, why)
}

impl<D: Dynamics> PanelStepper<'_, D> {
    /// Adds the next panel to the segment of the turns after `from`; true if the goal lies on it.
    pub fn advance(
        &mut self,
        segment: &mut Segment,
        from: &TurnStart,
        goal: Goal,
    ) -> Result<bool, NotApplicable> {
        let panel = self.panel()?;
        let turned = (panel.piece.to - self.start.angle.rest).abs() + panel.turns.abs() * TAU;
        segment.push(panel);
        Ok(match goal {
            Goal::Time(until) => segment.duration.0 > from.until(until),
            Goal::Turned(way) => turned + from.turns * TAU >= way - SAME_ANGLE,
        })
    }

    /// Ends the run, whose last turns began at `from`, at the goal, or before it for a reason. Leaves the panels to the
    /// next run, if they are shared.
    ///
    /// # Errors
    /// The reason, if the last turns have no panel.
    pub fn finished(
        self,
        (first, later): (Segment, Option<Turns>),
        from: &TurnStart,
        goal: Goal,
        why: Option<NotApplicable>,
    ) -> Result<AngleRun, NotApplicable> {
        let MotionState { angle, speed, .. } = self.start;
        let orbit = Orbit::one_way(angle, speed, first, later);
        let last = orbit.last_segment();
        let panel = last
            .panels
            .last()
            .ok_or(why.unwrap_or(NotApplicable::TooLong))?;
        let end = match goal {
            Goal::Time(until) if why.is_none() => until,
            Goal::Turned(way) if why.is_none() => orbit.time_of_turn(way).unwrap_or(orbit.length()),
            _ => orbit.length(),
        };
        let mut work = from.work + self.progress.work;
        if why.is_none() {
            let whole = self.solution.work(panel.rule, panel.piece.span, 1.0);
            let until_end = last.panel_at(from.until(end)).map(|(panel, since)| {
                let x = panel.position(since);
                self.solution.work(panel.rule, panel.piece.span, x)
            });
            work = work - whole + until_end.unwrap_or_default();
        }
        let turns = angle.turns + speed.signum() * from.turns;
        let early_end = why.map(|why| EarlyEnd {
            why,
            angle: Angle::new(turns + panel.turns, panel.piece.to),
            kinetic: self.progress.kinetic,
        });
        let shapes = self.panels.shapes();
        if let Some(shared) = self
            .dynamics
            .shared()
            .filter(|_| !self.resolution.is_second)
        {
            shared.replace(Panels(self.panels.panels));
        }
        Ok(AngleRun {
            orbit,
            shapes,
            end,
            work,
            errors: self.progress.errors,
            evaluations: self.evaluations,
            early_end,
        })
    }
}
