//! Phases of stick-slip motion: between two changes of friction the signs of slider velocity and normal force stay.

use std::cell::Cell;

use EventIndex::{CrankRate, DeadCentre, JamDistance, Limit, NormalForce, Speed, TurnLimit};

use super::coordinate;
use super::guide_friction::NEARBY_ANGLE;
use crate::engine::event_functions::EventFunction;
use crate::engine::events::ANGLE_ROUNDING;
use crate::engine::{Batch, Motion, NODES, fill_one_by_one};
use crate::mechanism::{CurveEquation, CurvePose, GuideForces, LoadValue, Sense};
use crate::numeric::angle::Angle;
use crate::numeric::enclosure::{MotionPiece, Variation};
use crate::scene::Variable;

/// Index of an event function of a motion on the configuration curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum EventIndex {
    /// Speed of the coordinate.
    Speed,
    /// Derivative of the slider position.
    DeadCentre,
    /// Cosine of the rod inclination.
    Limit,
    /// Rotation of the crank that is left to the turn limit.
    TurnLimit,
    /// Normal force of the guide.
    NormalForce,
    /// Distance from jamming.
    JamDistance,
    /// Derivative of the crank angle.
    CrankRate,
}

impl EventIndex {
    /// All indices, in the order of the values.
    pub const ALL: [EventIndex; 7] = [
        Speed,
        DeadCentre,
        Limit,
        TurnLimit,
        NormalForce,
        JamDistance,
        CrankRate,
    ];
}

pub(super) type Signs = [f64; EventIndex::ALL.len()];

/// Phase of the slider in its guide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum StickSlipPhase {
    Sliding {
        /// c = −μ sgn(v) sgn(N), zero without friction.
        c: f64,
        /// Signs of the speeds that dry loads oppose; zero without dry loads.
        opposed: Sense,
    },
    Sticking,
}

impl StickSlipPhase {
    /// Sliding without friction.
    pub const FREE: StickSlipPhase = StickSlipPhase::Sliding {
        c: 0.0,
        opposed: Sense {
            crank: 0.0,
            slider: 0.0,
        },
    };
}

/// Equation of motion on the configuration curve in one phase.
#[derive(Clone, Copy)]
pub(super) struct CurveMotion<'a> {
    pub equation: &'a CurveEquation,
    pub phase: StickSlipPhase,
}

impl CurveMotion<'_> {
    /// Returns acceleration (rad/s² of the coordinate), guide forces, and power (W) of all that has no potential.
    pub fn state(&self, t: f64, angle: Angle, speed: f64) -> (f64, GuideForces, f64) {
        match self.phase {
            StickSlipPhase::Sliding { c, opposed } => {
                let free = self.equation.free_against(t, angle, speed, opposed);
                let (acceleration, touch) = free.sliding(c);
                let power = free.power + touch.friction * (free.dx * speed);
                (acceleration, touch, power)
            }
            StickSlipPhase::Sticking => {
                let touch = self.equation.at_rest(angle).held(t).free.holding();
                (0.0, touch.unwrap_or_default(), 0.0)
            }
        }
    }

    /// Returns torque and force of the loads at a position, dry loads included.
    pub fn load(&self, place: &CurvePose, t: f64, angle: Angle, speed: f64) -> LoadValue {
        let loads = self.equation.loads();
        let now = self.equation.instant(place, t, angle, speed);
        let dry = match self.phase {
            StickSlipPhase::Sliding { opposed, .. } => loads.dry(&now, opposed),
            StickSlipPhase::Sticking => self.equation.at_rest(angle).held(t).dry,
        };
        let smooth = loads
            .with_potential_at(place.x)
            .plus(loads.non_conservative(&now));
        smooth.plus(dry)
    }
}

impl Motion for CurveMotion<'_> {
    fn acceleration(&self, t: f64, angle: Angle, speed: f64) -> f64 {
        self.state(t, angle, speed).0
    }

    fn acceleration_and_power(&self, t: f64, angle: Angle, speed: f64) -> (f64, f64) {
        let (acceleration, _, power) = self.state(t, angle, speed);
        (acceleration, power)
    }

    fn of_times(&self, t: &[f64; NODES]) -> [[f64; 2]; NODES] {
        match self.equation.may_be_batched() {
            true => coordinate::of_times(self.equation.loads(), t),
            false => [[0.0; 2]; NODES],
        }
    }

    fn fill(&self, batch: &mut Batch) {
        match self.phase {
            StickSlipPhase::Sliding { c, opposed } if self.equation.may_be_batched() => {
                coordinate::fill_with(batch, |at, alpha, power| {
                    self.equation.accelerations(at, (c, opposed), alpha, power);
                });
            }
            _ => fill_one_by_one(self, batch),
        }
    }

    fn depends_on_time(&self) -> bool {
        self.equation.loads().reads.has(Variable::T)
    }

    fn has_power(&self) -> bool {
        self.equation.friction.is_some() || !self.equation.loads().have_potential()
    }

    fn next_corner(&self, t: f64) -> f64 {
        self.equation.loads().next_corner(t)
    }

    fn varies_between_nodes(&self) -> bool {
        matches!(self.phase, StickSlipPhase::Sliding { .. })
            && self.equation.loads().vary_between_nodes()
    }

    fn variation(&self, reach: &MotionPiece, ellipse: f64) -> Variation {
        let StickSlipPhase::Sliding { c, .. } = self.phase else {
            return Variation::NONE;
        };
        let loads = self.equation.loads();
        let seen = self
            .equation
            .curve()
            .enclosed_state(reach, loads.slider_use());
        loads.variation(
            &seen,
            self.equation.unit_load_effects(reach.angle, c),
            ellipse,
        )
    }

    fn corner_on_way(&self, from: f64, to: f64) -> Option<f64> {
        let by_crank = self.equation.curve().is_crank_angle();
        by_crank.then(|| self.equation.loads().row_on_way(from, to))?
    }
}

/// Event functions of a run on the configuration curve.
pub(super) struct CurveEvents<'a> {
    pub equation: &'a CurveEquation,
    /// Crank angle at the start and largest rotation of the crank from there, rad.
    pub turn_limit: Option<(Angle, f64)>,
    pub evaluations: Cell<u64>,
    /// Signs of the speeds that dry loads oppose.
    pub opposed: Cell<Sense>,
}

impl EventFunction<{ EventIndex::ALL.len() }> for CurveEvents<'_> {
    fn values(&self, t: f64, angle: Angle, speed: f64) -> Signs {
        let curve = self.equation.curve();
        let place = curve.pose(angle.rest);
        let (normal, clear) = match self.equation.friction {
            Some(friction) => {
                self.evaluations.update(|before| before + 1);
                let opposed = self.opposed.get();
                let free = self.equation.free_against(t, angle, speed, opposed);
                (free.normal, free.clear_of_jam(friction.coefficient))
            }
            None => (1.0, 1.0),
        };
        let turned = self.turn_limit.map_or(1.0, |(start, limit)| {
            limit - curve.crank_angle(angle).minus(start).abs()
        });
        // In the order of `EventIndex`.
        [
            speed,
            place.dx,
            place.rod_cos,
            turned,
            normal,
            clear,
            place.dtheta,
        ]
    }

    /// Only the normal force and the distance from jamming have a double sign change between close positions.
    fn shown_travel(&self, angle: Angle) -> f64 {
        match self.equation.friction {
            Some(_) => self.equation.curve().shown_distance(angle.rest),
            None => f64::INFINITY,
        }
    }
}

/// Returns the signs at the start of a motion in `direction` (±1 of the coordinate). Where a value is zero but for the
/// rounding of the angle, the value `ahead`, a little further on, decides.
pub(super) fn signs(values: Signs, ahead: Signs, direction: f64) -> Signs {
    let mut signs: Signs = std::array::from_fn(|i| {
        let nothing = values[i].abs() <= ANGLE_ROUNDING / NEARBY_ANGLE * ahead[i].abs();
        let value = if nothing { ahead[i] } else { values[i] };
        if value < 0.0 { -1.0 } else { 1.0 }
    });
    signs[Speed as usize] = direction;
    (signs[TurnLimit as usize], signs[JamDistance as usize]) = (1.0, 1.0);
    signs
}

/// Returns the sliding phase that belongs to the signs.
pub(super) fn sliding(equation: &CurveEquation, signs: &Signs) -> StickSlipPhase {
    let friction = equation.friction;
    let mu = friction.map_or(0.0, |friction| friction.coefficient);
    StickSlipPhase::Sliding {
        c: -mu * signs[Speed as usize] * signs[DeadCentre as usize] * signs[NormalForce as usize],
        opposed: opposed(equation, signs),
    }
}

/// Returns the signs of the speeds that dry loads oppose; zero without dry loads.
pub(super) fn opposed(equation: &CurveEquation, signs: &Signs) -> Sense {
    match equation.loads().are_dry() {
        true => Sense::of(
            signs[Speed as usize] * signs[CrankRate as usize],
            signs[Speed as usize] * signs[DeadCentre as usize],
        ),
        false => Sense::default(),
    }
}
