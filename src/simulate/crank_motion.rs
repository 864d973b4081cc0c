//! Equation of motion with the crank angle as the coordinate, as the integrators see it.

use crate::engine::{Batch, Motion};
use crate::mechanism::{Equation, Instants, LoadValue};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{MotionPiece, Variation};
use crate::scene::Variable;

pub(super) struct CrankMotion<'a>(pub &'a Equation);

impl Motion for CrankMotion<'_> {
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

    fn varies_between_nodes(&self) -> bool {
        self.0.loads().vary_between_nodes()
    }

    fn variation(&self, reach: &MotionPiece, ellipse: f64) -> Variation {
        let loads = self.0.loads();
        let seen = self.0.linkage().enclosed_state(reach, loads.meet_slider());
        let force = loads.variation(&seen, seen.unit_load_effects(), ellipse);
        force.times(1.0 / self.0.terms(reach.angle.middle()).inertia.m)
    }

    fn corner_on_way(&self, from: f64, to: f64) -> Option<f64> {
        self.0.loads().row_on_way(from, to)
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
