//! Rows of a finished run at any time: its dense motion, read by its equation.

use std::sync::Arc;

use super::configuration_curve::{AlongCurve, Phase};
use super::guide_friction::Sliding;
use super::recorder::Coordinate;
use super::row::{Row, RowMaker};
use crate::mechanism::CurveEquation;
use crate::numeric::angle::Angle;
use crate::trajectory::Trajectory;

/// A time during which the slider touches its guide in one way, on the configuration curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spell {
    /// s
    pub from: f64,
    /// s
    pub until: f64,
    pub phase: Phase,
}

/// Takes a step in one phase.
pub(super) fn lengthen(spells: &mut Vec<Spell>, [from, until]: [f64; 2], phase: Phase) {
    match spells.last_mut() {
        Some(last) if last.until == from && last.phase == phase => last.until = until,
        _ => spells.push(Spell { from, until, phase }),
    }
}

/// What makes rows of a finished run.
#[derive(Clone, Debug, Default)]
pub(super) struct DenseRows {
    pub maker: Option<RowMaker>,
    /// Crank acceleration of a prescribed motion, rad/s².
    pub alpha: Option<f64>,
    /// The configuration curve whose coordinate the whole run follows, if it does.
    pub curve: Option<Arc<CurveEquation>>,
    /// When the motion was computed along a configuration curve, in order.
    pub spells: Vec<Spell>,
}

impl DenseRows {
    /// The row at a time, s; none outside the run, of a loose joint, and where a number is not finite.
    pub fn row(&self, trajectory: &Trajectory, t: f64) -> Option<Row> {
        let maker = self.maker.as_ref()?;
        let (angle, speed) = trajectory.coordinate(t)?;
        let after = self.spells.partition_point(|spell| spell.until < t);
        let spell = self.spells.get(after).filter(|spell| spell.from <= t);
        let row = match spell {
            Some(spell) => {
                let guide = maker.sliding.as_deref().map(Sliding::equation);
                let equation = self.curve.as_deref().or(guide)?;
                let reactor = maker.reactor.as_deref();
                AlongCurve::new(equation, spell.phase, reactor, Angle::default())
                    .row(t, angle, speed)
            }
            None => maker.row(t, angle, speed, self.alpha),
        };
        [row.theta, row.omega, row.alpha, row.x, row.v, row.a]
            .iter()
            .all(|number| number.is_finite())
            .then_some(row)
    }
}
