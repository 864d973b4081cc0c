//! What the runs are measured against.

use crate::numeric::double_double::DoubleDouble;

use super::collocation::{self, Acceleration, CORNER, Place, Resolution};
use super::extended::{Extended, State};
use crate::mechanism::Equation;
use crate::scene::{Load, MotionKind, Scene, Variable};

/// The state at the end of a run, and how far it may be off.
#[derive(Clone, Debug)]
pub(super) struct Reference {
    pub what: String,
    pub theta: DoubleDouble,
    pub omega: DoubleDouble,
    pub theta_error: f64,
    pub omega_error: f64,
}

/// Two runs of the reference must agree; what is stated is larger than their distance by this.
const MARGIN: f64 = 4.0;

/// Relative rounding of the last operations in double-double arithmetic.
const ROUNDING: f64 = 1e-29;

/// Ends of the series of the two runs, and where iterations end: with exact loads and with loads in floats,
/// whose rounding is seen in the series.
const EXACT: ([f64; 2], f64) = ([1e-17, 1e-19], 1e-20);
const ROUNDED: ([f64; 2], f64) = ([1e-8, 1e-10], 1e-15);

/// The reference in double-double arithmetic; none if it would take more evaluations than this, or the
/// motion does not get to the end.
pub(super) fn extended(scene: &Scene, t_end: f64, evaluations: u64) -> Option<Reference> {
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
            theta_error: theta.value().abs() * ROUNDING,
            omega_error: 0.0,
        });
    }
    let motion = Motion {
        extended: Extended::new(scene),
        equation: Equation::new(scene),
    };
    let exact = motion.extended.is_exact();
    let (tails, settled) = if exact { EXACT } else { ROUNDED };
    let ends = tails.map(|tail| {
        let resolution = Resolution {
            tail,
            settled,
            evaluations,
        };
        collocation::integrate(&motion, start, t_end, resolution)
    });
    let [Some(coarse), Some(fine)] = ends else {
        return None;
    };
    let distance = |a: DoubleDouble, b: DoubleDouble| {
        let rounding = b.value().abs() * ROUNDING;
        MARGIN * (a - b).value().abs() + rounding
    };
    let loads = if exact {
        ""
    } else {
        ", loads in double precision"
    };
    Some(Reference {
        what: format!("Gauss collocation of order 32 in double-double arithmetic{loads}"),
        theta: fine.theta,
        omega: fine.omega,
        theta_error: distance(coarse.theta, fine.theta),
        omega_error: distance(coarse.omega, fine.omega),
    })
}

/// The motion as the collocation sees it.
struct Motion {
    extended: Extended,
    /// For the slopes alone, which decide how fast the iteration converges and not where to.
    equation: Equation,
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
        let loads = self.extended.loads();
        loads
            .map(|load| load.next_corner(t))
            .fold(f64::INFINITY, f64::min)
    }

    fn corner_between(&self, theta: f64, towards: f64) -> Option<f64> {
        let corners = self.extended.loads().filter_map(|load| match load {
            Load::Table(table)
            | Load::Gas {
                pressure: table, ..
            } => Some(table),
            _ => None,
        });
        // A corner that was met is not met again.
        let slack = 4.0 * CORNER + 16.0 * f64::EPSILON * theta.abs().max(towards.abs());
        let (low, high) = (theta.min(towards) + slack, theta.max(towards) - slack);
        let between = corners
            .filter(|table| table.of() == Variable::Theta)
            .flat_map(|table| {
                table.rows().iter().filter_map(move |row| {
                    let period = table.period().unwrap_or(f64::INFINITY);
                    if period.is_infinite() {
                        return Some(*row);
                    }
                    // The repetition that is met first.
                    let turns = if towards > theta {
                        ((low - row) / period).ceil()
                    } else {
                        ((high - row) / period).floor()
                    };
                    Some(row + turns * period)
                })
            })
            .filter(|corner| (low..=high).contains(corner));
        between.min_by(|a, b| (a - theta).abs().total_cmp(&(b - theta).abs()))
    }
}
