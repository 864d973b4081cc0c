//! A motion over the crank angle: its errors by rounding and its energy balance.

use super::outcome::Balance;
use super::result::ErrorEstimate;
use super::run_setup::RunSetup;
use crate::engine::energy::NotApplicable;
use crate::engine::time::Start;
use crate::numeric::angle::Angle;

/// Times of a run at which its rows are judged.
const LOOKED_AT: u32 = 64;

/// Error of the worst row of a run until a time (s), by that of rows spread over the run.
pub(super) fn worst_row(
    end: f64,
    last: ErrorEstimate,
    error: impl Fn(f64) -> ErrorEstimate,
) -> ErrorEstimate {
    // Multiples of the golden section fall everywhere in panels, however these divide the run.
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let times = (1..=LOOKED_AT).map(|i| (f64::from(i) * golden).fract() * end);
    times.fold(last, |worst, t| worst.max(error(t)))
}

/// Where rounding takes over from the decay of the coefficients of a series, as part of the largest.
pub(super) const LEAST_TAIL: f64 = 4e-15;
/// How far an angle in its turn is rounded at most, rad.
pub(super) const PLACE: f64 = 2.0 * f64::EPSILON;

/// Error of a state if its time may be off by `late` (s): it moves the state along the motion. The angle in its
/// turn is right to `place` (rad), and rounded once more with its turns. The speed comes from series of 33
/// terms, whose sum is rounded by half of √33 units. These errors are independent.
pub(super) fn late_by(
    task: &RunSetup<'_>,
    (angle, omega): (Angle, f64),
    end: f64,
    late: f64,
    place: f64,
) -> ErrorEstimate {
    let (alpha, _) = task.maker.forward(end, angle, omega);
    let rounding = place + 0.5 * f64::EPSILON * angle.radians().abs();
    ErrorEstimate {
        theta_rad: (omega * late).hypot(rounding),
        omega_rad_per_s: (alpha * late).hypot(3.0 * f64::EPSILON * omega),
    }
}

/// Energy balance of a run whose largest kinetic energy (J) is known; `work` of the loads without potential, J.
pub(super) fn balance(task: &RunSetup<'_>, at: &Start, work: f64, largest_kinetic: f64) -> Balance {
    let equation = task.equation();
    let start = task.start();
    let turned = Angle {
        turns: at.angle.turns - start.turns,
        rest: at.angle.rest,
    };
    let begin = equation.kinetic_energy(start.rest, task.scene.motion.speed)
        + equation.potential_energy(start.rest);
    let last = equation.kinetic_energy(at.angle.rest, at.speed) + equation.potential_energy(turned);
    Balance::new(last - begin - work, &[largest_kinetic, begin, last, work])
}

/// Why a motion over the crank angle does not go on.
pub(super) fn reason(unserved: NotApplicable) -> &'static str {
    match unserved {
        NotApplicable::Equilibrium => "it starts at rest without a force",
        NotApplicable::NotFinite => "a load has no finite value on the way",
        NotApplicable::NotSmooth => "a load is not smooth",
        NotApplicable::TooSlow => "the crank comes too near to rest",
        NotApplicable::WorkLimit => "it takes more evaluations than the work limit allows",
        NotApplicable::TooLong => {
            "its turns differ from each other, and they are too many to be kept"
        }
    }
}
