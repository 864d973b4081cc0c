//! Adapter to the explicit Runge-Kutta methods of the crate ode_solvers; no other file names the crate.
//!
//! Precautions against version 0.6.2: sparse output only (dense output extrapolates its last point); time is a state,
//! which avoids the stage times of Dop853, two of which are wrong; each call starts at zero and runs forward; its
//! stiffness test is off; short calls keep its result vectors small.

use std::cell::Cell;

use ode_solvers::dop_shared::IntegrationError;
use ode_solvers::{Dop853, Dopri5, OutputType, SVector, System};

use super::Counted;
use super::run_in_time::{Finish, Settings};
use super::step::{Node, Step};
use crate::numeric::angle::Angle;

/// Runge-Kutta method.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RungeKutta {
    /// Dormand and Prince, order 8(5,3).
    Dop853,
    /// Dormand and Prince, order 5(4).
    Dopri5,
}

impl RungeKutta {
    /// Evaluations per attempted step.
    pub fn evaluations_in_a_step(self) -> u64 {
        match self {
            RungeKutta::Dop853 => 12,
            RungeKutta::Dopri5 => 6,
        }
    }

    /// Order of the method.
    pub fn order(self) -> usize {
        match self {
            RungeKutta::Dop853 => 8,
            RungeKutta::Dopri5 => 5,
        }
    }
}

/// Arguments of [`integrate`].
pub struct Call<'a> {
    /// Equation of motion.
    pub motion: &'a Counted<'a>,
    /// Method.
    pub method: RungeKutta,
    /// Tolerance of the local error and unit of work.
    pub settings: &'a Settings<'a>,
    /// Whole turns to be added to the angles of the call.
    pub turns: f64,
    /// Initial state.
    pub start: Node,
    /// Last time, s.
    pub t_end: f64,
    /// First step to try, s; 0: chosen by the method.
    pub first_step: f64,
    /// Most attempted steps.
    pub max_steps: u32,
    /// Observer of each accepted step; returning true ends the call.
    pub observer: &'a mut dyn FnMut(&Step) -> bool,
}

/// Integrates one call and returns the reason for its end.
pub fn integrate(call: Call<'_>) -> Finish {
    match (call.motion.has_power(), call.motion.depends_on_time()) {
        (false, false) => run::<2>(call, None, None),
        (false, true) => run::<3>(call, None, Some(2)),
        (true, false) => run::<3>(call, Some(2), None),
        (true, true) => run::<4>(call, Some(2), Some(3)),
    }
}

fn run<const N: usize>(call: Call<'_>, work: Option<usize>, clock: Option<usize>) -> Finish {
    let length = call.t_end - call.start.t;
    if length <= 0.0 {
        return Finish::AtEnd;
    }
    let mut state = SVector::<f64, N>::zeros();
    state[0] = call.start.theta;
    state[1] = call.start.omega;
    let (method, tolerance) = (call.method, call.settings.tolerance);
    let first_step = call.first_step.min(length);
    let max_steps = call.max_steps;
    let stopped = Cell::new(false);
    let system = Adapter {
        last: call.start,
        call,
        work,
        clock,
        stopped: &stopped,
    };
    // Damping of the step-size control, and bounds of the ratio of a step to the one before.
    macro_rules! integrated {
        ($method:ident, $damping:literal, $least:literal, $greatest:literal) => {
            $method::from_param(
                system,
                0.0,
                length,
                length,
                state,
                tolerance,
                tolerance,
                0.9,
                $damping,
                $least,
                $greatest,
                length,
                first_step,
                max_steps,
                u32::MAX,
                OutputType::Sparse,
            )
            .integrate()
        };
    }
    let result = match method {
        RungeKutta::Dop853 => integrated!(Dop853, 0.0, 0.333, 6.0),
        RungeKutta::Dopri5 => integrated!(Dopri5, 0.04, 0.2, 10.0),
    };
    match result {
        Ok(_) if stopped.get() => Finish::Stopped,
        Ok(_) => Finish::AtEnd,
        Err(IntegrationError::MaxNumStepReached { .. }) => Finish::WorkLimit,
        Err(_) => Finish::StepTooSmall,
    }
}

/// Motion in the form that ode_solvers takes; work counts from the start of the call, in units of `work_unit`.
struct Adapter<'a, 's> {
    call: Call<'a>,
    last: Node,
    work: Option<usize>,
    clock: Option<usize>,
    stopped: &'s Cell<bool>,
}

impl<const N: usize> System<f64, SVector<f64, N>> for Adapter<'_, '_> {
    fn system(&self, x: f64, y: &SVector<f64, N>, dy: &mut SVector<f64, N>) {
        let t = self.call.start.t + self.clock.map_or(x, |i| y[i]);
        let angle = Angle::new(self.call.turns, y[0]);
        dy[0] = y[1];
        if let Some(i) = self.work {
            let (alpha, power) = self.call.motion.acceleration_and_power(t, angle, y[1]);
            dy[1] = alpha;
            dy[i] = power / self.call.settings.work_unit;
        } else {
            dy[1] = self.call.motion.acceleration(t, angle, y[1]);
        }
        if let Some(i) = self.clock {
            dy[i] = 1.0;
        }
    }

    fn solout(&mut self, x: f64, y: &SVector<f64, N>, dy: &SVector<f64, N>) -> bool {
        let begin = &self.call.start;
        let end = Node {
            t: if x == self.call.t_end - begin.t {
                self.call.t_end
            } else {
                begin.t + x
            },
            theta: y[0],
            omega: y[1],
            alpha: dy[1],
            work: begin.work
                + self
                    .work
                    .map_or(0.0, |i| y[i] * self.call.settings.work_unit),
        };
        let step = Step::new(self.call.turns, self.last, end);
        self.last = end;
        let stop = (self.call.observer)(&step);
        if stop {
            self.stopped.set(true);
        }
        stop
    }
}
