//! Coordinates of integration in time, as rows and events see them: crank angle, or coordinate of the configuration
//! curve.

use super::row::{Row, RowMaker};
use super::stick_slip::CurveMotion;
use crate::engine::step::Step;
use crate::engine::time::MotionState;
use crate::engine::{Batch, Motion, NODES};
use crate::mechanism::{CurveEquation, Equation, Instants, LoadValue, Loads};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{MotionPiece, Variation};
use crate::scene::Variable;
use crate::trajectory::CrankMap;

/// Motion with the crank angle as the coordinate.
impl Motion for Equation {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        Equation::acceleration(self, t, angle, speed)
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        Equation::acceleration_and_power(self, t, angle, speed)
    }

    fn depends_on_time(&self) -> bool {
        self.loads().reads.has(Variable::T)
    }

    fn has_power(&self) -> bool {
        !self.loads().have_potential()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.loads().next_corner(t)
    }

    fn varies_between_nodes(&self) -> bool {
        self.loads().vary_between_nodes()
    }

    fn variation(&self, reach: &MotionPiece, ellipse: f64) -> Variation {
        let loads = self.loads();
        let seen = self.linkage().enclosed_state(reach, loads.slider_use());
        let force = loads.variation(&seen, seen.unit_load_effects(), ellipse);
        force.times(1.0 / self.terms(reach.angle.middle()).m)
    }

    fn corner_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.loads().row_on_way(from, to)
    }

    fn of_times(&self, t: &[f64; NODES]) -> [[f64; 2]; NODES] {
        of_times(self.loads(), t)
    }

    fn fill(&self, batch: &mut Batch) {
        fill_with(batch, |at, alpha, power| {
            self.accelerations(at, alpha, power)
        });
    }
}

/// Computes accelerations and powers of a batch over the crank angle.
pub(super) fn fill_with(
    batch: &mut Batch,
    accelerations: impl FnOnce(&Instants<'_, NODES>, &mut [f64; NODES], &mut [f64; NODES]),
) {
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
    accelerations(&at, &mut batch.alpha, &mut batch.power);
}

/// Returns torque (N m) and force (N) of the loads of time alone at some times, s.
pub(super) fn of_times(loads: &Loads, t: &[f64; NODES]) -> [[f64; 2]; NODES] {
    let values = loads.of_times(t);
    values.map(|LoadValue { torque, force }| [torque, force])
}

/// Coordinate of a step, with its equation of motion.
pub(super) enum Coordinate<'a> {
    /// Crank angle.
    Crank(&'a Equation),
    /// Coordinate of the configuration curve in one phase.
    Curve(CurveMotion<'a>),
}

impl Coordinate<'_> {
    /// Equation of motion with which steps are refined.
    pub fn motion(&self) -> &dyn Motion {
        match self {
            Coordinate::Crank(equation) => *equation,
            Coordinate::Curve(motion) => motion,
        }
    }

    /// Returns the crank angle and the crank speed (rad/s) at a time (s) of a step.
    pub fn crank(&self, step: &Step, t: f64) -> (Angle, f64) {
        let (q, speed) = step.at(t);
        let angle = step.angle(q);
        match self {
            Coordinate::Crank(_) => (angle, speed),
            Coordinate::Curve(motion) => motion.equation.crank(angle, speed),
        }
    }

    /// Makes the row at a time (s), an angle of the coordinate and a rate of the coordinate (rad/s).
    pub fn row(&self, maker: &RowMaker, t: f64, angle: Angle, speed: f64) -> Row {
        match self {
            Coordinate::Crank(_) => maker.row(t, angle, speed, None),
            Coordinate::Curve(motion) => motion.row(maker, t, angle, speed),
        }
    }
}

impl CrankMap for CurveEquation {
    fn crank(&self, angle: Angle, speed: f64) -> (Angle, f64) {
        let dtheta = self.curve().pose(angle.rest).dtheta;
        (self.curve().crank_angle(angle), dtheta * speed)
    }
}

/// Converts a state of the coordinate to time, crank angle and crank speed (rad/s).
pub(super) fn crank_state(equation: &CurveEquation, at: MotionState) -> MotionState {
    let (angle, speed) = equation.crank(at.angle, at.speed);
    MotionState { angle, speed, ..at }
}

impl CurveMotion<'_> {
    /// Returns the crank speed (rad/s) and the crank acceleration (rad/s²) at a time (s) of a step.
    pub fn crank_speed(&self, step: &Step, t: f64) -> (f64, f64) {
        let (q, speed) = step.at(t);
        let place = self.equation.curve().pose(q);
        let rate = place.dtheta * step.acceleration_at(t) + place.d2theta * speed * speed;
        (place.dtheta * speed, rate)
    }

    /// Makes the row at a time (s), an angle of the coordinate and a rate of the coordinate (rad/s).
    pub fn row(&self, maker: &RowMaker, t: f64, angle: Angle, speed: f64) -> Row {
        let curve = self.equation.curve();
        let place = curve.pose(angle.rest);
        let (acceleration, touch, _) = self.state(t, angle, speed);
        let reactions = maker.reactor.as_ref().map(|reactor| {
            let load = self.load(&place, t, angle, speed);
            let force = load.force + touch.friction;
            reactor.on_curve(&place, speed, acceleration, force, touch.normal)
        });
        Row {
            t,
            theta: curve.crank_angle(angle).radians(),
            omega: place.dtheta * speed,
            alpha: place.dtheta * acceleration + place.d2theta * speed * speed,
            x: place.x,
            v: place.dx * speed,
            a: place.dx * acceleration + place.d2x * speed * speed,
            phi: place.phi(),
            reactions,
            driving_torque: None,
            clearance: None,
        }
    }
}
