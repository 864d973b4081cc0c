//! Global error of a run on the curve.

use std::time::Instant;

use super::super::checkpoints::{Checkpoints, Compared};
use super::super::error_estimate::{MARGIN, MOST_EVALUATIONS, MUCH_TIGHTER, TIGHTER, TIGHTEST};
use super::super::result::{Cost, ErrorEstimate, Judged};
use super::arrived::{Arrived, End, Follow, Observer, crank_state};
use super::roundoff::Noise;
use super::stick_slip::Phase;
use crate::engine::step::Step;
use crate::engine::time::{Method, Settings};
use crate::mechanism::Curve;
use crate::numeric::angle::Angle;

/// The same method again is tighter than this only by so much, for rounding inside the steps takes over, and they would
/// collapse.
const TIGHTEST_AGAIN: f64 = 1e-13;
const A_LITTLE: f64 = 5.0;
/// Standard deviations of rounding that are stated.
const DEVIATIONS: f64 = 2.0;

/// The tolerance of the same method again.
fn tighter(tolerance: f64) -> f64 {
    (tolerance / TIGHTER).max(TIGHTEST_AGAIN.min(tolerance / A_LITTLE))
}

/// Global error of the last state: its distance from a much better run, and what rounding may have added to both.
pub(in crate::simulate) fn estimate(
    follow: &Follow<'_>,
    arrived: &Arrived,
    checkpoints: &Checkpoints,
) -> Option<Judged> {
    let begun = Instant::now();
    let tolerance = follow.settings.tolerance;
    let (factor, beside) = MOST_EVALUATIONS;
    let collocation = Settings {
        method: Method::Picard,
        tolerance: (tolerance / MUCH_TIGHTER).max(TIGHTEST),
        max_evaluations: arrived
            .evaluations
            .saturating_mul(factor)
            .saturating_add(beside)
            .min(follow.settings.max_evaluations),
        ..follow.settings
    };
    let again = Settings {
        tolerance: tighter(tolerance),
        ..follow.settings
    };
    let mut evaluations = 0;
    let mut better = |settings: &Settings| {
        let better = Follow {
            equation: follow.equation,
            settings: Settings {
                t_end: arrived.last.end.t,
                ..*settings
            },
            start: follow.start,
            turn_limit: None,
            turned_from: follow.turned_from,
        };
        let mut second = Second {
            noise: Noise::new(follow.equation),
            curve: follow.equation.curve(),
            compared: checkpoints.compared(),
        };
        let best = better.run(&mut second);
        evaluations += best.evaluations + second.noise.evaluations.get();
        (best.end == End::Done).then_some((best, second))
    };
    let (best, second) = better(&collocation).or_else(|| better(&again))?;
    let end = distance(follow, arrived, &best, &second.noise);
    let cost = Cost {
        evaluations,
        wall_s: begun.elapsed().as_secs_f64(),
    };
    Some(Judged {
        end,
        rows: second.compared.worst(end, MARGIN),
        cost,
    })
}

/// What is seen of the second run.
struct Second<'a> {
    noise: Noise<'a>,
    curve: &'a Curve,
    compared: Compared<'a>,
}

impl Observer for Second<'_> {
    fn step(&mut self, step: &Step, phase: Phase) -> bool {
        let curve = self.curve;
        self.compared.pass(step, |q| curve.place(q).dtheta);
        self.noise.step(step, phase)
    }

    fn event(&mut self, kind: &'static str, t: f64, angle: Angle, speed: f64) {
        self.noise.event(kind, t, angle, speed);
    }
}

fn distance(
    follow: &Follow<'_>,
    arrived: &Arrived,
    best: &Arrived,
    noise: &Noise<'_>,
) -> ErrorEstimate {
    let curve = follow.equation.curve();
    let (a, b) = (
        crank_state(curve, &arrived.last),
        crank_state(curve, &best.last),
    );
    let end = &arrived.last.end;
    let place = curve.place(end.theta);
    // Both runs round; many short steps more often.
    let often = 1.0 + arrived.steps as f64 / best.steps.max(1) as f64;
    let unit = DEVIATIONS * f64::EPSILON * often.sqrt();
    let angle = unit * noise.spread.angle();
    let speed = unit * noise.spread.speed();
    let dtheta = place.dtheta.abs();
    let bend = if place.d2theta.is_finite() {
        (place.d2theta * end.omega).abs()
    } else {
        0.0
    };
    ErrorEstimate {
        theta_rad: MARGIN * a.0.minus(b.0).abs()
            + dtheta * angle
            + f64::EPSILON * a.0.radians().abs(),
        omega_rad_per_s: MARGIN * (a.1 - b.1).abs()
            + dtheta * speed
            + bend * angle
            + f64::EPSILON * a.1.abs(),
    }
}
