//! The equation of motion as the integrators see it, and the estimate of their global error.

use std::time::Instant;

use super::summary::{Cost, ErrorEstimate};
use crate::engine::step::Step;
use crate::engine::time::{self, Finish, Settings, Start};
use crate::engine::{Batch, Counted, Motion};
use crate::mechanism::{Equation, Instants, LoadValue};
use crate::numeric::angle::Angle;
use crate::scene::Variable;

/// The equation, integrated forward.
pub(super) struct Forward<'a>(pub &'a Equation);

impl Motion for Forward<'_> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        self.0.acceleration(t, angle, speed)
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        self.0.acceleration_and_power(t, angle, speed)
    }

    fn depends_on_time(&self) -> bool {
        self.0.loads().reads().has(Variable::T)
    }

    fn has_power(&self) -> bool {
        !self.0.loads().have_potential()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.0.loads().next_corner(t)
    }

    fn of_time(&self, t: f64) -> [f64; 2] {
        let LoadValue { torque, force } = self.0.loads().of_time(t);
        [torque, force]
    }

    fn fill(&self, batch: &mut Batch) {
        let of_time = batch
            .of_time
            .map(|[torque, force]| LoadValue { torque, force });
        let at = Instants {
            t: &batch.t,
            of_time: &of_time,
            turns: batch.turns,
            theta: &batch.theta,
            omega: &batch.omega,
        };
        self.0
            .accelerations(&at, &mut batch.alpha, &mut batch.power);
    }
}

/// The second run of the estimate is so much tighter that its own error does not count, whatever the first
/// one's happens to be: at the order of collocation two more digits take a fifth more evaluations.
const MUCH_TIGHTER: f64 = 1e4;
/// Where collocation does not get to the end, the same method again, this much tighter.
const TIGHTER: f64 = 50.0;
/// What is stated is larger than the distance of the two runs by this, for the error of the second.
const MARGIN: f64 = 1.5;
/// Standard deviation of one rounding, in units of the last place.
const ONE_ROUNDING: f64 = 0.3;
/// The same of a step's mean acceleration: of a few units in each evaluation, averaged over the step.
const EVALUATION: f64 = 1.0;
/// What is stated of rounding, in standard deviations.
const DEVIATIONS: f64 = 1.5;
/// Where rounding inside a step takes over.
const TIGHTEST: f64 = 1e-15;
/// Evaluations of the collocation for one of the run that it judges, and beside them.
const MOST_EVALUATIONS: (u64, u64) = (20, 20_000);

/// A run as it ended.
#[derive(Clone, Copy)]
pub(super) struct Ended<'a> {
    /// Its last step.
    pub last: &'a Step,
    /// Number of its steps.
    pub steps: u64,
    /// Evaluations it took.
    pub evaluations: u64,
    /// The largest speed in it, rad/s.
    pub largest_speed: f64,
}

/// Global error of a run: its distance from a much better one, and what rounding may have added to both.
///
/// Rounding: each step rounds θ and θ̇ to half a unit in the last place, independently of the others, and a
/// rounded angle changes the acceleration; an error of the speed grows to one of the angle over the rest of
/// the run. Independent errors add up by their squares.
pub(super) fn estimate(
    equation: &Equation,
    start: Start,
    settings: &Settings,
    run: Ended<'_>,
) -> Option<(ErrorEstimate, Cost)> {
    let begun = Instant::now();
    let forward = Forward(equation);
    let motion = Counted::new(&forward);
    let t_end = run.last.end.t;
    let (factor, beside) = MOST_EVALUATIONS;
    let collocation = Settings {
        method: time::Method::Picard,
        tolerance: tighter(settings.tolerance),
        t_end,
        max_evaluations: run
            .evaluations
            .saturating_mul(factor)
            .saturating_add(beside),
        ..*settings
    };
    let same = Settings {
        tolerance: (settings.tolerance / TIGHTER).max(TIGHTEST),
        t_end,
        max_evaluations: settings.max_evaluations.saturating_mul(4),
        ..*settings
    };
    let better =
        Better::run(&motion, start, &collocation).or_else(|| Better::run(&motion, start, &same))?;
    let cost = Cost {
        evaluations: motion.evaluations(),
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some((better.distance(start, run), cost))
}

/// Tolerance of a run in time that is so much tighter that its own error does not count.
pub(super) fn tighter(tolerance: f64) -> f64 {
    (tolerance / MUCH_TIGHTER).max(TIGHTEST)
}

/// Square of what rounding does to the speed in a step, in units of the last place.
pub(super) fn unevenness(step: &Step) -> f64 {
    let travel = step.end.theta - step.start.theta;
    if travel == 0.0 || !step.end.alpha.is_finite() {
        return 0.0;
    }
    let slope = (step.end.alpha - step.start.alpha) / travel;
    let angle = ONE_ROUNDING * step.end.theta.abs() * slope;
    let evaluation = EVALUATION * step.end.alpha;
    (angle * angle + evaluation * evaluation) * step.length().powi(2)
}

/// The run that another is compared with.
struct Better {
    last: Step,
    steps: u64,
    /// Sum of squares of what rounding does to the speed in its steps, in units of the last place.
    unevenness: f64,
}

impl Better {
    fn run(motion: &Counted<'_>, start: Start, settings: &Settings) -> Option<Better> {
        let mut unevenness = 0.0;
        let (finish, last, steps) = time::run(motion, start, settings, &mut |step| {
            unevenness += self::unevenness(step);
            false
        });
        (finish == Finish::AtEnd).then_some(Better {
            last,
            steps,
            unevenness,
        })
    }

    fn distance(&self, start: Start, run: Ended<'_>) -> ErrorEstimate {
        let (best, last) = (&self.last, run.last);
        let whole = last.angle(last.end.theta);
        let angle = best.angle(best.end.theta).minus(whole).abs();
        let speed = (best.end.omega - last.end.omega).abs();
        let roundings = ((run.steps + self.steps) as f64).sqrt();
        // The acceleration is evaluated at rounded angles; fewer, longer steps average less.
        let fewer = self.steps as f64 / run.steps.max(1) as f64;
        let shaken = (self.unevenness * fewer.max(1.0)).sqrt();
        let one = DEVIATIONS * f64::EPSILON;
        let speed_noise = one * (ONE_ROUNDING * run.largest_speed * roundings).hypot(shaken);
        let duration = last.end.t - start.t;
        let in_steps = one * ONE_ROUNDING * (last.end.theta.abs() + 1.0) * roundings;
        // Errors of the speed that are made evenly over the run.
        let grown = speed_noise * duration / 3f64.sqrt();
        let angle_noise = in_steps.hypot(grown) + f64::EPSILON * whole.radians().abs();
        // An angle that is off while the crank is fast is a delay.
        let delayed = if run.largest_speed == 0.0 {
            0.0
        } else {
            (last.end.alpha / run.largest_speed * angle_noise).abs()
        };
        ErrorEstimate {
            theta_rad: MARGIN * angle + angle_noise,
            omega_rad_per_s: MARGIN * speed + speed_noise + delayed,
        }
    }
}
