//! Loop of a run over its phases, with step-size control.

use super::discontinuities::Breaks;
use super::dop853::Stages;
use super::{AcceptedStep, Contact, ContactSettings, Phase, Sample};
use crate::engine::run_in_time::Finish;

/// End of a run.
#[derive(Clone, Copy, Debug)]
pub struct ContactEnd<const N: usize> {
    /// Reason for the end: last time, observer, work limit, or rates that are not finite or too steep.
    pub finish: Finish,
    /// Last state.
    pub last: [f64; N],
    /// Phase of the last state.
    pub phase: Phase,
    /// Evaluations of the rates.
    pub evaluations: u64,
    /// Accepted steps.
    pub steps: u64,
}

/// Observer of accepted steps; returning true ends the run.
pub(super) type Observer<'a, const N: usize> = &'a mut dyn FnMut(&mut AcceptedStep<'_, N>) -> bool;

pub(super) struct Runner<'a, M: Contact<N>, const N: usize> {
    pub model: &'a M,
    pub settings: ContactSettings<'a>,
    pub observer: Observer<'a, N>,
    pub y: [f64; N],
    pub phase: Phase,
    /// Evaluation data prepared at `y`.
    pub near: M::Near,
    /// Rates and depth at `y` in `phase`.
    pub now: Sample<N>,
    /// Next step, s.
    pub h: f64,
    /// Next step in flight, s.
    pub flight_h: f64,
    /// End of the present piece, s: end of the run, corner of the rates or change of law.
    pub until: f64,
    pub breaks: Breaks<N>,
    pub evaluations: u64,
    pub steps: u64,
    sizes: [f64; N],
    pub counted: usize,
}

/// Outcome of a part of a run. The error is the reason for the end of the run, or none where the last step goes beyond
/// a change of the law of motion and is repeated up to it.
pub(super) type Halt<T = ()> = Result<T, Option<Finish>>;

/// Integrates from a state to the last time; `linked` keeps [`Phase::Link`] throughout.
pub fn run<M: Contact<N>, const N: usize>(
    model: &M,
    start: [f64; N],
    linked: bool,
    settings: ContactSettings<'_>,
    observer: Observer<'_, N>,
) -> ContactEnd<N> {
    let (sizes, counted) = model.sizes();
    let phase = if linked { Phase::Link } else { Phase::Flight };
    let near = model.near(&start);
    let mut runner = Runner {
        model,
        settings,
        observer,
        y: start,
        phase,
        near,
        now: model.sample(&near, phase, None, &start),
        h: 0.0,
        flight_h: 0.0,
        until: settings.t_end,
        breaks: Breaks::default(),
        evaluations: 1,
        steps: 0,
        sizes,
        counted,
    };
    let ended = runner.all();
    ContactEnd {
        finish: ended.err().flatten().unwrap_or(Finish::AtEnd),
        last: runner.y,
        phase: runner.phase,
        evaluations: runner.evaluations,
        steps: runner.steps,
    }
}

impl<M: Contact<N>, const N: usize> Runner<'_, M, N> {
    fn all(&mut self) -> Halt {
        self.begin();
        while self.y[0] < self.settings.t_end {
            self.until = self.model.next_corner(self.y[0]).min(self.settings.t_end);
            while self.y[0] < self.until {
                match self.go_on() {
                    Err(None) => {}
                    ended => ended?,
                }
            }
            // The rates change at a corner or a change of law.
            self.change()?;
            self.enter(self.phase);
        }
        Ok(())
    }

    fn go_on(&mut self) -> Halt {
        match self.phase {
            Phase::Flight => self.fly(),
            Phase::Contact { approach } => self.touch(approach),
            Phase::Release { approach } => self.recede(approach),
            Phase::Link => self.link(),
        }
    }

    /// Begins in contact where the bodies touch at rest and are pressed together, and sets the first step.
    fn begin(&mut self) {
        if self.phase == Phase::Flight && self.is_pressed_at_rest() {
            let approach = self.model.approach(self.now.depth_rate);
            self.enter(Phase::Contact { approach });
        }
        let fastest = (0..self.counted).fold(0.0, |most: f64, i| {
            most.max(self.now.rates[i].abs() / self.sizes[i])
        });
        // Part of the time in which the fastest number would change by its size; of that, where a contact begins.
        let first = 0.01;
        self.flight_h = first / fastest.max(1e-300);
        self.h = match self.phase {
            Phase::Contact { .. } => first * self.flight_h,
            _ => self.flight_h,
        };
    }

    /// True if the bodies touch at rest and are pressed together.
    pub fn is_pressed_at_rest(&self) -> bool {
        let now = &self.now;
        now.depth >= -self.model.rounding(&self.y)
            && now.depth_rate.abs() <= self.model.approach(0.0)
            && now.depth_acceleration > 0.0
    }

    /// Enters a phase at the present state.
    pub fn enter(&mut self, phase: Phase) {
        self.phase = phase;
        self.now = self.sample(None, &{ self.y });
    }

    /// Computes rates and depth at a state in the present phase.
    pub fn sample(&mut self, depth: Option<f64>, y: &[f64; N]) -> Sample<N> {
        self.evaluations += 1;
        self.model.sample(&self.near, self.phase, depth, y)
    }

    /// Returns the admissible error of a step of length `h` (s). Rounding sets a floor: that of the state, and that of
    /// the depth, which makes the force of a shallow contact uncertain however short the step is.
    pub fn scale(&self, h: f64) -> [f64; N] {
        // Largest relative error of the force that is attributed to rounding of the depth.
        let most_doubt = 1e-6;
        let doubt = match self.phase {
            Phase::Contact { .. } if self.now.depth > 0.0 => {
                (2.0 * self.model.rounding(&self.y) / self.now.depth).min(most_doubt)
            }
            _ => 0.0,
        };
        let mut scale = [0.0; N];
        for (i, each) in scale.iter_mut().enumerate() {
            *each = self.settings.tolerance * self.sizes[i]
                + f64::EPSILON * self.y[i].abs()
                + doubt * (h * self.now.rates[i]).abs();
        }
        scale
    }

    /// Computes a step in time of this length, s, not yet accepted.
    #[inline]
    pub fn try_step(&mut self, h: f64) -> Stages<N> {
        let (model, phase) = (self.model, self.phase);
        let near = &self.near;
        let mut rates = |_: f64, y: &[f64; N]| model.sample(near, phase, None, y).rates;
        self.evaluations += 11;
        Stages::new(&mut rates, &self.y, &self.now.rates, h)
    }

    /// Returns the next step within tolerance and its length, s; sets `h` to the length proposed for the one after.
    pub fn controlled_step(&mut self, longest: f64) -> Halt<(Stages<N>, f64)> {
        let mut rejected = false;
        loop {
            self.check_work()?;
            let left = self.until - self.y[0];
            let mut h = self.h.min(longest).min(left);
            if h > 0.9 * left && h < left {
                // Two halves of the rest are better than one step and a tiny one.
                h = 0.5 * left;
            }
            if h < left && (h <= 4.0 * f64::EPSILON * self.y[0].abs() || h < 1e-300) {
                return Err(Some(Finish::StepTooSmall));
            }
            let stages = self.try_step(h);
            let error = stages.error(&self.scale(h), self.counted);
            if error <= 1.0 {
                if let Some(shorter) = self.unresolved_after(&stages.end) {
                    self.h = shorter;
                    rejected = true;
                    continue;
                }
                let most = if rejected { 1.0 } else { 6.0 };
                let grown = h * growth(error).min(most);
                // A step cut short says little about the length of the next.
                self.h = if h < self.h { grown.max(self.h) } else { grown };
                return Ok((stages, h));
            }
            rejected = true;
            self.h = if error.is_finite() {
                h * growth(error)
            } else {
                0.1 * h
            };
        }
    }

    pub fn check_work(&self) -> Halt {
        if let Some(stop) = self.settings.limit.stop {
            stop.reach(self.y[0] / self.settings.t_end);
        }
        if self.settings.limit.is_reached(self.evaluations) {
            return Err(Some(Finish::WorkLimit));
        }
        Ok(())
    }

    fn link(&mut self) -> Halt {
        let (stages, h) = self.controlled_step(f64::INFINITY)?;
        let end = self.snapped(self.model.relinked(&stages.end), h);
        self.accept_at(stages, end)
    }
}

/// Returns the ratio of the next step to this one, from the error in units of the tolerance (order 8).
pub(super) fn growth(error: f64) -> f64 {
    (0.9 / error.sqrt().sqrt().sqrt()).clamp(0.2, 6.0)
}
