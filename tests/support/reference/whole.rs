//! Reference of smooth motions: without friction, limit or loose joint, which would divide the motion into pieces.

use std::f64::consts::TAU;

use super::collocation::{self, Acceleration, CORNER, ITERATIONS, Place, Resolution};
use super::extended::{Extended, State};
use crate::support::exact::turn;
use slider_crank::mechanism::{Class, Equation, Limits, Linkage};
use slider_crank::numeric::double_double::DoubleDouble;
use slider_crank::precision::Reference;
use slider_crank::scene::{Load, MotionKind, Scene, Variable};

/// Factor from the distance of the two reference runs to the stated error.
const MARGIN: f64 = 4.0;

/// Relative rounding error of the last operations in double-double arithmetic.
const RESULT_ROUNDING: f64 = 256.0 * DoubleDouble::ROUNDING;

/// Series tails of the two runs, and the end of the iterations. The coarser set is for motions near a limit, where
/// digits are lost; loads in floats have their rounding in the series.
const EXACT: [([f64; 2], f64); 2] = [([1e-20, 1e-22], 1e-23), ([1e-15, 1e-17], 1e-19)];
const ROUNDED: [([f64; 2], f64); 1] = [([1e-9, 1e-11], 1e-15)];

/// Returns the reference in double-double arithmetic; none if it would take more evaluations than this, or if the
/// motion does not reach the end.
pub fn extended(scene: &Scene, t_end: f64, evaluations: u64) -> Option<Reference> {
    let reduced = scene.reduced();
    if reduced.clearance.is_some() {
        return None;
    }
    let class = Limits::new(&Linkage::new(&reduced.geometry), 0.0).class;
    let motion = &scene.motion;
    let start = Place {
        t: DoubleDouble::ZERO,
        theta: DoubleDouble::from(motion.angle),
        omega: DoubleDouble::from(motion.speed),
    };
    if motion.kind == MotionKind::ConstantSpeed {
        let theta = start.omega * t_end + start.theta;
        return Some(Reference {
            what: "angle + speed t in double-double arithmetic".to_owned(),
            theta,
            omega: start.omega,
            theta_error: theta.value().abs() * RESULT_ROUNDING,
            omega_error: 0.0,
            ends_at: None,
        });
    }
    // The reference equations do not include dry loads; friction and limits divide a motion into pieces.
    if Equation::new(scene).loads().are_dry()
        || reduced.friction.is_some()
        || class != Class::RotatingCrank
    {
        return None;
    }
    let motion = Motion {
        extended: Extended::new(scene, t_end),
        equation: Equation::new(scene),
    };
    let exact = motion.extended.is_exact();
    let both_ends = |(tails, settled): &([f64; 2], f64)| {
        let end = |tail| {
            let resolution = Resolution {
                tail,
                settled: *settled,
                evaluations,
            };
            let until = |t_end| collocation::integrate(&motion, start, t_end, resolution);
            let turns = start.omega.value() * t_end / TAU;
            let repeated = motion.extended.repeats() && turns.abs() > FEW_TURNS;
            let repeated = repeated.then(|| motion.repeated(start, t_end, &until));
            repeated.flatten().or_else(|| until(t_end))
        };
        Some((end(tails[0])?, end(tails[1])?))
    };
    let resolutions: &[_] = if exact { &EXACT } else { &ROUNDED };
    let (coarse, fine) = resolutions.iter().find_map(both_ends)?;
    Some(Reference {
        what: format!(
            "Gauss collocation of order 32 in double-double arithmetic{}",
            loads(exact)
        ),
        theta: fine.theta,
        omega: fine.omega,
        theta_error: distance(coarse.theta, fine.theta),
        omega_error: distance(coarse.omega, fine.omega),
        ends_at: None,
    })
}

/// Returns the distance of two runs plus its rounding.
pub fn distance(a: DoubleDouble, b: DoubleDouble) -> f64 {
    MARGIN * (a - b).value().abs() + b.value().abs() * RESULT_ROUNDING
}

fn loads(exact: bool) -> &'static str {
    if exact {
        ""
    } else {
        ", loads in double precision"
    }
}

/// Number of turns above which equal turns are computed from one.
const FEW_TURNS: f64 = 64.0;

/// Motion as input of the collocation.
struct Motion {
    extended: Extended,
    /// Equation for the slopes alone, which affect the speed of convergence and not its limit.
    equation: Equation,
}

impl Motion {
    /// Returns the state at `t_end` of a motion that repeats every turn: whole periods, and the rest of one. None if
    /// the crank does not turn.
    fn repeated(
        &self,
        start: Place,
        t_end: f64,
        until: &dyn Fn(f64) -> Option<Place>,
    ) -> Option<Place> {
        let turn = turn() * start.omega.value().signum();
        let mut period = DoubleDouble::from((turn / start.omega).value());
        for _ in 0..ITERATIONS {
            let end = until(period.value())?;
            let change = (start.theta + turn - end.theta) / end.omega;
            let found = DoubleDouble::from(period.value()) + change;
            // Newton's method converges quadratically: after the last change all digits are correct.
            let settled = change.value().abs() <= 1e-13 * found.value();
            period = found;
            if !(period.value() > 0.0 && period.value() < t_end) {
                return None;
            }
            if settled {
                let turns = (t_end / period.value()).floor();
                let rest = DoubleDouble::from(t_end) - period * turns;
                let mut place = until(rest.value())?;
                let beyond = rest - rest.value();
                let alpha = self.exactly(place.t, place.theta, place.omega);
                place.theta += place.omega * beyond + turn * turns;
                place.omega += alpha * beyond;
                return Some(place);
            }
        }
        None
    }
}

impl Acceleration for Motion {
    fn exactly(&self, t: DoubleDouble, theta: DoubleDouble, omega: DoubleDouble) -> DoubleDouble {
        let t = t.value();
        self.extended.acceleration(&State { t, theta, omega })
    }

    fn slopes(&self, t: f64, theta: f64, omega: f64) -> (f64, f64) {
        let at = |theta, omega| self.equation.acceleration(t, theta, omega);
        let (dtheta, domega) = (1e-6, 1e-6 * omega.abs().max(1.0));
        let central = |high: f64, low: f64, step: f64| (high - low) / (2.0 * step);
        (
            central(at(theta + dtheta, omega), at(theta - dtheta, omega), dtheta),
            central(at(theta, omega + domega), at(theta, omega - domega), domega),
        )
    }

    fn next_time(&self, t: f64) -> f64 {
        self.extended.next_corner(t)
    }

    fn corner_between(&self, theta: f64, towards: f64) -> Option<f64> {
        let corners = self.extended.loads().filter_map(|load| match load {
            Load::Table(table)
            | Load::Gas {
                pressure: table, ..
            } => Some(table),
            _ => None,
        });
        // Skip a corner that has just been reached.
        let slack = 4.0 * CORNER + 16.0 * f64::EPSILON * theta.abs().max(towards.abs());
        let (low, high) = (theta.min(towards) + slack, theta.max(towards) - slack);
        let between = corners
            .filter(|table| table.of() == Variable::Theta)
            .flat_map(|table| {
                table.rows().iter().map(move |row| {
                    let Some(period) = table.period() else {
                        return *row;
                    };
                    // First repetition of the corner in the direction of motion.
                    let turns = if towards > theta {
                        ((low - row) / period).ceil()
                    } else {
                        ((high - row) / period).floor()
                    };
                    row + turns * period
                })
            })
            .filter(|corner| (low..=high).contains(corner));
        between.min_by(|a, b| (a - theta).abs().total_cmp(&(b - theta).abs()))
    }
}
